//! Which instructions multiply, divide, calculate with floats or trap: by their encodings, of which there are few.

/// A kind of processor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Machine {
    /// Armv6-M and Armv7-M: Cortex-M0, M3, M4.
    Thumb,
    /// RV32IMAC.
    RiscV32,
}

/// What an instruction does that a frame must not do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deed {
    /// A product, also one that is added to something.
    Multiply,
    /// A quotient or a remainder.
    Divide,
    /// Arithmetic with floats, or another coprocessor.
    Float,
    /// A trap, as after a path that "cannot happen".
    Trap,
}

impl Machine {
    /// Where the code at an address begins. Arm marks Thumb code by an odd address.
    pub const fn code_address(self, address: u64) -> u64 {
        match self {
            Self::Thumb => address & !1,
            Self::RiscV32 => address,
        }
    }

    /// The bytes of the instruction that begins with these halfwords, and its deed.
    pub fn read(self, first: u16, second: u16) -> (usize, Option<Deed>) {
        match self {
            Self::Thumb if first >> 11 >= 0b11101 => (4, thumb_wide(first, second)),
            Self::Thumb => (2, thumb_narrow(first)),
            Self::RiscV32 if first & 3 == 3 => (4, riscv_wide(u32::from(second) << 16 | u32::from(first))),
            Self::RiscV32 => (2, riscv_narrow(first)),
        }
    }
}

fn thumb_narrow(first: u16) -> Option<Deed> {
    match first {
        _ if first & 0xffc0 == 0x4340 => Some(Deed::Multiply),
        // UDF and BKPT.
        0xde00..=0xdeff | 0xbe00..=0xbeff => Some(Deed::Trap),
        _ => None,
    }
}

fn thumb_wide(first: u16, second: u16) -> Option<Deed> {
    match first {
        // SDIV and UDIV are among the long products.
        _ if first & 0xffd0 == 0xfb90 && second & 0x00f0 == 0x00f0 => Some(Deed::Divide),
        0xfb00..=0xfbff => Some(Deed::Multiply),
        _ if first & 0xec00 == 0xec00 => Some(Deed::Float),
        0xf7f0..=0xf7ff if second & 0xf000 == 0xa000 => Some(Deed::Trap),
        _ => None,
    }
}

fn riscv_narrow(first: u16) -> Option<Deed> {
    match (first & 0xe003, first) {
        // No instruction at all, and C.EBREAK.
        (_, 0x0000 | 0x9002) => Some(Deed::Trap),
        // Loads and stores of floats.
        (0x2000 | 0x6000 | 0xa000 | 0xe000 | 0x2002 | 0x6002 | 0xa002 | 0xe002, _) => Some(Deed::Float),
        _ => None,
    }
}

fn riscv_wide(word: u32) -> Option<Deed> {
    let (opcode, function) = (word & 0x7f, word >> 12 & 7);
    match opcode {
        0x33 if word >> 25 == 1 => Some(if function < 4 { Deed::Multiply } else { Deed::Divide }),
        0x07 | 0x27 | 0x43 | 0x47 | 0x4b | 0x4f | 0x53 => Some(Deed::Float),
        // EBREAK, and the write to a counter that stands for "no instruction".
        0x73 if word == 0x0010_0073 || word == 0xc000_1073 => Some(Deed::Trap),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{Deed, Machine};

    #[test]
    fn deeds_are_told_from_harmless_neighbours() {
        let thumb: [(u16, u16, usize, Option<Deed>); 14] = [
            (0x4348, 0, 2, Some(Deed::Multiply)),      // muls r0, r1, r0
            (0x4308, 0, 2, None),                      // orrs r0, r1
            (0x4388, 0, 2, None),                      // bics r0, r1
            (0xfb01, 0xf202, 4, Some(Deed::Multiply)), // mul r2, r1, r2
            (0xfb09, 0x2200, 4, Some(Deed::Multiply)), // mla r2, r9, r0, r2
            (0xfba0, 0x0101, 4, Some(Deed::Multiply)), // umull r0, r1, r0, r1
            (0xfb90, 0xf0f1, 4, Some(Deed::Divide)),   // sdiv r0, r0, r1
            (0xfbb0, 0xf0f1, 4, Some(Deed::Divide)),   // udiv r0, r0, r1
            (0xee30, 0x0a20, 4, Some(Deed::Float)),    // vadd.f32 s0, s0, s1
            (0xeb00, 0x0001, 4, None),                 // add.w r0, r0, r1
            (0xfa00, 0xf001, 4, None),                 // lsl.w r0, r0, r1
            (0xf7ff, 0xfffe, 4, None),                 // bl
            (0xde00, 0, 2, Some(Deed::Trap)),          // udf #0
            (0xf7f0, 0xa000, 4, Some(Deed::Trap)),     // udf.w #0
        ];
        for (first, second, bytes, deed) in thumb {
            assert_eq!(Machine::Thumb.read(first, second), (bytes, deed), "{first:#06x} {second:#06x}");
        }
        let riscv: [(u32, usize, Option<Deed>); 9] = [
            (0x02b5_0533, 4, Some(Deed::Multiply)), // mul a0, a0, a1
            (0x02b5_5533, 4, Some(Deed::Divide)),   // divu a0, a0, a1
            (0x02b5_7533, 4, Some(Deed::Divide)),   // remu a0, a0, a1
            (0x00b5_0533, 4, None),                 // add a0, a0, a1
            (0x40b5_0533, 4, None),                 // sub a0, a0, a1
            (0x00b5_7553, 4, Some(Deed::Float)),    // fadd.s fa0, fa0, fa1
            (0x852e, 2, None),                      // c.mv a0, a1
            (0x9002, 2, Some(Deed::Trap)),          // c.ebreak
            (0x0000, 2, Some(Deed::Trap)),          // unimp
        ];
        for (word, bytes, deed) in riscv {
            assert_eq!(Machine::RiscV32.read(word as u16, (word >> 16) as u16), (bytes, deed), "{word:#010x}");
        }
    }
}
