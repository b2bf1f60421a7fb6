//! Formulas and hybrid systems as data.
//!
//! A [`Graph`] holds formulas, in which equal ones are one node. [`Program`]s compute them in any
//! kind of [`Number`](stickslip_number::Number): with doubles the solver integrates, with
//! enclosures it decides guards, with dual numbers it has derivatives. A [`System`] is made of such
//! formulas, and has a text ([`System::parse`], [`System::text`]). With numbers for its parameters
//! it runs ([`System::with`]).
//!
//! ```
//! use stickslip_expression::System;
//! use stickslip_solver::{Dop853, Options};
//! use stickslip_solver::dynamic::run_dynamic;
//!
//! let system = System::parse(
//!     r#"
//! ## A ball that falls on a floor
//! parameter g = 9.81, e = 0.5
//! state x = 4.905, v = 0
//!
//! x' = v
//! v' = -g
//! when x < 0 "floor"
//!   x := 0
//!   v := -e*v
//!
//! end = 2.5
//! "#,
//! )?;
//! let ball = system.with(&[9.81, 0.5])?;
//! let (start, options) = (ball.start(), Options::default());
//! let mut bounces = Vec::new();
//! let end = run_dynamic(Dop853, &ball, start, ball.end(), &options, &mut bounces)?;
//! assert!(end.decided && (bounces[0].s - 1.0).abs() < 1e-14);
//! assert!((bounces[1].s - 2.0).abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The modules in reading order: `graph` has formulas and their derivatives, `program` compiles and
//! computes them, `system` is what a hybrid system consists of, `sliding` lets it slide along
//! surfaces, `native` makes it of a system of Rust, `zeros` finds where guards start from zero,
//! `branches` makes events of where equations jump, `compiled` makes it ready for parameters,
//! `resets` is what a rule makes of the state, `continuation` decides how it leaves surfaces, `run`
//! is what the solver sees of it, `recording` a run with its events, `explained` says why one
//! failed, `sensitivity` its derivatives, `family` the runs of a plane of parameters, and `text`
//! reads and writes it. `docs/systems.md` in the repository describes the language.

mod branches;
mod compiled;
mod continuation;
mod explained;
mod family;
mod graph;
mod native;
mod program;
mod recording;
mod resets;
mod run;
mod sensitivity;
mod sliding;
mod system;
mod text;
mod zeros;

pub use compiled::Compiled;
pub use family::{RuleOrder, SystemFamily};
pub use graph::{Binary, Formula, FormulaNode, Graph, Unary, Variable};
pub use native::{Jump, NativeSystem, ValuedSystem};
pub use program::{Inputs, Program};
pub use recording::{Recording, Stay, outcome_name};
pub use run::Runnable;
pub use sensitivity::{By, Moving, SensitivityError, SystemSensitivities};
pub use sliding::NotSliding;
pub use stickslip_number::InvalidValue;
pub use system::{Component, Condition, Mode, Next, Parameter, RestRule, Rule, System, Trigger};
pub use text::{TextError, format};

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
