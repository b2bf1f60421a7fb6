//! What is refused: statements that the paper does not have, and maps without cells.

use stickslip_plane::progress::SILENT;
use stickslip_reproduction::ReproductionError;
use stickslip_reproduction::figures::Reproduction;
use stickslip_reproduction::statements::{self, COUNT, Spring};

#[test]
fn there_is_no_statement_0_and_none_after_the_last() {
    for number in [0, COUNT + 1, 255] {
        let error = statements::run(Spring::Reset, &[number], SILENT).unwrap_err();
        assert!(matches!(error, ReproductionError::Statement { .. }), "{error}");
        assert_eq!(error.to_string(), format!("there is no statement {number}; expected 1 to 25"));
    }
    assert!(statements::run(Spring::Reset, &[], SILENT).unwrap().statements.is_empty());
}

#[test]
fn maps_have_cells() {
    let reproduction = Reproduction::new(0, Spring::Reset);
    for part in Reproduction::parts() {
        let error = part.run(&reproduction).unwrap_err();
        assert!(matches!(error, ReproductionError::NoCells), "{}: {error}", part.title);
    }
}
