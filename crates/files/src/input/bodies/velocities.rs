//! Velocities of the surfaces at the contact, which may stand for the motions of the bodies.

use stickslip_model::spheres::quantity::{self, PhysicalQuantity};

/// The velocities of the surfaces, in either of two forms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Velocities<T> {
    /// The normal and the tangential velocity in m/s.
    Components(T, T),
    /// The velocity in m/s, and its angle with the normal in rad.
    Polar(T, T),
}

/// The quantities of [`Velocities`], in the order of [`Velocities::new`].
pub const QUANTITIES: [&PhysicalQuantity; 4] = [
    &quantity::NORMAL_VELOCITY,
    &quantity::TANGENTIAL_VELOCITY,
    &quantity::SPEED,
    &quantity::ANGLE,
];

/// The reason why the quantities that are given are no velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VelocitiesError {
    /// Both forms are given.
    Both,
    /// One quantity of a form is given without the other one.
    Half {
        /// The index in `QUANTITIES` of what is given.
        given: usize,
        /// The index of what is missing.
        missing: usize,
    },
}

impl<T> Velocities<T> {
    /// The form that is given: normal and tangential velocity, or velocity and angle; `None` if
    /// nothing is given.
    ///
    /// # Errors
    /// [`VelocitiesError`]: both forms are given, or half of one.
    pub fn new(given: [Option<T>; 4]) -> Result<Option<Self>, VelocitiesError> {
        match given {
            [None, None, None, None] => Ok(None),
            [Some(normal), Some(tangential), None, None] => {
                Ok(Some(Self::Components(normal, tangential)))
            }
            [None, None, Some(speed), Some(angle)] => Ok(Some(Self::Polar(speed, angle))),
            [Some(_), None, None, None] => Err(VelocitiesError::Half { given: 0, missing: 1 }),
            [None, Some(_), None, None] => Err(VelocitiesError::Half { given: 1, missing: 0 }),
            [None, None, Some(_), None] => Err(VelocitiesError::Half { given: 2, missing: 3 }),
            [None, None, None, Some(_)] => Err(VelocitiesError::Half { given: 3, missing: 2 }),
            _ => Err(VelocitiesError::Both),
        }
    }

    /// The velocities with each value replaced, in the order of [`Self::new`].
    ///
    /// # Errors
    /// That of the first value that cannot be replaced.
    pub fn try_map<U, E>(self, mut map: impl FnMut(T) -> Result<U, E>) -> Result<Velocities<U>, E> {
        Ok(match self {
            Self::Components(normal, tangential) => {
                Velocities::Components(map(normal)?, map(tangential)?)
            }
            Self::Polar(speed, angle) => Velocities::Polar(map(speed)?, map(angle)?),
        })
    }
}

impl Velocities<f64> {
    /// The normal and the tangential velocity in m/s.
    pub fn components(self) -> (f64, f64) {
        match self {
            Self::Components(normal, tangential) => (normal, tangential),
            Self::Polar(speed, angle) => (speed * angle.cos(), speed * angle.sin()),
        }
    }
}
