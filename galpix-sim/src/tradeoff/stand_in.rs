//! Budgets fixed at compile time, in whose form a product runs. One for each choice of lanes and number of words: a frame's
//! time depends on these, on the rung and on the picture, and hardly on single bits. So a configuration takes the time of
//! the stand-in that has its lanes and the number of words that is nearest to its own.

use galpix_core::budget::{Bits, Demand};
use galpix_core::colour::Rgb888;
use galpix_core::frame::Settings;
use galpix_core::galpixel::{Fixed, Profile, Static};
use galpix_core::layout::{Lanes, Layout};

use super::design::Kept;
use super::timing::{Contender, Engine};
use crate::fill::Inpaint;
use crate::update::Update;

/// Makes the contender of an update; none if its maps cannot be laid out.
type Make = fn(&Update, Settings, Option<Inpaint>) -> Option<Box<dyn Contender>>;

/// A budget and lanes that are fixed at compile time.
#[derive(Clone, Copy)]
pub struct StandIn {
    /// Its lanes.
    pub kept: Kept,
    /// Its words.
    pub words: usize,
    /// `D`, `tau_recog` and `tau_prop` of its budget.
    pub demand: Demand,
    make: Make,
}

macro_rules! stand_ins {
    ($($name:ident: $kept:ident, $extent:literal, $prop:literal, $derive:ident;)*) => {
        $(
            enum $name {}
            impl Layout for $name {
                type Colour = Rgb888;
                const LANES: Lanes = Kept::$kept.lanes();
            }
            impl Profile for $name {
                const BITS: Bits = Bits::must(Bits::$derive(Demand { extent: $extent, recog: 8, prop: $prop }));
            }
        )*
        /// All of them.
        pub const ALL: &[StandIn] = &[$(StandIn {
            kept: Kept::$kept,
            words: <Static<$name> as Fixed<$name>>::RECORD.words(),
            demand: Demand { extent: $extent, recog: 8, prop: $prop },
            make: |update, settings, inpaint| {
                Some(Box::new(Engine::<$name, Static<$name>>::new(update, Static::new(), settings, inpaint)?))
            },
        }),*];
    };
}

stand_ins! {
    Still: Still, 1024, 16, derive;
    Velocity: Velocity, 1024, 32, derive_without_acceleration;
    VelocityDepth: VelocityDepth, 1024, 32, derive_without_acceleration;
    Acceleration: Acceleration, 1024, 32, derive;
    Full: Full, 1024, 16, derive;
    FullLong: Full, 1024, 32, derive;
    Luminosity: Luminosity, 1024, 32, derive;
}

/// The stand-in for some lanes and words.
#[must_use]
pub fn of(kept: Kept, words: usize) -> Option<&'static StandIn> {
    ALL.iter().filter(|stand_in| stand_in.kept == kept).min_by_key(|stand_in| stand_in.words.abs_diff(words))
}

impl StandIn {
    /// The engine of this stand-in over an update.
    #[must_use]
    pub fn contender(
        &self,
        update: &Update,
        settings: Settings,
        inpaint: Option<Inpaint>,
    ) -> Option<Box<dyn Contender>> {
        (self.make)(update, settings, inpaint)
    }

    /// Its name: lanes and words.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{} in {} words", self.kept.name(), self.words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_choice_of_lanes_has_a_stand_in_of_its_own_words() {
        for kept in Kept::ALL {
            assert!(ALL.iter().any(|stand_in| stand_in.kept == kept), "{}", kept.name());
        }
        let words: Vec<usize> = ALL.iter().map(|stand_in| stand_in.words).collect();
        assert_eq!(words, [1, 3, 3, 4, 5, 6, 6]);
        assert_eq!(of(Kept::Full, 9).map(|stand_in| stand_in.words), Some(6));
        assert_eq!(of(Kept::Full, 4).map(|stand_in| stand_in.words), Some(5));
    }
}
