//! tuning
use galpix_sim::ddoc::{Request, missing, open, reference, view::View, warp::Joint};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let var = |name: &str, default: f64| std::env::var(name).map_or(default, |s| s.parse().unwrap());
    let size: usize = args[2].parse().unwrap();
    let mut world = open(&args[1]).unwrap();
    let request = Request { size, radius: args[3].parse().unwrap(), asymmetry: args[4].parse().unwrap() };
    world.half_side = var("HALF", world.half_side);
    let mut settings = request.settings();
    settings.window = var("WINDOW", settings.window as f64) as u32;
    settings.conflict = (var("COS", 0.0) * 16384.0) as i32;
    let step = var("STEP", request.joints()[0].step as f64) as f32;
    let plain = reference::plain(&world, &View::reference(size));
    let ddoc = reference::ddoc(&world, size, &settings).unwrap();
    let joints = request.joints();
    let a = Joint { step, ..joints[0] };
    let b = Joint { step, reach: joints[1].reach + var("EXTRA", 0.0) as f32 };
    let all = missing::count(&world, size, &[(&plain, a), (&ddoc.image, b)]);
    let sum = |f: &dyn Fn(&missing::Missing) -> u32| all.iter().map(f).sum::<u32>() as f64;
    let (p, d, sp, sd) = (sum(&|m| m.missing[0]), sum(&|m| m.missing[1]), sum(&|m| m.strict[0]), sum(&|m| m.strict[1]));
    println!(
        "{} {size} D {} a {} half {} near {:.2} tri {}: {p} {d} {:.3}  strict {sp} {sd} {:.3}  {:?} {:?}",
        args[1],
        args[3],
        args[4],
        world.half_side,
        world.near,
        world.triangles.len(),
        d / p,
        sd / sp,
        ddoc.seconds,
        ddoc.tally
    );
}
