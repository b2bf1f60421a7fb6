//! What is read: texts of options, and files.
//!
//! Start reading in `number`; then, in this order: `range` (intervals and sizes), `part` (parts of
//! maps), `parameter` (the parameters of a collision), `recipe` (from options and columns to a
//! collision), `source` (files and standard input), `rows` (CSV files of collisions), `measured`
//! (CSV files of measured impacts), `json`, `law`, `bodies` and `atlas` (JSON files).

pub mod atlas;
pub mod bodies;
pub mod json;
pub mod law;
pub mod measured;
pub mod number;
pub mod parameter;
pub mod part;
pub mod range;
pub mod recipe;
pub mod rows;
pub mod source;
