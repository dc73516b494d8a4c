//! Searches the threshold tables of `Rounding::Searched`: the table whose worst drift over all residue classes is the
//! smallest where updates enter at its first entry. The short ones all of them, the others by simulated annealing from
//! the counter read backwards.
//!
//! ```sh
//! cargo run --release -p galpix-sim --example search_thresholds           # all tables, some minutes
//! cargo run --release -p galpix-sim --example search_thresholds -- 4 9    # four dropped bits, nine attempts
//! ```
//!
//! The result is data: what a table is worth is certified by `galpix_sim::certificate`, not by this search.

use std::process::ExitCode;

/// A table and the worst drift over its period, in units of the last dropped bit.
#[derive(Clone)]
struct Found {
    thresholds: Vec<i32>,
    worst: i32,
    /// Tells apart tables of one worst drift: an eighth-power mean over all classes and frames.
    rough: f64,
}

/// Runs every residue class over one period from entry `phase` on.
fn judge(thresholds: &[i32], phase: usize) -> (i32, f64) {
    let period = thresholds.len() as i32;
    let mut u = vec![0; (period / 2) as usize];
    let mut drift = vec![0; u.len()];
    let (mut worst, mut rough) = (0, 0.0);
    for a in 0..period {
        u.iter_mut().zip(0..).for_each(|(u, v)| *u = 2 * v + a);
        drift.fill(0);
        for threshold in thresholds.iter().cycle().skip(phase).take(thresholds.len()) {
            let mut eighths = 0f32;
            for (u, drift) in u.iter_mut().zip(&mut drift) {
                *drift += threshold - ((*u + threshold) & (period - 1));
                worst = worst.max(drift.abs());
                let square = (*drift * *drift) as f32;
                eighths += (square * square) * (square * square);
                *u += 2 * a;
            }
            rough += f64::from(eighths);
        }
    }
    (worst, rough.powf(0.125))
}

impl Found {
    fn new(thresholds: Vec<i32>) -> Self {
        let (worst, rough) = judge(&thresholds, 0);
        Self { thresholds, worst, rough }
    }

    fn energy(&self) -> f64 {
        f64::from(self.worst) + 0.2 * self.rough
    }
}

/// Marsaglia's xorshift: repeats on every machine.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Returns one change: an entry drawn anew, two entries exchanged, or an entry one more or less.
fn neighbour(thresholds: &[i32], random: &mut Random) -> Vec<i32> {
    let mut changed = thresholds.to_vec();
    let (i, j) = (random.below(changed.len()), random.below(changed.len()));
    match random.below(3) {
        0 => changed[i] = random.below(thresholds.len()) as i32,
        1 => changed.swap(i, j),
        _ => changed[i] = (changed[i] + 2 * random.below(2) as i32 - 1).clamp(0, thresholds.len() as i32 - 1),
    }
    changed
}

fn anneal(down: u32, rounds: u32, seed: u64) -> Found {
    let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
    let period = 1u32 << down;
    let mut now = Found::new((0..period).map(|n| (n.reverse_bits() >> (32 - down)) as i32).collect());
    let mut best = now.clone();
    for round in 0..rounds {
        let cooling = 1.0 - f64::from(round) / f64::from(rounds);
        let temperature = 0.02 * f64::from(period) * cooling * cooling + 1e-9;
        let next = Found::new(neighbour(&now.thresholds, &mut random));
        let rise = next.energy() - now.energy();
        if rise <= 0.0 || random.unit() < (-rise / temperature).exp() {
            now = next;
            if (now.worst, now.rough) < (best.worst, best.rough) {
                best = now.clone();
            }
        }
    }
    best
}

/// Returns all tables of up to four entries.
fn every(down: u32) -> impl Iterator<Item = Found> {
    let period = 1u32 << down;
    let entries = move |table: u32| (0..period).map(move |n| (table >> (n * down) & (period - 1)) as i32).collect();
    (0..1 << (period * down)).map(move |table| Found::new(entries(table)))
}

fn main() -> ExitCode {
    let numbers: Result<Vec<u32>, _> = std::env::args().skip(1).map(|text| text.parse()).collect();
    let (downs, attempts) = match numbers.as_deref() {
        Ok([]) => (1..=6, 4),
        Ok([down @ 1..=8]) => (*down..=*down, 4),
        Ok([down @ 1..=8, attempts]) if *attempts > 0 => (*down..=*down, *attempts),
        _ => {
            eprintln!("give nothing, or the dropped bits (1 to 8) and the number of attempts, as in \"4 9\"");
            return ExitCode::from(2);
        }
    };
    for down in downs {
        // As many table changes as take some seconds.
        let rounds = (1u64 << 34 >> (3 * down)).clamp(60_000, 1 << 20) as u32;
        let better = |a: &Found, b: &Found| (a.worst, a.rough).partial_cmp(&(b.worst, b.rough)).expect("finite");
        let best = match down {
            1 | 2 => every(down).min_by(better),
            _ => (1..=u64::from(attempts)).map(|seed| anneal(down, rounds, seed)).min_by(better),
        };
        let Some(best) = best else { continue };
        let any = (0..1 << down).map(|phase| judge(&best.thresholds, phase).0).max().unwrap_or(0);
        println!(
            "{down} dropped bits: worst {} and, from any entry on, {any} of {}; {:?}",
            best.worst,
            1 << (2 * down),
            best.thresholds
        );
    }
    ExitCode::SUCCESS
}
