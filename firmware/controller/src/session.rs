//! The program: every vsync a frame, and between them what the host sends.
//!
//! One frame: listen to the line, let the renderer deliver its rows, propagate, wait for the vsync, show. Nothing in it
//! waits for the host: an update that is late, short, corrupt or never comes changes only what the picture shows.

use galpix_core::scan_out::{PanelColour, View, row};
use galpix_core::{Delay, Format, Maps, Settings, Tally, graft};
use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, Galpixels, MAX_ENCODED, NO_SCENE, Status};
use galpix_link::panel::Description;
use galpix_link::picture::PictureHash;
use galpix_link::rejected::Rejected;

use embedded_graphics::Drawable;
use embedded_graphics::geometry::Point;
use embedded_graphics::image::Image;

use crate::board::Board;
use crate::log;
use crate::overlay::Overlay;
use crate::renderer::Renderer;
use crate::scene;

/// The most bytes from the line that one frame takes: 921 600 baud at 60 frames a second. What comes faster waits.
pub const BYTES_PER_FRAME: u32 = 1536;

/// Galpixels that were exact more frames ago are refused: twice the time for which they would be good.
pub const OLDEST: u32 = 32;

/// Frames to the second.
const SECOND: u32 = 60;

/// Frames for which a controller in lockstep waits for its host.
const PATIENCE: u32 = 120 * SECOND;

/// The controller of one panel.
pub struct Session<'p, M, B> {
    board: B,
    maps: M,
    panel: Description,
    settings: Settings,
    renderer: Option<Renderer>,
    line: Line,
    overlay: bool,
    tally: Tally,
    lifetime: core::marker::PhantomData<&'p ()>,
}

/// What is known of the line to the host.
struct Line {
    decoder: Decoder,
    status: Status,
    /// In lockstep: whether the next frame may be made.
    go: bool,
    /// Whether the frame that is being made has told how the controller is: its length says nothing of others.
    asked: bool,
    /// Frames until the next line of the log.
    until_log: u32,
}

