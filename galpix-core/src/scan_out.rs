//! Stage 6: rows of colour for a display. No arithmetic.
//!
//! [`row`] is the native path, for scanline engines and DMA: colour words of one row, in order. With the feature
//! `embedded-graphics`, a [`View`] of the whole display or of a band of its rows is an `ImageDrawable`, and any
//! `DrawTarget` is a display; it receives contiguous rows, never single pixels. What is pinned over the picture joins here,
//! see [`crate::overlay`].

use crate::galpixel::Budget;
use crate::galpixmap::Galpixmap;
use crate::layout::Layout;

/// The colour words of row `y` of the display (wings left out), from left to right; nothing below the display.
pub fn row<'m, L: Layout, B: Budget<L>>(
    map: &'m Galpixmap<'_, L, B>,
    y: u32,
) -> impl ExactSizeIterator<Item = u32> + 'm {
    span(map, y, 0, map.grid().display_width())
}

/// What lies over a map on the display: [`Bare`], or a reference to an [`crate::overlay::Overlay`].
pub trait Over<L: Layout>: Copy {
    /// The colour words of `width` columns from `x` on of row `y` of the display; fewer where the display ends.
    fn span<B: Budget<L>>(
        self,
        map: &Galpixmap<'_, L, B>,
        y: u32,
        x: u32,
        width: u32,
    ) -> impl ExactSizeIterator<Item = u32>;
}

/// Nothing lies over the map.
#[derive(Clone, Copy, Debug)]
pub struct Bare;

impl<L: Layout> Over<L> for Bare {
    #[inline(always)]
    fn span<B: Budget<L>>(
        self,
        map: &Galpixmap<'_, L, B>,
        y: u32,
        x: u32,
        width: u32,
    ) -> impl ExactSizeIterator<Item = u32> {
        span(map, y, x, width)
    }
}

/// The colour words of `width` columns from `x` on of row `y` of the display; fewer where the display ends.
pub(crate) fn span<'m, L: Layout, B: Budget<L>>(
    map: &'m Galpixmap<'_, L, B>,
    y: u32,
    x: u32,
    width: u32,
) -> impl ExactSizeIterator<Item = u32> + 'm {
    let grid = map.grid();
    let field = map.record().colour();
    let left = x.min(grid.display_width());
    let width = width.min(grid.display_width() - left) as usize;
    let start = if y < grid.display_height() { grid.row((y + grid.wings().top) as i32) } else { None };
    let plane = |word: usize| match (start, map.planes().get(word)) {
        (Some(start), Some(plane)) => {
            plane.get((start + grid.wings().left + left) as usize..).and_then(|rest| rest.get(..width)).unwrap_or(&[])
        }
        _ => &[],
    };
    let ((upper, lower), extract) = (field.words(), field.extract());
    plane(upper).iter().zip(plane(lower)).map(move |(&upper, &lower)| extract.unsigned(upper, lower))
}

#[cfg(feature = "embedded-graphics")]
pub use panel::{PanelColour, View};

#[cfg(feature = "embedded-graphics")]
mod panel {
    use embedded_graphics_core::draw_target::DrawTarget;
    use embedded_graphics_core::geometry::{OriginDimensions, Point, Size};
    use embedded_graphics_core::image::ImageDrawable;
    use embedded_graphics_core::pixelcolor::{
        self, IntoStorage, PixelColor, raw::RawU4, raw::RawU8, raw::RawU16, raw::RawU24,
    };
    use embedded_graphics_core::primitives::Rectangle;

    use crate::colour::{Colour, Gray4, Gray8, Rgb565, Rgb888};
    use crate::galpixel::Budget;
    use crate::galpixmap::Galpixmap;
    use crate::layout::Layout;
    use crate::overlay::Overlay;

    use super::{Bare, Over};

