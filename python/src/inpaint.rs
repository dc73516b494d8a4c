//! Inpainting of a plain image.

use galpix_core::inpaint::{Inpainting, Metamer, MetamerWorkspace, Motion, Picture, PushPull, Recipe};
use galpix_core::{Colour, SetupError};
use galpix_sim::engine::fill::{Fill, Kind};
use numpy::{PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::arrays::{Floats, optional, slice, zeros};
use crate::names::{self, value_error};

/// How an image is inpainted: attributes of an object of the package.
#[derive(FromPyObject)]
pub struct Way {
    method: String,
    gamma: Option<String>,
    levels: u32,
    seed: u32,
    coloured: bool,
    bgr: bool,
}

/// An image, and where it has holes.
#[derive(FromPyObject)]
pub struct Holed<'py> {
    /// Bytes; the result is written here too.
    image: PyReadwriteArrayDyn<'py, u8>,
    /// A byte for each pixel: not 0 for a hole.
    mask: PyReadonlyArrayDyn<'py, u8>,
    /// 0 the nearest, 1 the farthest.
    depth: Option<Floats<'py>>,
}

/// Fills the holes of an image of one or three channels in place; returns how many were filled.
#[pyfunction]
pub fn inpaint(py: Python<'_>, holed: Holed<'_>, way: Way) -> PyResult<u32> {
    let Holed { mut image, mask, depth } = holed;
    let shape = image.shape().to_vec();
    let (height, width) = (shape[0], shape[1]);
    let channels = shape.get(2).copied().unwrap_or(1);
    let cells = height * width;
    let depth = optional(depth.as_ref(), cells)?;
    let mask = slice(&mask, cells)?;
    let bytes = image.as_slice_mut()?;
    let size = [width, height].map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let Fill::Inpaint(inpaint) = names::fill(&way.method, way.gamma.as_deref())? else {
        return Err(value_error(format!("`method` is '{}': give push-pull or metamer", way.method)));
    };
    let recipe = Recipe { levels: way.levels, seed: way.seed, coloured: way.coloured, ..Recipe::default() };
    let filled = py.detach(|| {
        let depths = depth.map(|depth| (0..cells).map(|cell| depth_word(depth.at(cell))).collect::<Vec<u32>>());
        let inpainting = match &depths {
            Some(_) => Inpainting::for_depth(Inpainting::DEPTH_BITS, inpaint.gamma),
            None => Inpainting { gamma: inpaint.gamma, ..Inpainting::classic() },
        };
        let order = Order::of(channels, inpaint.kind, way.bgr);
        let mut colours = order.words(bytes);
        let known = zeros(mask);
        let mut picture = Picture::new(size[0], size[1], order.colour(), &mut colours, &known)?;
        if let Some(depths) = &depths {
            picture = picture.with_depths(depths)?;
        }
        let filled = fill(inpaint.kind, &recipe, size, (&mut picture, &inpainting))?;
        order.put(bytes, &colours, &known);
        Ok(filled)
    });
    filled.map_err(|error: SetupError| value_error(error))
}

/// Returns a depth in the bits that inpainting keeps.
fn depth_word(depth: f64) -> u32 {
    let top = f64::from((1_u32 << Inpainting::DEPTH_BITS) - 1);
    // `as` saturates; what is not a number is nearest, and a hole has a depth or is told apart by none.
    (depth * top).round().min(top) as u32
}

fn fill(
    kind: Kind,
    recipe: &Recipe,
    [width, height]: [u32; 2],
    (picture, inpainting): (&mut Picture<'_>, &Inpainting<'_>),
) -> Result<u32, SetupError> {
    match kind {
        Kind::PushPull => {
            let mut memory = vec![0; PushPull::words(width, height, Motion::Kept)];
            Ok(PushPull::new(width, height, Motion::Kept, &mut memory)?.fill_picture(picture, inpainting))
        }
        Kind::Metamer => {
            let mut memory = vec![0; Metamer::words(width, height, recipe.levels)];
            let mut workspace = Box::new(MetamerWorkspace::new());
            Metamer::new(width, height, *recipe, &mut memory, &mut workspace)?.fill_picture(picture, inpainting, &[])
        }
    }
}

/// The order of the channels of a pixel.
#[derive(Clone, Copy)]
enum Order {
    /// One channel.
    Gray,
    /// The first channel is the highest of the colour word.
    HighFirst,
    /// The first channel is the lowest of the colour word.
    LowFirst,
}

impl Order {
    /// Returns the order for an image. Push-pull treats channels alike, so that the one that is packed faster serves.
    const fn of(channels: usize, kind: Kind, bgr: bool) -> Self {
        match (channels, kind) {
            (1, _) => Self::Gray,
            (_, Kind::Metamer) if !bgr => Self::HighFirst,
            _ => Self::LowFirst,
        }
    }

    const fn colour(self) -> Colour {
        match self {
            Self::Gray => Colour::GRAY8,
            Self::HighFirst | Self::LowFirst => Colour::RGB888,
        }
    }

    /// Returns a colour word for each pixel.
    fn words(self, bytes: &[u8]) -> Vec<u32> {
        match self {
            Self::Gray => bytes.iter().map(|&byte| u32::from(byte)).collect(),
            Self::HighFirst => bytes.as_chunks().0.iter().map(|&[r, g, b]| u32::from_be_bytes([0, r, g, b])).collect(),
            Self::LowFirst => low_first(bytes),
        }
    }

    /// Puts the colours of the cells that are not known into an image.
    fn put(self, bytes: &mut [u8], colours: &[u32], known: &[u32]) {
        for (word, &known) in known.iter().enumerate() {
            let mut holes = !known;
            while holes != 0 {
                let cell = 32 * word + holes.trailing_zeros() as usize;
                holes &= holes - 1;
                // The last word has bits beyond the last cell.
                let Some(&colour) = colours.get(cell) else { break };
                match self {
                    Self::Gray => bytes[cell] = colour as u8,
                    Self::HighFirst => bytes[3 * cell..][..3].copy_from_slice(&colour.to_be_bytes()[1..]),
                    Self::LowFirst => bytes[3 * cell..][..3].copy_from_slice(&colour.to_le_bytes()[..3]),
                }
            }
        }
    }
}

/// Returns a word for each pixel of three bytes, the first of them the lowest: four pixels are made of three words.
fn low_first(bytes: &[u8]) -> Vec<u32> {
    let (fours, rest) = bytes.as_chunks::<12>();
    let mut words = Vec::with_capacity(bytes.len() / 3);
    words.extend(fours.iter().flat_map(|&[a, b, c, d, e, f, g, h, i, j, k, l]| {
        let [low, middle, high] = [[a, b, c, d], [e, f, g, h], [i, j, k, l]].map(u32::from_le_bytes);
        [low & 0xff_ffff, low >> 24 | (middle & 0xffff) << 8, middle >> 16 | (high & 0xff) << 16, high >> 8]
    }));
    words.extend(rest.as_chunks().0.iter().map(|&[a, b, c]| u32::from_le_bytes([a, b, c, 0])));
    words
}
