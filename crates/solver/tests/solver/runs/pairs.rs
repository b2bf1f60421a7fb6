//! Pairs that are chosen at run time.

use stickslip_solver::{Dop853, Dopri5, Method, Options, Pair, UnknownPair};

use super::{at, ball};
use crate::erased::{run, run_with};

#[test]
fn a_pair_at_run_time_is_the_method() {
    let start = at(0.0, [1.0, 0.0]);
    let options = Options::default();
    let one = run(Dopri5, &ball(), start, 3.0, &options, &mut ()).unwrap();
    let other = run(Dop853, &ball(), start, 3.0, &options, &mut ()).unwrap();
    let by = |pair: Pair| run_with(pair, &ball(), start, 3.0, &options, &mut ()).unwrap();
    assert_eq!((by(Pair::Dopri5), by(Pair::Dop853)), (one, other));
    assert_ne!(one.statistics, other.statistics);
}

#[test]
fn pairs_have_the_names_and_numbers_of_methods() {
    fn is<M: Method>(pair: Pair) {
        assert_eq!(pair.to_string(), M::NAME);
        assert_eq!(M::NAME.parse(), Ok(pair));
        assert_eq!(
            (pair.order(), pair.stages(), pair.dense_degree()),
            (M::ORDER, M::STAGES, M::DENSE_DEGREE)
        );
    }
    is::<Dopri5>(Pair::Dopri5);
    is::<Dop853>(Pair::Dop853);
    assert_eq!(format!("{:>8}", Pair::Dopri5), "  dopri5");
    assert_eq!("RK45".parse::<Pair>(), Err(UnknownPair { name: "RK45".to_owned() }));
}
