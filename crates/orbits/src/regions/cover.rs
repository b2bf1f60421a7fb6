//! Orbits over the lines of a grid, and all orbits above a point.

use nalgebra::DVector;
use rayon::prelude::*;
use stickslip_tracer::Point;

use super::{FollowedOrbits, RegionOptions};
use crate::branch::point::Along;
use crate::branch::{Branch, BranchOptions, SpecialKind, SpecialOrbit};
use crate::equations::{Draft, Equations, enlarge};
use crate::error::OrbitError;
use crate::find::Orbits;
use crate::newton::correct;
use crate::orbit::{Orbit, Segment, Verdict};

/// Two orbits at one point are one if their states differ by less than this part of their size.
const SAME: f64 = 1e-7;
/// A multiplier so near to the unit circle is not decided to be inside or outside.
const ON_CIRCLE: f64 = 1e-9;
/// The greatest number of branches over lines.
const MOST_BRANCHES: usize = 2000;

/// Branches over the lines of a grid.
pub(super) struct Cover<'a> {
    pub orbits: &'a Orbits,
    pub parameters: [usize; 2],
    pub window: [[f64; 2]; 2],
    pub branches: Vec<LineBranch>,
    /// Where an orbit on a line was lost.
    pub lost: Vec<Point>,
    /// The values of each parameter that are followed.
    lines: [Vec<f64>; 2],
    /// The largest values of components: an orbit from which one goes on may have less.
    sizes: Vec<f64>,
    options: BranchOptions,
}

/// A branch over one parameter, at a value of the other one.
pub(super) struct LineBranch {
    /// Which of the two it is over.
    pub over: usize,
    /// The value of the other one.
    pub at: f64,
    pub branch: Branch,
}

/// Orbits from which branches begin, with which parameter they are over.
type Waiting = Vec<(usize, Orbit)>;

impl<'a> Cover<'a> {
    pub fn new(
        orbits: &'a Orbits,
        orbit: &Orbit,
        parameters: [usize; 2],
        window: [[f64; 2]; 2],
        options: &RegionOptions,
    ) -> Result<Self, OrbitError> {
        let lines = [0, 1].map(|k| {
            let [low, high] = window[k];
            let cells = options.cells;
            let part = |i: usize| low + (high - low) * i as f64 / cells as f64;
            let mut lines: Vec<f64> = (0..cells).map(part).collect();
            lines.extend([high, orbit.parameters[parameters[k]]]);
            lines.sort_by(f64::total_cmp);
            lines.dedup();
            lines
        });
        let (branches, lost) = (Vec::new(), Vec::new());
        let options = options.branch;
        let sizes = vec![0.0; orbits.system.components.len()];
        let mut cover = Self { orbits, parameters, window, branches, lost, lines, sizes, options };
        // The first branch has to begin.
        cover.branch(1, orbit)?;
        let mut waiting: Waiting = vec![(0, orbit.clone()), (1, orbit.clone())];
        while !waiting.is_empty() && cover.branches.len() < MOST_BRANCHES {
            waiting = cover.follow(waiting);
        }
        if !waiting.is_empty() {
            let places = waiting.iter().map(|(_, orbit)| cover.place(orbit));
            let places: Vec<Point> = places.collect();
            cover.lost.extend(places);
        }
        for orbit in cover.branches.iter().flat_map(|it| &it.branch.points) {
            for segment in &orbit.segments {
                enlarge(&mut cover.sizes, &segment.state);
            }
        }
        Ok(cover)
    }

    /// Where an orbit is in the plane.
    pub fn place(&self, orbit: &Orbit) -> Point {
        self.parameters.map(|k| orbit.parameters[k]).into()
    }

    fn branch(&self, over: usize, orbit: &Orbit) -> Result<Branch, OrbitError> {
        self.orbits.branch(orbit, self.parameters[over], self.window[over], &self.options)
    }

    /// Follows the branches of orbits that are not known, those of one line one after another, and
    /// returns the orbits where they meet other lines.
    fn follow(&mut self, waiting: Waiting) -> Waiting {
        let mut lines: Vec<((usize, u64), Vec<Orbit>)> = Vec::new();
        for (over, orbit) in waiting {
            let line = (over, orbit.parameters[self.parameters[1 - over]].to_bits());
            match lines.iter_mut().find(|(own, _)| *own == line) {
                Some((_, all)) => all.push(orbit),
                None => lines.push((line, vec![orbit])),
            }
        }
        let found = lines.into_par_iter().map(|((over, bits), waiting)| {
            let (at, mut own, mut next) = (f64::from_bits(bits), Vec::new(), Vec::new());
            let mut lost = Vec::new();
            for orbit in waiting {
                let all = self.branches.iter().chain(&own);
                let mut line = all.filter(|it| it.over == over && it.at.to_bits() == bits);
                let value = orbit.parameters[self.parameters[over]];
                let is_known =
                    line.any(|it| self.crossings(it, value).0.iter().any(|it| is_same(it, &orbit)));
                if is_known {
                    continue;
                }
                let Ok(branch) = self.branch(over, &orbit) else {
                    lost.push(self.place(&orbit));
                    continue;
                };
                let branch = LineBranch { over, at, branch };
                for value in &self.lines[over] {
                    let (all, complete) = self.crossings(&branch, *value);
                    next.extend(all.into_iter().map(|it| (1 - over, it)));
                    if complete.is_err() {
                        lost.push(self.place(&orbit));
                    }
                }
                own.push(branch);
            }
            (own, next, lost)
        });
        let found: Vec<_> = found.collect();
        let mut waiting = Vec::new();
        for (own, next, lost) in found {
            self.branches.extend(own);
            waiting.extend(next);
            self.lost.extend(lost);
        }
        waiting
    }

