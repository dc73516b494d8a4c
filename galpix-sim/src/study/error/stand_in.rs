//! Formats fixed at compile time, in whose form a product runs: a frame's time depends on the fields, on the number of
//! words, on the fill mode and on the picture, and hardly on single bits. So a configuration takes the time of the
//! stand-in that has its fields, where there is one. Each is compiled on its own, so there are few: other fields are
//! timed in the form chosen at run time alone.

use galpix_core::{Bits, Demand, Layout, Profile, Record, Settings, Static};

use super::design::Kept;
use crate::engine::fill::Inpaint;
use crate::study::timing::{Contender, Engine};
use crate::update::Update;

/// The design numbers of all stand-ins: the paper's.
const DEMAND: Demand = Demand { extent: 1024, recog: 8, prop: 16 };

/// Makes the contender of an update; none if its maps cannot be laid out.
type Make = fn(&Update, Settings, Option<Inpaint>) -> Option<Box<dyn Contender>>;

/// A format that is fixed at compile time.
#[derive(Clone, Copy)]
pub struct StandIn {
    /// Its fields.
    pub kept: Kept,
    /// Its stored form.
    pub record: Record,
    make: Make,
}

enum Still {}

impl Profile for Still {
    const LAYOUT: Layout = Kept::Still.layout();
    const BITS: Bits = Bits::must(Bits::derive(DEMAND));
}

enum Velocity {}

impl Profile for Velocity {
    const LAYOUT: Layout = Kept::Velocity.layout();
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));
}

enum Full {}

impl Profile for Full {
    const LAYOUT: Layout = Kept::Full.layout();
    const BITS: Bits = Bits::must(Bits::derive(DEMAND));
}

/// All of them.
pub static ALL: [StandIn; 3] =
    [StandIn::of::<Still>(Kept::Still), StandIn::of::<Velocity>(Kept::Velocity), StandIn::of::<Full>(Kept::Full)];

/// Returns the stand-in for some fields, if there is one.
#[must_use]
pub fn of(kept: Kept) -> Option<&'static StandIn> {
    ALL.iter().find(|stand_in| stand_in.kept == kept)
}

impl StandIn {
    const fn of<P: Profile + 'static>(kept: Kept) -> Self {
        Self {
            kept,
            record: Static::<P>::RECORD,
            make: |update, settings, inpaint| {
                Some(Box::new(Engine::new(update, Static::<P>::new(), settings, inpaint)?))
            },
        }
    }

    /// Makes its engine over an update; none if its maps cannot be laid out.
    #[must_use]
    pub fn contender(
        &self,
        update: &Update,
        settings: Settings,
        inpaint: Option<Inpaint>,
    ) -> Option<Box<dyn Contender>> {
        (self.make)(update, settings, inpaint)
    }

    /// Returns its name: fields and words.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{} in {} words", self.kept.name(), self.record.words())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stand_ins_are_found_by_their_fields() {
        let names = Kept::ALL.map(|kept| of(kept).map(StandIn::name));
        let [still, velocity, full] = ["still in 1 words", "velocity in 3 words", "full in 5 words"];
        let expected = [Some(still), Some(velocity), None, None, Some(full), None];
        assert_eq!(names.each_ref().map(Option::as_deref), expected);
    }
}
