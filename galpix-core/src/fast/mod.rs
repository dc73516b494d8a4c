//! The fast forms of a frame's passes, and the only place where they are selected.
//!
//! Every pass has a reference in [`crate::frame::reference`], whose instructions do not depend on the picture. This
//! module adds at most one fast form for each class of machine: [`wide`] where loops over neighbours become vector
//! code, [`narrow`] where they do not. With the feature `check` each fast pass is compared with its reference while it
//! runs.

#[cfg(feature = "check")]
pub(crate) mod check;
mod fill;
mod narrow;
pub mod rolling;
mod wide;

use crate::disocclusion::{self, Reach};
use crate::error::SetupError;
use crate::format::rounding::Rounding;
use crate::format::{Dynamic, Format, Profile, Static};
use crate::frame::fill::Around;
use crate::frame::tally::Tally;
use crate::frame::{self, Scratch, Settings, reference};
use crate::inpaint::{Inpainting, Metamer, PushPull, map, quads};
use crate::layers::{self, Layers};
use crate::map::Galpixmap;
use crate::source::cracks::Closed;
use crate::source::row::{self, Finish, GatherRow};
use crate::source::{self, Budget, Gather, Source, Sources, Visibility};
use rolling::Rolling;

/// Whether loops over neighbours become vector code on the target. Selects the form of a pass; results do not depend on
/// it.
pub(crate) const VECTORS: bool =
    cfg!(any(target_arch = "x86_64", target_arch = "x86", target_arch = "aarch64", target_arch = "wasm32"));

/// Marks the cells of a map that are on an edge, see [`crate::frame::edge::mark`].
pub(crate) fn mark<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    #[cfg(feature = "check")]
    check::mark(front, threshold, edges);
    if VECTORS { wide::edge::mark(front, threshold, edges) } else { narrow::edge::mark(front, threshold, edges) }
}

/// Marks the cells of a map that are on an edge, by instructions that do not depend on the picture.
pub(crate) fn mark_constant_time<F: Format>(front: &Galpixmap<'_, F>, threshold: u32, edges: &mut [u32]) -> u32 {
    if VECTORS { wide::edge::mark(front, threshold, edges) } else { reference::edge::mark(front, threshold, edges) }
}

/// Propagates a map and resolves collisions, see [`crate::frame::resolve::sweep`].
pub(crate) fn sweep<F: Format>(
    front: &Galpixmap<'_, F>,
    back: &mut Galpixmap<'_, F>,
    winners: &mut [u32],
    rounding: Rounding,
    frame: u32,
) -> Tally {
    #[cfg(feature = "check")]
    check::sweep(front, back, winners, rounding, frame);
    if VECTORS {
        wide::sweep(front, back, winners, rounding, frame)
    } else {
        narrow::sweep(front, back, winners, rounding, frame)
    }
}

/// Fills the holes of `back`, see [`crate::frame::fill::fill`].
pub(crate) fn fill<F: Format>(
    around: &impl Around,
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    settings: &Settings,
    tally: &mut Tally,
) {
    #[cfg(feature = "check")]
    check::fill(around, back, scratch, settings, tally);
    fill::fill(around, back, scratch, settings, tally);
}

/// Fills only the bullet holes of `back`; other holes stay empty and are not counted.
pub(crate) fn fill_bullets<F: Format>(
    back: &mut Galpixmap<'_, F>,
    scratch: &mut Scratch<'_>,
    reach: u32,
    tally: &mut Tally,
) {
    #[cfg(feature = "check")]
    check::fill_bullets(back, scratch, reach, tally);
    fill::fill_bullets(back, scratch, reach, tally);
}

/// Links the samples of a map, see [`source::links`].
fn link<F: Format>(map: &Galpixmap<'_, F>, edge_threshold: u32, links: &mut [u32]) {
    wide::source::links::link(map, edge_threshold, links);
    #[cfg(feature = "check")]
    check::link(map, edge_threshold, links);
}

