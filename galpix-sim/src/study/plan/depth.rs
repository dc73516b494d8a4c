//! Depth and fill mode, decided by running the update: what is left out must not change the pictures.

use galpix_core::record::Component;
use galpix_core::{FillMode, Layout, Record};

use super::extremes::Extremes;
use super::measured::{Ran, Subject};
use super::{Build, PlanError};

/// The share of all pixels of all frames that may differ before a field is kept.
const TOLERATED: f64 = 1e-3;

/// Bits of a z-buffer that are tried, from none.
const DEPTHS: [u32; 4] = [0, 4, 8, 12];

/// Removes from a build what its pictures do not need, with the reasons.
pub fn decide(
    subject: &Subject<'_>,
    extremes: &Extremes,
    build: &mut Build,
    reasons: &mut Vec<String>,
) -> Result<(), PlanError> {
    if !build.layout.velocity {
        build.layout = Layout { depth_bits: 0, depth_motion: false, ..build.layout };
        build.fill_mode = FillMode::None;
        reasons.push("depth is left out: nothing moves, so nothing collides and nothing is uncovered".to_owned());
        reasons.push("no fill mode is needed: there are no holes".to_owned());
        return Ok(());
    }
    let whole = subject.run(build)?;
    depth_motion(subject, extremes, build, &whole, reasons)?;
    depth_bits(subject, build, &whole, reasons)?;
    fill_mode(subject, build, &whole, reasons)
}

fn depth_motion(
    subject: &Subject<'_>,
    extremes: &Extremes,
    build: &mut Build,
    whole: &Ran,
    reasons: &mut Vec<String>,
) -> Result<(), PlanError> {
    // Without motion the z-buffer has no fraction: the same width is then worth more range bits.
    let without = Build { layout: Layout { depth_motion: false, ..build.layout }, ..*build };
    let differs = if extremes.depth_change == 0.0 { 0.0 } else { subject.run(&without)?.differs(whole) };
    if differs <= TOLERATED {
        *build = without;
        reasons.push(format!("motion in depth is left out: {:.3} % of the pixels differ without it", 100.0 * differs));
    } else {
        reasons.push(format!("motion in depth is kept: {:.2} % of the pixels differ without it", 100.0 * differs));
    }
    Ok(())
}

fn depth_bits(
    subject: &Subject<'_>,
    build: &mut Build,
    whole: &Ran,
    reasons: &mut Vec<String>,
) -> Result<(), PlanError> {
    for bits in DEPTHS {
        if build.layout.depth_motion && bits == 0 {
            continue;
        }
        let mut fewer = Build { layout: Layout { depth_bits: bits, ..build.layout }, ..*build };
        if build.layout.depth_motion {
            // The range has at most as many bins as the z-buffer has steps.
            fewer.bits.depth_int = fewer.bits.depth_int.min(bits);
            fewer.bits.z = Component { position_frac: 0, ..fewer.bits.z };
        }
        if Record::plan(fewer.bits, fewer.layout).is_err() {
            continue;
        }
        let differs = subject.run(&fewer)?.differs(whole);
        if differs <= TOLERATED {
            *build = fewer;
            reasons.push(match bits {
                0 => format!("depth is left out: {:.3} % of the pixels differ without it", 100.0 * differs),
                _ => format!("{bits} bits of depth do: {:.3} % of the pixels differ", 100.0 * differs),
            });
            return Ok(());
        }
    }
    reasons.push("16 bits of depth are kept: with fewer more than 0.1 % of the pixels differ".to_owned());
    Ok(())
}

fn fill_mode(
    subject: &Subject<'_>,
    build: &mut Build,
    whole: &Ran,
    reasons: &mut Vec<String>,
) -> Result<(), PlanError> {
    if whole.holes == 0 {
        build.fill_mode = FillMode::None;
        reasons.push("no fill mode is needed: there are no holes".to_owned());
        return Ok(());
    }
    if whole.unobscured == 0 {
        build.fill_mode = FillMode::Bullet;
        reasons.push("the fill mode bullet does: every hole lies inside a surface".to_owned());
        return Ok(());
    }
    let mut shown = Vec::new();
    for fill_mode in [FillMode::Hold, FillMode::Debris, FillMode::Bullet, FillMode::Galdebris, FillMode::Extend] {
        let psnr_db = subject.run(&Build { fill_mode, ..*build })?.psnr_db(subject);
        shown.push((fill_mode, psnr_db));
    }
    let best = shown.iter().filter_map(|&(_, psnr_db)| psnr_db).reduce(f64::max);
    let Some(best) = best else {
        reasons.push("the fill mode extend is kept: no truth says that a cheaper one does".to_owned());
        return Ok(());
    };
    // A tenth of a decibel is not seen.
    let cheapest = shown.iter().find(|(_, psnr_db)| psnr_db.is_some_and(|psnr_db| psnr_db >= best - 0.1));
    if let Some(&(fill_mode, Some(psnr_db))) = cheapest {
        build.fill_mode = fill_mode;
        reasons.push(format!("the fill mode {} does: {psnr_db:.2} dB of at most {best:.2} dB", fill_mode.name()));
    }
    Ok(())
}
