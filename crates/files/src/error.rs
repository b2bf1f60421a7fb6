//! What can go wrong with a file.

use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

use stickslip_figure::FigureError;

/// The reason why a file cannot be read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// What an option names is of no use.
    #[error("{0}")]
    Option(String),
    /// An input file cannot be used.
    #[error("{}: {reason}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what is expected.
        reason: String,
    },
    /// Another process makes the same map.
    #[error(
        "{}: another process{} is making this map; expected another --out, or to wait",
        directory.display(), holder.map(|id| format!(" ({id})")).unwrap_or_default()
    )]
    Busy {
        /// The directory of its tiles.
        directory: PathBuf,
        /// The number of the process, if it is known.
        holder: Option<u32>,
    },
    /// An output file cannot be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// What the system reports.
        source: io::Error,
    },
    /// A picture cannot be drawn.
    #[error("{}: {source}", path.display())]
    Picture {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: FigureError,
    },
    /// A film cannot be made.
    #[error(
        "{}: no film can be made: {source}; expected ffmpeg among the programs of this machine, or a \
         name that ends in .gif",
        path.display()
    )]
    Film {
        /// The file.
        path: PathBuf,
        /// What the system reports.
        source: io::Error,
    },
}

impl FileError {
    /// An input file that cannot be used.
    pub fn input(path: &Path, reason: impl Display) -> Self {
        const MOST_BYTES: usize = 2000;
        // The reason may quote the file, and what it quotes must not break the line.
        let mut shown = String::new();
        for character in reason.to_string().chars() {
            if shown.len() > MOST_BYTES {
                shown.push('…');
                break;
            }
            if character.is_control() {
                shown.extend(character.escape_default());
            } else {
                shown.push(character);
            }
        }
        Self::Input { path: path.to_owned(), reason: shown }
    }

    /// An output file that cannot be written.
    pub fn output(path: &Path, source: impl Into<io::Error>) -> Self {
        Self::Output { path: path.to_owned(), source: source.into() }
    }
}
