//! Tests of formulas and systems as data.

mod formulas;
mod mistakes;
mod systems;
