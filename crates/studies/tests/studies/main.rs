//! Tests of the studies, in one program.

mod convergence;
mod reproduction;
mod stiff_limit;
