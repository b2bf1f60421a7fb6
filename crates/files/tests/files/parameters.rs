//! Parameters and their ranges.

use stickslip_files::input::parameter::Parameter::{
    Alpha, Damping, Kappa, Mu, Psi, Ratio, TangentialDamping,
};

#[test]
fn every_parameter_has_a_range() {
    for parameter in [Kappa, Psi, Ratio, Mu, Alpha, Damping, TangentialDamping] {
        assert!(parameter.check(f64::NAN).is_err(), "{parameter:?}");
        assert!(parameter.parse("-1").is_err(), "{parameter:?}");
        assert!(parameter.parse("1").is_ok(), "{parameter:?}");
        let may_be_zero = matches!(parameter, Kappa | Mu | Damping | TangentialDamping);
        assert_eq!(parameter.parse("0").is_ok(), may_be_zero);
    }
    assert!(Alpha.parse("1.0000001").is_err());
}
