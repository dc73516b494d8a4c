//! A layout of one's own: a slider without depth, 12 bits per galpixel. `cargo run -p galpix-core --example
//! own_layout`.

use galpix_core::record::{Component, Shave};
use galpix_core::{Bits, BudgetError, Colour, Demand, Dynamic, Format, Layout};

/// Gray pixels that slide; nothing hides anything.
const SLIDER: Layout = Layout { colour: Colour::GRAY4, velocity: true, ..Layout::STILL };

fn main() -> Result<(), BudgetError> {
    // The equations of the paper for 128 pixels, recognition in 8 frames, an update every 8 ...
    let demand = Demand { extent: 128, recog: 8, prop: 8 };
    let bits = Bits::derive_without_acceleration(demand)?;
    // ... and one velocity bit fewer along the columns: half the largest speed.
    let none = Shave::default();
    let y = Component::derive_without_acceleration(demand)?.shaved(Shave { velocity_int: 1, ..none })?;
    let bits = bits.with_xy(bits.x, y);

    let format = Dynamic::new(bits, SLIDER)?;
    let record = format.record();
    println!("{} bits in {} words per galpixel", record.bits(), record.words());
    for (name, field) in [
        ("class", record.class()),
        ("offset x", record.offset_x()),
        ("offset y", record.offset_y()),
        ("velocity x", record.velocity(0)),
        ("velocity y", record.velocity(1)),
        ("colour", record.colour()),
    ] {
        println!("{name:<10} {:>2} bits, word {}, from bit {}", field.bits, field.word, field.shift);
    }
    // What cannot exist is refused with the remedy.
    println!("{}", Dynamic::new(bits, Layout { acceleration: true, ..SLIDER }).unwrap_err());
    Ok(())
}
