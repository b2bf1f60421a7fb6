//! The state in regularized coordinates: which component is what.

use stickslip_solver::State;

/// Number of components.
pub const STATE: usize = 8;

/// u = √x, the root of the compression.
pub const U: usize = 0;
/// v = dx/dt, the rate of the compression, where the damping a is below 1, and otherwise
/// a³(v + u²/a), whose zero ends the contact; see
/// [`Regularized::compression_rate`](super::Regularized::compression_rate).
pub const V: usize = 1;
/// c ω y/σ while sticking, with c = max(1, κ^{1/4}) and σ = min(1, ψ): these factors make errors of
/// y and of switch times comparable to those of w.
pub const SPRING: usize = 2;
/// w/σ, the scaled tangential velocity; see
/// [`Regularized::velocity`](super::Regularized::velocity).
pub const W: usize = 3;
/// Time since the phase began.
pub const T: usize = 4;
/// Normal energy taken by damping.
pub const DAMPING: usize = 5;
/// gap/c, until a stick phase is settled.
pub const GAP: usize = 6;
/// rate/c², until a stick phase is settled.
pub const RATE: usize = 7;

/// The components of a state as an array.
#[inline(always)]
pub(crate) fn array(y: &State<STATE>) -> &[f64; STATE] {
    &y.data.0[0]
}
