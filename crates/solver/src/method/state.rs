//! A state, and weighted sums of states.
//!
//! There are no intrinsics: the compiler vectorises arrays of fixed size. It may not contract a
//! product and a sum into one rounding by itself, so `add_multiple` asks for that where the target
//! has the instruction. The workspace is built for such targets (x86-64-v3); on others the last
//! digits differ (docs/numerics.md).

use nalgebra::{SMatrix, SVector};

use crate::method::tableau::MAX_STAGES;

/// A state of `N` components.
pub type State<const N: usize> = SVector<f64, N>;

/// Columns of `N` components that are integrated together: a state, and its derivatives.
pub type Columns<const N: usize, const Q: usize> = SMatrix<f64, N, Q>;

/// Whether the steps of this build round a product and the sum to which it is added only once.
///
/// It is true if the processor for which the crate is built has an instruction for that. The last
/// digits of results depend on it.
pub const FUSED_PRODUCTS: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// The sum of the first `count` stages `k`, each times its weight.
#[inline(always)]
pub(super) fn combine<const N: usize, const Q: usize>(
    weights: &[f64; MAX_STAGES],
    k: &[Columns<N, Q>; MAX_STAGES],
    count: usize,
) -> Columns<N, Q> {
    let mut sum = Columns::zeros();
    for j in 0..count {
        if weights[j] != 0.0 {
            sum = add_multiple(&sum, &k[j], weights[j]);
        }
    }
    sum
}

/// sum + factor·k. It is rounded only once if the processor has an instruction for that, which
/// halves the arithmetic of a step.
#[inline(always)]
pub(super) fn add_multiple<const N: usize, const Q: usize>(
    sum: &Columns<N, Q>,
    k: &Columns<N, Q>,
    factor: f64,
) -> Columns<N, Q> {
    if FUSED_PRODUCTS { k.zip_map(sum, |k, sum| k.mul_add(factor, sum)) } else { sum + k * factor }
}

/// sum + factor·k for one component, rounded as in [`add_multiple`].
#[inline(always)]
pub(crate) fn add_product(sum: f64, k: f64, factor: f64) -> f64 {
    if FUSED_PRODUCTS { k.mul_add(factor, sum) } else { sum + k * factor }
}
