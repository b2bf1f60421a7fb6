//! Results written. A file is complete or not there at all.
//!
//! Start reading in `file`; then, in this order: `partial` (what is not complete), `directory`,
//! `csv`, `rows` and `impact_rows` (of batches), `json`, `npz`, `table_npz`, `picture`, `study`
//! (all files of a study).

pub mod csv;
pub mod directory;
pub mod file;
pub mod impact_rows;
pub mod json;
pub mod npz;
pub mod partial;
pub mod picture;
pub mod rows;
pub mod study;
pub mod table_npz;
