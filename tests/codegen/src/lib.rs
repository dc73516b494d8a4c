//! The core's passes as symbols of a static library, so that their machine code can be inspected.
//!
//! `proof_*` must reach no panic, no multiplication, no division and no float, but for `proof_inpaint_*` and `proof_submit_*`, which may multiply;
//! `distorted_*` must reach no panic;
//! `planted_*` each reach one of them on purpose, so that the inspection is seen to find it. All arguments are opaque to the optimiser: maps, scratch memory and
//! settings come from outside.

#![no_std]

use galpix_core::budget::{Bits, Demand};
use galpix_core::disocclusion::Reach;
use galpix_core::frame::{self, Controller, Inpainting, Scratch, Settings, Work};
use galpix_core::galpixel::{Profile, Static};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::inpaint::paint::{Moving, Tint};
use galpix_core::inpaint::pyramid::Pyramid;
use galpix_core::layers::{Layers, LayersTally};
use galpix_core::layout::{Flat565, Full, Layout, Shaded, Tagged, Velocity565, VelocityGray4};
use galpix_core::objects::{Object, ObjectsTally, Queue};
use galpix_core::overlay::{self, Overlay};
use galpix_core::rolling::Rolling;
use galpix_core::rounding::Rounding;
use galpix_core::tally::Tally;
use galpix_core::{disocclusion, edge, fill, scan_out, sweep};

const DEMAND: Demand = Demand { extent: 512, recog: 8, prop: 16 };

/// A panel of up to 512 pixels a side, with acceleration.
#[derive(Debug)]
pub struct Panel;

impl Profile for Panel {
    const BITS: Bits = Bits::must(Bits::derive(DEMAND));
}

/// The same without acceleration.
#[derive(Debug)]
pub struct PanelVelocity;

impl Profile for PanelVelocity {
    const BITS: Bits = Bits::must(Bits::derive_without_acceleration(DEMAND));
}

macro_rules! proofs {
    ($($layout:ident, $profile:ident: $sweep:ident, $edge:ident, $fill:ident, $step:ident, $constant:ident,
        $scan_out:ident, $inpaint:ident, $rolling:ident, $overlay:ident, $disocclusion:ident, $cover:ident, $layers:ident;)*) => {$(
        /// Propagation and resolution.
        #[unsafe(no_mangle)]
        pub fn $sweep(
            front: &Galpixmap<'_, $layout, Static<$profile>>,
            back: &mut Galpixmap<'_, $layout, Static<$profile>>,
            winners: &mut [u32],
            rounding: Rounding,
            frame: u32,
        ) -> Tally {
            sweep::sweep(front, back, winners, rounding, frame)
        }

        /// The edge map.
        #[unsafe(no_mangle)]
        pub fn $edge(front: &Galpixmap<'_, $layout, Static<$profile>>, threshold: u32, edges: &mut [u32]) -> u32 {
            edge::mark(front, threshold, edges)
        }

        /// The fill ladder.
        #[unsafe(no_mangle)]
        pub fn $fill(
            front: &Galpixmap<'_, $layout, Static<$profile>>,
            back: &mut Galpixmap<'_, $layout, Static<$profile>>,
            scratch: &mut Scratch<'_>,
            settings: &Settings,
            tally: &mut Tally,
        ) {
            fill::fill(front, back, scratch.winners, scratch.edges, settings.rung, settings.reach, tally);
        }

        /// A whole frame.
        #[unsafe(no_mangle)]
        pub fn $step(
            front: &Galpixmap<'_, $layout, Static<$profile>>,
            back: &mut Galpixmap<'_, $layout, Static<$profile>>,
            scratch: &mut Scratch<'_>,
            settings: &Settings,
            frame: u32,
        ) -> Tally {
            frame::step(front, back, scratch, settings, frame)
        }

        /// A whole frame with constant work.
        #[unsafe(no_mangle)]
        pub fn $constant(
            front: &Galpixmap<'_, $layout, Static<$profile>>,
            back: &mut Galpixmap<'_, $layout, Static<$profile>>,
            scratch: &mut Scratch<'_>,
            settings: &Settings,
            frame: u32,
        ) -> Tally {
            frame::step(front, back, scratch, &Settings { work: Work::Constant, ..*settings }, frame)
        }

        /// Quads and push-pull, sparse and dense, of colours with their motion.
        #[unsafe(no_mangle)]
        pub fn $inpaint(
            controller: &mut Controller<'_, $layout, Static<$profile>>,
            settings: &Settings,
            inpainting: &Inpainting<'_>,
            pyramid: &mut Pyramid<'_, Moving>,
        ) -> u32 {
            controller.inpaint(settings, inpainting, pyramid)
        }

        /// Push-pull in one map, of colours.
        #[unsafe(no_mangle)]
        pub fn $rolling(
            rolling: &mut Rolling<'_, $layout, Static<$profile>>,
            settings: &Settings,
            inpainting: &Inpainting<'_>,
            pyramid: &mut Pyramid<'_, Tint>,
        ) -> u32 {
            rolling.inpaint(settings, inpainting, pyramid)
        }

        /// The disocclusion map, marked and spread in raster order.
        #[unsafe(no_mangle)]
        pub fn $disocclusion(
            front: &Galpixmap<'_, $layout, Static<$profile>>,
            extents: &mut [u32],
            reach: &Reach,
        ) -> disocclusion::Tally {
            disocclusion::map(front, extents, reach)
        }

        /// Its cells, a bit each, with a line of memory.
        #[unsafe(no_mangle)]
        pub fn $cover(
            front: &Galpixmap<'_, $layout, Static<$profile>>,
            line: &mut [u32],
            mask: &mut [u32],
            reach: &Reach,
        ) -> disocclusion::Tally {
            disocclusion::cover(front, line, mask, reach)
        }

        /// A frame of three layers, any of which but the base may be anchored, and what they showed before it.
        #[unsafe(no_mangle)]
        pub fn $layers(
            layers: &mut Layers<'_, $layout, Static<$profile>, 2>,
            settings: &Settings,
            cell: u32,
        ) -> (usize, LayersTally<2>) {
            layers.resolve(settings.work);
            (layers.layer_at(cell), layers.step(settings))
        }

        /// A row for a display of 16-bit words.
        #[unsafe(no_mangle)]
        pub fn $scan_out(map: &Galpixmap<'_, $layout, Static<$profile>>, y: u32, line: &mut [u16]) {
            for (word, colour) in line.iter_mut().zip(scan_out::row(map, y)) {
                *word = colour as u16;
            }
        }

        /// The same under an overlay.
        #[unsafe(no_mangle)]
        pub fn $overlay(
            map: &Galpixmap<'_, $layout, Static<$profile>>,
            overlay: &Overlay<'_, <$layout as Layout>::Colour>,
            y: u32,
            line: &mut [u16],
        ) {
            for (word, colour) in line.iter_mut().zip(overlay::row(map, overlay, y)) {
                *word = colour as u16;
            }
        }
    )*};
}

