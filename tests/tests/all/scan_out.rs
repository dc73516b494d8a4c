//! Scan-out through `embedded-graphics`: contiguous rows only, one call a draw, the right colours in the right places.

use embedded_graphics::Pixel;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{Dimensions, OriginDimensions, Point, Size};
use embedded_graphics::image::{Image, ImageDrawable, ImageDrawableExt};
use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::pixelcolor::{self, PixelColor, RgbColor, raw::RawU16};
use embedded_graphics::prelude::{Drawable, GrayColor, IntoStorage};
use embedded_graphics::primitives::{PointsIter, Rectangle};

use galpix_core::overlay::Overlay;
use galpix_core::scan_out::{self, Over, PanelColour, View};
use galpix_core::sub_cell::{self, SubCell};
use galpix_core::{Bits, Colour, Dynamic, Format, Galpixel, Galpixmap, Grid, Layout, Margin};
use galpix_tests::memory::{Shape, with_maps};
use galpix_tests::profiles::{PAPER, SCENE, SLIDE, dynamic};
use galpix_tests::random;

/// A display that takes contiguous areas and nothing else.
struct Panel<C> {
    size: Size,
    pixels: Vec<Option<C>>,
    calls: u32,
}

impl<C: PixelColor> Panel<C> {
    fn new(width: u32, height: u32) -> Self {
        Self { size: Size::new(width, height), pixels: vec![None; (width * height) as usize], calls: 0 }
    }
}

impl<C> OriginDimensions for Panel<C> {
    fn size(&self) -> Size {
        self.size
    }
}

impl<C: PixelColor> DrawTarget for Panel<C> {
    type Color = C;
    type Error = core::convert::Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<C>>>(&mut self, _: I) -> Result<(), Self::Error> {
        panic!("single pixels were drawn");
    }

    fn fill_contiguous<I: IntoIterator<Item = C>>(&mut self, area: &Rectangle, colours: I) -> Result<(), Self::Error> {
        self.calls += 1;
        assert_eq!(area.intersection(&self.bounding_box()), *area, "outside of the display");
        let mut colours = colours.into_iter();
        for point in area.points() {
            let index = (point.y as u32 * self.size.width + point.x as u32) as usize;
            let colour = colours.next().expect("as many colours as the area has pixels");
            assert!(self.pixels[index].replace(colour).is_none(), "{point} was drawn twice");
        }
        assert!(colours.next().is_none(), "more colours than the area has pixels");
        Ok(())
    }

    fn fill_solid(&mut self, _: &Rectangle, _: C) -> Result<(), Self::Error> {
        panic!("a solid area was drawn");
    }
}

const SHAPES: [Shape; 4] = [
    Shape::plain(13, 7),
    Shape::plain(1, 1),
    Shape { width: 12, height: 9, margin: Margin { left: 3, right: 0, top: 2, bottom: 5 } },
    Shape { width: 5, height: 4, margin: Margin::all(6) },
];

/// Returns a colour that identifies its place in the display; what is in the margin is `[255, 0, 255]`.
fn colour(shape: Shape, x: i32, y: i32) -> [u8; 3] {
    let (x, y) = (x - shape.margin.left as i32, y - shape.margin.top as i32);
    if (0..shape.width as i32).contains(&x) && (0..shape.height as i32).contains(&y) {
        [(x * 16) as u8, (y * 24) as u8, ((x + y) * 8) as u8]
    } else {
        [255, 0, 255]
    }
}

