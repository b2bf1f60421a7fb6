//! JSON files of two bodies and their surfaces, with or without their motions. The layout is that
//! of docs/impact.schema.json.
//!
//! Files are read into options first. A missing field is then an error of this crate, with its
//! path, unit and range; serde only sees the layout. A test feeds the schema with every file that
//! is refused here.
//!
//! Start reading here; then, in this order: `file` (what the fields mean), `field` (numbers and
//! vectors in them), `velocities` (instead of motions) and `impacts` (rows that change the file).

mod field;
mod file;
mod impacts;
mod velocities;

use std::path::Path;

use stickslip_model::Law;
use stickslip_model::spheres::{Body, BodyPair, Encounter, Sphere};

use super::source;
use crate::error::FileError;
use file::{Bodies, File, Other};
pub use impacts::ImpactReading;
pub use velocities::{Velocities, VelocitiesError};

/// The two bodies in the file at `path`, reduced to what their contact feels under a law; `-` is
/// standard input.
///
/// Motions may be in the file, but they are not used.
///
/// # Errors
/// [`FileError::Input`]: the file cannot be read, is not JSON, or does not describe two bodies. The
/// message names the line or the field, and what is expected there.
pub fn read_pair(path: &Path, law: Law) -> Result<BodyPair, FileError> {
    read_sphere_and_pair(path, law).map(|(_, pair)| pair)
}

/// As [`read_pair`], with the first sphere.
///
/// # Errors
/// As [`read_pair`].
pub fn read_sphere_and_pair(path: &Path, law: Law) -> Result<(Sphere, BodyPair), FileError> {
    read(path, |file| {
        let Bodies { sphere: (sphere, _), other, forces } = file.resolve(law)?;
        let pair = BodyPair::new(&sphere, &other.body(), forces);
        pair.map(|pair| (sphere, pair)).map_err(|invalid| invalid.to_string())
    })
}

/// The two bodies in the file at `path` at the moment when they touch, and their contact law; `-`
/// is standard input. Their motions are those of the file, or those of velocities of the surfaces.
///
/// # Errors
/// [`FileError::Input`]: as [`read_pair`], or a motion is missing, or the bodies do not collide.
pub fn read_encounter(
    path: &Path,
    law: Law,
    velocities: Option<Velocities<f64>>,
) -> Result<Encounter, FileError> {
    read(path, |file| file.resolve(law)?.encounter(velocities))
}

impl Bodies {
    /// The bodies at the moment when they touch, with the motions of the file, or with velocities
    /// of the surfaces.
    ///
    /// # Errors
    /// A motion is missing, or the bodies do not collide.
    fn encounter(&self, velocities: Option<Velocities<f64>>) -> Result<Encounter, String> {
        let Self { sphere: (sphere, motion), other, forces } = self;
        if let Some(velocities) = velocities {
            let components = velocities.components();
            return Encounter::of_velocities(sphere, &other.body(), components, *forces)
                .map_err(|error| error.to_string());
        }
        let first = (sphere, &field::required("spheres[0].motion", *motion)?);
        let encounter = match other {
            Other::Sphere(other, motion) => {
                let motion = field::required("spheres[1].motion", *motion)?;
                Encounter::of_spheres(first, (other, &motion), *forces)
            }
            Other::Wall(wall, motion) => {
                let motion = field::required("wall.motion", *motion)?;
                Encounter::with_wall(first, (wall, &motion), *forces)
            }
        };
        encounter.map_err(|error| error.to_string())
    }
}

impl Other {
    fn body(&self) -> Body {
        match *self {
            Self::Sphere(sphere, _) => Body::Sphere(sphere),
            Self::Wall(wall, _) => Body::Wall(wall),
        }
    }
}

/// Largest number of bytes of a file.
const MOST_BYTES: u64 = 1 << 20;

fn read<T>(path: &Path, make: impl FnOnce(File) -> Result<T, String>) -> Result<T, FileError> {
    let text = source::read(path, MOST_BYTES)?;
    File::parse(&text)
        .and_then(make)
        .map_err(|reason| FileError::input(source::shown(path), reason))
}
