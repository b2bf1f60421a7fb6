//! Tests of the studies, in one program.

mod convergence;
mod envelopes;
mod one_collision;
mod search;
mod stiff_limit;
mod unreset;
