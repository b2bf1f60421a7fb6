//! Pictures: what all of them have in common.
//!
//! A picture is drawn as SVG; a PNG is that SVG rasterised, so that both look the same. Start
//! reading in [`panel`] (axes and what is drawn against them), [`course`] and [`collision`] (a
//! picture); then [`svg`] and [`text`] (how shapes and words are written), [`style`] (colours and
//! sizes), [`bitmap`] and [`label`] (maps), [`raster`] (PNG).

pub mod atlas;
mod bitmap;
pub mod chart;
pub mod collision;
pub mod course;
pub mod gallery;
mod label;
pub mod map;
pub mod panel;
mod raster;
pub mod style;
pub mod svg;
mod text;

use std::io::{self, Write};
use std::path::PathBuf;

use crate::error::Failure;
use crate::output::OutputFile;
pub use svg::Svg;
pub use text::number;

/// The file of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    path: PathBuf,
    format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Svg,
    Png,
}

impl Target {
    /// The picture file `path`, whose name tells its format.
    ///
    /// # Errors
    /// The name does not end in .svg or .png.
    pub fn new(path: PathBuf) -> Result<Self, String> {
        let is =
            |name: &str| path.extension().is_some_and(|given| given.eq_ignore_ascii_case(name));
        let format = match (is("svg"), is("png")) {
            (true, _) => Format::Svg,
            (_, true) => Format::Png,
            _ => {
                return Err("not a picture; expected a name that ends in .svg or .png".to_owned());
            }
        };
        Ok(Self { path, format })
    }

    /// Makes sure that the file can be written, before there is work to lose.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn check(&self) -> Result<(), Failure> {
        OutputFile::create(&self.path).map(drop).map_err(|error| self.failure(error))
    }

    /// Writes `picture` beside the file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn write(&self, picture: &Svg) -> Result<Unpublished<'_>, Failure> {
        let svg = picture.document();
        let file = OutputFile::create(&self.path).and_then(|mut file| {
            match self.format {
                Format::Svg => file.write_all(svg.as_bytes())?,
                Format::Png => file.write_all(&raster::png(&svg)?)?,
            }
            file.store()?;
            Ok(file)
        });
        let file = file.map_err(|error| self.failure(error))?;
        Ok(Unpublished { target: self, file })
    }

    /// The picture cannot be made.
    pub fn failure(&self, error: io::Error) -> Failure {
        Failure::output(&self.path, error)
    }
}

/// A picture that is complete but for its name.
pub struct Unpublished<'a> {
    target: &'a Target,
    file: OutputFile,
}

impl Unpublished<'_> {
    /// Gives the file its name.
    ///
    /// # Errors
    /// It cannot be renamed.
    pub fn publish(self) -> Result<(), Failure> {
        self.file.publish().map_err(|error| self.target.failure(error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_tells_the_format() {
        let format = |name: &str| Target::new(name.into()).map(|target| target.format);
        assert_eq!(format("a/b.svg"), Ok(Format::Svg));
        assert_eq!(format("b.c.PNG"), Ok(Format::Png));
        for name in ["svg", ".png", "a.pdf", "a.svg.", ""] {
            assert!(format(name).is_err(), "{name}");
        }
    }
}
