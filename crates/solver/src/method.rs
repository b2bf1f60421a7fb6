//! Runge–Kutta pairs: their coefficients, one step, the size of the next one, and measured orders.

pub(crate) mod control;
mod dense;
mod dop853;
mod dopri5;
mod order;
mod state;
mod step;
mod tableau;

pub use dense::Dense;
pub use dop853::Dop853;
pub use dopri5::Dopri5;
pub use order::{Order, fit_order};
pub use state::{FUSED_PRODUCTS, State};
pub use step::{Step, Trial};
pub use tableau::{INTERIOR_NODES, MAX_STAGES, Method, Tableau};
