//! The core's passes as symbols of a static library, so that their machine code can be inspected.
//!
//! `proof_*` must reach no panic, no multiplication, no division and no float, but for those that inpaint, go over
//! layers, resample rows, show stationary sources, submit objects or make disocclusion maps, which may multiply.
//! `distorted_*` must reach no panic. `planted_*` each reach one of these on purpose, so that the inspection is seen to
//! find it. All arguments are opaque to the optimiser: maps, scratch memory and settings come from outside.

#![no_std]

use galpix_core::disocclusion::{self, Reach};
use galpix_core::inpaint::PushPull;
use galpix_core::layers::Layers;
use galpix_core::objects::{Object, ObjectsTally, Queue};
use galpix_core::overlay::{self, Overlay};
use galpix_core::rolling::Rolling;
use galpix_core::source::{Budget, Gather, Source, Sources};
use galpix_core::{
    Bits, Controller, Demand, Galpixmap, Inpainting, Layout, Profile, Rounding, Scratch, Settings, Static, Tally,
    scan_out, stages, sub_cell,
};

/// A panel of up to 512 pixels a side.
const DEMAND: Demand = Demand { extent: 512, recog: 8, prop: 16 };
const WITH_ACCELERATION: Bits = Bits::must(Bits::derive(DEMAND));
const WITHOUT_ACCELERATION: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));

/// Declares the format of a module.
macro_rules! fields {
    ($layout:ident, $bits:ident) => {
        use super::*;

        /// Which fields there are, and their widths.
        #[derive(Debug)]
        pub struct Fields;

        impl Profile for Fields {
            const LAYOUT: Layout = Layout::$layout;
            const BITS: Bits = $bits;
        }

        type Format = Static<Fields>;
    };
}

