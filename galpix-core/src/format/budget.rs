//! Bit budgets: equations (8) to (14) of the paper.
//!
//! Three design numbers give every width: the extent `D` of the display in pixels; `tau_recog`, the shortest time in
//! frames in which an object can be recognised; and `tau_prop`, the frames for which a galpixmap is propagated without
//! an update. Logarithms of numbers that are no powers of two are rounded up.

use crate::error::BudgetError;

/// Bits of the widest velocity or acceleration, so that `2v + a` fits in 32 bits.
pub const WIDEST_FIELD: u32 = 30;

/// The three design numbers of one component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Demand {
    /// `D`: the extent of the display along this component, in pixels (depth: in bins).
    pub extent: u32,
    /// `tau_recog`, in frames.
    pub recog: u32,
    /// `tau_prop`, in frames.
    pub prop: u32,
}

/// How many bits to subtract from what the equations give ("one can always shave bits off this estimate").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Shave {
    /// Fraction bits of the position.
    pub position_frac: u32,
    /// Integer bits of the velocity; each halves the largest speed.
    pub velocity_int: u32,
    /// Fraction bits of the velocity.
    pub velocity_frac: u32,
    /// Integer bits of the acceleration.
    pub acceleration_int: u32,
    /// Fraction bits of the acceleration.
    pub acceleration_frac: u32,
}

/// The widths of one component. Integer bits include the sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Component {
    /// Fraction bits of the position, equation (11).
    pub position_frac: u32,
    /// Integer bits of the velocity, equation (8).
    pub velocity_int: u32,
    /// Fraction bits of the velocity, equation (13).
    pub velocity_frac: u32,
    /// Integer bits of the acceleration, equation (9); 0 without acceleration.
    pub acceleration_int: u32,
    /// Fraction bits of the acceleration, equation (12); 0 without acceleration.
    pub acceleration_frac: u32,
}

/// Returns the smallest `n`, possibly negative, with `2^n >= numerator / denominator`. Both must be positive.
const fn ceil_log2_ratio(numerator: u64, denominator: u64) -> i32 {
    let mut n = 0;
    let mut high = denominator as u128;
    let mut low = numerator as u128;
    while high < low {
        high <<= 1;
        n += 1;
    }
    while high >= (low << 1) {
        low <<= 1;
        n -= 1;
    }
    n
}

impl Demand {
    /// Returns `log2 D`, rounded up: the bits that number the cells along this component.
    #[must_use]
    pub const fn extent_bits(self) -> u32 {
        if self.extent <= 1 { 0 } else { 32 - (self.extent - 1).leading_zeros() }
    }

    const fn check(self) -> Result<(), BudgetError> {
        if self.extent == 0 || self.recog == 0 || self.prop == 0 {
            return Err(BudgetError::Zero);
        }
        if self.prop == 1 {
            return Err(BudgetError::PropagationTooShort);
        }
        Ok(())
    }
}

impl Component {
    /// Derives every width by equations (8), (9), (11), (12) and (13).
    ///
    /// *Errors:* a demand with a zero or with `prop = 1`, a width that vanishes, or what [`Self::checked`] refuses.
    pub const fn derive(demand: Demand) -> Result<Self, BudgetError> {
        if let Err(error) = demand.check() {
            return Err(error);
        }
        let (extent, recog, prop) = (demand.extent as u64, demand.recog as u64, demand.prop as u64);
        let velocity_int = ceil_log2_ratio(extent, recog) + 3; // (8)
        let acceleration_int = ceil_log2_ratio(extent, recog * recog) + 4; // (9)
        let position_frac = ceil_log2_ratio(prop, 1); // (11)
        let acceleration_frac = ceil_log2_ratio(prop * prop, 2); // (12)
        if velocity_int < 1 {
            return Err(BudgetError::VelocityVanishes { integer_bits: velocity_int });
        }
        if acceleration_int < 1 {
            return Err(BudgetError::AccelerationVanishes { integer_bits: acceleration_int });
        }
        Self {
            position_frac: position_frac as u32,
            velocity_int: velocity_int as u32,
            velocity_frac: acceleration_frac as u32, // (13)
            acceleration_int: acceleration_int as u32,
            acceleration_frac: acceleration_frac as u32,
        }
        .checked()
    }

