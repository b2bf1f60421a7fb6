//! Boundaries, followed one by one.
//!
//! In reading order: `trace` (how all are found), `scan` (on one segment), `branch` (how one is
//! followed), `step` (a step), `special`, `touch` and `ahead` (where it ends), `seed` and `island`
//! (where it starts), `corrector` (onto a boundary), `runs` (the family, with its runs counted),
//! `network` (what is collected), `naming` (what vertices are), `extrema` (of boundaries in a
//! parameter).

pub mod branch;
mod corrector;
pub mod extrema;
mod island;
mod naming;
pub mod network;
pub mod runs;
mod scan;
pub mod seed;
pub mod trace;
