//! The host's end of a serial line.

use std::io::{Read, Write};
use std::os::unix::net::UnixStream;
use std::time::{Duration, Instant};

use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, MAX_ENCODED, Status};

use crate::boards::Board;
use crate::failure::Failure;

/// How long a board may take to answer.
const PATIENCE: Duration = Duration::from_secs(120);

/// A serial line to a board.
pub struct Line {
    stream: UnixStream,
    board: Board,
    decoder: Decoder,
    waiting: Vec<u8>,
}

/// What a board sends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Said {
    /// How it is.
    Status(Status),
    /// It shows a frame: its counter and the hash of the picture.
    Shown(u32, u32),
}

impl Line {
    /// Creates a line over an open stream.
    pub fn new(stream: UnixStream, board: Board) -> Self {
        Self { stream, board, decoder: Decoder::new(), waiting: Vec::new() }
    }

    /// Waits until the board answers. What is sent before its line is set up is lost: so the request is repeated.
    pub fn greet(&mut self) -> Result<(), Failure> {
        self.stream.set_read_timeout(Some(Duration::from_millis(500)))?;
        let (begin, mut requests) = (Instant::now(), 0);
        loop {
            requests += 1;
            // The 0 ends what may have been begun.
            self.send_bytes(&[0])?;
            match self.status() {
                Ok(_) => break,
                Err(failure) if begin.elapsed() > PATIENCE => return Err(failure),
                Err(_) => {}
            }
        }
        // A board that starts slowly has more requests to answer: until it is silent.
        while requests > 1 && self.listen().is_ok() {}
        Ok(self.stream.set_read_timeout(Some(PATIENCE))?)
    }

    /// Sends a frame.
    pub fn send(&mut self, frame: &Frame<'_>) -> Result<(), Failure> {
        let mut buffer = [0; MAX_ENCODED];
        let bytes = frame.encode(&mut buffer).map_err(|error| Failure::new(format!("{frame:?} is {error}")))?;
        self.send_bytes(bytes)
    }

    /// Sends bytes, whatever they are.
    pub fn send_bytes(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        Ok(self.stream.write_all(bytes)?)
    }

    /// Waits for the next frame from the board.
    pub fn listen(&mut self) -> Result<Said, Failure> {
        loop {
            while !self.waiting.is_empty() {
                match self.decoder.push(self.waiting.remove(0)) {
                    None => {}
                    Some(Ok(Frame::Status(status))) => return Ok(Said::Status(status)),
                    Some(Ok(Frame::Shown { frame, hash })) => return Ok(Said::Shown(frame, hash)),
                    Some(other) => {
                        return Err(Failure::new(format!("{} sent {other:?}", self.board.name())));
                    }
                }
            }
            let mut buffer = [0; 256];
            let count = self.stream.read(&mut buffer).map_err(|error| {
                Failure::new(format!("{} does not answer over its line: {error}", self.board.name()))
            })?;
            if count == 0 {
                return Err(Failure::new(format!("{}: the line is closed", self.board.name())));
            }
            self.waiting.extend_from_slice(&buffer[..count]);
        }
    }

    /// Asks how the board is.
    pub fn status(&mut self) -> Result<Status, Failure> {
        self.send(&Frame::Hello)?;
        loop {
            if let Said::Status(status) = self.listen()? {
                return Ok(status);
            }
        }
    }

    /// Waits until a frame is shown: its counter and hash.
    pub fn shown(&mut self) -> Result<(u32, u32), Failure> {
        loop {
            if let Said::Shown(frame, hash) = self.listen()? {
                return Ok((frame, hash));
            }
        }
    }
}