    /// The orbits of a branch at a value of its parameter, without verdicts, and whether these are
    /// all.
    fn crossings(&self, line: &LineBranch, value: f64) -> (Vec<Orbit>, Result<(), OrbitError>) {
        let place = self.parameters[line.over];
        let Branch { points, specials, closed, .. } = &line.branch;
        // Orbits in order, and whether the branch turns back there.
        let mut all: Vec<(&Orbit, bool)> = Vec::with_capacity(points.len() + specials.len());
        let mut rest = specials.iter().peekable();
        let known = |it: &'_ SpecialOrbit| it.kind == SpecialKind::Fold;
        for (k, orbit) in points.iter().enumerate() {
            while let Some(special) = rest.next_if(|it| it.behind <= k) {
                all.push((&special.orbit, known(special)));
            }
            all.push((orbit, false));
        }
        all.extend(rest.map(|it| (&it.orbit, known(it))));
        if *closed {
            all.extend(points.first().map(|it| (it, false)));
        }
        let of = |(orbit, _): (&Orbit, bool)| orbit.parameters[place];
        let (mut found, mut complete): (Vec<Orbit>, _) = (Vec::new(), Ok(()));
        for pair in all.windows(2) {
            let [low, high] = [of(pair[0]), of(pair[1])];
            if (low < value && high < value) || (low > value && high > value) || low == high {
                continue;
            }
            // Beside a fold the parameter goes as a square.
            let part = (value - low) / (high - low);
            let part = match (pair[0].1, pair[1].1) {
                (true, false) => part.sqrt(),
                (false, true) => 1.0 - (1.0 - part).sqrt(),
                _ => part,
            };
            let mut draft = mixed([pair[0].0, pair[1].0], part);
            draft.parameters[place] = value;
            draft.parameters[self.parameters[1 - line.over]] = line.at;
            match self.at(&draft) {
                Ok(orbit) if found.iter().any(|it| is_same(it, &orbit)) => {}
                Ok(orbit) => found.push(orbit),
                Err(error) => complete = Err(error),
            }
        }
        (found, complete)
    }

    /// The orbit near a draft, without a verdict.
    fn at(&self, draft: &Draft) -> Result<Orbit, OrbitError> {
        let Orbits { system, options, .. } = self.orbits;
        let equations = Equations::new(system, draft.clone(), &[], options)?;
        let zero = correct(&equations, &equations.place(draft), &[])?;
        let (found, evaluation) = (equations.draft(&zero.at), equations.at(&zero.at)?);
        Ok(Orbits::sketched(&equations, &found, &evaluation, zero.error))
    }

    /// All orbits above a point, without verdicts: from those on the lines around it.
    fn above(&self, point: &Point) -> Result<Vec<Orbit>, OrbitError> {
        let mut found: Vec<Orbit> = Vec::new();
        for line in &self.branches {
            let across = 1 - line.over;
            let target = point[across];
            let beside = &self.lines[across];
            let upper = beside.partition_point(|it| *it <= target);
            let around = &beside[upper.saturating_sub(1)..(upper + 1).min(beside.len())];
            if !around.contains(&line.at) {
                continue;
            }
            let (all, complete) = self.crossings(line, point[line.over]);
            complete?;
            for orbit in all {
                let own = self.travelled(&orbit, across, target)?;
                found.extend(own.filter(|own| !found.iter().any(|it| is_same(it, own))));
            }
        }
        Ok(found)
    }

