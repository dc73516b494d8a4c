//! Lines: what carries bytes to a device, and its answers back.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use serialport::SerialPort;

/// How long a line may refuse to take bytes.
pub const WRITE_PATIENCE: Duration = Duration::from_secs(10);

/// Something that carries bytes, and perhaps answers.
pub trait Line: Write {
    /// Receives what is there, or comes within `wait`; 0 bytes if nothing does.
    ///
    /// *Errors:* a line that broke, or whose other end has gone.
    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> io::Result<usize>;

    /// Returns whether anybody can answer.
    fn answers(&self) -> bool {
        true
    }
}

/// Returns what a read with a timeout gave: nothing is no error, and an end is one.
fn received(read: io::Result<usize>) -> io::Result<usize> {
    match read {
        Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {
            Ok(0)
        }
        read => read,
    }
}

/// Returns a timeout that sockets accept: 0 would mean for ever.
fn positive(wait: Duration) -> Option<Duration> {
    Some(wait.max(Duration::from_millis(1)))
}

impl Line for TcpStream {
    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.set_read_timeout(positive(wait))?;
        received(self.read(bytes))
    }
}

#[cfg(unix)]
impl Line for std::os::unix::net::UnixStream {
    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.set_read_timeout(positive(wait))?;
        received(self.read(bytes))
    }
}

/// A serial device.
pub struct Serial(pub Box<dyn SerialPort>);

impl Write for Serial {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.set_timeout(WRITE_PATIENCE)?;
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        // The system sends by itself what it has taken; to wait for each row would leave gaps on the line.
        Ok(())
    }
}

impl Line for Serial {
    fn receive(&mut self, bytes: &mut [u8], wait: Duration) -> io::Result<usize> {
        self.0.set_timeout(wait)?;
        received(self.0.read(bytes))
    }
}

/// A file, which answers nothing.
impl Line for File {
    fn receive(&mut self, _: &mut [u8], _: Duration) -> io::Result<usize> {
        Ok(0)
    }

    fn answers(&self) -> bool {
        false
    }
}
