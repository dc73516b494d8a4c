//! Push-pull by size and by share of holes.
//!
//! ```sh
//! cargo bench -p galpix-bench --bench inpaint                # all, about two minutes
//! cargo bench -p galpix-bench --bench inpaint -- share       # run time against the share of holes
//! ```
//!
//! Each group has a plot of its times, `target/criterion/*/report/lines.svg`. Holes are strips at places that a counter
//! gives, one to eight cells wide, as uncovered areas are. The dense form is a reference inside the core and is not
//! measured any more. For ratios to a memory copy and to floats see `src/bin/inpaint.rs`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use galpix_bench::holes::{Holes, Picture, picture, strips};
use galpix_core::inpaint::{self, Gamma, Motion, PushPull};
use galpix_core::{Colour, Inpainting};

const SIZES: [u32; 3] = [512, 1024, 2048];

/// Per mille of the cells.
const SHARES: [u32; 7] = [2, 10, 20, 50, 100, 200, 400];

/// Memory for a picture of a size, and the fill.
struct Filler {
    width: u32,
    height: u32,
    memory: Vec<u32>,
}

impl Filler {
    fn new(width: u32, height: u32) -> Self {
        Self { width, height, memory: vec![0; PushPull::words(width, height, Motion::Kept)] }
    }

    fn fill(&mut self, picture: &mut Picture, inpainting: &Inpainting<'_>) {
        let (width, height) = (self.width, self.height);
        let mut push_pull = PushPull::new(width, height, Motion::Kept, &mut self.memory).expect("memory enough");
        let mut holed = inpaint::Picture::new(width, height, Colour::RGB888, &mut picture.colours, &picture.known)
            .expect("slices long enough");
        if inpainting.threshold != u32::MAX {
            holed = holed.with_depths(&picture.depths).expect("slices long enough");
        }
        black_box(push_pull.fill_picture(&mut holed, inpainting));
    }
}

fn inpaintings(threshold: u32) -> [(&'static str, Inpainting<'static>); 4] {
    let aware = |gamma| Inpainting { gamma, threshold, ..Inpainting::classic() };
    [
        ("classic", Inpainting::classic()),
        ("depth-aware-gamma-0", aware(Gamma::Zero)),
        ("depth-aware-gamma-half", aware(Gamma::Half)),
        ("depth-aware-gamma-1", aware(Gamma::One)),
    ]
}

/// What a step leaves, by size.
fn sizes(criterion: &mut Criterion) {
    for side in SIZES {
        let mut holed = picture(side, side, Holes::Slivers);
        let mut filler = Filler::new(side, side);
        let mut group = criterion.benchmark_group(format!("size={side}"));
        group.throughput(Throughput::Elements(u64::from(side) * u64::from(side)));
        for (name, inpainting) in inpaintings(holed.threshold) {
            group.bench_function(name, |bencher| bencher.iter(|| filler.fill(&mut holed, &inpainting)));
        }
        group.finish();
    }
}

/// Run time against the share of holes, at 1024 x 1024.
fn shares(criterion: &mut Criterion) {
    const SIDE: u32 = 1024;
    let mut filler = Filler::new(SIDE, SIDE);
    let mut group = criterion.benchmark_group("share");
    for share in SHARES {
        let mut holed = strips(SIDE, SIDE, share);
        for (name, inpainting) in inpaintings(holed.threshold) {
            group.bench_with_input(BenchmarkId::new(name, share), &share, |bencher, _| {
                bencher.iter(|| filler.fill(&mut holed, &inpainting));
            });
        }
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(800));
    targets = sizes, shares
}
criterion_main!(benches);
