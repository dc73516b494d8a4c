//! Each stage of a frame by layout, size and motion.
//!
//! ```sh
//! cargo bench -p galpix-bench                                     # all, about five minutes
//! cargo bench -p galpix-bench -- 'stage=sweep/layout=Full/.*/motion=scene'
//! RUSTFLAGS='-C target-cpu=native' cargo bench -p galpix-bench -- stage=sweep
//! ```
//!
//! `sweep` is propagation and resolution, `sweep-winners` the same with the winner map that the richer fill modes need.
//! For ratios to a memory copy and to floats, which depend less on the machine, see `src/bin/ratios.rs`.

use std::cell::{LazyCell, RefCell};
use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use galpix_bench::naive::{Pixel, propagate};
use galpix_bench::scene::{Motion, samples};
use galpix_bench::{Flat565, Full, Maps, Velocity565};
use galpix_core::{Profile, Static};

const SIZES: [(u32, u32); 3] = [(320, 240), (512, 512), (1024, 1024)];

fn stages<P: Profile + 'static>(criterion: &mut Criterion, layout: &str) {
    for ((width, height), motion) in SIZES.into_iter().flat_map(|size| Motion::ALL.map(|motion| (size, motion))) {
        let name = format!("layout={layout}/size={width}x{height}/motion={}", motion.name());
        // Made when a bench needs it: what a filter leaves out costs nothing.
        let maps = LazyCell::new(|| {
            RefCell::new(Maps::new(width, height, Static::<P>::new(), &samples(width, height, motion)))
        });
        for stage in Maps::<Static<P>>::stages() {
            let mut group = criterion.benchmark_group(format!("stage={}", stage.name));
            group.throughput(Throughput::Elements(u64::from(width) * u64::from(height)));
            group.bench_function(&name, |bencher| {
                let maps = &mut *maps.borrow_mut();
                let Some(before) = stage.before else { return bencher.iter(|| (stage.run)(maps)) };
                bencher.iter_custom(|times| {
                    let mut timed = Duration::ZERO;
                    for _ in 0..times {
                        before(maps);
                        let start = Instant::now();
                        (stage.run)(maps);
                        timed += start.elapsed();
                    }
                    timed
                });
            });
            group.finish();
        }
    }
}

/// The obvious version in floats, under the same names.
fn floats(criterion: &mut Criterion) {
    for ((width, height), motion) in SIZES.into_iter().flat_map(|size| Motion::ALL.map(|motion| (size, motion))) {
        let mut group = criterion.benchmark_group("stage=sweep");
        group.throughput(Throughput::Elements(u64::from(width) * u64::from(height)));
        let name = format!("layout=naive-f32/size={width}x{height}/motion={}", motion.name());
        group.bench_function(name, |bencher| {
            let old: Vec<_> = samples(width, height, motion).iter().map(Pixel::from).collect();
            let mut new = vec![Pixel::default(); old.len()];
            bencher.iter(|| propagate(black_box(&old), black_box(&mut new), width as usize, height as usize));
        });
        group.finish();
    }
}

fn all(criterion: &mut Criterion) {
    stages::<Full>(criterion, "Full");
    stages::<Flat565>(criterion, "Flat565");
    stages::<Velocity565>(criterion, "Velocity565");
    floats(criterion);
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_millis(1200));
    targets = all
}
criterion_main!(benches);
