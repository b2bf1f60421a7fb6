//! Results written: files that are complete or not there at all, tables, JSON, pictures, progress.

pub mod csv;
pub mod file;
pub mod json;
pub mod picture;
pub mod progress;
pub mod rows;
pub mod study;
pub mod text;
