//! Progress on standard error: a bar on a terminal, elsewhere a line now and then; nothing where that is to be quiet.

use std::ops::Deref;
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::thread;
use std::time::Duration;

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::{complain, quiet};

/// The time between two lines where there is no bar.
const BETWEEN: Duration = Duration::from_secs(10);

/// The progress of a piece of work.
pub struct Progress {
    bar: ProgressBar,
    /// Dropped, it ends the lines.
    _lines: Option<Sender<()>>,
}

impl Deref for Progress {
    type Target = ProgressBar;

    fn deref(&self) -> &ProgressBar {
        &self.bar
    }
}

/// Returns the progress of `length` steps with a name; of 0 steps it is not known how many there are.
#[must_use]
pub fn bar(length: u64, name: &str) -> Progress {
    let target = if quiet() { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let lines = !quiet() && target.is_hidden();
    let bar = ProgressBar::with_draw_target(Some(length), target);
    if let Ok(style) = ProgressStyle::with_template("{prefix:>16} {bar:40} {pos}/{len} {elapsed} {msg}") {
        bar.set_style(style);
    }
    bar.set_prefix(name.to_owned());
    Progress { _lines: lines.then(|| line_by_line(bar.clone())), bar }
}

/// Writes a line now and then until the bar is finished or what is returned is dropped.
fn line_by_line(bar: ProgressBar) -> Sender<()> {
    let (end, ended) = mpsc::channel();
    thread::spawn(move || {
        while ended.recv_timeout(BETWEEN) == Err(RecvTimeoutError::Timeout) && !bar.is_finished() {
            complain(&line(&bar));
        }
    });
    end
}

fn line(bar: &ProgressBar) -> String {
    let done = bar.length().filter(|&length| length > 0).map(|length| format!(" {} of {length},", bar.position()));
    let (name, message) = (bar.prefix(), bar.message());
    let separator = if message.is_empty() { "" } else { ": " };
    format!("{name}:{} {}{separator}{message}", done.unwrap_or_default(), HumanDuration(bar.elapsed()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_what_is_done_and_since_when() {
        let bar = ProgressBar::hidden();
        bar.set_prefix("ball");
        assert_eq!(line(&bar), "ball: 0 seconds");
        bar.set_length(24);
        bar.set_position(3);
        bar.set_message("searched");
        assert_eq!(line(&bar), "ball: 3 of 24, 0 seconds: searched");
    }
}
