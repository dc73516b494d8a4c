//! The calls. Each is a function of its own, so that the machine code of what happens in every frame (`proof_`) can be
//! told from that of setting up and of looking at single galpixels, which may multiply (`call_`).

use core::hint::black_box;

use galpix_core::inpaint::PushPull;
use galpix_core::rolling::Rolling;
use galpix_core::{
    Controller, Delay, Format, Galpixel, Galpixmap, Grafted, Grid, Inpainting, Profile, Rounding, Scratch, Settings,
    Static, Tally, graft, scan_out, stages,
};

use crate::Inputs;

/// Calls everything that a firmware calls, for a format fixed at compile time.
#[inline(never)]
pub fn call_all<P: Profile>(inputs: &mut Inputs<'_>) {
    with_two_maps::<P>(inputs);
    with_one_map::<P>(inputs);
}

fn with_two_maps<P: Profile>(inputs: &mut Inputs<'_>) {
    let Inputs {
        size,
        margin,
        place,
        frame,
        settings,
        galpixel,
        rows,
        maps,
        scratch,
        line,
        inpainting,
        motion,
        push_pull,
        ..
    } = black_box(inputs);
    let ([front, back], [winners, edges], [x, y]) = (maps, scratch, *place);
    let format = Static::<P>::new();
    let Ok(grid) = Grid::new(size[0], size[1], *margin, rows) else { return };
    let Ok(mut front) = Galpixmap::new(grid, format, front) else { return };
    let Ok(mut back) = Galpixmap::over(grid, format, back) else { return };

    black_box(proof_store(&mut front, x, y, galpixel));
    black_box(call_load(&front, x, y));
    black_box(call_rgb888(&front, x, y));
    black_box(proof_edge(&front, settings.edge_threshold, edges));
    let mut tally = black_box(proof_sweep(&front, &mut back, winners, settings.rounding, *frame));
    let mut scratch = Scratch { winners, edges };
    proof_fill(&front, &mut back, &mut scratch, settings, &mut tally);
    black_box(tally);
    let Ok(mut controller) = Controller::new(front, back, scratch) else { return };
    controller.set_frame(*frame);
    black_box(proof_step(&mut controller, settings));
    black_box(proof_step_constant_time(&mut controller, settings));
    if let Ok(mut push_pull) = PushPull::new(size[0], size[1], *motion, push_pull) {
        black_box(proof_inpaint_controller(&mut controller, settings, inpainting, &mut push_pull));
    }
    proof_scan_out(controller.front(), *frame, line);
    black_box(&line);
}

fn with_one_map<P: Profile>(inputs: &mut Inputs<'_>) {
    let Inputs {
        size,
        margin,
        place,
        frame,
        settings,
        rows,
        window_rows,
        maps,
        scratch,
        inpainting,
        motion,
        push_pull,
        ..
    } = black_box(inputs);
    let ([map, window], [winners, edges]) = (maps, scratch);
    let format = Static::<P>::new();
    let Ok(grid) = Grid::new(size[0], size[1], *margin, rows) else { return };
    let Ok(rolls) = Grid::window(&grid, size[1], window_rows) else { return };
    let Ok(map) = Galpixmap::over(grid, format, map) else { return };
    let Ok(window) = Galpixmap::over(rolls, format, window) else { return };
    let Ok(mut rolling) = Rolling::new(map, window, Scratch { winners, edges }) else { return };
    black_box(proof_rolling(&mut rolling, settings));
    if let Ok(mut push_pull) = PushPull::new(size[0], size[1], *motion, push_pull) {
        black_box(proof_inpaint_rolling(&mut rolling, inpainting, &mut push_pull));
    }
    let rounding = settings.rounding;
    black_box(proof_graft(rolling.map_mut(), (place[0], place[1]), black_box(&[0; 8]), rounding, *frame));
}

#[inline(never)]
fn proof_store<F: Format>(map: &mut Galpixmap<'_, F>, x: i32, y: i32, galpixel: &Galpixel) -> Option<u32> {
    map.store(x, y, galpixel)
}

#[inline(never)]
fn call_load<F: Format>(map: &Galpixmap<'_, F>, x: i32, y: i32) -> Option<Galpixel> {
    map.load(x, y)
}

#[inline(never)]
fn call_rgb888<F: Format>(map: &Galpixmap<'_, F>, x: i32, y: i32) -> Option<[u8; 3]> {
    map.rgb888(x, y)
}

#[inline(never)]
fn proof_edge<F: Format>(map: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    stages::mark(map, threshold, edges)
}

#[inline(never)]
fn proof_sweep<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    stages::sweep(front, back, winners, rounding, frame)
}

#[inline(never)]
fn proof_fill<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    stages::fill(front, back, scratch, settings, tally);
}

#[inline(never)]
fn proof_step<F: Format>(controller: &mut Controller<'_, F>, settings: &Settings) -> Tally {
    controller.step(settings)
}

#[inline(never)]
fn proof_step_constant_time<F: Format>(controller: &mut Controller<'_, F>, settings: &Settings) -> Tally {
    controller.step_constant_time(settings)
}

#[inline(never)]
fn proof_rolling<F: Format>(rolling: &mut Rolling<'_, F>, settings: &Settings) -> Tally {
    rolling.step(settings)
}

/// Quads and push-pull, of colours and of colours with their motion.
#[inline(never)]
fn proof_inpaint_controller<F: Format>(
    controller: &mut Controller<'_, F>,
    settings: &Settings,
    inpainting: &Inpainting<'_>,
    push_pull: &mut PushPull<'_>,
) -> u32 {
    controller.inpaint(settings, inpainting, push_pull)
}

/// Push-pull in one map.
#[inline(never)]
fn proof_inpaint_rolling<F: Format>(
    rolling: &mut Rolling<'_, F>,
    inpainting: &Inpainting<'_>,
    push_pull: &mut PushPull<'_>,
) -> u32 {
    rolling.inpaint(inpainting, push_pull)
}

#[inline(never)]
fn proof_graft<F: Format>(
    map: &mut Galpixmap<'_, F>,
    place: (i32, i32),
    words: &[u32],
    rounding: Rounding,
    frame: u32,
) -> Grafted {
    graft(map, place, words, Delay { stamp: frame, now: black_box(frame), rounding })
}

/// A row for a display of 16-bit words.
#[inline(never)]
fn proof_scan_out<F: Format>(map: &Galpixmap<'_, F>, y: u32, line: &mut [u16]) {
    for (word, colour) in line.iter_mut().zip(scan_out::row(map, y)) {
        *word = colour as u16;
    }
}
