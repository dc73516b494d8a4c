//! What the controller says, with the feature `defmt`; nothing without it.

use galpix_core::{Record, Tally};
use galpix_link::frame::Status;
use galpix_link::panel::Description;
use galpix_link::rejected::Rejected;

/// At the start: the display, how its galpixels are stored, and where the memory goes.
pub fn started(panel: &Description, record: &Record, memory: &[(&'static str, usize)]) {
    #[cfg(feature = "defmt")]
    {
        defmt::info!("{=str}: {} x {} galpixels", panel.name, panel.width, panel.height);
        defmt::info!("a galpixel: {} bits in {} bytes", record.bits(), record.bytes());
        for component in 0..2 {
            let scale = record.scales[component];
            let (velocity, acceleration) = (record.velocity(component).bits, record.acceleration(component).bits);
            defmt::info!(
                "component {}: position fraction {}, velocity {} bits, acceleration {} bits",
                component,
                scale.position_frac,
                velocity,
                acceleration
            );
        }
        let mut sum = 0;
        for (what, bytes) in memory {
            defmt::info!("memory: {=usize} bytes {=str}", *bytes, *what);
            sum += bytes;
        }
        defmt::info!("memory: {=usize} bytes in all", sum);
    }
    #[cfg(not(feature = "defmt"))]
    let _ = (panel, record, memory);
}

/// Once a second: what the last frame counted, how busy the processor was in the longest one, and what came over the
/// line.
pub fn second(status: &Status, tally: &Tally) {
    #[cfg(feature = "defmt")]
    {
        defmt::info!(
            "frame {}: moved {} lost {} collided {} saturated {} holes {} bullets {} galdebris {} empty {}",
            status.frame,
            tally.moved,
            tally.lost,
            tally.collided,
            tally.saturated,
            tally.holes,
            tally.bullets,
            tally.galdebris,
            tally.empty
        );
        defmt::info!(
            "busy {} of {} ticks, late {}, accepted {}, refused {}",
            status.busy,
            status.ticks,
            status.late,
            status.accepted,
            status.rejected.total()
        );
    }
    #[cfg(not(feature = "defmt"))]
    let _ = (status, tally);
}

/// A frame was not ready at its vsync.
pub fn late(frame: u32, missed: u32) {
    #[cfg(feature = "defmt")]
    defmt::warn!("frame {} came {} vsyncs late", frame, missed);
    #[cfg(not(feature = "defmt"))]
    let _ = (frame, missed);
}

/// A frame from the host was refused.
pub fn refused(cause: Rejected) {
    #[cfg(feature = "defmt")]
    defmt::debug!("refused: {}", cause);
    #[cfg(not(feature = "defmt"))]
    let _ = cause;
}
