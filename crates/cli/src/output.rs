//! What is shown while the program works, and to readers.
//!
//! Start reading in `console` (standard output and standard error); then `text` (tables for
//! readers) and `progress`.

pub mod console;
pub mod progress;
pub mod text;