    /// The orbit to which another one leads as a parameter goes to a value, if its branch does not
    /// turn back before.
    fn travelled(
        &self,
        orbit: &Orbit,
        over: usize,
        target: f64,
    ) -> Result<Option<Orbit>, OrbitError> {
        let parameter = self.parameters[over];
        let value = orbit.parameters[parameter];
        if value == target {
            return Ok(Some(orbit.clone()));
        }
        let Orbits { system, options, .. } = self.orbits;
        let (draft, [low, high]) = (orbit.draft(), self.window[over]);
        let active = [(parameter, high - low)];
        let equations = Equations::new(system, draft.clone(), &active, options)?;
        let equations = &equations.enlarged(&self.sizes);
        let range = [value.min(target), value.max(target)];
        let along = Along { judged: false, ..Along::new(self.orbits, equations, parameter, range) };
        let mut last = along.first(&draft)?;
        if (last.tangent[equations.count()] < 0.0) != (target < value) {
            last = last.turned();
        }
        let at_target = |place: &DVector<f64>| {
            let found = Draft { parameters: orbit.parameters.clone(), ..equations.draft(place) };
            let mut parameters = found.parameters.clone();
            parameters[parameter] = target;
            self.at(&Draft { parameters, ..found }).map(Some)
        };
        let unknown = equations.count();
        let mut step = self.options.first_step;
        for _ in 0..self.options.most_points {
            let next = match along.step(&last, step) {
                Ok(next) => next,
                Err(_) if 0.5 * step >= self.options.shortest_step => {
                    step *= 0.5;
                    continue;
                }
                Err(error) => return Err(error),
            };
            let ahead = [&last, &next].map(|point| point.tangent[unknown]);
            if (ahead[0] < 0.0) != (ahead[1] < 0.0) {
                // The branch turns back, before or behind the target.
                let length = last.tangent.dot(&(&next.place - &last.place));
                let turn = along.zero(&last, (length, ahead[0], ahead[1]), |point| {
                    Some(point.tangent[unknown])
                })?;
                let Some((_, turn)) = turn else { return Ok(None) };
                let [from, to] = [&last, &turn].map(|point| along.value(&point.place));
                let part = (target - from) / (to - from);
                if !(0.0..=1.0).contains(&part) {
                    return Ok(None);
                }
                let part = 1.0 - (1.0 - part).sqrt();
                return at_target(&last.place.lerp(&turn.place, part));
            }
            last = next;
            let at = along.value(&last.place);
            let near = 1e-12 * (target - value).abs();
            if (at - value).abs() <= near {
                return Ok(None);
            }
            if (at - target).abs() <= near {
                return at_target(&last.place);
            }
            step = (1.5 * step).min(self.options.longest_step);
        }
        Err(OrbitError::nowhere("the way to a point has too many steps"))
    }

    /// What the system follows at a point.
    pub fn label(&self, point: &Point) -> Result<FollowedOrbits, OrbitError> {
        let undecided = |reason: String| Err(OrbitError::Undecided(reason));
        let mut followed = Vec::new();
        for orbit in self.above(point)? {
            let draft = orbit.draft();
            let Orbits { system, options, .. } = self.orbits;
            let equations = Equations::new(system, draft, &[], options)?;
            match self.orbits.judged(&equations, &orbit)?.verdict {
                Verdict::Virtual(_) => continue,
                Verdict::Undecided(reason) => return undecided(reason),
                Verdict::Admissible => {}
            }
            let Some(multipliers) = &orbit.multipliers else {
                return undecided("a multiplier is infinite".to_owned());
            };
            let sizes: Vec<f64> = multipliers.iter().map(|[re, im]| re.hypot(*im)).collect();
            if sizes.iter().any(|size| (size - 1.0).abs() < ON_CIRCLE) {
                return undecided("a multiplier is on the unit circle".to_owned());
            }
            followed.push(sizes.iter().filter(|size| **size > 1.0).count());
        }
        followed.sort_unstable();
        Ok(FollowedOrbits(followed))
    }

    /// What the system follows at many points.
    pub fn labels(&self, points: &[Point]) -> Vec<Result<FollowedOrbits, OrbitError>> {
        points.par_iter().map(|point| self.label(point)).collect()
    }
}

/// The draft between two neighbours on a branch.
fn mixed(pair: [&Orbit; 2], part: f64) -> Draft {
    let [one, other] = pair.map(Orbit::draft);
    let mix = |x: f64, y: f64| x + part * (y - x);
    let all = |xs: &[f64], ys: &[f64]| xs.iter().zip(ys).map(|(x, y)| mix(*x, *y)).collect();
    let states = one.states.iter().zip(&other.states);
    Draft {
        parameters: all(&one.parameters, &other.parameters),
        start: mix(one.start, other.start),
        states: states.map(|(xs, ys)| all(xs, ys)).collect(),
        durations: all(&one.durations, &other.durations),
        legs: one.legs,
    }
}

/// Whether two orbits at one point are one.
pub(super) fn is_same(one: &Orbit, other: &Orbit) -> bool {
    are_near(one, other, SAME)
}

/// Whether states and durations differ by less than a part of their sizes, perhaps from another
/// segment on.
pub(super) fn are_near(one: &Orbit, other: &Orbit, part: f64) -> bool {
    let n = one.segments.first().map_or(0, |it| it.state.len());
    let mut sizes = vec![0.0_f64; n];
    for segment in &one.segments {
        enlarge(&mut sizes, &segment.state);
        enlarge(&mut sizes, &segment.end);
    }
    let m = one.segments.len();
    let near = |one: &Segment, other: &Segment, period: f64| {
        let states = one.state.iter().zip(&other.state).zip(&sizes);
        one.leg == other.leg
            && (one.duration - other.duration).abs() <= part * period
            && states.into_iter().all(|((x, y), size)| (x - y).abs() <= part * size)
    };
    let own = |i: usize, shift: usize| (&one.segments[i], &other.segments[(i + shift) % m]);
    m == other.segments.len()
        && (0..m).any(|shift| {
            (0..m).map(|i| own(i, shift)).all(|(segment, other)| near(segment, other, one.period))
        })
}
