//! Basins over two initial values: where runs lead to, told apart.

use rayon::prelude::*;
use stickslip_expression::{Inputs, InvalidValue, Program, Runnable};
use stickslip_solver::Outcome;

use super::coarse;
use crate::equations::{Draft, is_apart};
use crate::find::{Guess, Orbits};
use crate::orbit::Orbit;
use crate::settle::require_time;
use crate::watch::Watched;

/// How much two states of one attractor may differ, of the largest value of the component in the
/// second halves of runs that settle.
const SAME: f64 = 1e-3;
/// What is smaller at last, of its largest value, has died out.
const GONE: f64 = 1e-9;
/// The greatest number of runs.
const MOST_RUNS: usize = 1 << 24;

/// Where runs from a grid of initial values lead.
#[derive(Clone, Debug, PartialEq)]
pub struct Basins {
    /// The components, by their places in the system.
    pub components: [usize; 2],
    /// The initial values of each.
    pub values: [Vec<f64>; 2],
    /// What runs lead to, in the order of the grid.
    pub attractors: Vec<Attractor>,
    /// The attractor of each run, by its place; the first component runs fastest. `None` if a run
    /// does not settle, as on a chaotic attractor, or fails.
    pub labels: Vec<Option<usize>>,
}

/// What a run leads to.
#[derive(Clone, Debug, PartialEq)]
pub enum Attractor {
    /// A periodic orbit.
    Orbit(Box<Orbit>),
    /// A state that does not change.
    Rest {
        /// The mode.
        mode: usize,
        /// The state.
        state: Vec<f64>,
    },
    /// The rule of a mode that ends the run.
    End {
        /// The mode.
        mode: usize,
        /// The rule, by its place in the mode.
        rule: usize,
    },
}

/// What one run has come to.
enum Fate {
    Round(Draft),
    Other(Attractor),
    Unknown,
}

impl Orbits {
    /// Where runs from a grid of two initial values lead within a time. Other values are those of
    /// the guess, whose itinerary is not used. Orbits are solved for once they have been met; a run
    /// belongs to one whose states differ by less than 1e-3 of their size, so that two attractors
    /// that are closer are one. Runs are computed side by side.
    ///
    /// # Errors
    /// [`InvalidValue`]: a value cannot be used.
    pub fn basins(
        &self,
        parameters: &[f64],
        guess: &Guess<'_>,
        components: [usize; 2],
        values: [&[f64]; 2],
        time: f64,
    ) -> Result<Basins, InvalidValue> {
        let start = self.start(parameters, guess)?;
        require_time("the time to settle", time)?;
        let state = start.start().state.to_vec();
        let (n, [one, other]) = (state.len(), components);
        let accepted = one != other && one.max(other) < n;
        let expected = format!("the places of two of {n} components");
        InvalidValue::check("the components", one.max(other), expected, accepted)?;
        let [xs, ys] = values;
        let runs = xs.len().saturating_mul(ys.len());
        let expected = format!("1 to {MOST_RUNS}");
        InvalidValue::check("the number of runs", runs, expected, (1..=MOST_RUNS).contains(&runs))?;
        for value in xs.iter().chain(ys) {
            let name = "an initial value";
            InvalidValue::check(name, *value, "a finite number", value.is_finite())?;
        }
        let slopes = self.system.modes.iter().map(|mode| {
            let inputs = Inputs { components: n, parameters: parameters.len(), fixed: true };
            Program::compile(&self.system.graph, &mode.slopes, inputs).with(parameters)
        });
        let slopes: Vec<Program> = slopes.collect();
        self.watch.begin(runs);
        let fates = (0..runs).into_par_iter().map(|run| {
            let mut state = state.clone();
            (state[one], state[other]) = (xs[run % xs.len()], ys[run / xs.len()]);
            let start = start.clone().starting(None, None, Some(&state));
            let mut sizes = vec![0.0; n];
            let fate = start.map_or(Fate::Unknown, |start| {
                self.fate(&start, (time, &mut sizes), &slopes, parameters)
            });
            self.watch.advance(1);
            (fate, sizes)
        });
        let fates: Vec<(Fate, Vec<f64>)> = fates.collect();
        let mut sizes = vec![0.0; n];
        for (_, own) in fates.iter().filter(|(fate, _)| !matches!(fate, Fate::Unknown)) {
            sizes.iter_mut().zip(own).for_each(|(size, own): (&mut f64, _)| *size = size.max(*own));
        }
        let mut attractors: Vec<Attractor> = Vec::new();
        // Rounds to which no orbit belongs.
        let mut without: Vec<Draft> = Vec::new();
        let mut label = |fate: &Fate| {
            let known = attractors.iter().position(|it| self.leads_to(fate, it, &sizes));
            let new = match fate {
                _ if known.is_some() => return known,
                Fate::Unknown => return None,
                Fate::Other(attractor) => attractor.clone(),
                Fate::Round(draft) => {
                    if without.iter().any(|it| self.is_same(it, draft, &sizes)) {
                        return None;
                    }
                    let orbit = self.once_around(draft).ok();
                    let Some(orbit) = orbit.filter(|it| self.is_same(&it.draft(), draft, &sizes))
                    else {
                        without.push(draft.clone());
                        return None;
                    };
                    Attractor::Orbit(Box::new(orbit))
                }
            };
            attractors.push(new);
            Some(attractors.len() - 1)
        };
        let labels = fates.iter().map(|(fate, _)| label(fate)).collect();
        let values = values.map(<[f64]>::to_vec);
        Ok(Basins { components, values, attractors, labels })
    }