/// Steps and shows the samples of a layer, see [`source::draw`].
pub(crate) fn scatter<F: Format>(
    source: &mut Source<'_, F>,
    visibility: &mut Visibility<'_>,
    first: u32,
    edge_threshold: u32,
    step: Option<(Rounding, u32)>,
) -> Tally {
    #[cfg(feature = "check")]
    check::scatter(source, visibility, first, edge_threshold, step);
    wide::source::scatter::scatter(source, visibility, first, edge_threshold, step)
}

/// Closes cracks, see [`source::cracks`].
pub(crate) fn close_cracks<F: Format>(
    sources: &[Source<'_, F>],
    visibility: &mut Visibility<'_>,
    threshold: i32,
) -> Closed {
    #[cfg(feature = "check")]
    check::close_cracks(sources, visibility, threshold);
    wide::source::cracks::close(sources, visibility, threshold)
}

/// Closes cracks in constant time, at most so many of each row; returns also how many are left out.
pub(crate) fn close_cracks_constant_time<F: Format>(
    sources: &[Source<'_, F>],
    visibility: &mut Visibility<'_>,
    threshold: i32,
    most: usize,
) -> (Closed, u32) {
    wide::source::cracks::close_constant_time(sources, visibility, threshold, most)
}

/// Gathers the colours of the cells of a row that show a sample, see [`row::gather_row`].
pub(crate) fn gather_row<F: Format>(
    layers: &[Source<'_, F>],
    visibility: &Visibility<'_>,
    start: u32,
    gather: &GatherRow,
    colours: &mut [u32],
) {
    #[cfg(feature = "check")]
    check::gather_row(layers, visibility, start, gather, colours);
    wide::source::gather::gather_row(layers, visibility, start, gather, colours);
}

/// Finishes a row, see [`Sources::finish`].
pub(crate) fn finish_row<F: Format>(sources: &Sources<'_, '_, F>, finish: &Finish<'_>, colours: &mut [u32]) {
    #[cfg(feature = "check")]
    check::finish_row(sources, finish, colours);
    wide::source::finish::finish(sources, finish, colours);
}

/// Makes the next frame of a map in place, see [`Rolling::step`].
fn rolling_step<F: Format>(rolling: &mut Rolling<'_, F>, settings: &Settings) -> Tally {
    #[cfg(feature = "check")]
    let expected = check::rolling(rolling, settings);
    let tally = rolling::make(rolling, settings);
    #[cfg(feature = "check")]
    expected.compare(rolling.map(), &tally);
    tally
}

/// Declares the trait [`Passes`]: generic functions for [`Static`] formats, and functions for [`Dynamic`] that are
/// compiled once, in this crate.
macro_rules! passes {
    ($(fn $name:ident($($argument:ident: $type:ty),* $(,)?) $(-> $result:ty)? = $pass:expr;)*) => {
        /// The passes over maps of a format. Not part of the public interface.
        #[doc(hidden)]
        pub trait Passes: Sized {
            $(fn $name($($argument: $type),*) $(-> $result)? where Self: Format { $pass($($argument),*) })*
        }

        impl<P: Profile> Passes for Static<P> {}

        impl Passes for Dynamic {
            $(fn $name($($argument: $type),*) $(-> $result)? { $pass($($argument),*) })*
        }
    };
}

passes! {
    fn step(
        front: &Galpixmap<'_, Self>,
        back: &mut Galpixmap<'_, Self>,
        scratch: &mut Scratch<'_>,
        settings: &Settings,
        frame: u32,
    ) -> Tally = frame::make::<Self, false>;
    fn step_constant_time(
        front: &Galpixmap<'_, Self>,
        back: &mut Galpixmap<'_, Self>,
        scratch: &mut Scratch<'_>,
        settings: &Settings,
        frame: u32,
    ) -> Tally = frame::make::<Self, true>;
    fn mark(front: &Galpixmap<'_, Self>, threshold: u32, edges: &mut [u32]) -> u32 = mark::<Self>;
    fn sweep(
        front: &Galpixmap<'_, Self>,
        back: &mut Galpixmap<'_, Self>,
        winners: &mut [u32],
        rounding: Rounding,
        frame: u32,
    ) -> Tally = sweep::<Self>;
    fn fill(
        front: &Galpixmap<'_, Self>,
        back: &mut Galpixmap<'_, Self>,
        scratch: &mut Scratch<'_>,
        settings: &Settings,
        tally: &mut Tally,
    ) = fill;
    fn rolling_step(rolling: &mut Rolling<'_, Self>, settings: &Settings) -> Tally = rolling_step;
    fn layers_step(layers: &mut Layers<'_, '_, Self>, settings: &Settings) -> Tally = layers::make::<Self, false>;
    fn layers_step_constant_time(layers: &mut Layers<'_, '_, Self>, settings: &Settings) -> Tally =
        layers::make::<Self, true>;
    fn layers_composite(layers: &mut Layers<'_, '_, Self>) = layers::composite::<Self, false>;
    fn layers_restore(layers: &mut Layers<'_, '_, Self>) = layers::restore::<Self, false>;
    fn source_links(map: &Galpixmap<'_, Self>, edge_threshold: u32, links: &mut [u32]) = link;
    fn source_step(source: &mut Source<'_, Self>, rounding: Rounding, frame: u32) -> Tally = wide::source::step::step;
    fn sources_draw(
        layers: &mut [Source<'_, Self>],
        visibility: &mut Visibility<'_>,
        edge_threshold: u32,
        step: Option<(Rounding, u32)>,
    ) -> Tally = source::draw;
    fn sources_draw_constant_time(
        layers: &mut [Source<'_, Self>],
        visibility: &mut Visibility<'_>,
        settings: &Settings,
        limits: (u32, &Budget),
    ) -> (Tally, u32) = source::constant_time::draw;
    fn sources_gather(
        sources: &Sources<'_, '_, Self>,
        y: u32,
        gather: Gather,
        colours: &mut [u32],
    ) -> u32 = row::gather;
    fn sources_known(
        sources: &Sources<'_, '_, Self>,
        y: u32,
        known: &mut [u32],
        depths: &mut [u32],
    ) = row::known;
    fn sources_moved(sources: &Sources<'_, '_, Self>, y: u32, moved: &mut [u32]) = row::moved;
    fn sources_finish(
        sources: &Sources<'_, '_, Self>,
        y: u32,
        edge_threshold: u32,
        gathered: [&[u32]; 3],
        colours: &mut [u32],
    ) = row::finish;
    fn push_pull(
        map: &mut Galpixmap<'_, Self>,
        inpainting: &Inpainting<'_>,
        push_pull: &mut PushPull<'_>,
    ) -> u32 = map::push_pull;
    fn metamers(
        map: &mut Galpixmap<'_, Self>,
        inpainting: &Inpainting<'_>,
        metamer: &mut Metamer<'_>,
        age: u32,
    ) -> Result<u32, SetupError> = map::metamers;
    fn lay_background(
        before: &Galpixmap<'_, Self>,
        map: &mut Galpixmap<'_, Self>,
        edges: &[u32],
        rounding: Rounding,
        frame: u32,
    ) -> u32 = quads::lay_background;
    fn disocclusion_map(front: &Galpixmap<'_, Self>, extents: &mut [u32], reach: &Reach) -> disocclusion::Tally =
        disocclusion::make;
    fn disocclusion_mark(front: &Galpixmap<'_, Self>, extents: &mut [u32], reach: &Reach) -> disocclusion::Tally =
        disocclusion::mark_pairs;
    fn disocclusion_cover(
        front: &Galpixmap<'_, Self>,
        line: &mut [u32],
        mask: &mut [u32],
        reach: &Reach,
    ) -> disocclusion::Tally = disocclusion::make_cover;
}