    /// A colour format that a panel understands.
    pub trait PanelColour: Colour {
        /// The panel's pixel.
        type Pixel: PixelColor;
        /// The pixel of a colour word.
        fn pixel(colour: u32) -> Self::Pixel;
        /// The colour word of a pixel.
        fn word(pixel: Self::Pixel) -> u32;
    }

    impl PanelColour for Rgb888 {
        type Pixel = pixelcolor::Rgb888;
        #[inline(always)]
        fn pixel(colour: u32) -> Self::Pixel {
            RawU24::new(colour).into()
        }
        #[inline(always)]
        fn word(pixel: Self::Pixel) -> u32 {
            pixel.into_storage()
        }
    }

    impl PanelColour for Rgb565 {
        type Pixel = pixelcolor::Rgb565;
        #[inline(always)]
        fn pixel(colour: u32) -> Self::Pixel {
            RawU16::new(colour as u16).into()
        }
        #[inline(always)]
        fn word(pixel: Self::Pixel) -> u32 {
            pixel.into_storage().into()
        }
    }

    impl PanelColour for Gray8 {
        type Pixel = pixelcolor::Gray8;
        #[inline(always)]
        fn pixel(colour: u32) -> Self::Pixel {
            RawU8::new(colour as u8).into()
        }
        #[inline(always)]
        fn word(pixel: Self::Pixel) -> u32 {
            pixel.into_storage().into()
        }
    }

    impl PanelColour for Gray4 {
        type Pixel = pixelcolor::Gray4;
        #[inline(always)]
        fn pixel(colour: u32) -> Self::Pixel {
            RawU4::new(colour as u8).into()
        }
        #[inline(always)]
        fn word(pixel: Self::Pixel) -> u32 {
            pixel.into_storage().into()
        }
    }

    /// The display's part of a map, or a band of its rows, and what lies over it.
    #[derive(Debug)]
    pub struct View<'m, 'p, L, B, O = Bare> {
        map: &'m Galpixmap<'p, L, B>,
        over: O,
        top: u32,
        rows: u32,
    }

    impl<'m, 'p, L: Layout, B: Budget<L>> View<'m, 'p, L, B> {
        /// The whole display.
        #[must_use]
        pub fn new(map: &'m Galpixmap<'p, L, B>) -> Self {
            Self { map, over: Bare, top: 0, rows: map.grid().display_height() }
        }

        /// At most `rows` rows of the display from row `top` on; fewer at its end. Draw it at `(0, top)`.
        #[must_use]
        pub fn band(map: &'m Galpixmap<'p, L, B>, top: u32, rows: u32) -> Self {
            let top = top.min(map.grid().display_height());
            Self { map, over: Bare, top, rows: rows.min(map.grid().display_height() - top) }
        }

        /// The same under an overlay.
        #[must_use]
        pub fn under<'o, 'q>(
            self,
            overlay: &'o Overlay<'q, L::Colour>,
        ) -> View<'m, 'p, L, B, &'o Overlay<'q, L::Colour>> {
            View { map: self.map, over: overlay, top: self.top, rows: self.rows }
        }
    }

    impl<L: Layout, B: Budget<L>, O> OriginDimensions for View<'_, '_, L, B, O> {
        fn size(&self) -> Size {
            Size::new(self.map.grid().display_width(), self.rows)
        }
    }

    impl<L: Layout<Colour: PanelColour>, B: Budget<L>, O: Over<L>> ImageDrawable for View<'_, '_, L, B, O> {
        type Color = <L::Colour as PanelColour>::Pixel;

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
            // Drawn from the target's origin on, as the trait asks.
            let place = Rectangle::new(inside.top_left - area.top_left, inside.size);
            let row = |y: u32| self.over.span(self.map, y, left, width).map(L::Colour::pixel);
            if inside.size.height == 1 {
                // A row alone goes out without the bookkeeping of several.
                return target.fill_contiguous(&place, row(first));
            }
            target.fill_contiguous(&place, (first..first + inside.size.height).flat_map(row))
        }
    }
}
