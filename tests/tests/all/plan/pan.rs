use galpix_core::record::Component;
use galpix_core::{Bits, FillMode, Layout, Profile, Rounding, Settings};

/// 81 bits in 3 words per galpixel.
pub enum PlannedPan {}
impl Profile for PlannedPan {
    const LAYOUT: Layout = Layout { velocity: true, acceleration: true, ..Layout::STILL };
    const BITS: Bits = Bits {
        x: Component { position_frac: 5, velocity_int: 4, velocity_frac: 9, acceleration_int: 1, acceleration_frac: 9 },
        y: Component { position_frac: 5, velocity_int: 3, velocity_frac: 9, acceleration_int: 1, acceleration_frac: 9 },
        z: Component { position_frac: 5, velocity_int: 8, velocity_frac: 9, acceleration_int: 6, acceleration_frac: 9 },
        depth_int: 8, luminosity_int: 6, luminosity_frac: 5,
    };
}
pub const SETTINGS: Settings = Settings {
    rounding: Rounding::Searched, fill_mode: FillMode::Hold, edge_threshold: 1, reach: 1,
};
