//! Stage 6: rows of colour for a display.
//!
//! [`row`] returns the colour words of a row in order, for scanline engines and DMA. With the feature
//! `embedded-graphics`, the type `View` of the whole display or of a band of its rows is an `ImageDrawable`, and any
//! `DrawTarget` is a display; it receives contiguous rows, never single pixels. Overlays are applied here, see
//! [`crate::output::overlay`]. [`crate::output::sub_cell`] resamples the rows by where in its cell each galpixel is.

use crate::format::Format;
use crate::map::Galpixmap;

/// Returns the colour words of row `y` of the display, without the margin, from left to right; none below the display.
pub fn row<'m, F: Format>(map: &'m Galpixmap<'_, F>, y: u32) -> impl ExactSizeIterator<Item = u32> + 'm {
    span(map, y, 0, map.grid().display_width())
}

/// How cells become the colours of a display: [`Nearest`] or [`SubCell`](crate::sub_cell::SubCell).
pub trait Sampling: Copy {
    /// Returns the colour words of `width` columns from `x` on of row `y` of the display; fewer at the end of the
    /// display.
    fn span<F: Format>(self, map: &Galpixmap<'_, F>, y: u32, x: u32, width: u32) -> impl ExactSizeIterator<Item = u32>;
}

/// A cell shows the colour that it holds, wherever in the cell its galpixel is.
#[derive(Clone, Copy, Debug)]
pub struct Nearest;

impl Sampling for Nearest {
    #[inline(always)]
    fn span<F: Format>(self, map: &Galpixmap<'_, F>, y: u32, x: u32, width: u32) -> impl ExactSizeIterator<Item = u32> {
        span(map, y, x, width)
    }
}

/// What is shown over a map: [`Bare`] for nothing, or a reference to an [`Overlay`](crate::overlay::Overlay).
pub trait Over: Copy {
    /// Returns the colour words that are shown over `colours`, which are those of row `y` of the display from column
    /// `x` on.
    fn over(self, colours: impl ExactSizeIterator<Item = u32>, y: u32, x: u32) -> impl ExactSizeIterator<Item = u32>;
}

/// Nothing is shown over the map.
#[derive(Clone, Copy, Debug)]
pub struct Bare;

impl Over for Bare {
    #[inline(always)]
    fn over(self, colours: impl ExactSizeIterator<Item = u32>, _y: u32, _x: u32) -> impl ExactSizeIterator<Item = u32> {
        colours
    }
}

/// Returns the colour words of `width` columns from `x` on of row `y` of the display; fewer at the end of the display.
fn span<'m, F: Format>(
    map: &'m Galpixmap<'_, F>,
    y: u32,
    x: u32,
    width: u32,
) -> impl ExactSizeIterator<Item = u32> + 'm {
    let grid = map.grid();
    let field = map.record().colour();
    let left = x.min(grid.display_width());
    let width = width.min(grid.display_width() - left) as usize;
    let start = if y < grid.display_height() { grid.row((y + grid.margin().top) as i32) } else { None };
    let plane = |word: usize| match (start, map.planes().get(word)) {
        (Some(start), Some(plane)) => plane
            .get((start + grid.margin().left + left) as usize..)
            .and_then(|words| words.get(..width))
            .unwrap_or(&[]),
        _ => &[],
    };
    let ((upper, lower), extract) = (field.words(), field.extract());
    plane(upper).iter().zip(plane(lower)).map(move |(&upper, &lower)| extract.unsigned(upper, lower))
}

#[cfg(feature = "embedded-graphics")]
pub use panel::{PanelColour, View};

#[cfg(feature = "embedded-graphics")]
mod panel {
    use core::marker::PhantomData;

    use embedded_graphics_core::draw_target::DrawTarget;
    use embedded_graphics_core::geometry::{OriginDimensions, Point, Size};
    use embedded_graphics_core::image::ImageDrawable;
    use embedded_graphics_core::pixelcolor::{
        self, IntoStorage, PixelColor, raw::RawU4, raw::RawU8, raw::RawU16, raw::RawU24,
    };
    use embedded_graphics_core::primitives::Rectangle;

    use crate::format::Format;
    use crate::format::colour::Colour;
    use crate::map::Galpixmap;

    use super::{Bare, Nearest, Over, Sampling};

    /// A pixel type of `embedded-graphics` that corresponds to a colour format.
    pub trait PanelColour: PixelColor {
        /// The colour format.
        const FORMAT: Colour;

        /// Returns the pixel of a colour word of [`Self::FORMAT`].
        fn of_word(word: u32) -> Self;

        /// Returns the colour word of [`Self::FORMAT`].
        fn word(self) -> u32;

        /// Converts a colour word of any format; by 8-bit red, green and blue if it is not [`Self::FORMAT`].
        #[inline(always)]
        fn of(format: &Colour, word: u32) -> Self {
            let same = *format == Self::FORMAT;
            Self::of_word(if same { word } else { Self::FORMAT.from_rgb888(format.to_rgb888(word)) })
        }

