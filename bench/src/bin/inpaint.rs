//! Push-pull compared with a memory copy and with the textbook's in floats, in one run.
//!
//! ```sh
//! cargo run --release -p galpix-bench --bin inpaint                              # 1024x1024, 15 rounds
//! taskset -c 1 cargo run --release -p galpix-bench --bin inpaint -- 512x512 31   # pinned to a core
//! ```
//!
//! The picture is what a step makes of the scene of the benches: `all` are all its holes, `slivers` those that are left
//! when bullet holes are filled; `map` are these in a galpixmap, with the motion of what is filled, by push-pull with
//! quads unless the name says otherwise, and by metamers. The copy is of 20 bytes per cell, a map of the paper's
//! galpixels. The columns are described in `race.rs`.
//!
//! Ours computes what the holes need, the textbook's all cells.

use std::cell::RefCell;
use std::hint::black_box;
use std::process::ExitCode;
use std::rc::Rc;

use galpix_bench::holes::{Holes, Picture, picture};
use galpix_bench::race::{Contender, arguments, race, table};
use galpix_bench::scene::{Motion, samples};
use galpix_bench::textbook::{Pixel, Textbook};
use galpix_bench::{Full, Maps};
use galpix_core::inpaint::{self, Gamma, Metamer, MetamerWorkspace, PushPull, Recipe};
use galpix_core::{Colour, Controller, Inpainting, Settings, Static};

/// What others are compared with.
const TEXTBOOK: &str = "textbook f32, dense";

/// Bytes of the copy for each cell.
const COPIED: usize = 20;

fn main() -> ExitCode {
    match arguments() {
        Ok((size, rounds)) => {
            compare(size, rounds);
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::from(2)
        }
    }
}

fn compare((width, height): (u32, u32), rounds: usize) {
    let cells = width * height;
    println!("{width}x{height}, {rounds} rounds");
    let mut contenders = Vec::new();
    for holes in [Holes::All, Holes::Slivers] {
        let picture = Rc::new(picture(width, height, holes));
        println!("{}: {:.2} % of the cells are holes", holes.name(), 100.0 * picture.share());
        contenders.push(textbook(&picture, holes.name(), (width, height)));
        let depth_aware = picture.threshold;
        for (gamma, threshold) in
            [(Gamma::Zero, u32::MAX), (Gamma::Zero, depth_aware), (Gamma::Half, depth_aware), (Gamma::One, depth_aware)]
        {
            let aware = if threshold == u32::MAX { "" } else { ", depth-aware" };
            let what = format!("push-pull, gamma {}{aware}", gamma.name());
            let run = ours(&picture, (width, height), Inpainting { gamma, threshold, ..Inpainting::classic() });
            let bytes = COPIED * cells as usize;
            contenders.push(Contender::new(what, holes.name(), bytes, Box::new(|| {}), run));
        }
    }
    contenders.extend(on_a_map((width, height)));
    contenders.extend(metamers((width, height)));
    race(&mut contenders, cells, rounds);
    table(&contenders, cells, TEXTBOOK);
}

fn ours(picture: &Rc<Picture>, (width, height): (u32, u32), inpainting: Inpainting<'static>) -> Box<dyn FnMut()> {
    let picture = Rc::clone(picture);
    let mut colours = picture.colours.clone();
    let mut memory = vec![0; PushPull::words(width, height, inpaint::Motion::Kept)];
    Box::new(move || {
        let mut push_pull = PushPull::new(width, height, inpaint::Motion::Kept, &mut memory).expect("memory enough");
        let mut holed = inpaint::Picture::new(width, height, Colour::RGB888, &mut colours, &picture.known)
            .expect("slices long enough");
        if inpainting.threshold != u32::MAX {
            holed = holed.with_depths(&picture.depths).expect("slices long enough");
        }
        black_box(push_pull.fill_picture(&mut holed, &inpainting));
    })
}

