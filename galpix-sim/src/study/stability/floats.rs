//! The same scheme in floating point: `r += v + a/2`, `v += a` each frame, in `f32` and in `f64`.

use super::exact::Px;

/// A galpixel's component in floating point.
#[derive(Clone, Copy, Debug)]
pub struct Float<T> {
    position: T,
    velocity: T,
    acceleration: T,
}

macro_rules! float {
    ($type:ty) => {
        impl Float<$type> {
            /// What an update hands over.
            #[must_use]
            pub fn load([position, velocity, acceleration]: [Px; 3]) -> Self {
                Self {
                    position: position.to_f64() as $type,
                    velocity: velocity.to_f64() as $type,
                    acceleration: acceleration.to_f64() as $type,
                }
            }

            /// One frame later.
            pub fn step(&mut self) {
                self.position += self.velocity + self.acceleration / 2.0;
                self.velocity += self.acceleration;
            }

            /// Returns how far it is from an exact place, in pixels.
            #[must_use]
            pub fn off_px(&self, exact: Px) -> f64 {
                (exact - Px::near(self.position.into())).to_f64()
            }
        }
    };
}

float!(f32);
float!(f64);
