//! Tests of the solver: order conditions, smooth problems, guards with planted zeros, margins.

mod checks;
mod event_battery;
mod guard_rounding;
mod margins;
mod methods;
mod planted_roots;
mod properties;
#[cfg(feature = "serde")]
mod serialization;
mod smooth_problems;