/// A controller that several contenders share.
type Shared = Rc<RefCell<Controller<'static, Static<Full>>>>;

/// Returns a controller of the scene after a step, and how that was made.
fn stepped((width, height): (u32, u32)) -> (Shared, Settings) {
    let maps = Maps::new(width, height, Static::<Full>::new(), &samples(width, height, Motion::Scene));
    let settings = *maps.settings();
    let mut controller = maps.into_controller();
    controller.step(&settings);
    (Rc::new(RefCell::new(controller)), settings)
}

/// Returns the stage as a controller has it: the holes of a galpixmap, with motion, and the depth of the background
/// before.
fn on_a_map((width, height): (u32, u32)) -> Vec<Contender> {
    let (controller, settings) = stepped((width, height));
    let depth_bits = u32::from(controller.borrow().front().record().depth().bits);
    let bytes = COPIED * (width * height) as usize;
    let aware = |gamma| Inpainting::for_depth(depth_bits, gamma);
    [
        ("classic", Inpainting::classic()),
        ("depth-aware, gamma 0, without quads", Inpainting { quads: false, ..aware(Gamma::Zero) }),
        ("depth-aware, gamma 0", aware(Gamma::Zero)),
        ("depth-aware, gamma 1/2", aware(Gamma::Half)),
    ]
    .into_iter()
    .map(|(name, inpainting)| {
        let controller = Rc::clone(&controller);
        let mut memory = vec![0; PushPull::words(width, height, inpaint::Motion::Inpainted)];
        // What is uncovered stays so: the stage can be repeated.
        let run = move || {
            let mut push_pull =
                PushPull::new(width, height, inpaint::Motion::Inpainted, &mut memory).expect("memory enough");
            black_box(controller.borrow_mut().inpaint(&settings, &inpainting, &mut push_pull));
        };
        Contender::new(name, "map", bytes, Box::new(|| {}), Box::new(run))
    })
    .collect()
}

/// Metamers in the same map.
fn metamers((width, height): (u32, u32)) -> Vec<Contender> {
    let (controller, settings) = stepped((width, height));
    let depth_bits = u32::from(controller.borrow().front().record().depth().bits);
    let bytes = COPIED * (width * height) as usize;
    [(Gamma::Half, 5), (Gamma::Half, 3), (Gamma::Zero, 5)]
        .into_iter()
        .map(|(gamma, levels)| {
            let controller = Rc::clone(&controller);
            let mut memory = vec![0; Metamer::words(width, height, levels)];
            let mut workspace = Box::new(MetamerWorkspace::new());
            let inpainting = Inpainting::for_depth(depth_bits, gamma);
            let recipe = Recipe { levels, ..Recipe::default() };
            let run = move || {
                let mut metamer =
                    Metamer::new(width, height, recipe, &mut memory, &mut workspace).expect("memory enough");
                let mut controller = controller.borrow_mut();
                black_box(controller.synthesise(&settings, &inpainting, &mut metamer)).expect("memory enough");
            };
            let what = format!("metamers, gamma {}, {levels} levels", gamma.name());
            Contender::new(what, "map", bytes, Box::new(|| {}), Box::new(run))
        })
        .collect()
}

fn textbook(picture: &Rc<Picture>, group: &str, (width, height): (u32, u32)) -> Contender {
    let pixels: Vec<Pixel> = (0..picture.colours.len())
        .map(|cell| {
            let colour = picture.colours[cell];
            let channel = |shift: u32| (colour >> shift & 255) as f32;
            let known = picture.known[cell / 32] >> (cell % 32) & 1;
            [channel(16), channel(8), channel(0), known as f32]
        })
        .collect();
    let mut textbook = Textbook::new(width as usize, height as usize);
    let bytes = COPIED * (width * height) as usize;
    let run = move || {
        black_box(textbook.fill(black_box(&pixels)));
    };
    Contender::new(TEXTBOOK, group, bytes, Box::new(|| {}), Box::new(run))
}
