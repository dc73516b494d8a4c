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

use galpix_core::colour::Colour;
use galpix_core::error::SetupError;
use galpix_core::galpixel::{Chosen, Class, Galpixel, Profile};
use galpix_core::galpixmap::Galpixmap;
use galpix_core::grid::{Grid, Wings};
use galpix_core::layout::{Flat565, Full, Layout, Still, VelocityGray4, VelocityGray8};
use galpix_core::overlay::{self, Overlay};
use galpix_core::scan_out::{self, PanelColour, View};
use galpix_tests::lent::{Shape, with_maps, words};
use galpix_tests::profiles::{Paper, Scene, Slide};

/// A map of distinct colours, and an overlay of the given size and place with every third cell pinned.
fn with_both<L: Layout, P: Profile>(
    shape: Shape,
    [width, height, left, top]: [u32; 4],
    wings: Wings,
    work: impl FnOnce(&Galpixmap<'_, L, Chosen<L>>, &mut Overlay<'_, L::Colour>),
) {
    with_maps(shape, Chosen::<L>::new(P::BITS).unwrap(), None, |mut map, _| {
        for (x, y) in (0..shape.rows() as i32).flat_map(|y| (0..shape.columns() as i32).map(move |x| (x, y))) {
            let colour = [(x * 16) as u8, (y * 24) as u8, ((x + y) * 8) as u8];
            // What lies in front of everything does not lie in front of the overlay.
            map.store(x, y, &Galpixel { colour, ..Galpixel::default() });
        }
        let mut starts = vec![0; Grid::rows(height, wings)];
        let grid = Grid::new(width, height, wings, &mut starts).unwrap();
        let mut memory = vec![0x1234_5678; Overlay::<L::Colour>::words(&grid)];
        let mut overlay = Overlay::new(grid, &mut memory).unwrap().at(left, top);
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
fn expected<L: Layout>(map: &Galpixmap<'_, L, Chosen<L>>, [width, height, left, top]: [u32; 4], x: u32, y: u32) -> u32 {
    let wings = map.grid().wings();
    let inside = (left..left + width).contains(&x) && (top..top + height).contains(&y);
    if inside && is_pinned(x - left, y - top) {
        return L::Colour::from_rgb888(colour(x - left, y - top));
    }
    map.colour(map.grid().cell((x + wings.left) as i32, (y + wings.top) as i32).unwrap())
}

const SHAPES: [Shape; 3] = [
    Shape::plain(13, 7),
    Shape::plain(1, 1),
    Shape { width: 12, height: 9, wings: Wings { left: 3, right: 1, top: 2, bottom: 5 } },
];

/// Overlays of the display's size, a bar, one that reaches beyond the display, and one that lies outside.
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

fn shows<L: Layout<Colour: PanelColour>, P: Profile>() {
    for shape in SHAPES {
        for place in places(shape) {
            for wings in [Wings::NONE, Wings { left: 1, right: 2, top: 3, bottom: 1 }] {
                with_both::<L, P>(shape, place, wings, |map, overlay| {
                    for y in 0..shape.height + 2 {
                        let row = overlay::row(map, overlay, y);
                        assert_eq!(row.len(), if y < shape.height { shape.width as usize } else { 0 });
                        for (x, word) in (0..).zip(row) {
                            assert_eq!(word, expected(map, place, x, y), "{x}, {y} of {shape:?} under {place:?}");
                        }
                    }
                });
            }
        }
    }
}

#[test]
fn rows_show_what_is_pinned_and_else_the_map() {
    shows::<Full, Paper>();
    shows::<Still, Paper>();
    shows::<Flat565, Scene>();
    shows::<VelocityGray8, Slide>();
    shows::<VelocityGray4, Slide>();
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
    type Color = C::Pixel;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C::Pixel>>>(&mut self, pixels: I) -> Result<(), Self::Error> {
        for Pixel(point, pixel) in pixels {
            self.words[(point.y as u32 * self.size.width + point.x as u32) as usize] = Some(C::word(pixel));
        }
        Ok(())
    }
}

fn draws<L: Layout<Colour: PanelColour>, P: Profile>() {
    for shape in SHAPES {
        for place in places(shape) {
            with_both::<L, P>(shape, place, Wings::NONE, |map, overlay| {
                let panel = |width, height| Panel::<L::Colour> {
                    size: Size::new(width, height),
                    words: vec![None; (width * height) as usize],
                    colour: core::marker::PhantomData,
                };
                for rows in 1..=shape.height {
                    let mut panel = panel(shape.width, shape.height);
                    for top in (0..shape.height).step_by(rows as usize) {
                        let band = View::band(map, top, rows).under(overlay);
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
                    View::new(map).under(overlay).draw_sub_image(&mut panel, &area).unwrap();
                    for (index, word) in (0..).zip(panel.words) {
                        assert_eq!(word, Some(expected(map, place, 2 + index % 4, 1 + index / 4)));
                    }
                }
            });
        }
    }
}

#[test]
fn views_show_what_is_pinned_and_else_the_map() {
    draws::<Full, Paper>();
    draws::<Flat565, Scene>();
    draws::<VelocityGray8, Slide>();
    draws::<VelocityGray4, Slide>();
}

#[test]
fn what_is_removed_shows_the_map_again() {
    let shape = Shape::plain(6, 4);
    with_both::<Full, Paper>(shape, [6, 4, 0, 0], Wings::all(2), |map, overlay| {
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
    let grid = Grid::new(20, 12, Wings::NONE, &mut starts).unwrap();
    let mut overlay = Overlay::<galpix_core::colour::Rgb565>::new(grid, &mut memory).unwrap();
    let mut reference = MockDisplay::<BinaryColor>::new();
    reference.set_allow_out_of_bounds_drawing(true);
    reference.set_allow_overdraw(true);
    let yellow = pixelcolor::Rgb565::YELLOW;
    let line = Line::new(Point::new(-3, 11), Point::new(30, 2));
    line.into_styled(PrimitiveStyle::with_stroke(yellow, 1)).draw(&mut overlay).unwrap();
    line.into_styled(PrimitiveStyle::with_stroke(BinaryColor::On, 1)).draw(&mut reference).unwrap();
    Text::new("Hi", Point::new(2, 8), MonoTextStyle::new(&FONT_6X10, yellow)).draw(&mut overlay).unwrap();
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

/// Every class and depth loses against what is pinned, and too little memory is said.
#[test]
fn nothing_is_in_front_of_the_overlay() {
    with_maps::<Full, _, _>(Shape::plain(4, 1), Chosen::new(Paper::BITS).unwrap(), None, |mut map, _| {
        for (x, class) in (0..).zip([Class::Galpixel, Class::JustUnobscured, Class::Debris, Class::Empty]) {
            map.store(x, 0, &Galpixel { class, colour: [9; 3], ..Galpixel::default() });
        }
        let mut starts = [0];
        let grid = Grid::new(4, 1, Wings::NONE, &mut starts).unwrap();
        let mut memory = [0; 4];
        let short = Overlay::<galpix_core::colour::Rgb888>::new(grid, &mut memory[..3]);
        assert_eq!(short.err(), Some(SetupError::TooShort { plane: "galpixmap", need: 4, have: 3 }));
        let mut overlay = Overlay::new(grid, &mut memory).unwrap();
        for x in 0..4 {
            overlay.pin(x, 0, [7; 3]);
        }
        assert!(overlay::row(&map, &overlay, 0).eq([0x07_07_07; 4]));
    });
}
