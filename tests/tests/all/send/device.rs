//! A little display controller: a decoder, a map, counters. It shows nothing, and its time goes on with each question.

use std::io::{ErrorKind, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use galpix_core::{Galpixel, Galpixmap, Grid, Margin, Static};
use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, MAX_ENCODED, NO_SCENE, Status};
use galpix_link::panel::{Description, Panel};
use galpix_sim::send::Address;

/// Returns the memory of a panel's map with these galpixels, row by row; without any it is as after a start.
pub fn memory<P: Panel>(galpixels: &[Galpixel]) -> Vec<u32> {
    let height = u32::from(P::HEIGHT);
    let mut starts = vec![0; Grid::rows(height, Margin::NONE)];
    let grid = Grid::new(u32::from(P::WIDTH), height, Margin::NONE, &mut starts).unwrap();
    let mut memory = vec![0; P::MAP_WORDS];
    let mut map = Galpixmap::new(grid, Static::<P>::new(), &mut memory).unwrap();
    for (index, galpixel) in galpixels.iter().enumerate() {
        let width = usize::from(P::WIDTH);
        map.store((index % width) as i32, (index / width) as i32, galpixel).unwrap();
    }
    memory
}

/// A display controller, and what happened to it.
pub struct Device {
    panel: Description,
    /// Its map, in the order of planes.
    pub memory: Vec<u32>,
    /// The map as it is after a start.
    empty: Vec<u32>,
    pub status: Status,
    /// Update, stamp, and age on arrival, of each frame of galpixels.
    pub stamps: Vec<(u16, u32, u32)>,
    /// Frames that its counter goes on with each question; in lockstep with each Go.
    pub pace: u32,
}

impl Device {
    pub fn new<P: Panel>() -> Self {
        let panel = P::DESCRIPTION;
        let Description { width, height, words, fingerprint, .. } = panel;
        let status =
            Status { frame: 1000, fingerprint, width, height, words, accepted: u32::MAX - 5, ..Status::default() };
        let empty = memory::<P>(&[]);
        Self { panel, memory: empty.clone(), empty, status, stamps: Vec::new(), pace: 3 }
    }

    /// Obeys a frame, and returns the answer.
    fn take(&mut self, frame: &Frame<'_>) -> Option<Frame<'static>> {
        match frame {
            Frame::Hello => {
                if !self.status.lockstep {
                    self.status.frame = self.status.frame.wrapping_add(self.pace);
                }
                Some(Frame::Status(self.status))
            }
            Frame::Scene { number: NO_SCENE } => {
                self.status.scene = NO_SCENE;
                self.memory.clone_from(&self.empty);
                None
            }
            Frame::Lockstep { on } => {
                self.status.lockstep = *on;
                on.then_some(Frame::Shown { frame: self.status.frame, hash: 0 })
            }
            Frame::Go if self.status.lockstep => {
                self.status.frame = self.status.frame.wrapping_add(self.pace);
                Some(Frame::Shown { frame: self.status.frame, hash: 0 })
            }
            Frame::Galpixels(galpixels) => {
                match galpixels.stored(&self.panel) {
                    Ok(stored) => {
                        let (width, cells) =
                            (usize::from(self.panel.width), self.memory.len() / usize::from(self.panel.words));
                        for stored in stored {
                            let cell = usize::from(stored.y) * width + usize::from(stored.x);
                            for word in 0..usize::from(self.panel.words) {
                                self.memory[word * cells + cell] = stored.words[word];
                            }
                        }
                        self.status.accepted = self.status.accepted.wrapping_add(1);
                        self.stamps.push((galpixels.update, galpixels.stamp, galpixels.age(self.status.frame)));
                    }
                    Err(cause) => self.status.rejected.count(cause),
                }
                None
            }
            other => panic!("the host sent {other:?}"),
        }
    }

    /// Lives on a line until the other end closes it or `stop` is set. `noise` may change the bytes of a frame, without
    /// its 0, before they arrive; it gets the number of the frame.
    pub fn live(&mut self, mut line: impl Read + Write, stop: &AtomicBool, mut noise: impl FnMut(usize, &mut Vec<u8>)) {
        let (mut decoder, mut frame, mut count) = (Decoder::new(), Vec::new(), 0);
        let mut bytes = [0; 1000];
        while !stop.load(Ordering::Relaxed) {
            let received = match line.read(&mut bytes) {
                Ok(0) => return,
                Ok(received) => received,
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => continue,
                Err(_) => return,
            };
            for &byte in &bytes[..received] {
                if byte != 0 {
                    frame.push(byte);
                    continue;
                }
                if !frame.is_empty() {
                    noise(count, &mut frame);
                    count += 1;
                }
                frame.push(0);
                for byte in frame.drain(..) {
                    match decoder.push(byte) {
                        Some(Ok(frame)) => {
                            if let Some(answer) = self.take(&frame) {
                                line.write_all(answer.encode(&mut [0; MAX_ENCODED]).unwrap()).unwrap();
                            }
                        }
                        Some(Err(cause)) => self.status.rejected.count(cause),
                        None => {}
                    }
                }
            }
        }
    }
}

/// Returns a port for a device, and its address.
pub fn port() -> (TcpListener, Address) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = Address::Tcp(listener.local_addr().unwrap().to_string());
    (listener, address)
}

/// Returns the connection that a host makes.
pub fn connection(listener: &TcpListener) -> TcpStream {
    let (stream, _) = listener.accept().unwrap();
    stream.set_read_timeout(Some(Duration::from_millis(50))).unwrap();
    stream
}
