//! A family of any dimension as one type.

use std::sync::Arc;

use pyo3::prelude::*;
use stickslip_solver::{Dop853, Margin};
use stickslip_tracer::{Family, FamilyError, HybridFamily, Itinerary};

use crate::failure::bad_input;
use crate::families::blueprint::Blueprint;
use crate::families::member::Members;
use crate::hybrid::trouble::Trouble;

/// The runs of a family, whatever its dimension is.
pub type Runs =
    Box<dyn Family<Label = Itinerary, Margin = Margin, Error = FamilyError> + Send + Sync>;

/// The greatest numbers of components and of guards.
const MOST: (usize, usize) = (12, 12);

/// Refuses a family that is too large.
pub fn check(blueprint: &Blueprint) -> PyResult<()> {
    let (dimension, guards) = (blueprint.dimension(), blueprint.guards);
    if dimension > MOST.0 || guards > MOST.1 {
        return Err(bad_input(format!(
            "the systems have {dimension} components and {guards} guards; a family may have up to \
             {} and {}",
            MOST.0, MOST.1
        )));
    }
    Ok(())
}

/// The runs of a family that was checked. Code for each dimension would take long to compile, so
/// that some systems have components and guards that do nothing.
pub fn runs(blueprint: &Arc<Blueprint>, trouble: &Arc<Trouble>) -> Runs {
    fn sized<const N: usize, const G: usize>(
        blueprint: &Arc<Blueprint>,
        trouble: &Arc<Trouble>,
    ) -> Runs {
        let Blueprint { options, end, .. } = **blueprint;
        let problem = Members { blueprint: blueprint.clone(), trouble: trouble.clone() };
        Box::new(HybridFamily::<_, _, N, G> { problem, method: Dop853, options, end })
    }
    macro_rules! first_that_fits {
        ($($n:literal)*) => {
            match (blueprint.dimension(), blueprint.guards) {
                $(
                    (..=$n, ..=2) => sized::<$n, 2>(blueprint, trouble),
                    (..=$n, ..=4) => sized::<$n, 4>(blueprint, trouble),
                    (..=$n, _) => sized::<$n, 12>(blueprint, trouble),
                )*
                _ => sized::<12, 12>(blueprint, trouble),
            }
        };
    }
    first_that_fits!(1 2 3 4 6 12)
}
