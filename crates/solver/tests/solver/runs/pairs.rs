//! Pairs that are chosen at run time.

use stickslip_solver::{Dop853, Dopri5, EmbeddedPair, InvalidValue, Method, Options};

use super::{at, ball};
use crate::erased::{run, run_with};

#[test]
fn a_pair_at_run_time_is_the_method() {
    let start = at(0.0, [1.0, 0.0]);
    let options = Options::default();
    let one = run(Dopri5, &ball(), start, 3.0, &options, &mut ()).unwrap();
    let other = run(Dop853, &ball(), start, 3.0, &options, &mut ()).unwrap();
    let by = |pair: EmbeddedPair| run_with(pair, &ball(), start, 3.0, &options, &mut ()).unwrap();
    assert_eq!((by(EmbeddedPair::Dopri5), by(EmbeddedPair::Dop853)), (one, other));
    assert_ne!(one.statistics, other.statistics);
}

#[test]
fn pairs_have_the_names_and_numbers_of_methods() {
    fn is<M: Method>(pair: EmbeddedPair) {
        assert_eq!(pair.to_string(), M::NAME);
        assert_eq!(M::NAME.parse(), Ok(pair));
        assert_eq!(
            (pair.order(), pair.stages(), pair.dense_degree()),
            (M::ORDER, M::STAGES, M::DENSE_DEGREE)
        );
    }
    is::<Dopri5>(EmbeddedPair::Dopri5);
    is::<Dop853>(EmbeddedPair::Dop853);
    assert_eq!(format!("{:>8}", EmbeddedPair::Dopri5), "  dopri5");
    assert_eq!(
        "RK45".parse::<EmbeddedPair>(),
        Err(InvalidValue::new("method", "RK45", "\"dopri5\" or \"dop853\""))
    );
}
