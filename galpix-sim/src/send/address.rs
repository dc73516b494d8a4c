//! Where a device is.

use std::fmt;
use std::fs::File;
use std::io;
use std::net::{TcpStream, ToSocketAddrs};
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use super::line::{Line, Serial, WRITE_PATIENCE};

/// The speed of a serial device, in bits a second, where none is given.
pub const BAUD: u32 = 115_200;
/// How long a connection may take.
const CONNECT: Duration = Duration::from_secs(5);

/// Where a device is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// A host and a port: an emulator's serial line, or a bridge to one.
    Tcp(String),
    /// A socket in the file system.
    Unix(PathBuf),
    /// A file for the stream, which cannot answer.
    File(PathBuf),
    /// A serial device.
    Serial(String),
}

/// Why a line cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum OpenError {
    /// Nothing listens there.
    #[error("{0} cannot be reached ({1}): is the device or its emulator running, and listening there?")]
    Unreachable(Address, io::Error),
    /// The file cannot be made.
    #[error("{0} cannot be written ({1}): choose another path")]
    Unwritable(Address, io::Error),
    /// No serial device, or one that is in use or forbidden.
    #[error(
        "{0} cannot be opened as a serial device ({1}): give the path of one that no other program uses, \
         tcp:HOST:PORT, unix:PATH, or file:PATH for a file"
    )]
    NotSerial(Address, serialport::Error),
    /// A speed for what has none.
    #[error("--baud is for a serial device, and {0} is none: leave it out")]
    NoBaud(Address),
    /// This system has no such sockets.
    #[error("{0} cannot be reached: this system has no sockets in the file system; use tcp:HOST:PORT")]
    NoUnixSockets(Address),
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tcp(host) => write!(f, "tcp:{host}"),
            Self::Unix(path) => write!(f, "unix:{}", path.display()),
            Self::File(path) => write!(f, "file:{}", path.display()),
            Self::Serial(path) => f.write_str(path),
        }
    }
}

impl FromStr for Address {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        const FORMS: &str = "give tcp:HOST:PORT, unix:PATH, file:PATH or the path of a serial device";
        let address = match text.split_once(':') {
            Some(("tcp", host)) => {
                let (name, port) = host.rsplit_once(':').unwrap_or_default();
                if name.is_empty() || port.parse::<u16>().is_err() {
                    return Err(format!("no host and port from 0 to 65535: {FORMS}"));
                }
                Self::Tcp(host.to_owned())
            }
            Some(("unix", path)) => Self::Unix(path.into()),
            Some(("file", path)) => Self::File(path.into()),
            _ => Self::Serial(text.to_owned()),
        };
        match &address {
            Self::Unix(path) | Self::File(path) if path.as_os_str().is_empty() => Err(format!("no path: {FORMS}")),
            Self::Serial(path) if path.is_empty() => Err(FORMS.to_owned()),
            _ => Ok(address),
        }
    }
}

impl Address {
    /// Opens the line; `baud` is the speed of a serial device in bits a second.
    ///
    /// *Errors:* one sentence that says what, where and how to correct it.
    pub fn open(&self, baud: Option<u32>) -> Result<Box<dyn Line>, OpenError> {
        if baud.is_some() && !matches!(self, Self::Serial(_)) {
            return Err(OpenError::NoBaud(self.clone()));
        }
        match self {
            Self::Tcp(host) => match connected(host) {
                Ok(stream) => Ok(Box::new(stream)),
                Err(error) => Err(OpenError::Unreachable(self.clone(), error)),
            },
            #[cfg(unix)]
            Self::Unix(path) => {
                let stream = std::os::unix::net::UnixStream::connect(path)
                    .and_then(|stream| stream.set_write_timeout(Some(WRITE_PATIENCE)).map(|()| stream))
                    .map_err(|error| OpenError::Unreachable(self.clone(), error))?;
                Ok(Box::new(stream))
            }
            #[cfg(not(unix))]
            Self::Unix(_) => Err(OpenError::NoUnixSockets(self.clone())),
            Self::File(path) => {
                let file = File::create(path).map_err(|error| OpenError::Unwritable(self.clone(), error))?;
                Ok(Box::new(file))
            }
            Self::Serial(path) => {
                let port = serialport::new(path, baud.unwrap_or(BAUD)).timeout(WRITE_PATIENCE).open();
                Ok(Box::new(Serial(port.map_err(|error| OpenError::NotSerial(self.clone(), error))?)))
            }
        }
    }
}

/// Returns a connection to the first address of a host that takes one.
fn connected(host: &str) -> io::Result<TcpStream> {
    let mut last = io::Error::new(io::ErrorKind::NotFound, "the host has no address");
    for address in host.to_socket_addrs()? {
        match TcpStream::connect_timeout(&address, CONNECT) {
            Ok(stream) => {
                stream.set_nodelay(true)?;
                stream.set_write_timeout(Some(WRITE_PATIENCE))?;
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(last)
}
