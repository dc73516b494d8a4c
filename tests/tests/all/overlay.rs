//! The pinned overlay: shown where something is pinned and nowhere else, by the native path and by the panel's.

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::image::{Image, ImageDrawable};
use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::mono_font::{MonoTextStyle, ascii::FONT_6X10};
use embedded_graphics::pixelcolor::{self, BinaryColor, RgbColor};
use embedded_graphics::prelude::Drawable;
use embedded_graphics::primitives::{Line, Primitive, PrimitiveStyle, Rectangle};
use embedded_graphics::text::Text;

use galpix_core::overlay::{self, Overlay};
use galpix_core::scan_out::{self, PanelColour, View};
use galpix_core::{Bits, Class, Colour, Dynamic, Format, Galpixel, Galpixmap, Grid, Layout, Margin, SetupError};
use galpix_tests::memory::{Shape, with_maps, words};
use galpix_tests::profiles::{PAPER, SCENE, SLIDE, dynamic, formats};

/// A map of distinct colours, and an overlay of the given size and place with every third cell pinned.
fn with_both(
    format: Dynamic,
    shape: Shape,
    [width, height, left, top]: [u32; 4],
    margin: Margin,
    work: impl FnOnce(&Galpixmap<'_, Dynamic>, &mut Overlay<'_>),
) {
    with_maps(shape, format, None, |mut map, _| {
        for (x, y) in (0..shape.rows() as i32).flat_map(|y| (0..shape.columns() as i32).map(move |x| (x, y))) {
            let colour = [(x * 16) as u8, (y * 24) as u8, ((x + y) * 8) as u8];
            // What lies in front of everything does not lie in front of the overlay.
            map.store(x, y, &Galpixel { colour, ..Galpixel::default() });
        }
        let mut starts = vec![0; Grid::rows(height, margin)];
        let grid = Grid::new(width, height, margin, &mut starts).unwrap();
        let mut memory = vec![0x1234_5678; Overlay::words(&grid)];
        let mut overlay = Overlay::new(grid, *format.record().colour_format(), &mut memory).unwrap().at(left, top);
        assert_eq!((overlay.width(), overlay.height()), (width, height));
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            assert_eq!(overlay.pinned(x, y), None, "a new overlay is empty");
            if is_pinned(x, y) {
                assert!(overlay.pin(x, y, colour(x, y)));
            }
        }
        work(&map, &mut overlay);
    });
}

fn is_pinned(x: u32, y: u32) -> bool {
    (x + 2 * y).is_multiple_of(3)
}

/// Black at the corner: pinned black is not nothing.
fn colour(x: u32, y: u32) -> [u8; 3] {
    [(x * 40) as u8, (y * 40) as u8, ((x + y) * 20) as u8]
}

/// What the display shows at a place, from the two apart.
fn expected(map: &Galpixmap<'_, Dynamic>, [width, height, left, top]: [u32; 4], x: u32, y: u32) -> u32 {
    let margin = map.grid().margin();
    let inside = (left..left + width).contains(&x) && (top..top + height).contains(&y);
    if inside && is_pinned(x - left, y - top) {
        return map.record().colour_format().from_rgb888(colour(x - left, y - top));
    }
    map.colour(map.grid().cell((x + margin.left) as i32, (y + margin.top) as i32).unwrap())
}

const SHAPES: [Shape; 3] = [
    Shape::plain(13, 7),
    Shape::plain(1, 1),
    Shape { width: 12, height: 9, margin: Margin { left: 3, right: 1, top: 2, bottom: 5 } },
];

/// Margins of an overlay's grid.
const MARGINS: [Margin; 2] = [Margin::NONE, Margin { left: 1, right: 2, top: 3, bottom: 1 }];

