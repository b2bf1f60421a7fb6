//! Tests of the solver.
//!
//! | module | content |
//! |---|---|
//! | `methods` | order conditions of both pairs, and orders observed in steps |
//! | `fitted_orders` | orders of convergence, fitted to errors that are known |
//! | `smooth_problems` | published results, the DETEST problems, work counters |
//! | `event_battery` | guards with known zeros, and systems with known switches |
//! | `planted_roots` | random polynomials with planted roots as guards |
//! | `plateaus` | guards that are zero on a stretch, or touch or leave zero without a slope |
//! | `guard_rounding` | guards whose signs are lost in their own rounding |
//! | `stairs` | guards that rounding leaves only stairs of |
//! | `enclosures` | enclosures of formulas against their values at places |
//! | `margins` | margins with a closed form |
//! | `properties` | what holds of random systems; `checks` says it, for the fuzz targets too |
//! | `planted_kinds` | random guards of every kind: steep, fast, kinked, with jumps and poles |
//! | `fast_guards` | black boxes that go up and down often on one step, and poles on long steps |
//! | `singular` | guards without bounds or without a value somewhere |
//! | `sliding` | systems that slide along surfaces |
//! | `instants`, `planted_instants` | random systems whose events coincide, exactly or nearly |
//! | `reports` | systems from public reports about the events of other tools |
//! | `strangers` | systems that nobody here designed for |
//! | `chatter` | a ball whose hops become smaller than rounding |
//! | `dynamic` | systems whose dimension is known at run time |
//! | `erased` | runs along any system as runs along one type, so that they are compiled once |
//! | `black_box` | systems that can be read as black boxes |
//! | `runs` | what surrounds a run: closures, runs backwards, samples, ends, defined answers |
//! | `serialization` | the JSON of results |

mod black_box;
mod chatter;
mod checks;
mod dynamic;
mod enclosures;
mod erased;
mod event_battery;
mod fast_guards;
mod fitted_orders;
mod guard_rounding;
mod instants;
mod margins;
mod methods;
mod planted_instants;
mod planted_kinds;
mod planted_roots;
mod plateaus;
mod properties;
mod reports;
mod runs;
mod sensitivities;
#[cfg(feature = "serde")]
mod serialization;
mod singular;
mod sliding;
mod smooth_problems;
mod stairs;
mod strangers;