impl<'p, M, B> Session<'p, M, B>
where
    M: Maps<'p>,
    B: Board,
{
    /// A controller that shows the first built-in scene.
    pub fn new(board: B, maps: M, panel: Description, settings: Settings) -> Self {
        let status = Status {
            fingerprint: panel.fingerprint,
            width: panel.width,
            height: panel.height,
            words: panel.words,
            ticks: B::TICKS_PER_FRAME,
            ..Status::default()
        };
        let line = Line { decoder: Decoder::new(), status, go: false, asked: false, until_log: SECOND };
        let (tally, lifetime) = (Tally::default(), core::marker::PhantomData);
        let mut session = Self { board, maps, panel, settings, renderer: None, line, overlay: true, tally, lifetime };
        session.choose(0);
        session
    }

    /// How the controller is.
    pub fn status(&self) -> Status {
        let (stack_used, stack) = self.board.stack();
        Status { frame: self.maps.frame(), stack_used, stack, ..self.line.status }
    }

    /// Shows the map as it is, and goes on with a frame at each vsync.
    pub fn run(mut self) -> ! {
        self.board.vsync();
        self.present();
        loop {
            self.frame();
        }
    }

    /// Makes the next frame and shows it.
    pub fn frame(&mut self) {
        let begin = self.board.ticks();
        self.listen(BYTES_PER_FRAME);
        let now = self.maps.frame();
        if let (Some(renderer), Some(map)) = (self.renderer, self.maps.layer_mut(0)) {
            renderer.next(map, now);
        }
        self.tally = self.maps.step(&self.settings);
        let made = self.board.ticks();
        let missed = self.board.vsync().saturating_sub(1);
        let shown = self.board.ticks();
        if missed > 0 && !self.line.status.lockstep {
            self.line.status.late = self.line.status.late.wrapping_add(missed);
            log::late(self.maps.frame(), missed);
        }
        self.present();
        if !self.line.status.lockstep && !core::mem::take(&mut self.line.asked) {
            let busy = made.wrapping_sub(begin).wrapping_add(self.board.ticks().wrapping_sub(shown));
            self.line.status.busy = self.line.status.busy.max(busy);
        }
        self.line.second(self.maps.frame(), &self.tally);
    }

    /// Shows the map. In lockstep says so, and waits until the host lets it go on.
    fn present(&mut self) {
        let overlay = self.overlay.then(|| Overlay::new(self.maps.frame(), &self.tally));
        let map = self.maps.shown();
        let ink = [[255; 3], [0; 3]].map(|rgb| B::Pixel::of_word(B::Pixel::FORMAT.from_rgb888(rgb)));
        self.board.show(|band, top, rows| {
            for y in top..top + rows {
                // What the band refuses is left out: the picture goes on.
                let _ = Image::new(&View::band(map, y, 1), Point::new(0, y as i32)).draw(band);
            }
            if let Some(overlay) = &overlay {
                let _ = overlay.draw(band, (top, rows), ink);
            }
        });
        if self.line.status.lockstep {
            self.line.go = false;
            self.say(&Frame::Shown { frame: self.maps.frame(), hash: self.hash() });
            let (mut begin, mut frames) = (self.board.ticks(), 0);
            while self.line.status.lockstep && !self.line.go {
                self.listen(1);
                if self.board.ticks().wrapping_sub(begin) >= B::TICKS_PER_FRAME {
                    begin = begin.wrapping_add(B::TICKS_PER_FRAME);
                    frames += 1;
                    // A host that has gone away does not stop the picture for ever.
                    if frames == PATIENCE {
                        self.line.status.lockstep = false;
                    }
                }
            }
            // The time that the host took is nobody's lateness.
            self.board.vsync();
        }
    }

    /// The hash of the picture, without the overlay.
    fn hash(&self) -> u32 {
        let mut hash = PictureHash::new();
        for y in 0..u32::from(self.panel.height) {
            hash.row(row(self.maps.shown(), y));
        }
        hash.finish()
    }

    /// Takes what has come over the line, at most so many bytes.
    fn listen(&mut self, most: u32) {
        for _ in 0..most {
            let Some(byte) = self.board.receive() else { return };
            let now = self.maps.frame();
            let asked = match self.line.decoder.push(byte) {
                None => continue,
                Some(Ok(Frame::Galpixels(galpixels))) => {
                    take(&mut self.maps, &self.panel, &self.settings, &galpixels, now).map(|()| Asked::Galpixels)
                }
                Some(Ok(Frame::Hello)) => Ok(Asked::Status),
                Some(Ok(Frame::Scene { number })) => Ok(Asked::Scene(number)),
                Some(Ok(Frame::Lockstep { on })) => Ok(Asked::Lockstep(on)),
                Some(Ok(Frame::Overlay { on })) => Ok(Asked::Overlay(on)),
                Some(Ok(Frame::Go)) => Ok(Asked::Go),
                // What a device says it is not told.
                Some(Ok(Frame::Status(_) | Frame::Shown { .. })) => Err(Rejected::UnknownKind),
                Some(Err(cause)) => Err(cause),
            };
            let done = asked.and_then(|asked| self.obey(asked));
            if let Err(cause) = done {
                self.line.status.rejected.count(cause);
                log::refused(cause);
            }
        }
    }

    fn obey(&mut self, asked: Asked) -> Result<(), Rejected> {
        match asked {
            Asked::Galpixels => self.line.status.accepted = self.line.status.accepted.wrapping_add(1),
            Asked::Status => {
                self.say(&Frame::Status(self.status()));
                self.line.status.busy = 0;
                self.line.asked = true;
            }
            Asked::Scene(number) if self.choose(number) => {}
            Asked::Scene(_) => return Err(Rejected::UnknownKind),
            Asked::Lockstep(on) => self.line.status.lockstep = on,
            Asked::Overlay(on) => self.overlay = on,
            Asked::Go => self.line.go = true,
        }
        Ok(())
    }

    /// Begins a scene, or an empty map; whether there is such a scene.
    fn choose(&mut self, number: u8) -> bool {
        let now = self.maps.frame();
        let Some(map) = self.maps.layer_mut(0) else { return false };
        match scene::ALL.get(usize::from(number)) {
            Some(scene) => {
                let renderer = Renderer::new(scene, now);
                renderer.begin(map);
                self.renderer = Some(renderer);
            }
            None if number == NO_SCENE => {
                map.clear();
                self.renderer = None;
            }
            None => return false,
        }
        self.line.status.scene = number;
        true
    }

    fn say(&mut self, frame: &Frame<'_>) {
        let mut buffer = [0; MAX_ENCODED];
        // What a device says always fits.
        for &byte in frame.encode(&mut buffer).unwrap_or_default() {
            self.board.send(byte);
        }
    }
}

/// What a frame from the host asks for, without what it borrows.
enum Asked {
    Galpixels,
    Status,
    Scene(u8),
    Lockstep(bool),
    Overlay(bool),
    Go,
}

/// Grafts galpixels from the host.
fn take<'p, M: Maps<'p>>(
    maps: &mut M,
    panel: &Description,
    settings: &Settings,
    galpixels: &Galpixels<'_>,
    now: u32,
) -> Result<(), Rejected> {
    let stored = galpixels.stored(panel)?;
    if galpixels.age(now) > OLDEST {
        return Err(Rejected::TooOld);
    }
    let Some(map) = maps.layer_mut(0) else { return Ok(()) };
    let delay = Delay { stamp: galpixels.stamp, now, rounding: settings.rounding };
    for galpixel in stored {
        let place = (i32::from(galpixel.x), i32::from(galpixel.y));
        graft(map, place, &galpixel.words, delay);
    }
    Ok(())
}

impl Line {
    /// Logs once a second.
    fn second(&mut self, frame: u32, tally: &Tally) {
        self.status.frame = frame;
        self.until_log = self.until_log.saturating_sub(1);
        if self.until_log == 0 {
            self.until_log = SECOND;
            log::second(&self.status, tally);
        }
    }
}

/// Logs what a controller starts with: the panel, the stored form, and the memory by its use.
pub fn log_start<F: Format>(panel: &Description, format: F, memory: &[(&'static str, usize)]) {
    log::started(panel, format.record(), memory);
}
