//! How boundaries are found and followed.
//!
//! In reading order:
//!
//! - `trace`: all boundaries in a window
//! - `count`: how many curves and regions there are, roughly, before anything is traced
//! - `tracer`: a search, and what it has found
//! - `stage` and `stages`: the order of the search, in steps
//! - `state` and `resume`: what a search must remember to go on later
//! - `scan`: the boundaries that cross a segment
//! - `seed`: from a change of the label to a place on a boundary
//! - `island`: closed boundaries between the places of the grid
//! - `sliver`: boundaries of regions between two places with the same label
//! - `tangency`: ends of curves that begin on another one with its tangent
//! - `branch`: one boundary, followed from its seed
//! - `end`: why it ends, and where
//! - `fit`: cubics as close to a boundary as the options ask
//! - `corrector`: from a guess to the zero of a margin
//! - `runs`: the runs of a family, counted
//! - `builder`: the network that grows
//! - `network`: what a trace finds
//! - `cut`: the part of it that lies in the window
//! - `naming`: the kinds of vertices
//! - `special_points`: the names of points at which two conditions hold together
//! - `extrema`: where boundaries are extremal in a coordinate
//! - `follow`: one boundary, with monitors

pub mod branch;
mod builder;
mod corrector;
pub mod count;
mod cut;
pub mod end;
pub mod extrema;
mod fit;
pub mod follow;
mod island;
mod naming;
pub mod network;
mod resume;
pub mod runs;
mod scan;
pub mod seed;
mod sliver;
pub mod special_points;
pub(crate) mod stage;
mod stages;
pub(crate) mod state;
mod tangency;
pub mod trace;
pub mod tracer;
