//! Orbits against closed forms.

mod ball;
mod branches;
mod buck;
mod impact;
mod refused;
mod sliding;
