//! Bit budgets: equations (8) to (14) of the paper.
//!
//! Three design numbers give every width: the extent `D` of the display in pixels, `tau_recog`, the shortest time in frames
//! for which an object can be recognised, and `tau_prop`, the frames that a galpixmap must survive without an update.
//! Where a number is no power of two, the smallest number of bits that holds the magnitude is taken.

use crate::error::BudgetError;

/// The widest velocity or acceleration: `2v + a` must not leave 32 bits.
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

/// How many bits to take off what the equations give ("one can always shave bits off this estimate").
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Shave {
    /// Fraction bits of the position.
    pub position_frac: u32,
    /// Integer bits of the velocity: lowers the largest speed.
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

/// The smallest `n`, possibly negative, with `2^n >= numerator / denominator`; both positive.
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
    /// `log2 D`, rounded up: the bits of the number of cells along this component.
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
    /// Every width by equations (8), (9), (11), (12) and (13).
    ///
    /// *Errors:* a demand with a zero, a width that vanishes, or a field wider than [`WIDEST_FIELD`].
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

    /// The widths of a component that carries no acceleration.
    ///
    /// The factor 4 in the paper's largest speed `4D/tau_recog` comes from a galpixel that is pulled back; without
    /// acceleration the bound is `D/tau_recog`, two integer bits fewer, and the smallest speed of equation (10) needs no
    /// more fraction bits than the position has.
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

    /// The same component with some bits taken off.
    ///
    /// *Errors:* if a field would vanish, or the velocity would become coarser than the acceleration.
    pub const fn shaved(self, shave: Shave) -> Result<Self, BudgetError> {
        const fn less(bits: u32, shaved: u32, least: u32) -> Option<u32> {
            match bits.checked_sub(shaved) {
                Some(left) if left >= least => Some(left),
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

    /// Checks what the arithmetic needs: fields of at most [`WIDEST_FIELD`] bits, also after they are brought to the
    /// position's unit, room for the rounding threshold, and no acceleration finer than the velocity.
    ///
    /// *Errors:* a velocity without a bit, a field that is too wide, a velocity coarser than the acceleration.
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
        // An acceleration is brought to the velocity's fraction, so that integer bits alone tell which is wider.
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

    /// Whether the rounding threshold of a position with `position_frac` fraction bits fits beside `2v + a`.
    pub(crate) const fn dropped_bits_checked(self, position_frac: u32) -> Result<(), BudgetError> {
        let bits = (self.velocity_frac + 2).saturating_sub(position_frac);
        if bits > WIDEST_FIELD { Err(BudgetError::FieldTooWide { bits, most: WIDEST_FIELD }) } else { Ok(()) }
    }

    /// Whether this component carries an acceleration.
    #[must_use]
    pub const fn has_acceleration(self) -> bool {
        self.acceleration_int > 0
    }

    /// Bits of a stored velocity.
    #[must_use]
    pub const fn velocity_bits(self) -> u32 {
        self.velocity_int + self.velocity_frac
    }

    /// Bits of a stored acceleration.
    #[must_use]
    pub const fn acceleration_bits(self) -> u32 {
        self.acceleration_int + self.acceleration_frac
    }

    /// Equation (14): the bits that motion adds to this component of each pixel.
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
    /// In depth. `z.position_frac` bits are added to the bits of the z-buffer.
    pub z: Component,
    /// Depth bins are of the size of pixels: the whole depth range is `2^depth_int` bins.
    pub depth_int: u32,
    /// Bits of a colour-rate field (shading inertia): integer bits with sign.
    pub luminosity_int: u32,
    /// Fraction bits of the luminosity and of its rate.
    pub luminosity_frac: u32,
}

impl Bits {
    /// The same budget for all three components, as in the paper.
    pub const fn derive(demand: Demand) -> Result<Self, BudgetError> {
        match Component::derive(demand) {
            Ok(component) => Self::from_component(component, demand),
            Err(error) => Err(error),
        }
    }

    /// The same without acceleration, see [`Component::derive_without_acceleration`].
    pub const fn derive_without_acceleration(demand: Demand) -> Result<Self, BudgetError> {
        match Component::derive_without_acceleration(demand) {
            Ok(component) => Self::from_component(component, demand),
            Err(error) => Err(error),
        }
    }

    const fn from_component(component: Component, demand: Demand) -> Result<Self, BudgetError> {
        // The luminosity is a position on a scale of 256: the largest rate crosses it in tau_recog, as D/tau_recog does
        // for pixels, and its fraction follows (11).
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

    /// Another component for the depth: fewer bits, or another extent.
    #[must_use]
    pub const fn with_z(mut self, z: Component, depth_int: u32) -> Self {
        self.z = z;
        self.depth_int = depth_int;
        self
    }

    /// Other components in the picture plane.
    #[must_use]
    pub const fn with_xy(mut self, x: Component, y: Component) -> Self {
        self.x = x;
        self.y = y;
        self
    }

    /// For constants: the bits, or a compile error with the reason.
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
