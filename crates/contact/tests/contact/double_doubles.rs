//! Numbers with twice the digits.

use stickslip_contact::numerics::double_double::DoubleDouble;

#[test]
fn pairs_keep_what_rounding_drops() {
    let tiny = 2.0_f64.powi(-70);
    let sum = DoubleDouble::sum(1.0, tiny);
    assert_eq!((sum.0, sum.1), (1.0, tiny));
    // (1 + ε)² = 1 + 2ε + ε²
    let square = sum.times(sum).minus(DoubleDouble(1.0, 0.0)).minus(DoubleDouble(2.0 * tiny, 0.0));
    assert!(square.nearest().abs() < 1e-30);
    let third = DoubleDouble(1.0, 0.0).over(DoubleDouble(3.0, 0.0));
    let back = third.times(DoubleDouble(3.0, 0.0)).minus(DoubleDouble(1.0, 0.0));
    assert!(back.nearest().abs() < 1e-31);
    assert_eq!(DoubleDouble::product(0.1, 10.0).nearest(), 1.0);
}
