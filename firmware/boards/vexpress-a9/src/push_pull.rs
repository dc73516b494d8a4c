//! Push-pull after each frame, with the feature `push-pull`; without it the maps stay as they are.

#[cfg(feature = "push-pull")]
mod pyramid {
    use galpix_controller::inpainted::Inpainted;
    use galpix_core::SetupError;
    use galpix_core::inpaint::paint::Moving;
    use galpix_core::inpaint::pyramid::{Cell, Pyramid};
    use galpix_link::panel::Panel;
    use static_cell::ConstStaticCell;

    use crate::Display;

    type Filling = <Display as Panel>::Filling;

    const CELLS: usize = Display::PYRAMID.0;
    const STATES: usize = Display::PYRAMID.1;

    static CELLS_OF_IT: ConstStaticCell<[Cell<Filling>; CELLS]> =
        ConstStaticCell::new([Cell::unknown(Moving::BLACK); CELLS]);
    static STATES_OF_IT: ConstStaticCell<[u32; STATES]> = ConstStaticCell::new([0; STATES]);

    /// Bytes of the pyramid: its cells, and two bits for the state of each.
    pub const BYTES: usize = CELLS * size_of::<Cell<Filling>>() + STATES * 4;

    /// Maps whose frames are inpainted. The second time there is no memory left, and the program ends.
    pub fn inpainted<M>(maps: M) -> Result<Inpainted<'static, M, Filling>, SetupError> {
        let (width, height) = (Display::WIDTH.into(), Display::HEIGHT.into());
        let pyramid = Pyramid::new(width, height, CELLS_OF_IT.take(), STATES_OF_IT.take())?;
        Ok(Inpainted::new(maps, Display::INPAINTING, pyramid))
    }
}

#[cfg(not(feature = "push-pull"))]
mod pyramid {
    use galpix_core::SetupError;

    /// There is none.
    pub const BYTES: usize = 0;

    /// The maps as they are.
    pub const fn inpainted<M>(maps: M) -> Result<M, SetupError> {
        Ok(maps)
    }
}

pub use pyramid::{BYTES, inpainted};