    /// Derives the widths of a component that carries no acceleration.
    ///
    /// The factor 4 in the paper's largest speed `4D/tau_recog` comes from galpixels whose acceleration reverses their
    /// motion. Without acceleration the bound is `D/tau_recog`, which saves two integer bits, and the smallest speed of
    /// equation (10) needs no more fraction bits than the position has.
    ///
    /// *Errors:* as [`Self::derive`].
    pub const fn derive_without_acceleration(demand: Demand) -> Result<Self, BudgetError> {
        if let Err(error) = demand.check() {
            return Err(error);
        }
        let velocity_int = ceil_log2_ratio(demand.extent as u64, demand.recog as u64) + 1;
        let position_frac = ceil_log2_ratio(demand.prop as u64, 1) as u32;
        if velocity_int < 1 {
            return Err(BudgetError::VelocityVanishes { integer_bits: velocity_int });
        }
        Self {
            position_frac,
            velocity_int: velocity_int as u32,
            velocity_frac: position_frac,
            acceleration_int: 0,
            acceleration_frac: 0,
        }
        .checked()
    }

    /// Returns the component with some bits shaved off.
    ///
    /// *Errors:* a field that would vanish, or a velocity that would become coarser than the acceleration.
    pub const fn shaved(self, shave: Shave) -> Result<Self, BudgetError> {
        const fn less(bits: u32, shaved: u32, least: u32) -> Option<u32> {
            match bits.checked_sub(shaved) {
                Some(remaining) if remaining >= least => Some(remaining),
                _ => None,
            }
        }
        let least = if self.has_acceleration() { 1 } else { 0 };
        match (
            less(self.position_frac, shave.position_frac, 0),
            less(self.velocity_int, shave.velocity_int, 1),
            less(self.velocity_frac, shave.velocity_frac, 0),
            less(self.acceleration_int, shave.acceleration_int, least),
            less(self.acceleration_frac, shave.acceleration_frac, 0),
        ) {
            (
                Some(position_frac),
                Some(velocity_int),
                Some(velocity_frac),
                Some(acceleration_int),
                Some(acceleration_frac),
            ) => Self { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac }.checked(),
            _ => Err(BudgetError::ShavedAway),
        }
    }

    /// Checks what the arithmetic needs: fields of at most [`WIDEST_FIELD`] bits, also in units of the position's last
    /// bit; room for a rounding threshold in the word of `2v + a`; at most 16 fraction bits of the position; and no
    /// acceleration finer than the velocity.
    ///
    /// *Errors:* a velocity without an integer bit, a field that is too wide, a velocity coarser than the acceleration.
    pub const fn checked(self) -> Result<Self, BudgetError> {
        let Self { position_frac, velocity_int, velocity_frac, acceleration_int, acceleration_frac } = self;
        if velocity_int == 0 {
            return Err(BudgetError::VelocityVanishes { integer_bits: 0 });
        }
        if self.has_acceleration() && acceleration_frac > velocity_frac {
            return Err(BudgetError::VelocityCoarserThanAcceleration {
                velocity: velocity_frac,
                acceleration: acceleration_frac,
            });
        }
        if position_frac > 16 {
            return Err(BudgetError::FieldTooWide { bits: position_frac, most: 16 });
        }
        // The acceleration is shifted to the velocity's fraction bits, so that the integer bits decide which is wider.
        let widest_int = if acceleration_int > velocity_int { acceleration_int } else { velocity_int };
        let lift = position_frac.saturating_sub(velocity_frac.saturating_add(1));
        let bits = widest_int.saturating_add(velocity_frac).saturating_add(lift);
        if bits > WIDEST_FIELD {
            return Err(BudgetError::FieldTooWide { bits, most: WIDEST_FIELD });
        }
        match self.dropped_bits_checked(position_frac) {
            Ok(()) => Ok(self),
            Err(error) => Err(error),
        }
    }

    /// Checks that the rounding threshold of a position with `position_frac` fraction bits fits into the word of `2v +
    /// a`.
    pub(crate) const fn dropped_bits_checked(self, position_frac: u32) -> Result<(), BudgetError> {
        let bits = (self.velocity_frac + 2).saturating_sub(position_frac);
        if bits > WIDEST_FIELD { Err(BudgetError::FieldTooWide { bits, most: WIDEST_FIELD }) } else { Ok(()) }
    }