/// Returns overlays of the display's size, a bar, one that reaches beyond the display, and one that lies outside.
fn places(shape: Shape) -> [[u32; 4]; 5] {
    let (width, height) = (shape.width, shape.height);
    [
        [width, height, 0, 0],
        [width, 1, 0, height - 1],
        [3, 2, 1, 1],
        [9, 9, width / 2, height / 2],
        [4, 4, width, height],
    ]
}

#[test]
fn rows_show_what_is_pinned_and_else_the_map() {
    for (name, format) in formats() {
        for (shape, margin) in SHAPES.into_iter().flat_map(|shape| MARGINS.map(|margin| (shape, margin))) {
            for place in places(shape) {
                with_both(format, shape, place, margin, |map, overlay| {
                    for y in 0..shape.height + 2 {
                        let row = overlay::row(map, overlay, y);
                        assert_eq!(row.len(), if y < shape.height { shape.width as usize } else { 0 });
                        for (x, word) in (0..).zip(row) {
                            let expected = expected(map, place, x, y);
                            assert_eq!(word, expected, "{name}: {x}, {y} of {shape:?} under {place:?}");
                        }
                    }
                });
            }
        }
    }
}

/// A display that remembers the colour words of contiguous areas.
struct Panel<C> {
    size: Size,
    words: Vec<Option<u32>>,
    colour: core::marker::PhantomData<C>,
}

impl<C> OriginDimensions for Panel<C> {
    fn size(&self) -> Size {
        self.size
    }
}

impl<C: PanelColour> DrawTarget for Panel<C> {
    type Color = C;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(point, pixel) in pixels {
            self.words[(point.y as u32 * self.size.width + point.x as u32) as usize] = Some(pixel.word());
        }
        Ok(())
    }
}

/// Draws maps of a format on a panel of the same colours.
fn draws<C: PanelColour>(layout: Layout, bits: Bits) {
    assert_eq!(C::FORMAT, layout.colour);
    for (shape, place) in SHAPES.into_iter().flat_map(|shape| places(shape).map(|place| (shape, place))) {
        with_both(dynamic(layout, bits), shape, place, Margin::NONE, |map, overlay| {
            let panel = |width, height| Panel::<C> {
                size: Size::new(width, height),
                words: vec![None; (width * height) as usize],
                colour: core::marker::PhantomData,
            };
            for rows in 1..=shape.height {
                let mut panel = panel(shape.width, shape.height);
                for top in (0..shape.height).step_by(rows as usize) {
                    let band = View::band(map, top, rows).under(&*overlay);
                    Image::new(&band, Point::new(0, top as i32)).draw(&mut panel).unwrap();
                }
                let whole: Vec<_> = (0..shape.height)
                    .flat_map(|y| (0..shape.width).map(move |x| (x, y)))
                    .map(|(x, y)| Some(expected(map, place, x, y)))
                    .collect();
                assert_eq!(panel.words, whole, "bands of {rows} of {shape:?} under {place:?}");
            }
            if shape.width > 5 {
                let area = Rectangle::new(Point::new(2, 1), Size::new(4, 3));
                let mut panel = panel(4, 3);
                View::new(map).under(&*overlay).draw_sub_image(&mut panel, &area).unwrap();
                for (index, word) in (0..).zip(panel.words) {
                    assert_eq!(word, Some(expected(map, place, 2 + index % 4, 1 + index / 4)));
                }
            }
        });
    }
}

#[test]
fn views_show_what_is_pinned_and_else_the_map() {
    draws::<pixelcolor::Rgb888>(Layout::FULL, PAPER);
    draws::<pixelcolor::Rgb565>(Layout::FLAT565, SCENE);
    draws::<pixelcolor::Gray8>(Layout::VELOCITY_GRAY8, SLIDE);
    draws::<pixelcolor::Gray4>(Layout::VELOCITY_GRAY4, SLIDE);
}

