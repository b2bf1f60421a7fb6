//! Exit codes that no command line leads to.

use stickslip_cli::Failure;
use stickslip_model::Contact;
use stickslip_plane::atlas::AtlasError;
use stickslip_reproduction::ReproductionError;

/// Nobody who asks for the reproduction gives such a parameter: the program is wrong.
#[test]
fn an_error_inside_the_reproduction_is_not_bad_usage() {
    let invalid = Contact::new(-1.0, 1.0, 0.0).unwrap_err();
    let inside = Failure::from(ReproductionError::from(invalid.clone()));
    assert_eq!((inside.code(), Failure::from(AtlasError::from(invalid)).code()), (1, 2));
}
