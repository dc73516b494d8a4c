//! Contenders against each other and against a memory copy, in one run: figures that survive a noisy machine.
//!
//! In each round every contender runs once, between two copies of as many bytes as it is compared with. `x copy` is the
//! median over rounds of its time by the mean of these two, `x faster` the median of the time of the contender of the
//! same group that it is measured against, in the same round, by its own. All times are this thread's processor time,
//! with caches as the same work left them.

use std::hint::black_box;
use std::time::Duration;

use cpu_time::ThreadTime;

/// Something to be timed.
pub struct Contender {
    what: String,
    group: String,
    /// Of the copy that it is compared with.
    bytes: usize,
    before: Box<dyn FnMut()>,
    run: Box<dyn FnMut()>,
    /// A time for each round.
    times: Vec<Duration>,
    /// The mean of the two copies for each round.
    copies: Vec<Duration>,
}

impl Contender {
    /// Makes a contender whose `before` is not timed.
    pub fn new(
        what: impl Into<String>,
        group: impl Into<String>,
        bytes: usize,
        before: Box<dyn FnMut()>,
        run: Box<dyn FnMut()>,
    ) -> Self {
        Self { what: what.into(), group: group.into(), bytes, before, run, times: Vec::new(), copies: Vec::new() }
    }

    /// Returns what it is called.
    #[must_use]
    pub fn what(&self) -> &str {
        &self.what
    }

    /// Returns which contenders it is measured against.
    #[must_use]
    pub fn group(&self) -> &str {
        &self.group
    }

    /// Returns the median over rounds of its time by that of another contender in the same round.
    #[must_use]
    pub fn by(&self, other: &Self) -> f64 {
        median_ratio(&self.times, &other.times)
    }

    /// Returns the mean of several times, after one that is not counted: in a display nothing else turns the caches
    /// over.
    fn time(&mut self, times: u32) -> Duration {
        let mut timed = Duration::ZERO;
        for counted in 0..=times {
            (self.before)();
            let start = ThreadTime::now();
            (self.run)();
            timed += if counted > 0 { start.elapsed() } else { Duration::ZERO };
        }
        timed / times
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    if values.len() % 2 == 1 { values[middle] } else { 0.5 * (values[middle - 1] + values[middle]) }
}

fn median_ratio(above: &[Duration], below: &[Duration]) -> f64 {
    median(above.iter().zip(below).map(|(above, below)| above.as_secs_f64() / below.as_secs_f64()).collect())
}

/// Two blocks of memory, one to be copied into the other.
struct Copy {
    from: Vec<u8>,
    to: Vec<u8>,
}

impl Copy {
    /// Copies and times as [`Contender::time`].
    fn time(&mut self, bytes: usize, times: u32) -> Duration {
        let mut timed = Duration::ZERO;
        for counted in 0..=times {
            let start = ThreadTime::now();
            black_box(&mut self.to[..bytes]).copy_from_slice(black_box(&self.from[..bytes]));
            timed += if counted > 0 { start.elapsed() } else { Duration::ZERO };
        }
        timed / times
    }
}

/// Returns size and rounds from the command line; one sentence where they are not understood.
pub fn arguments() -> Result<((u32, u32), usize), String> {
    let mut arguments = std::env::args().skip(1);
    let size = arguments.next().unwrap_or("1024x1024".to_owned());
    let rounds = arguments.next().unwrap_or("15".to_owned());
    let sides = size.split_once('x').and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    match (sides, rounds.parse()) {
        (Some((width, height)), Ok(1..)) if !(16..=4096).contains(&width) || !(16..=4096).contains(&height) => {
            Err(format!("a size of {size} cannot be measured: give sides of 16 to 4096 cells"))
        }
        (Some(size), Ok(rounds)) if rounds >= 1 => Ok((size, rounds)),
        _ => Err(format!("\"{size} {rounds}\" is not understood: give a size and rounds, as in \"512x512 15\"")),
    }
}

/// Runs all of them, after a round that warms up.
pub fn race(contenders: &mut [Contender], cells: u32, rounds: usize) {
    let most = contenders.iter().map(|contender| contender.bytes).max().unwrap_or(0);
    let mut copy = Copy { from: vec![1; most], to: vec![2; most] };
    // Small maps several times, so that a time is milliseconds.
    let times = ((1 << 19) / cells).max(1);
    for round in 0..=rounds {
        for contender in &mut *contenders {
            let before = copy.time(contender.bytes, times);
            let time = contender.time(times);
            let after = copy.time(contender.bytes, times);
            if round > 0 {
                contender.times.push(time);
                contender.copies.push((before + after) / 2);
            }
        }
    }
}

/// Prints the figures; `against` is the contender of each group that the others are measured against.
pub fn table(contenders: &[Contender], cells: u32, against: &str) {
    println!(
        "\n{:<46} {:<8} {:>9} {:>8} {:>8} {:>9}",
        "contender", "group", "ns/cell", "copy ns", "x copy", "x faster"
    );
    for contender in contenders {
        let base = contenders.iter().find(|other| other.what == against && other.group == contender.group);
        let nanoseconds =
            |times: &[Duration]| median(times.iter().map(|time| time.as_secs_f64() * 1e9 / f64::from(cells)).collect());
        println!(
            "{:<46} {:<8} {:>9.2} {:>8.2} {:>8.2} {:>9.2}",
            contender.what,
            contender.group,
            nanoseconds(&contender.times),
            nanoseconds(&contender.copies),
            median_ratio(&contender.times, &contender.copies),
            base.map_or(f64::NAN, |base| base.by(contender)),
        );
    }
}
