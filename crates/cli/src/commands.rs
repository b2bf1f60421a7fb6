//! What each command does. One file for each; `batch` is what files of collisions and of impacts
//! have in common, `course` writes courses, `system_map` is `map` of a system
//! of one's own, and `reproduce` with statements alone is `statements`.

pub mod batch;
pub mod collide;
pub mod completions;
pub mod course;
pub mod fit;
pub mod impact;
pub mod join;
pub mod laws;
pub mod locate;
pub mod man;
pub mod map;
pub mod reproduce;
pub mod run;
pub mod stack;
pub mod statements;
pub mod studies;
pub mod system_map;
pub mod table;
pub mod timestep;
pub mod trace;
