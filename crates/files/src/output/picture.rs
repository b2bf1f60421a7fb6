//! Files of pictures.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;

use stickslip_figure::{FigureError, Svg, gif, pdf, png};

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
    Pdf,
}

impl PictureFile {
    /// The picture file `path`, whose name tells its format.
    ///
    /// # Errors
    /// The name does not end in .svg, .png or .pdf.
    pub fn new(path: PathBuf) -> Result<Self, String> {
        let format = match &extension(&path)[..] {
            "svg" => PictureFormat::Svg,
            "png" => PictureFormat::Png,
            "pdf" => PictureFormat::Pdf,
            _ => {
                let expected = "expected a name that ends in .svg, .png or .pdf";
                return Err(format!("not a picture; {expected}"));
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
            PictureFormat::Pdf => pdf(&picture),
        });
        let failed = |source| FileError::Picture { path: self.path.clone(), source };
        let bytes = bytes.map_err(failed)?;
        OutputFile::create(&self.path)?.finish(&bytes)
    }
}

fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// The file of an animation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnimationFile {
    path: PathBuf,
    is_film: bool,
}

impl AnimationFile {
    /// The file `path`: a GIF, or a film in MP4.
    ///
    /// # Errors
    /// The name does not end in .gif or .mp4.
    pub fn new(path: PathBuf) -> Result<Self, String> {
        let is_film = match &extension(&path)[..] {
            "gif" => false,
            "mp4" => true,
            _ => {
                let expected = "expected a name that ends in .gif or .mp4";
                return Err(format!("not an animation; {expected}"));
            }
        };
        Ok(Self { path, is_film })
    }

    /// The path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes sure that the file can be written, before there is work to lose.
    ///
    /// # Errors
    /// [`FileError::Output`]: the file cannot be created. [`FileError::Film`]: there is no ffmpeg.
    pub fn probe(&self) -> Result<(), FileError> {
        if self.is_film {
            let asked = ffmpeg().arg("-version").stdout(Stdio::null()).status();
            asked.map_err(|source| self.no_film(source))?;
        }
        OutputFile::create(&self.path).map(drop)
    }

    /// Writes `pictures` completely, except for the name of the file.
    ///
    /// # Errors
    /// [`FileError::Picture`]: they cannot be drawn. [`FileError::Output`]: the file cannot be
    /// written. [`FileError::Film`]: ffmpeg cannot make the film.
    pub fn write(&self, pictures: impl Iterator<Item = Svg>) -> Result<StoredFile, FileError> {
        let failed = |source| FileError::Picture { path: self.path.clone(), source };
        let bytes = if self.is_film {
            let pictures: Result<Vec<_>, _> = pictures.map(|picture| png(&picture)).collect();
            film(&pictures.map_err(failed)?).map_err(|source| self.no_film(source))?
        } else {
            gif(pictures).map_err(failed)?
        };
        OutputFile::create(&self.path)?.finish(&bytes)
    }

    fn no_film(&self, source: io::Error) -> FileError {
        FileError::Film { path: self.path.clone(), source }
    }
}

fn ffmpeg() -> Command {
    let mut ffmpeg = Command::new("ffmpeg");
    ffmpeg.stdin(Stdio::null()).stderr(Stdio::null());
    ffmpeg
}

/// The film of these PNG pictures, at the pace of a GIF. The last one stays for two seconds.
fn film(pictures: &[Vec<u8>]) -> io::Result<Vec<u8>> {
    // Pictures of a film have even sides.
    let even = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,tpad=stop_mode=clone:stop_duration=2";
    let file = tempfile::Builder::new().suffix(".mp4").tempfile()?;
    let mut ffmpeg = ffmpeg()
        .args(["-y", "-f", "image2pipe", "-framerate", "100/6", "-c:v", "png", "-i", "-"])
        .args(["-vf", even, "-pix_fmt", "yuv420p", "-movflags", "+faststart"])
        .arg(file.path())
        .stdin(Stdio::piped())
        .spawn()?;
    let input = ffmpeg.stdin.take();
    let written = thread::scope(|scope| {
        let writer = scope.spawn(move || match input {
            Some(mut input) => pictures.iter().try_for_each(|picture| input.write_all(picture)),
            None => Ok(()),
        });
        let ended = ffmpeg.wait();
        // The writer does not panic.
        (writer.join(), ended)
    });
    match written {
        (Ok(Ok(())), Ok(status)) if status.success() => std::fs::read(file.path()),
        (Ok(Err(error)), _) | (_, Err(error)) => Err(error),
        (_, Ok(status)) => Err(io::Error::other(format!("ffmpeg ended with {status}"))),
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
        assert_eq!(format("c.pdf"), Ok(PictureFormat::Pdf));
        for name in ["svg", ".png", "a.ps", "a.svg.", ""] {
            assert!(format(name).is_err(), "{name}");
        }
        let film = |name: &str| AnimationFile::new(name.into()).map(|file| file.is_film);
        assert_eq!((film("a.GIF"), film("a.mp4")), (Ok(false), Ok(true)));
        assert!(film("a.png").is_err());
    }
}
