//! The largest values of a collision.

use stickslip_model::limits::largest::FORCE;

#[test]
fn the_largest_force_is_that_of_the_largest_compression() {
    assert_eq!(FORCE, 1.25_f64.powf(0.6));
}