    /// What a run comes to.
    fn fate(
        &self,
        start: &Runnable,
        (time, sizes): (f64, &mut Vec<f64>),
        slopes: &[Program],
        parameters: &[f64],
    ) -> Fate {
        let Ok(found) = self.settling(start, time, &coarse(), Watched::one(&self.watch)) else {
            return Fate::Unknown;
        };
        let run = &found.run;
        let [whole, late] = &found.sizes;
        // What dies out never becomes the 0 of its orbit.
        *sizes = whole.iter().zip(late).map(|(all, own)| own.max(GONE * all)).collect();
        if let Outcome::EndedByGuard { guard } = run.outcome {
            return Fate::Other(Attractor::End { mode: run.mode, rule: guard });
        }
        if let Some(draft) = self.repeated(parameters, &found) {
            return Fate::Round(draft);
        }
        let mut moves = vec![f64::NAN; run.state.len()];
        slopes[run.mode].run(run.s, &run.state, &mut moves);
        let is_quiet = found.last.last().is_none_or(|event| event.s < run.s - 0.5 * time);
        let mut parts = moves.iter().zip(whole);
        let is_still = parts.all(|(slope, size)| (slope * time).abs() <= SAME * size);
        if run.outcome == Outcome::ReachedEnd && is_quiet && is_still {
            Fate::Other(Attractor::Rest { mode: run.mode, state: run.state.clone() })
        } else {
            Fate::Unknown
        }
    }

    /// Whether what a run has come to is an attractor.
    fn leads_to(&self, fate: &Fate, attractor: &Attractor, sizes: &[f64]) -> bool {
        match (fate, attractor) {
            (Fate::Round(draft), Attractor::Orbit(orbit)) => {
                self.is_same(&orbit.draft(), draft, sizes)
            }
            (
                Fate::Other(Attractor::Rest { mode, state }),
                Attractor::Rest { mode: other, state: known },
            ) => mode == other && are_near(state, known, sizes, |_| false),
            (Fate::Other(own), Attractor::End { .. }) => own == attractor,
            _ => false,
        }
    }

    /// Whether a round is another one, perhaps from another segment on, or goes around it several
    /// times.
    fn is_same(&self, one: &Draft, other: &Draft, sizes: &[f64]) -> bool {
        let (n, m) = (one.legs.len(), other.legs.len());
        let (period, length) = ((m / n) as f64 * one.period(), other.period());
        if m % n != 0 || (period - length).abs() > SAME * period {
            return false;
        }
        let apart = |k: usize| is_apart(&self.system, &one.legs, k);
        (0..n).any(|shift| {
            (0..m).all(|k| {
                let i = (k + shift) % n;
                one.legs[i] == other.legs[k]
                    && are_near(&one.states[i], &other.states[k], sizes, apart)
            })
        })
    }
}

fn are_near(one: &[f64], other: &[f64], sizes: &[f64], apart: impl Fn(usize) -> bool) -> bool {
    let parts = one.iter().zip(other).zip(sizes).enumerate();
    parts.into_iter().all(|(k, ((x, y), size))| (x - y).abs() <= SAME * size || apart(k))
}
