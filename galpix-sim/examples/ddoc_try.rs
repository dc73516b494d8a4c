use galpix_sim::ddoc::{distortion, missing, reference, view::View, warp::Joint, world::World};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let size: usize = args[2].parse().unwrap();
    let radius: u32 = args[3].parse().unwrap();
    let asym: f64 = args[4].parse().unwrap();
    let mut world = World::of_scene(galpix_sim::scene::find(&args[1]).unwrap());
    if let Some(half) = args.get(5) {
        world.half_side = half.parse().unwrap();
    }
    let step: f32 = args.get(6).map_or(1.0 / 64.0, |s| s.parse().unwrap());
    let window: u32 = args.get(7).map_or(3, |s| s.parse().unwrap());
    println!("{} triangles near {}", world.triangles.len(), world.near);
    let settings = galpix_core::ddoc::Settings {
        radius,
        asymmetry: (16.0 * asym) as u32,
        window,
        threshold: (step * (1u32 << 24) as f32) as u32,
        ..distortion::settings()
    };
    let plain = reference::plain(&world, &View::reference(size));
    let ddoc = reference::ddoc(&world, size, &settings).unwrap();
    println!("{:?} {:?}", ddoc.tally, ddoc.seconds);
    let a = Joint { step, reach: 1.5 };
    let b = Joint { step, reach: 2.0 * asym as f32 + 1.5 };
    for near in [0, 1] {
        let all = missing::count(&world, size, &[(&plain, a), (&ddoc.image, b)], near);
        let sum = |i: usize| all.iter().map(|m| m.missing[i]).sum::<u32>();
        let truth: u32 = all.iter().map(|m| m.truth).sum();
        println!(
            "near {near}: truth {truth} plain {} ddoc {} ratio {:.3}",
            sum(0),
            sum(1),
            f64::from(sum(1)) / f64::from(sum(0))
        );
    }
    let save = |r: &reference::Reference, name: &str| {
        let p = galpix_sim::picture::Picture {
            width: size,
            height: size,
            pixels: r.raster.carried.iter().map(|c| [c[0] as u8, c[1] as u8, c[2] as u8]).collect(),
        };
        p.write_png(std::path::Path::new(name)).unwrap();
    };
    save(&plain, "/tmp/ddoc-plain.png");
    save(&ddoc.image, "/tmp/ddoc-ddoc.png");
    let view = missing::desired([world.half_side, 0.0, 0.0], size);
    let truth = reference::plain(&world, &view);
    for (r, j, name) in [(&plain, a, "plain"), (&ddoc.image, b, "ddoc")] {
        let f = galpix_sim::ddoc::warp::warp(r, &view, &j);
        let m = missing::mask(&truth.raster, &f, 1);
        let p = galpix_sim::picture::Picture {
            width: f.width,
            height: f.height,
            pixels: f
                .carried
                .iter()
                .zip(&m)
                .map(|(c, &m)| if m { [255, 0, 255] } else { [c[0] as u8, c[1] as u8, c[2] as u8] })
                .collect(),
        };
        p.write_png(std::path::Path::new(&format!("/tmp/ddoc-frame-{name}.png"))).unwrap();
    }
}