        /// Converts to a colour word of any format; by 8-bit red, green and blue if it is not [`Self::FORMAT`].
        #[inline(always)]
        fn word_in(self, format: &Colour) -> u32 {
            let same = *format == Self::FORMAT;
            if same { self.word() } else { format.from_rgb888(Self::FORMAT.to_rgb888(self.word())) }
        }
    }

    macro_rules! panel_colours {
        ($($pixel:ident: $format:ident, $raw:ident, $word:ty;)*) => {$(
            impl PanelColour for pixelcolor::$pixel {
                const FORMAT: Colour = Colour::$format;

                #[inline(always)]
                fn of_word(word: u32) -> Self {
                    $raw::new(word as $word).into()
                }

                #[inline(always)]
                fn word(self) -> u32 {
                    self.into_storage().into()
                }
            }
        )*};
    }

    panel_colours! {
        Rgb888: RGB888, RawU24, u32;
        Rgb565: RGB565, RawU16, u16;
        Gray8: GRAY8, RawU8, u8;
        Gray4: GRAY4, RawU4, u8;
    }

    /// The part of a map that a display shows, or a band of its rows, and what is shown over it.
    ///
    /// `C` is the pixel type of the panel. Maps of another colour format are converted by 8-bit red, green and blue.
    #[derive(Debug)]
    pub struct View<'m, 'p, F, C, O = Bare, S = Nearest> {
        map: &'m Galpixmap<'p, F>,
        over: O,
        sampling: S,
        pixel: PhantomData<C>,
        top: u32,
        rows: u32,
    }

    impl<'m, 'p, F: Format, C: PanelColour> View<'m, 'p, F, C> {
        /// Makes a view of the whole display.
        #[must_use]
        pub fn new(map: &'m Galpixmap<'p, F>) -> Self {
            Self { map, over: Bare, sampling: Nearest, pixel: PhantomData, top: 0, rows: map.grid().display_height() }
        }

        /// Makes a view of at most `rows` rows of the display from row `top` on; fewer at its end. Draw it at `(0,
        /// top)`.
        #[must_use]
        pub fn band(map: &'m Galpixmap<'p, F>, top: u32, rows: u32) -> Self {
            let top = top.min(map.grid().display_height());
            let rows = rows.min(map.grid().display_height() - top);
            Self { map, over: Bare, sampling: Nearest, pixel: PhantomData, top, rows }
        }
    }

    impl<'m, 'p, F, C, O, S> View<'m, 'p, F, C, O, S> {
        /// Returns the view under an overlay.
        #[must_use]
        pub fn under<P: Over>(self, over: P) -> View<'m, 'p, F, C, P, S> {
            let Self { map, sampling, pixel, top, rows, .. } = self;
            View { map, over, sampling, pixel, top, rows }
        }

        /// Returns the view with colours that are sampled in another way.
        #[must_use]
        pub fn sampled<T: Sampling>(self, sampling: T) -> View<'m, 'p, F, C, O, T> {
            let Self { map, over, pixel, top, rows, .. } = self;
            View { map, over, sampling, pixel, top, rows }
        }
    }

    impl<F: Format, C, O, S> OriginDimensions for View<'_, '_, F, C, O, S> {
        fn size(&self) -> Size {
            Size::new(self.map.grid().display_width(), self.rows)
        }
    }

    impl<F: Format, C: PanelColour, O: Over, S: Sampling> ImageDrawable for View<'_, '_, F, C, O, S> {
        type Color = C;

        fn draw<D: DrawTarget<Color = Self::Color>>(&self, target: &mut D) -> Result<(), D::Error> {
            self.draw_sub_image(target, &Rectangle::new(Point::zero(), self.size()))
        }

        fn draw_sub_image<D: DrawTarget<Color = Self::Color>>(
            &self,
            target: &mut D,
            area: &Rectangle,
        ) -> Result<(), D::Error> {
            let inside = area.intersection(&Rectangle::new(Point::zero(), self.size()));
            let (left, width) = (inside.top_left.x.max(0) as u32, inside.size.width);
            let first = self.top + inside.top_left.y.max(0) as u32;
            // The trait requires the area to be drawn at the target's origin.
            let place = Rectangle::new(inside.top_left - area.top_left, inside.size);
            let format = *self.map.record().colour_format();
            let row = |y: u32| {
                let colours = self.sampling.span(self.map, y, left, width);
                self.over.over(colours, y, left).map(move |word| C::of(&format, word))
            };
            if inside.size.height == 1 {
                // A single row needs no iterator over rows.
                return target.fill_contiguous(&place, row(first));
            }
            target.fill_contiguous(&place, (first..first + inside.size.height).flat_map(row))
        }
    }
}