macro_rules! passes {
    ($($name:ident: $layout:ident, $bits:ident;)*) => {$(
        /// The passes of this format.
        pub mod $name {
            fields!($layout, $bits);

            /// Propagation and resolution.
            #[unsafe(export_name = concat!("proof_sweep_", stringify!($name)))]
            pub fn sweep(
                front: &Galpixmap<'_, Format>,
                back: &mut Galpixmap<'_, Format>,
                winners: &mut [u32],
                rounding: Rounding,
                frame: u32,
            ) -> Tally {
                stages::sweep(front, back, winners, rounding, frame)
            }

            /// The edge map.
            #[unsafe(export_name = concat!("proof_edge_", stringify!($name)))]
            pub fn edge(front: &Galpixmap<'_, Format>, threshold: u32, edges: &mut [u32]) -> u32 {
                stages::mark(front, threshold, edges)
            }

            /// The fill modes.
            #[unsafe(export_name = concat!("proof_fill_", stringify!($name)))]
            pub fn fill(
                front: &Galpixmap<'_, Format>,
                back: &mut Galpixmap<'_, Format>,
                scratch: &mut Scratch<'_>,
                settings: &Settings,
                tally: &mut Tally,
            ) {
                stages::fill(front, back, scratch, settings, tally);
            }

            /// A whole frame.
            #[unsafe(export_name = concat!("proof_step_", stringify!($name)))]
            pub fn step(controller: &mut Controller<'_, Format>, settings: &Settings) -> Tally {
                controller.step(settings)
            }

            /// A whole frame in constant time.
            #[unsafe(export_name = concat!("proof_constant_", stringify!($name)))]
            pub fn constant(controller: &mut Controller<'_, Format>, settings: &Settings) -> Tally {
                controller.step_constant_time(settings)
            }

            /// Quads and push-pull, of colours and of colours with their motion.
            #[unsafe(export_name = concat!("proof_inpaint_", stringify!($name)))]
            pub fn inpaint(
                controller: &mut Controller<'_, Format>,
                settings: &Settings,
                inpainting: &Inpainting<'_>,
                push_pull: &mut PushPull<'_>,
            ) -> u32 {
                controller.inpaint(settings, inpainting, push_pull)
            }

            /// Push-pull in one map.
            #[unsafe(export_name = concat!("proof_inpaint_rolling_", stringify!($name)))]
            pub fn inpaint_rolling(
                rolling: &mut Rolling<'_, Format>,
                inpainting: &Inpainting<'_>,
                push_pull: &mut PushPull<'_>,
            ) -> u32 {
                rolling.inpaint(inpainting, push_pull)
            }

            /// The disocclusion map, marked and spread in raster order.
            #[unsafe(export_name = concat!("proof_disocclusion_", stringify!($name)))]
            pub fn disocclusion(
                front: &Galpixmap<'_, Format>,
                extents: &mut [u32],
                reach: &Reach,
            ) -> disocclusion::Tally {
                disocclusion::map(front, extents, reach)
            }

            /// Its cells, a bit each, with a line of memory.
            #[unsafe(export_name = concat!("proof_cover_", stringify!($name)))]
            pub fn cover(
                front: &Galpixmap<'_, Format>,
                line: &mut [u32],
                mask: &mut [u32],
                reach: &Reach,
            ) -> disocclusion::Tally {
                disocclusion::cover(front, line, mask, reach)
            }

            /// A frame of layers, in either mode, and what they showed before it. Any but the base may be stationary.
            #[unsafe(export_name = concat!("proof_layers_", stringify!($name)))]
            pub fn layers(
                layers: &mut Layers<'_, '_, Format>,
                settings: &Settings,
                constant_time: bool,
                cell: u32,
            ) -> (usize, Tally) {
                layers.composite();
                let shown = layers.layer_at(cell);
                (shown, if constant_time { layers.step_constant_time(settings) } else { layers.step(settings) })
            }

            /// A row for a display of 16-bit words.
            #[unsafe(export_name = concat!("proof_scan_out_", stringify!($name)))]
            pub fn scan_out(map: &Galpixmap<'_, Format>, y: u32, line: &mut [u16]) {
                for (word, colour) in line.iter_mut().zip(scan_out::row(map, y)) {
                    *word = colour as u16;
                }
            }

            /// The same, resampled by the offsets.
            #[unsafe(export_name = concat!("proof_sub_cell_", stringify!($name)))]
            pub fn sub_cell(map: &Galpixmap<'_, Format>, edge_threshold: u32, y: u32, line: &mut [u16]) {
                for (word, colour) in line.iter_mut().zip(sub_cell::row(map, edge_threshold, y)) {
                    *word = colour as u16;
                }
            }

            /// A frame of stationary sources, and an update before it.
            #[unsafe(export_name = concat!("proof_sources_", stringify!($name)))]
            pub fn sources<'p>(
                sources: &mut Sources<'p, '_, Format>,
                spare: &mut Source<'p, Format>,
                settings: &Settings,
                layer: usize,
            ) -> Tally {
                spare.begin_at([layer as i32; 2], settings.edge_threshold);
                spare.step(settings.rounding, sources.frame());
                if sources.replace(layer, spare).is_ok() {
                    sources.show(settings);
                }
                sources.step(settings)
            }

            /// A frame of them in constant time.
            #[unsafe(export_name = concat!("proof_sources_constant_", stringify!($name)))]
            pub fn sources_constant(
                sources: &mut Sources<'_, '_, Format>,
                settings: &Settings,
                budget: &Budget,
            ) -> (Tally, u32) {
                sources.step_constant_time(settings, budget)
            }

            /// Rows of them: gathered, how far they have moved, what is known of them, and finished.
            #[unsafe(export_name = concat!("proof_source_rows_", stringify!($name)))]
            pub fn source_rows(
                sources: &Sources<'_, '_, Format>,
                y: u32,
                gather: Gather,
                lines: [&mut [u32]; 3],
                finished: &mut [u32],
            ) -> Option<(usize, u32)> {
                let [above, row, below] = lines;
                sources.gather(y, gather, row);
                sources.moved(y, above);
                sources.known(y, above, below);
                sources.finish(y, gather.edge_threshold, [above, row, below], finished);
                sources.shown(y)
            }

            /// The row as it is, under an overlay.
            #[unsafe(export_name = concat!("proof_overlay_", stringify!($name)))]
            pub fn overlay(
                map: &Galpixmap<'_, Format>,
                overlay: &Overlay<'_>,
                y: u32,
                line: &mut [u16],
            ) {
                for (word, colour) in line.iter_mut().zip(overlay::row(map, overlay, y)) {
                    *word = colour as u16;
                }
            }
        }
    )*};
}

