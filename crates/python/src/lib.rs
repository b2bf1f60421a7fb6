//! What the Python package `stickslip` computes with.
//!
//! Nothing is decided here: arguments become settings of the libraries, and their results become
//! arrays, or the JSON that the program prints. Names, shapes and units are documented in the
//! Python functions that call these, in `python/stickslip`.
//!
//! Start reading in `arrays`; then `collision`, `impacts`, `planes`, `stacks`, `steps`, `fits`,
//! `tables`, `studies` (results), `hybrid`, `formulas`, `orbits`, `many`, `tape` (systems of one's
//! own), `families` (and what they depend on), `style` (colours), `engines`, `parallel` and
//! `failure` (what they share).

mod arrays;
mod background;
mod collision;
mod engines;
mod failure;
mod families;
mod fits;
mod formulas;
mod hybrid;
mod impacts;
mod many;
mod orbits;
mod parallel;
mod planes;
mod stacks;
mod steps;
mod studies;
mod style;
mod tables;
mod tape;

/// The module that Python loads. It has no state of its own, and needs no lock of the interpreter.
#[pyo3::pymodule(gil_used = false)]
mod _native {
    use numpy::PyArray1;
    use pyo3::prelude::*;

    /// Looks up NumPy now: while a result is made, Ctrl-C could end the look with a panic.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) {
        PyArray1::<f64>::zeros(module.py(), 0, false);
    }

    #[pymodule_export]
    use super::arrays::{collide_many, eps_t};
    #[pymodule_export]
    use super::collision::Collision;
    #[pymodule_export]
    use super::engines::{
        explorer, has_fused_products, laws, processor_has_fused_products, program, restitution,
        version,
    };
    #[pymodule_export]
    use super::failure::ComputationError;
    #[pymodule_export]
    use super::families::{FamilyAtlas, HybridFamily, stack_family};
    #[pymodule_export]
    use super::fits::Fit;
    #[pymodule_export]
    use super::formulas::FormulaSystem;
    #[pymodule_export]
    use super::hybrid::{evaluate_dense, run_hybrid};
    #[pymodule_export]
    use super::impacts::{BodyPair, homogeneous_mass};
    #[pymodule_export]
    use super::many::run_many;
    #[pymodule_export]
    use super::orbits::{OrbitMap, OrbitSystem, branch_picture};
    #[pymodule_export]
    use super::planes::{Atlas, atlas_options, gaining_lines};
    #[pymodule_export]
    use super::stacks::stack;
    #[pymodule_export]
    use super::steps::TimeSteps;
    #[pymodule_export]
    use super::studies::{
        asymptote, compare_laws, converge, reproduce, reproduce_all, reproduction_parts,
    };
    #[pymodule_export]
    use super::style::style;
    #[pymodule_export]
    use super::tables::RestitutionTable;
    #[pymodule_export]
    use super::tape::Tape;
}