macro_rules! object_proofs {
    ($($layout:ident: $submit:ident, $apply:ident;)*) => {$(
        /// Takes an object's rendering, or refuses it.
        #[unsafe(no_mangle)]
        pub fn $submit(
            queue: &mut Queue<'_, $layout, Static<Panel>, 4>,
            layers: &Layers<'_, $layout, Static<Panel>, 1>,
            object: &Object,
            words: &[u32],
        ) -> bool {
            queue.submit(layers, object, words).is_ok()
        }

        /// Replaces objects in two layers.
        #[unsafe(no_mangle)]
        pub fn $apply(
            queue: &mut Queue<'_, $layout, Static<Panel>, 4>,
            layers: &mut Layers<'_, $layout, Static<Panel>, 1>,
            rounding: Rounding,
            most: u32,
        ) -> ObjectsTally {
            queue.apply(layers, rounding, most)
        }
    )*};
}

object_proofs! {
    Tagged: proof_submit_tagged, proof_apply_tagged;
    Shaded: proof_submit_shaded, proof_apply_shaded;
}

proofs! {
    Full, Panel: proof_sweep_full, proof_edge_full, proof_fill_full, proof_step_full, proof_constant_full, proof_scan_out_full,
        proof_inpaint_full, proof_inpaint_rolling_full, proof_overlay_full, proof_disocclusion_full, proof_cover_full, proof_layers_full;
    Shaded, Panel: proof_sweep_shaded, proof_edge_shaded, proof_fill_shaded, proof_step_shaded, proof_constant_shaded, proof_scan_out_shaded,
        proof_inpaint_shaded, proof_inpaint_rolling_shaded, proof_overlay_shaded, proof_disocclusion_shaded, proof_cover_shaded, proof_layers_shaded;
    Flat565, Panel: proof_sweep_flat565, proof_edge_flat565, proof_fill_flat565, proof_step_flat565, proof_constant_flat565,
        proof_scan_out_flat565,
        proof_inpaint_flat565, proof_inpaint_rolling_flat565, proof_overlay_flat565, proof_disocclusion_flat565, proof_cover_flat565, proof_layers_flat565;
    Velocity565, PanelVelocity: proof_sweep_velocity565, proof_edge_velocity565, proof_fill_velocity565,
        proof_step_velocity565, proof_constant_velocity565, proof_scan_out_velocity565,
        proof_inpaint_velocity565, proof_inpaint_rolling_velocity565, proof_overlay_velocity565, proof_disocclusion_velocity565, proof_cover_velocity565, proof_layers_velocity565;
    VelocityGray4, PanelVelocity: proof_sweep_velocity_gray4, proof_edge_velocity_gray4, proof_fill_velocity_gray4,
        proof_step_velocity_gray4, proof_constant_velocity_gray4, proof_scan_out_velocity_gray4,
        proof_inpaint_velocity_gray4, proof_inpaint_rolling_velocity_gray4, proof_overlay_velocity_gray4, proof_disocclusion_velocity_gray4, proof_cover_velocity_gray4, proof_layers_velocity_gray4;
}

mod distorted {
    //! The distortion map of the DDOC: it multiplies and divides, and reaches no panic.

    use galpix_core::ddoc::splat::Splat;
    use galpix_core::ddoc::{DistortionMap, Settings, Tally};
    use galpix_core::grid::Grid;

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
