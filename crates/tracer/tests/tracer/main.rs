//! Traces and subdivisions with known answers.

mod known_curves;
mod naming;
mod subdivision;
