//! Tests of the studies, in one program.

mod convergence;
mod stiff_limit;
