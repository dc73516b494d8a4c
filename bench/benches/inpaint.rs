//! Push-pull by size and by share of holes.
//!
//! ```sh
//! cargo bench -p galpix-bench --bench inpaint                # all, about two minutes
//! cargo bench -p galpix-bench --bench inpaint -- share       # run time against the share of holes
//! ```
//!
//! Each group has a plot of its times, `target/criterion/*/report/lines.svg`. Holes are strips at places that a counter
//! gives, one to eight cells wide, as uncovered areas are. For ratios to a memory copy and to floats see
//! `src/bin/inpaint.rs`.

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use galpix_bench::holes::{Holes, Picture, picture, strips};
use galpix_core::Colour;
use galpix_core::inpaint::levels;
use galpix_core::inpaint::paint::Tint;
use galpix_core::inpaint::picture::Masked;
use galpix_core::inpaint::push_pull::{Rule, dense, sparse};
use galpix_core::inpaint::pyramid::{Cell, Pyramid, state_words};
use galpix_core::inpaint::validity::Gamma;

const SIZES: [u32; 3] = [512, 1024, 2048];

/// Per mille of the cells.
const SHARES: [u32; 7] = [2, 10, 20, 50, 100, 200, 400];

/// Memory for a picture of a size, and the fill.
struct Filler {
    width: u32,
    height: u32,
    cells: Vec<Cell<Tint>>,
    states: Vec<u32>,
}

impl Filler {
    fn new(width: u32, height: u32) -> Self {
        let cells = vec![Cell::default(); levels::cells(width, height)];
        let states = vec![0; state_words(cells.len())];
        Self { width, height, cells, states }
    }

    fn fill(&mut self, picture: &mut Picture, rule: &Rule, all: bool) {
        let (width, height) = (self.width, self.height);
        let mut pyramid = Pyramid::new(width, height, &mut self.cells, &mut self.states).expect("memory enough");
        let depths: &[u32] = if rule.threshold == u32::MAX { &[] } else { &picture.depths };
        let mut masked = Masked::new(width, height, Colour::RGB888, &mut picture.colours, &picture.known, depths)
            .expect("slices long enough");
        let fill = if all { dense } else { sparse };
        black_box(fill(&mut masked, &mut pyramid, rule));
    }
}

fn rules(threshold: u32) -> [(&'static str, Rule, bool); 5] {
    let rule = |gamma, threshold| Rule { gamma, threshold };
    [
        ("classic", rule(Gamma::Zero, u32::MAX), false),
        ("classic-dense", rule(Gamma::Zero, u32::MAX), true),
        ("depth-aware-gamma-0", rule(Gamma::Zero, threshold), false),
        ("depth-aware-gamma-half", rule(Gamma::Half, threshold), false),
        ("depth-aware-gamma-1", rule(Gamma::One, threshold), false),
    ]
}

/// What a step leaves, by size.
fn sizes(criterion: &mut Criterion) {
    for side in SIZES {
        let mut holed = picture(side, side, Holes::Slivers);
        let mut filler = Filler::new(side, side);
        let mut group = criterion.benchmark_group(format!("size={side}"));
        group.throughput(Throughput::Elements(u64::from(side) * u64::from(side)));
        for (name, rule, all) in rules(holed.threshold) {
            group.bench_function(name, |bencher| bencher.iter(|| filler.fill(&mut holed, &rule, all)));
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
        for (name, rule, all) in rules(holed.threshold) {
            group.bench_with_input(BenchmarkId::new(name, share), &share, |bencher, _| {
                bencher.iter(|| filler.fill(&mut holed, &rule, all));
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
