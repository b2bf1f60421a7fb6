//! The files of the program: what is read and what is written.
//!
//! Nothing here depends on the options and commands of the program. An error says what is wrong
//! with a file; the program decides about the exit code.
//!
//! Start reading in [`output`], where a file is complete or not there at all; then [`input`] (texts
//! of options, and files), [`map`] (the files of a map, also of one that is not finished) and
//! `error` (what can go wrong).

mod error;
pub mod input;
pub mod map;
pub mod output;

pub use error::FileError;
