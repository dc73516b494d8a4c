//! The calls. Each is a function of its own, so that the machine code of what happens in every frame (`proof_`) can be
//! told from that of setting up and of looking at single galpixels, which may multiply (`call_`).

use core::hint::black_box;

use galpix_core::frame::{self, Controller, Inpainting, Scratch, Settings};
use galpix_core::galpixel::{Budget, Galpixel, Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::graft::{Grafted, graft};
use galpix_core::grid::Grid;
use galpix_core::inpaint::paint::{Moving, Tint};
use galpix_core::inpaint::pyramid::Pyramid;
use galpix_core::layout::Layout;
use galpix_core::rolling::Rolling;
use galpix_core::rounding::Rounding;
use galpix_core::tally::Tally;
use galpix_core::{edge, fill, scan_out, sweep};

use crate::Inputs;

type Map<'p, L, B> = Galpixmap<'p, L, B>;

/// Everything a firmware calls, for a layout and a budget fixed at compile time.
#[inline(never)]
pub fn call_all<L: Layout, P: Profile>(inputs: &mut Inputs<'_>) {
    with_two_maps::<L, P>(inputs);
    with_one_map::<L, P>(inputs);
}

fn with_two_maps<L: Layout, P: Profile>(inputs: &mut Inputs<'_>) {
    let Inputs {
        size,
        wings,
        place,
        frame,
        settings,
        galpixel,
        rows,
        maps,
        scratch,
        line,
        inpainting,
        moving,
        states,
        ..
    } = black_box(inputs);
    let ([front, back], [winners, edges], [x, y]) = (maps, scratch, *place);
    let budget = Static::<P>::new();
    let Ok(grid) = Grid::new(size[0], size[1], *wings, rows) else { return };
    let Ok(mut front) = Map::<L, _>::new(grid, budget, front) else { return };
    let Ok(mut back) = Map::<L, _>::over(grid, budget, back) else { return };

    black_box(proof_store(&mut front, x, y, galpixel));
    black_box(call_load(&front, x, y));
    black_box(call_rgb888(&front, x, y));
    black_box(proof_edge(&front, settings.edge_threshold, edges));
    black_box(proof_edge_single(&front, settings.edge_threshold, edges));
    black_box(proof_sweep_single(&front, &mut back, winners, settings.rounding, *frame));
    let mut tally = black_box(proof_sweep(&front, &mut back, winners, settings.rounding, *frame));
    let mut scratch = Scratch { winners, edges };
    proof_fill(&front, &mut back, &mut scratch, settings, &mut tally);
    black_box(tally);
    black_box(proof_frame(&front, &mut back, &mut scratch, settings, *frame));
    let Ok(mut controller) = Controller::new(front, back, scratch) else { return };
    black_box(proof_controller(&mut controller, settings));
    if let Ok(mut pyramid) = Pyramid::new(size[0], size[1], moving, states) {
        black_box(proof_inpaint_controller(&mut controller, settings, inpainting, &mut pyramid));
    }
    proof_scan_out(controller.front(), *frame, line);
    black_box(&line);
}

fn with_one_map<L: Layout, P: Profile>(inputs: &mut Inputs<'_>) {
    let Inputs {
        size, wings, place, frame, settings, rows, window_rows, maps, scratch, inpainting, tints, states, ..
    } = black_box(inputs);
    let ([map, window], [winners, edges]) = (maps, scratch);
    let budget = Static::<P>::new();
    let Ok(grid) = Grid::new(size[0], size[1], *wings, rows) else { return };
    let Ok(rolls) = Grid::window(&grid, size[1], window_rows) else { return };
    let Ok(map) = Map::<L, _>::over(grid, budget, map) else { return };
    let Ok(window) = Map::<L, _>::over(rolls, budget, window) else { return };
    let Ok(mut rolling) = Rolling::new(map, window, Scratch { winners, edges }) else { return };
    black_box(proof_rolling(&mut rolling, settings));
    if let Ok(mut pyramid) = Pyramid::new(size[0], size[1], tints, states) {
        black_box(proof_inpaint_rolling(&mut rolling, settings, inpainting, &mut pyramid));
    }
    let rounding = settings.rounding;
    black_box(proof_graft(rolling.map_mut(), (place[0], place[1]), black_box(&[0; 8]), rounding, *frame));
}

#[inline(never)]
fn proof_store<L: Layout, B: Budget<L>>(map: &mut Map<'_, L, B>, x: i32, y: i32, galpixel: &Galpixel) -> Option<u32> {
    map.store(x, y, galpixel)
}

#[inline(never)]
fn call_load<L: Layout, B: Budget<L>>(map: &Map<'_, L, B>, x: i32, y: i32) -> Option<Galpixel> {
    map.load(x, y)
}

#[inline(never)]
fn call_rgb888<L: Layout, B: Budget<L>>(map: &Map<'_, L, B>, x: i32, y: i32) -> Option<[u8; 3]> {
    map.rgb888(x, y)
}

#[inline(never)]
fn proof_edge<L: Layout, B: Budget<L>>(map: &Map<'_, L, B>, threshold: u32, edges: &mut [u32]) -> u32 {
    edge::mark(map, threshold, edges)
}

#[inline(never)]
fn proof_edge_single<L: Layout, B: Budget<L>>(map: &Map<'_, L, B>, threshold: u32, edges: &mut [u32]) -> u32 {
    edge::single::mark(map, threshold, edges)
}

#[inline(never)]
fn proof_sweep<L: Layout, B: Budget<L>>(
    front: &Map<'_, L, B>,
    back: &mut Map<'_, L, B>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    sweep::sweep(front, back, winners, rounding, frame)
}

#[inline(never)]
fn proof_sweep_single<L: Layout, B: Budget<L>>(
    front: &Map<'_, L, B>,
    back: &mut Map<'_, L, B>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    sweep::single::sweep(front, back, winners, rounding, frame)
}

#[inline(never)]
fn proof_fill<L: Layout, B: Budget<L>>(
    front: &Map<'_, L, B>,
    back: &mut Map<'_, L, B>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    fill::fill(front, back, scratch.winners, scratch.edges, settings.rung, settings.reach, tally);
}

/// In either mode.
#[inline(never)]
fn proof_frame<L: Layout, B: Budget<L>>(
    front: &Map<'_, L, B>,
    back: &mut Map<'_, L, B>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    frame: u32,
) -> Tally {
    frame::step(front, back, scratch, settings, frame)
}

#[inline(never)]
fn proof_controller<L: Layout, B: Budget<L>>(controller: &mut Controller<'_, L, B>, settings: &Settings) -> Tally {
    controller.step(settings)
}

#[inline(never)]
fn proof_rolling<L: Layout, B: Budget<L>>(rolling: &mut Rolling<'_, L, B>, settings: &Settings) -> Tally {
    rolling.step(settings)
}

/// Quads and push-pull, sparse and dense, of colours with their motion.
#[inline(never)]
fn proof_inpaint_controller<L: Layout, B: Budget<L>>(
    controller: &mut Controller<'_, L, B>,
    settings: &Settings,
    inpainting: &Inpainting<'_>,
    pyramid: &mut Pyramid<'_, Moving>,
) -> u32 {
    controller.inpaint(settings, inpainting, pyramid)
}

/// Push-pull in one map, sparse and dense, of colours.
#[inline(never)]
fn proof_inpaint_rolling<L: Layout, B: Budget<L>>(
    rolling: &mut Rolling<'_, L, B>,
    settings: &Settings,
    inpainting: &Inpainting<'_>,
    pyramid: &mut Pyramid<'_, Tint>,
) -> u32 {
    rolling.inpaint(settings, inpainting, pyramid)
}

#[inline(never)]
fn proof_graft<L: Layout, B: Budget<L>>(
    map: &mut Map<'_, L, B>,
    place: (i32, i32),
    words: &[u32],
    rounding: Rounding,
    frame: u32,
) -> Grafted {
    graft(map, place, words, rounding, frame, black_box(frame))
}

/// A row for a display of 16-bit words.
#[inline(never)]
fn proof_scan_out<L: Layout, B: Budget<L>>(map: &Map<'_, L, B>, y: u32, line: &mut [u16]) {
    for (word, colour) in line.iter_mut().zip(scan_out::row(map, y)) {
        *word = colour as u16;
    }
}
