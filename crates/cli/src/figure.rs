//! Pictures: what all of them have in common.
//!
//! A picture is drawn as SVG; a PNG is that SVG rasterised, so that both look the same. Start reading in
//! [`panel`] (axes and what is drawn against them) and [`collision`] (a picture); then [`svg`] and [`text`] (how shapes and
//! words are written), [`style`] (colours and sizes), [`bitmap`] and [`label`] (maps), [`raster`] (PNG).

mod bitmap;
pub mod collision;
mod label;
pub mod map;
mod panel;
mod raster;
mod style;
mod svg;
mod text;

use std::io::Write;
use std::path::PathBuf;

use crate::error::Failure;
use crate::output::OutputFile;
use svg::Svg;

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
    /// The name ends otherwise than accepted.
    pub fn new(path: PathBuf) -> Result<Self, String> {
        let is =
            |name: &str| path.extension().is_some_and(|given| given.eq_ignore_ascii_case(name));
        let format = match (is("svg"), is("png")) {
            (true, _) => Format::Svg,
            (_, true) => Format::Png,
            _ => {
                return Err(
                    "not a picture; accepted is a name that ends in .svg or .png".to_owned()
                );
            }
        };
        Ok(Self { path, format })
    }

    /// Starts to write the picture, so that a file that cannot be written is found before there is work to lose.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(&self) -> Result<Unpublished<'_>, Failure> {
        let file =
            OutputFile::create(&self.path).map_err(|error| Failure::output(&self.path, error))?;
        Ok(Unpublished { target: self, file })
    }
}

/// A picture file on its way.
pub struct Unpublished<'a> {
    target: &'a Target,
    file: OutputFile,
}

impl Unpublished<'_> {
    /// Writes `picture` and gives the file its name.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn publish(mut self, picture: &Svg) -> Result<(), Failure> {
        let svg = picture.document();
        let written = match self.target.format {
            Format::Svg => self.file.write_all(svg.as_bytes()),
            Format::Png => raster::png(&svg).and_then(|png| self.file.write_all(&png)),
        };
        written
            .and_then(|()| self.file.store())
            .and_then(|()| self.file.publish())
            .map_err(|error| Failure::output(&self.target.path, error))
    }
}