    /// Returns whether this component carries an acceleration.
    #[must_use]
    pub const fn has_acceleration(self) -> bool {
        self.acceleration_int > 0
    }

    /// Returns the bits of a stored velocity.
    #[must_use]
    pub const fn velocity_bits(self) -> u32 {
        self.velocity_int + self.velocity_frac
    }

    /// Returns the bits of a stored acceleration.
    #[must_use]
    pub const fn acceleration_bits(self) -> u32 {
        self.acceleration_int + self.acceleration_frac
    }

    /// Returns the bits that motion adds to this component of each pixel, equation (14).
    #[must_use]
    pub const fn motion_bits(self) -> u32 {
        self.position_frac + self.velocity_bits() + self.acceleration_bits()
    }
}

/// The widths of all three components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bits {
    /// Along a row.
    pub x: Component,
    /// Along a column.
    pub y: Component,
    /// In depth. A z-buffer that moves has `z.position_frac` more bits than the layout's `depth_bits`.
    pub z: Component,
    /// Base-2 logarithm of the number of depth bins in the whole depth range. A bin is as large as a pixel.
    pub depth_int: u32,
    /// Integer bits of the luminosity rate (shading inertia), with the sign.
    pub luminosity_int: u32,
    /// Fraction bits of the luminosity and of its rate.
    pub luminosity_frac: u32,
}

impl Bits {
    /// Derives the same widths for all three components, as in the paper.
    ///
    /// *Errors:* those of [`Component::derive`].
    pub const fn derive(demand: Demand) -> Result<Self, BudgetError> {
        match Component::derive(demand) {
            Ok(component) => Self::from_component(component, demand),
            Err(error) => Err(error),
        }
    }

    /// Derives the same widths for all three components, without acceleration.
    ///
    /// *Errors:* those of [`Component::derive_without_acceleration`].
    pub const fn derive_without_acceleration(demand: Demand) -> Result<Self, BudgetError> {
        match Component::derive_without_acceleration(demand) {
            Ok(component) => Self::from_component(component, demand),
            Err(error) => Err(error),
        }
    }

    const fn from_component(component: Component, demand: Demand) -> Result<Self, BudgetError> {
        // The luminosity is a position on a scale of 256 values. As with D/tau_recog for pixels, the largest rate
        // crosses the scale in tau_recog frames; its fraction bits follow equation (11).
        let luminosity_int = ceil_log2_ratio(256, demand.recog as u64) + 1;
        let luminosity_int = if luminosity_int < 1 { 1 } else { luminosity_int as u32 };
        Ok(Self {
            x: component,
            y: component,
            z: component,
            depth_int: demand.extent_bits(),
            luminosity_int,
            luminosity_frac: component.position_frac,
        })
    }

    /// Replaces the component of the depth and the logarithm of the number of depth bins.
    #[must_use]
    pub const fn with_z(mut self, z: Component, depth_int: u32) -> Self {
        self.z = z;
        self.depth_int = depth_int;
        self
    }

    /// Replaces the components in the picture plane.
    #[must_use]
    pub const fn with_xy(mut self, x: Component, y: Component) -> Self {
        self.x = x;
        self.y = y;
        self
    }

    /// Returns the bits, for constants; an error becomes a compile error that states the reason.
    ///
    /// *Panics* on an error if called at run time.
    #[must_use]
    pub const fn must(bits: Result<Self, BudgetError>) -> Self {
        match bits {
            Ok(bits) => bits,
            Err(BudgetError::Zero) => panic!("budget: extent, recog and prop must all be positive"),
            Err(BudgetError::PropagationTooShort) => panic!("budget: prop must be 2 frames or more"),
            Err(BudgetError::VelocityVanishes { .. }) => {
                panic!("budget: no velocity bits left: raise extent or lower recog")
            }
            Err(BudgetError::AccelerationVanishes { .. }) => {
                panic!("budget: no acceleration bits left: raise extent, lower recog, or leave acceleration out")
            }
            Err(BudgetError::FieldTooWide { .. }) => {
                panic!("budget: a field is wider than a word: lower extent or prop")
            }
            Err(_) => panic!("budget: these widths cannot exist together"),
        }
    }
}
