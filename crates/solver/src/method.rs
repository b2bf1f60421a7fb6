//! Runge–Kutta pairs: coefficients, one step, the size of the next step, and measured orders.
//!
//! Start reading in `tableau` (a pair as data) and `step` (one step as a pure function). Then come
//! `store` (how states are stored), `dense` (the state inside a step), `dopri5` and `dop853` (the
//! two pairs), `control` (the step size), `order` (orders of convergence, from measured errors) and
//! `pair` (a pair that is chosen at run time).

pub(crate) mod control;
mod dense;
mod dop853;
mod dopri5;
mod order;
mod pair;
mod state;
mod step;
mod store;
mod tableau;

pub use dense::{Dense, DenseOf};
pub use dop853::Dop853;
pub use dopri5::Dopri5;
pub use order::{Order, fit_order};
pub use pair::EmbeddedPair;
pub use state::{Columns, FUSED_PRODUCTS, State};
pub(crate) use step::Field;
pub use step::{Step, StepOf, Trial, TrialOf};
pub use store::Store;
pub use tableau::{INTERIOR_NODES, MAX_STAGES, Method, Tableau};