/// Of layouts with a tag.
macro_rules! objects {
    ($($name:ident: $layout:ident, $bits:ident;)*) => {$(
        /// What replaces objects in maps of this format.
        pub mod $name {
            fields!($layout, $bits);

            /// Takes an object's rendering, or refuses it.
            #[unsafe(export_name = concat!("proof_submit_", stringify!($name)))]
            pub fn submit(
                queue: &mut Queue<'_, Format>,
                layers: &Layers<'_, '_, Format>,
                object: &Object,
                words: &[u32],
            ) -> bool {
                queue.submit(layers, object, words).is_ok()
            }

            /// Replaces objects in layers.
            #[unsafe(export_name = concat!("proof_apply_", stringify!($name)))]
            pub fn apply(
                queue: &mut Queue<'_, Format>,
                layers: &mut Layers<'_, '_, Format>,
                rounding: Rounding,
                most: u32,
            ) -> ObjectsTally {
                queue.apply(layers, rounding, most)
            }
        }
    )*};
}

passes! {
    full: FULL, WITH_ACCELERATION;
    shaded: SHADED, WITH_ACCELERATION;
    flat565: FLAT565, WITH_ACCELERATION;
    velocity565: VELOCITY565, WITHOUT_ACCELERATION;
    velocity_gray4: VELOCITY_GRAY4, WITHOUT_ACCELERATION;
}

/// What replaces objects, besides the passes.
pub mod of_objects {
    use super::*;

    objects! {
        tagged: TAGGED, WITH_ACCELERATION;
        shaded: SHADED, WITH_ACCELERATION;
    }
}

mod distorted {
    //! The distortion map of the DDOC: it multiplies and divides, and reaches no panic.

    use galpix_core::Grid;
    use galpix_core::ddoc::{DistortionMap, Settings, Splat, Tally};

    /// The map from depths.
    #[unsafe(no_mangle)]
    pub fn distorted_map(
        grid: &Grid<'_>,
        depths: &[u32],
        settings: &Settings,
        owners: &mut [u32],
        splats: &mut [Splat],
    ) -> Tally {
        DistortionMap::new(*grid, depths, settings, owners, splats).map(|(_, tally)| tally).unwrap_or_default()
    }

    /// One place.
    #[unsafe(no_mangle)]
    pub fn distorted_place(map: &DistortionMap<'_>, place: &[i32; 2], depth: u32, to: &mut [i32; 2]) {
        *to = map.displaced(*place, depth);
    }
}

mod planted {
    //! One fault each.

    /// An index that may be out of range, two calls down.
    #[unsafe(no_mangle)]
    pub fn planted_panic(words: &mut [u32], cell: usize) {
        outer(words, cell);
    }

    #[inline(never)]
    fn outer(words: &mut [u32], cell: usize) {
        inner(words, cell);
        inner(words, cell + 1);
    }

    #[inline(never)]
    fn inner(words: &mut [u32], cell: usize) {
        words[cell] = 0;
    }

    /// A panic behind a function pointer that a table in memory holds.
    #[unsafe(no_mangle)]
    pub fn planted_panic_in_table(words: &mut [u32], cell: usize, which: usize) {
        static TABLE: [fn(&mut [u32], usize); 2] = [inner, outer];
        if let Some(chosen) = TABLE.get(which) {
            chosen(words, cell);
        }
    }

    /// A multiplication in the code itself.
    #[unsafe(no_mangle)]
    pub fn planted_multiply(y: u32, width: u32) -> u32 {
        y.wrapping_mul(width)
    }

    /// A multiplication that is a helper's work where the machine has no 64-bit product.
    #[unsafe(no_mangle)]
    pub fn planted_wide_multiply(y: u64, width: u64) -> u64 {
        y.wrapping_mul(width)
    }

    /// A quotient where a product is allowed.
    #[unsafe(no_mangle)]
    pub fn planted_inpaint_divide(cells: u32, width: core::num::NonZeroU32) -> u32 {
        cells.wrapping_mul(cells) / width
    }

    /// A panic where a product is allowed.
    #[unsafe(no_mangle)]
    pub fn planted_inpaint_panic(words: &mut [u32], cell: usize) {
        outer(words, cell.wrapping_mul(cell));
    }

    /// A division, an instruction or a helper; no panic.
    #[unsafe(no_mangle)]
    pub fn planted_divide(cells: u32, width: core::num::NonZeroU32) -> u32 {
        cells / width
    }

    /// A remainder by a constant, which optimisers turn into a multiplication.
    #[unsafe(no_mangle)]
    pub fn planted_remainder(cells: u32) -> u32 {
        cells % 10
    }

    /// A float.
    #[unsafe(no_mangle)]
    pub fn planted_float(v: f32, a: f32) -> f32 {
        v + a
    }
}

unsafe extern "C" {
    /// Defined nowhere: whatever reaches it can panic.
    safe fn galpix_core_can_panic() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    galpix_core_can_panic()
}
