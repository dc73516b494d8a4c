//! Requests and answers over a line, and what is sent in between.

use std::io::ErrorKind;
use std::time::{Duration, Instant};

use galpix_link::decode::Decoder;
use galpix_link::frame::{Frame, MAX_ENCODED, Status};

use super::SendError;
use super::line::Line;

/// How long a device may take to answer a request.
const PATIENCE: Duration = Duration::from_secs(2);
/// What the slowest line carries in a second: a request waits behind everything that was sent before it.
const SLOWEST_BYTES_PER_SECOND: u64 = 10_000;
/// How long a line must be quiet before a request.
const QUIET: Duration = Duration::from_millis(1);
/// The longest wait for that.
const NEVER_QUIET: Duration = Duration::from_millis(200);

/// The host's end of a line.
pub struct Talk<'l> {
    line: &'l mut dyn Line,
    to: &'l str,
    decoder: Decoder,
    /// Encoded and not yet sent.
    waiting: Vec<u8>,
    sent: u64,
    /// Bytes sent since the last answer.
    unanswered: u64,
}

impl<'l> Talk<'l> {
    pub fn new(line: &'l mut dyn Line, to: &'l str) -> Self {
        Self { line, to, decoder: Decoder::new(), waiting: Vec::new(), sent: 0, unanswered: 0 }
    }

    /// Returns what the line is called in messages.
    pub const fn to(&self) -> &'l str {
        self.to
    }

    /// Returns the bytes sent.
    pub const fn sent(&self) -> u64 {
        self.sent
    }

    fn broken(&self, error: std::io::Error) -> SendError {
        let error = match error.kind() {
            ErrorKind::WouldBlock | ErrorKind::TimedOut => std::io::Error::other("it takes no more bytes"),
            ErrorKind::UnexpectedEof => std::io::Error::other("the other end has closed it"),
            _ => error,
        };
        SendError::Broken { to: self.to.to_owned(), bytes: self.sent, error }
    }

    /// Puts a frame behind what waits to be sent.
    pub fn put(&mut self, frame: &Frame<'_>) {
        // Frames are made of what fits into them.
        if let Ok(bytes) = frame.encode(&mut [0; MAX_ENCODED]) {
            self.waiting.extend_from_slice(bytes);
        }
    }

    /// Sends what waits.
    pub fn flush(&mut self) -> Result<(), SendError> {
        let written = self.line.write_all(&self.waiting).and_then(|()| self.line.flush());
        written.map_err(|error| self.broken(error))?;
        self.sent += self.waiting.len() as u64;
        self.unanswered += self.waiting.len() as u64;
        self.waiting.clear();
        Ok(())
    }

    /// Requests the device's status until it answers; `None` if nothing can answer.
    pub fn ask(&mut self) -> Result<Option<Status>, SendError> {
        if self.line.answers() {
            // An answer to an earlier question must not be taken for the one to this.
            let started = Instant::now();
            while started.elapsed() < NEVER_QUIET && self.listen(QUIET)?.1 {}
        }
        let patience = PATIENCE + Duration::from_secs(self.unanswered / SLOWEST_BYTES_PER_SECOND);
        let started = Instant::now();
        while started.elapsed() < patience {
            // The 0 ends whatever the line has carried before.
            self.waiting.push(0);
            self.put(&Frame::Hello);
            self.flush()?;
            if !self.line.answers() {
                return Ok(None);
            }
            let asked = Instant::now();
            while asked.elapsed() < patience / 4 {
                if let (Some(status), _) = self.listen(patience / 4 - asked.elapsed().min(patience / 4))? {
                    self.unanswered = 0;
                    return Ok(Some(status));
                }
            }
        }
        Err(SendError::Silent { to: self.to.to_owned(), seconds: patience.as_secs() })
    }

    /// Takes what comes within `wait`: the last status of it, and whether anything came at all.
    fn listen(&mut self, wait: Duration) -> Result<(Option<Status>, bool), SendError> {
        let mut bytes = [0; 256];
        let count = self.line.receive(&mut bytes, wait).map_err(|error| self.broken(error))?;
        let mut status = None;
        for &byte in bytes.iter().take(count) {
            if let Some(Ok(Frame::Status(received))) = self.decoder.push(byte) {
                status = Some(received);
            }
        }
        Ok((status, count > 0))
    }
}
