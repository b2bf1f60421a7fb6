//! JSON files of two bodies and their surfaces, with their motion or without: docs/impact.schema.json.

mod field;
mod file;

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use stickslip_model::{Body, Encounter, Motion, Pair, Plane, Sphere, Surface, Wall};

use crate::error::Failure;

/// What a file describes; motions that it does not have are `None`.
pub struct Bodies {
    sphere: (Sphere, Option<Motion>),
    other: Other,
    surface: Surface,
}

/// What the first sphere hits.
enum Other {
    Sphere(Sphere, Option<Motion>),
    Wall(Wall, Option<Plane>),
}

/// The two bodies in the file at `path`, `-` for standard input, as their contact feels them.
///
/// Motions may be in the file; they do not matter here.
///
/// # Errors
/// [`Failure::Input`]: the file cannot be read, is not JSON, or does not describe two bodies. It
/// names the line or the field, and what is accepted there.
pub fn read_pair(path: &Path) -> Result<Pair, Failure> {
    read(path, |Bodies { sphere: (sphere, _), other, surface }| {
        let other = match other {
            Other::Sphere(other, _) => Body::Sphere(other),
            Other::Wall(wall, _) => Body::Wall(wall),
        };
        Pair::new(&sphere, &other, &surface).map_err(|invalid| invalid.to_string())
    })
}

/// The two bodies in the file at `path`, `-` for standard input, about to touch.
///
/// # Errors
/// [`Failure::Input`]: as [`read_pair`], or a motion is missing, or the bodies do not collide.
pub fn read_encounter(path: &Path) -> Result<Encounter, Failure> {
    read(path, |Bodies { sphere: (sphere, motion), other, surface }| {
        let first = (&sphere, &field::required("spheres[0].motion", motion)?);
        let encounter = match &other {
            Other::Sphere(other, motion) => {
                let motion = field::required("spheres[1].motion", *motion)?;
                Encounter::of_spheres(first, (other, &motion), &surface)
            }
            Other::Wall(wall, plane) => {
                let plane = field::required("wall.motion", *plane)?;
                Encounter::with_wall(first, (wall, &plane), &surface)
            }
        };
        encounter.map_err(|error| error.to_string())
    })
}

fn read<T>(path: &Path, make: impl FnOnce(Bodies) -> Result<T, String>) -> Result<T, Failure> {
    let standard = path == Path::new("-");
    let shown = if standard { Path::new("standard input") } else { path };
    let mut text = Vec::new();
    let read = if standard {
        io::stdin().lock().read_to_end(&mut text)
    } else {
        fs::File::open(path).and_then(|mut file| file.read_to_end(&mut text))
    };
    read.map_err(|error| Failure::input(shown, format!("cannot be read: {error}")))?;
    Bodies::parse(&text).and_then(make).map_err(|reason| Failure::input(shown, reason))
}

#[cfg(test)]
mod tests {
    use stickslip_model::Material;

    use super::*;

    fn example(name: &str) -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name)
    }

    #[test]
    fn a_pair_is_the_same_with_and_without_motion() {
        let steel =
            Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3: 7850.0 };
        let surface =
            Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e12, damping_time_s: 0.0 };
        let expected = Pair::equal_spheres(0.02, &steel, &surface).unwrap();
        for name in ["steel_pair.json", "steel_spheres.json"] {
            assert_eq!(read_pair(&example(name)).unwrap(), expected, "{name}");
        }
    }
}
