//! Orbits against closed forms.

mod attractors;
mod ball;
mod branches;
mod buck;
mod curves;
mod impact;
mod native;
mod planted;
mod published;
mod refused;
mod regions;
mod resumed;
mod sliding;
mod strangers;
