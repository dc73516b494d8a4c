//! What a panel must show, made on the host: two maps, a format chosen at run time, vector code, another processor.

use std::convert::Infallible;
use std::marker::PhantomData;

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{Gray4, Rgb565};
use galpix_controller::overlay::Overlay;
use galpix_controller::renderer::Renderer;
use galpix_controller::scene;
use galpix_core::inpaint::PushPull;
use galpix_core::scan_out::{PanelColour, row};
use galpix_core::{Controller, Delay, Dynamic, Galpixmap, Grid, Margin, Scratch, Tally, graft, stages};
use galpix_link::panel::{Lcd, Oled, Panel, Tft};
use galpix_link::picture::PictureHash;
use galpix_sim::picture::Picture;

use crate::boards::{Board, Filling};
use crate::failure::Failure;

/// A frame that a panel must show.
pub struct Expected {
    /// The frame counter.
    pub frame: u32,
    /// The hash of the galpixmap's colours.
    pub hash: u32,
    /// The picture with the overlay, as the emulator shows it.
    pub picture: Picture,
}

/// What a panel shows.
#[derive(Clone, Copy, Debug)]
pub enum Shows<'s> {
    /// A built-in scene, by its number.
    Scene(u8),
    /// An update that a host sends: all words of each galpixel, row by row.
    Sent(&'s [u32]),
}

/// Returns the `frames` frames after frame `first`, in which the board was controlled.
pub fn frames(
    (board, filling): (Board, Filling),
    shows: Shows<'_>,
    first: u32,
    frames: u32,
    overlay: bool,
) -> Result<Vec<Expected>, Failure> {
    match board {
        Board::Lm3s6965evb => of::<Oled, Gray4>((board, filling), shows, first, frames, overlay),
        Board::Rp2040 => of::<Tft, Rgb565>((board, filling), shows, first, frames, overlay),
        Board::VexpressA9 => of::<Lcd, Rgb565>((board, filling), shows, first, frames, overlay),
    }
}

fn of<P: Panel, C: PanelColour>(
    (board, filling): (Board, Filling),
    shows: Shows<'_>,
    first: u32,
    count: u32,
    overlay: bool,
) -> Result<Vec<Expected>, Failure> {
    let failed = |error: &dyn std::fmt::Display| Failure::new(format!("the host's map cannot be set up: {error}"));
    let format = Dynamic::new(P::BITS, P::LAYOUT).map_err(|error| failed(&error))?;
    let mut starts = vec![0; usize::from(P::HEIGHT)];
    let grid = Grid::new(u32::from(P::WIDTH), u32::from(P::HEIGHT), Margin::NONE, &mut starts)
        .map_err(|error| failed(&error))?;
    let words = Galpixmap::words(&grid, format);
    let (mut front, mut back) = (vec![0; words], vec![0; words]);
    let told = |words: usize| vec![0; if P::TELLS_SURFACES { words } else { 0 }];
    let (mut winners, mut edges) = (told(grid.cells() as usize), told(stages::words(&grid)));
    let mut controller = Controller::new(
        Galpixmap::new(grid, format, &mut front).map_err(|error| failed(&error))?,
        Galpixmap::new(grid, format, &mut back).map_err(|error| failed(&error))?,
        Scratch { winners: &mut winners, edges: &mut edges },
    )
    .map_err(|error| failed(&error))?;
    controller.set_frame(first);
    let mut memory = vec![0; P::PUSH_PULL_WORDS];
    let mut push_pull =
        PushPull::new(P::WIDTH.into(), P::HEIGHT.into(), P::MOTION, &mut memory).map_err(|error| failed(&error))?;

    let renderer = match shows {
        Shows::Scene(number) => {
            let scene = scene::ALL
                .get(usize::from(number))
                .ok_or_else(|| Failure::new(format!("there is no built-in scene {number}")))?;
            let renderer = Renderer::new(scene, first);
            renderer.begin(controller.front_mut());
            Some(renderer)
        }
        Shows::Sent(words) => {
            let galpixels = words.chunks_exact(P::RECORD.words());
            for (cell, galpixel) in (0..).zip(galpixels) {
                let place = (cell % i32::from(P::WIDTH), cell / i32::from(P::WIDTH));
                let delay = Delay { stamp: first, now: first, rounding: P::SETTINGS.rounding };
                graft(controller.front_mut(), place, galpixel, delay);
            }
            None
        }
    };
    let mut made = Vec::new();
    for _ in 0..count {
        if let Some(renderer) = renderer {
            let now = controller.frame();
            renderer.next(controller.front_mut(), now);
        }
        let tally = controller.step(&P::SETTINGS);
        if filling == Filling::PushPull {
            controller.inpaint(&P::SETTINGS, &P::INPAINTING, &mut push_pull);
        }
        made.push(expected::<P, C>(board, &controller, &tally, overlay));
    }
    Ok(made)
}

fn expected<P: Panel, C: PanelColour>(
    board: Board,
    controller: &Controller<'_, Dynamic>,
    tally: &Tally,
    overlay: bool,
) -> Expected {
    let (width, height) = (usize::from(P::WIDTH), usize::from(P::HEIGHT));
    let (frame, mut hash) = (controller.frame(), PictureHash::new());
    let mut sheet = Sheet { colours: Vec::with_capacity(width * height), width, height, pixel: PhantomData::<C> };
    for y in 0..height as u32 {
        hash.row(row(controller.front(), y));
        sheet.colours.extend(row(controller.front(), y));
    }
    if overlay {
        let ink = [[255; 3], [0; 3]].map(|rgb| C::of_word(C::FORMAT.from_rgb888(rgb)));
        let Ok(()) = Overlay::new(frame, tally).draw(&mut sheet, (0, height as u32), ink);
    }
    let pixels = sheet.colours.iter().map(|&colour| board.shown(colour)).collect();
    Expected { frame, hash: hash.finish(), picture: Picture { width, height, pixels } }
}

/// A picture of colour words.
struct Sheet<C> {
    colours: Vec<u32>,
    width: usize,
    height: usize,
    pixel: PhantomData<C>,
}

impl<C> OriginDimensions for Sheet<C> {
    fn size(&self) -> Size {
        Size::new(self.width as u32, self.height as u32)
    }
}

impl<C: PanelColour> DrawTarget for Sheet<C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, colour) in pixels {
            let (x, y) = (point.x as usize, point.y as usize);
            if x < self.width && y < self.height {
                self.colours[y * self.width + x] = colour.word();
            }
        }
        Ok(())
    }
}
