//! Orbits against closed forms.

mod ball;
mod branches;
mod buck;
mod curves;
mod impact;
mod refused;
mod sliding;
