//! Files of pictures.

use std::path::{Path, PathBuf};

use stickslip_figure::{FigureError, Svg, gif, png};

use super::file::{OutputFile, StoredFile};
use crate::error::FileError;

/// The file of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureFile {
    path: PathBuf,
    format: PictureFormat,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PictureFormat {
    Svg,
    Png,
}

impl PictureFile {
    /// The picture file `path`, whose name tells its format.
    ///
    /// # Errors
    /// The name does not end in .svg or .png.
    pub fn new(path: PathBuf) -> Result<Self, String> {
        let is =
            |name: &str| path.extension().is_some_and(|given| given.eq_ignore_ascii_case(name));
        let format = match (is("svg"), is("png")) {
            (true, _) => PictureFormat::Svg,
            (_, true) => PictureFormat::Png,
            _ => {
                return Err("not a picture; expected a name that ends in .svg or .png".to_owned());
            }
        };
        Ok(Self { path, format })
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes sure that the file can be written, before there is work to lose.
    ///
    /// # Errors
    /// [`FileError::Output`]: the file cannot be created.
    pub fn probe(&self) -> Result<(), FileError> {
        OutputFile::create(&self.path).map(drop)
    }

    /// Writes `picture` completely, except for the name of the file.
    ///
    /// # Errors
    /// [`FileError::Picture`]: it cannot be drawn. [`FileError::Output`]: it cannot be written.
    pub fn write(&self, picture: Result<Svg, FigureError>) -> Result<StoredFile, FileError> {
        let bytes = picture.and_then(|picture| match self.format {
            PictureFormat::Svg => Ok(picture.document().into_bytes()),
            PictureFormat::Png => png(&picture),
        });
        let failed = |source| FileError::Picture { path: self.path.clone(), source };
        let bytes = bytes.map_err(failed)?;
        OutputFile::create(&self.path)?.finish(&bytes)
    }
}

/// The file of an animation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnimationFile(PathBuf);

impl AnimationFile {
    /// The file `path`.
    ///
    /// # Errors
    /// The name does not end in .gif.
    pub fn new(path: PathBuf) -> Result<Self, String> {
        match path.extension() {
            Some(given) if given.eq_ignore_ascii_case("gif") => Ok(Self(path)),
            _ => Err("not an animation; expected a name that ends in .gif".to_owned()),
        }
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Makes sure that the file can be written, before there is work to lose.
    ///
    /// # Errors
    /// [`FileError::Output`]: the file cannot be created.
    pub fn probe(&self) -> Result<(), FileError> {
        OutputFile::create(&self.0).map(drop)
    }

    /// Writes `pictures` completely, except for the name of the file.
    ///
    /// # Errors
    /// [`FileError::Picture`]: they cannot be drawn. [`FileError::Output`]: the file cannot be
    /// written.
    pub fn write(&self, pictures: impl Iterator<Item = Svg>) -> Result<StoredFile, FileError> {
        let failed = |source| FileError::Picture { path: self.0.clone(), source };
        let bytes = gif(pictures).map_err(failed)?;
        OutputFile::create(&self.0)?.finish(&bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_tells_the_format() {
        let format = |name: &str| PictureFile::new(name.into()).map(|file| file.format);
        assert_eq!(format("a/b.svg"), Ok(PictureFormat::Svg));
        assert_eq!(format("b.c.PNG"), Ok(PictureFormat::Png));
        for name in ["svg", ".png", "a.pdf", "a.svg.", ""] {
            assert!(format(name).is_err(), "{name}");
        }
    }
}
