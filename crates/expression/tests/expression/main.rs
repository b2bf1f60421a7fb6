//! Tests of formulas and systems as data.

mod branches;
mod checks;
mod examples;
mod formulas;
mod mistakes;
mod requires;
mod sensitivities;
mod sliding;
mod surfaces;
mod systems;
mod tables;