fn with_view(format: Dynamic, shape: Shape, work: impl Fn(&Galpixmap<'_, Dynamic>)) {
    with_maps(shape, format, None, |mut map, _| {
        for (x, y) in (0..shape.rows() as i32).flat_map(|y| (0..shape.columns() as i32).map(move |x| (x, y))) {
            map.store(x, y, &Galpixel { colour: colour(shape, x, y), ..Galpixel::default() });
        }
        work(&map);
    });
}

/// Returns the pixel at a place of the display, of a map whose colours have the format `stored`.
fn expected<C: PanelColour>(stored: Colour, shape: Shape, x: u32, y: u32) -> C {
    let (x, y) = ((x + shape.margin.left) as i32, (y + shape.margin.top) as i32);
    let word = stored.from_rgb888(colour(shape, x, y));
    C::of_word(if stored == C::FORMAT { word } else { C::FORMAT.from_rgb888(stored.to_rgb888(word)) })
}

/// The whole, in one call; bands of every height, put together; every sub-image.
fn draws<C: PanelColour + core::fmt::Debug>(layout: Layout, bits: Bits) {
    for shape in SHAPES {
        with_view(dynamic(layout, bits), shape, |map| {
            let whole: Vec<_> = (0..shape.height)
                .flat_map(|y| (0..shape.width).map(move |x| Some(expected::<C>(layout.colour, shape, x, y))))
                .collect();
            let mut panel = Panel::new(shape.width, shape.height);
            let view = View::new(map);
            assert_eq!(view.size(), panel.size, "the margin are left out");
            view.draw(&mut panel).unwrap();
            assert!(panel.calls == 1 && panel.pixels == whole);

            for rows in 1..=shape.height + 1 {
                let mut panel = Panel::new(shape.width, shape.height);
                for top in (0..shape.height).step_by(rows as usize) {
                    let band = View::band(map, top, rows);
                    assert_eq!(band.size(), Size::new(shape.width, rows.min(shape.height - top)));
                    Image::new(&band, Point::new(0, top as i32)).draw(&mut panel).unwrap();
                }
                assert!(panel.calls == shape.height.div_ceil(rows) && panel.pixels == whole, "bands of {rows}");
            }
            for top in [shape.height, shape.height + 1, u32::MAX] {
                assert_eq!(View::<_, C>::band(map, top, 3).size().height, 0, "below the display");
            }
            sub_images::<C>(shape, map);
        });
    }
}

fn sub_images<C: PanelColour + core::fmt::Debug>(shape: Shape, map: &Galpixmap<'_, Dynamic>) {
    let layout = map.record().layout();
    let view = View::new(map);
    for (left, top) in [(0, 0), (1, 0), (0, 1), (3, 2)] {
        for (width, height) in [(1, 1), (4, 2), (2, 3)] {
            if left + width > shape.width || top + height > shape.height {
                continue;
            }
            let area = Rectangle::new(Point::new(left as i32, top as i32), Size::new(width, height));
            let mut panel = Panel::new(width, height);
            view.draw_sub_image(&mut panel, &area).unwrap();
            let part: Vec<_> = (0..height)
                .flat_map(|y| (0..width).map(move |x| Some(expected::<C>(layout.colour, shape, left + x, top + y))))
                .collect();
            assert!(panel.calls == 1 && panel.pixels == part, "{area:?} of {shape:?}");
            // The same through the adapter that users write.
            let mut panel = Panel::new(width, height);
            Image::new(&view.sub_image(&area), Point::zero()).draw(&mut panel).unwrap();
            assert!(panel.pixels == part);
        }
    }
    // An area that sticks out at all sides: the part inside lands where it belongs.
    let area = Rectangle::new(Point::new(-2, -1), view.size() + Size::new(4, 4));
    let mut panel = Panel::new(area.size.width, area.size.height);
    view.draw_sub_image(&mut panel, &area).unwrap();
    for (point, pixel) in panel.bounding_box().points().zip(&panel.pixels) {
        let place = point + area.top_left;
        let inside = view.bounding_box().contains(place);
        let wanted = inside.then(|| expected::<C>(layout.colour, shape, place.x as u32, place.y as u32));
        assert_eq!(*pixel, wanted, "{place} of {shape:?}");
    }
}

#[test]
fn every_colour_format_is_drawn_in_contiguous_areas() {
    draws::<pixelcolor::Rgb888>(Layout::FULL, PAPER);
    draws::<pixelcolor::Rgb888>(Layout::STILL, PAPER);
    draws::<pixelcolor::Rgb888>(Layout::SHADED, SCENE);
    draws::<pixelcolor::Rgb565>(Layout::FLAT565, SCENE);
    draws::<pixelcolor::Rgb565>(Layout::VELOCITY565, SLIDE);
    draws::<pixelcolor::Gray8>(Layout::VELOCITY_GRAY8, SLIDE);
    draws::<pixelcolor::Gray4>(Layout::VELOCITY_GRAY4, SLIDE);
}

#[test]
fn colours_that_the_panel_does_not_have_are_converted() {
    draws::<pixelcolor::Rgb565>(Layout::FULL, PAPER);
    draws::<pixelcolor::Gray4>(Layout::FLAT565, SCENE);
    draws::<pixelcolor::Rgb888>(Layout::VELOCITY565, SLIDE);
    draws::<pixelcolor::Rgb888>(Layout { colour: Colour::must(Colour::rgb(3, 3, 2)), ..Layout::VELOCITY565 }, SLIDE);
}

#[test]
fn colours_of_the_panel_are_colours_of_the_map() {
    assert_eq!(pixelcolor::Rgb888::of_word(0x12_34_56), pixelcolor::Rgb888::new(0x12, 0x34, 0x56));
    let pixel = pixelcolor::Rgb565::of_word(0b10101 << 11 | 0b01_0101 << 5 | 0b11011);
    assert_eq!((pixel.r(), pixel.g(), pixel.b()), (0b10101, 0b01_0101, 0b11011));
    assert_eq!(pixel, pixelcolor::Rgb565::from(RawU16::new(0b10101 << 11 | 0b01_0101 << 5 | 0b11011)));
    for level in 0..=255 {
        let gray = pixelcolor::Gray8::of_word(level);
        assert_eq!(u32::from(gray.luma()), level);
    }
    for level in 0..=15 {
        let gray = pixelcolor::Gray4::of_word(level);
        assert_eq!(u32::from(gray.luma()), level);
    }
}

#[test]
fn a_picture_on_the_mock_display() {
    let rows = ["RGB.", ".WKY"];
    let shape = Shape::plain(4, 2);
    with_maps(shape, dynamic(Layout::FULL, PAPER), None, |mut map, _| {
        for (y, row) in (0..).zip(rows) {
            for (x, letter) in (0..).zip(row.chars()) {
                let colour = match letter {
                    'R' => [255, 0, 0],
                    'G' => [0, 255, 0],
                    'B' => [0, 0, 255],
                    'Y' => [255, 255, 0],
                    'W' => [255; 3],
                    _ => continue,
                };
                map.store(x, y, &Galpixel { colour, ..Galpixel::default() });
            }
        }
        let mut display = MockDisplay::<pixelcolor::Rgb888>::new();
        Image::new(&View::new(&map), Point::zero()).draw(&mut display).unwrap();
        display.assert_pattern(&["RGBK", "KWKY"]);
    });
}

/// The native path gives the words that the panel path turns into pixels.
#[test]
fn rows_are_the_displays_rows() {
    for shape in SHAPES {
        with_view(dynamic(Layout::FULL, PAPER), shape, |map| {
            for y in 0..shape.height {
                let row = scan_out::row(map, y);
                assert_eq!(row.len(), shape.width as usize);
                for (x, word) in (0..).zip(row) {
                    assert_eq!(
                        word,
                        expected::<pixelcolor::Rgb888>(Colour::RGB888, shape, x, y).into_storage(),
                        "{x}, {y} of {shape:?}"
                    );
                }
            }
            for y in [shape.height, shape.height + 1, u32::MAX] {
                assert_eq!(scan_out::row(map, y).len(), 0, "below the display");
            }
        });
    }
}

/// A view that is resampled shows the resampled rows: as a whole, in bands of every height, in parts of its rows. An
/// overlay over them keeps every bit.
#[test]
fn resampled_views_show_the_resampled_rows() {
    let (format, shape) = (dynamic(Layout::FULL, PAPER), Shape::new(37, 6, [2, 1, 1, 3]));
    let sampling = SubCell { edge_threshold: 1 << 28 };
    let content = random::words(7, format.record().words() * shape.cells() as usize);
    with_maps(shape, format, Some(&content), |map, _| {
        let pixel = |word| Some(pixelcolor::Rgb888::of_word(word));
        let whole: Vec<u32> = (0..shape.height).flat_map(|y| sub_cell::row(&map, sampling.edge_threshold, y)).collect();
        assert!(
            whole.iter().copied().ne((0..shape.height).flat_map(|y| scan_out::row(&map, y))),
            "nothing to resample"
        );
        let pixels: Vec<_> = whole.iter().copied().map(pixel).collect();
        for rows in 1..=shape.height {
            let mut panel = Panel::new(shape.width, shape.height);
            for top in (0..shape.height).step_by(rows as usize) {
                let band = View::band(&map, top, rows).sampled(sampling);
                Image::new(&band, Point::new(0, top as i32)).draw(&mut panel).unwrap();
            }
            assert!(panel.pixels == pixels, "bands of {rows}");
        }
        let area = Rectangle::new(Point::new(15, 1), Size::new(19, 4));
        let mut panel = Panel::<pixelcolor::Rgb888>::new(19, 4);
        View::new(&map).sampled(sampling).draw_sub_image(&mut panel, &area).unwrap();
        let part = (1..5).flat_map(|y| (15..34).map(move |x| y * 37 + x)).map(|at| pixels[at]);
        assert!(panel.pixels.iter().copied().eq(part));

        let mut starts = vec![0; 3];
        let grid = Grid::new(5, 3, Margin::NONE, &mut starts).unwrap();
        let mut memory = vec![0; Overlay::words(&grid)];
        let mut overlay = Overlay::new(grid, Colour::RGB888, &mut memory).unwrap().at(34, 2);
        overlay.pin(1, 2, [1, 2, 3]);
        overlay.pin(4, 0, [4, 5, 6]);
        let mut under = whole;
        under[4 * 37 + 35] = 0x01_02_03;
        let rows =
            (0..shape.height).flat_map(|y| (&overlay).over(sub_cell::row(&map, sampling.edge_threshold, y), y, 0));
        assert!(rows.eq(under.iter().copied()));
        let mut panel = Panel::new(shape.width, shape.height);
        View::new(&map).under(&overlay).sampled(sampling).draw(&mut panel).unwrap();
        assert!(panel.pixels.iter().copied().eq(under.into_iter().map(pixel)));
    });
}
