//! Tests of the crate, in one program.

mod bodies;
mod inside;
mod numbers;
mod output_files;
mod parameters;
mod parts;
mod ranges;
mod thumbnails;

// Where modules of the crate find each other.
use inside::{error, input};
