//! Traces and subdivisions with known answers.

mod every_change;
mod extrema;
mod guards;
mod known_curves;
mod leaving_minimum;
mod random_circles;
mod random_guards;
mod stack;
mod subdivision;
mod vertex_kinds;