#[test]
fn what_is_removed_shows_the_map_again() {
    let shape = Shape::plain(6, 4);
    with_both(dynamic(Layout::FULL, PAPER), shape, [6, 4, 0, 0], Margin::all(2), |map, overlay| {
        let before = words(map);
        assert_eq!(overlay.pinned(0, 0), Some(0), "pinned black");
        assert!(overlay.unpin(0, 0));
        assert_eq!(overlay.pinned(0, 0), None);
        assert_eq!(overlay::row(map, overlay, 0).next(), Some(map.colour(0)));
        for (x, y) in [(6, 0), (0, 4), (u32::MAX, 0), (0, u32::MAX)] {
            assert!(!overlay.pin(x, y, [255; 3]) && !overlay.unpin(x, y) && overlay.pinned(x, y).is_none());
        }
        overlay.clear();
        for y in 0..4 {
            assert!(overlay::row(map, overlay, y).eq(scan_out::row(map, y)));
        }
        assert_eq!(words(map), before, "the map is not touched");
    });
}

/// An overlay is drawn into like any display, and what is drawn beyond it is cut.
#[test]
fn text_and_lines_are_pinned() {
    let mut starts = [0; 12];
    let mut memory = [0; 20 * 12];
    let grid = Grid::new(20, 12, Margin::NONE, &mut starts).unwrap();
    let mut overlay = Overlay::new(grid, Colour::RGB565, &mut memory).unwrap();
    let mut reference = MockDisplay::<BinaryColor>::new();
    reference.set_allow_out_of_bounds_drawing(true);
    reference.set_allow_overdraw(true);
    let yellow = pixelcolor::Rgb565::YELLOW;
    let line = Line::new(Point::new(-3, 11), Point::new(30, 2));
    line.into_styled(PrimitiveStyle::with_stroke(yellow, 1)).draw(&mut overlay.canvas::<pixelcolor::Rgb565>()).unwrap();
    line.into_styled(PrimitiveStyle::with_stroke(BinaryColor::On, 1)).draw(&mut reference).unwrap();
    Text::new("Hi", Point::new(2, 8), MonoTextStyle::new(&FONT_6X10, yellow))
        .draw(&mut overlay.canvas::<pixelcolor::Rgb565>())
        .unwrap();
    Text::new("Hi", Point::new(2, 8), MonoTextStyle::new(&FONT_6X10, BinaryColor::On)).draw(&mut reference).unwrap();
    let mut pinned = 0;
    for (x, y) in (0..12).flat_map(|y| (0..20).map(move |x| (x, y))) {
        let drawn = reference.get_pixel(Point::new(x, y)) == Some(BinaryColor::On);
        let wanted = drawn.then_some(0xffe0);
        assert_eq!(overlay.pinned(x as u32, y as u32), wanted, "{x}, {y}");
        pinned += u32::from(drawn);
    }
    assert!(pinned > 30, "{pinned} cells");
}

/// Every class and depth loses against what is pinned, and too little memory is refused.
#[test]
fn nothing_is_in_front_of_the_overlay() {
    with_maps(Shape::plain(4, 1), dynamic(Layout::FULL, PAPER), None, |mut map, _| {
        for (x, class) in (0..).zip([Class::Galpixel, Class::JustUnobscured, Class::Debris, Class::Empty]) {
            map.store(x, 0, &Galpixel { class, colour: [9; 3], ..Galpixel::default() });
        }
        let mut starts = [0];
        let grid = Grid::new(4, 1, Margin::NONE, &mut starts).unwrap();
        let mut memory = [0; 4];
        let short = Overlay::new(grid, Colour::RGB888, &mut memory[..3]);
        assert_eq!(short.err(), Some(SetupError::TooShort { plane: "overlay", need: 4, have: 3 }));
        let mut overlay = Overlay::new(grid, Colour::RGB888, &mut memory).unwrap();
        for x in 0..4 {
            overlay.pin(x, 0, [7; 3]);
        }
        assert!(overlay::row(&map, &overlay, 0).eq([0x07_07_07; 4]));
    });
}
