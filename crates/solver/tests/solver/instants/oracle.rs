//! What happens in a planted system, by exact arithmetic.
//!
//! At an instant, the pending crossings and the violated conditions act in the order of priority
//! and index. A run is cut off where the answer is not defined, or where the rounding of a run in
//! doubles could change it: two times are either equal, or differ by 64 roundings.
//!
//! What rounding makes of a run is followed as sums of independent sources, so that errors that
//! two components have in common cancel in the difference of two times.

use stickslip_solver::Direction;

use super::planted::{Exact, G, LINEAR, Planted, Reset, UNIT, double, times};

/// A guard acts, or is preempted.
#[derive(Clone, Debug, PartialEq)]
pub struct Act {
    pub s: Exact,
    pub guard: usize,
    pub from: usize,
    /// The mode and the state that follow, or none if the guard is preempted.
    pub then: Option<(usize, [Exact; LINEAR])>,
    /// Whether nothing changes.
    pub idle: bool,
    /// Bounds for the errors of the time and of the state.
    pub error: (f64, [f64; LINEAR]),
}

/// What makes the cases hard, counted.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    pub instants: usize,
    /// Instants at which several guards act.
    pub shared: usize,
    /// The largest number of guards that act at one.
    pub most: usize,
    /// Crossings that find themselves in a mode without their guard.
    pub preempted: usize,
    /// Conditions that are not violated any more when it is their turn.
    pub dismissed: usize,
    /// Conditions that another guard's transition violates.
    pub violated: usize,
    /// Crossings by jumps.
    pub jumps: usize,
    /// Events at the start and at the end of the run.
    pub at_start: usize,
    pub at_end: usize,
    /// Successive times that are closer than 1e-9, and closer than 1e-12, as parts of the scale.
    pub close: usize,
    pub closest: usize,
}

/// What happens in a run up to `end`.
#[derive(Clone, Debug)]
pub struct Plan {
    pub acts: Vec<Act>,
    pub end: Exact,
    /// The guard that ends the run.
    pub terminal: Option<usize>,
    pub mode: usize,
    pub state: [Exact; LINEAR],
    pub error: [f64; LINEAR],
    pub counts: Counts,
}

const ROUNDING: f64 = f64::EPSILON;

/// A sum of independent errors.
type Errors = Vec<f64>;

fn combine(sum: &mut Errors, factor: f64, other: &Errors) {
    if sum.len() < other.len() {
        sum.resize(other.len(), 0.0);
    }
    for (sum, other) in sum.iter_mut().zip(other) {
        *sum += factor * other;
    }
}

fn bound(errors: &Errors) -> f64 {
    errors.iter().map(|error| error.abs()).sum()
}

/// The exact state of a run, and its errors.
#[derive(Clone)]
struct Walk<'a> {
    planted: &'a Planted,
    s: Exact,
    mode: usize,
    y: [Exact; LINEAR],
    errors: [Errors; LINEAR],
    /// The number of independent errors so far.
    sources: usize,
    counts: Counts,
}

/// Why the plan goes no further.
enum Stop {
    /// It is not known what happens from here on.
    Here,
    /// The run ends.
    Terminal(usize),
}

impl Walk<'_> {
    fn form(&self, guard: usize) -> Option<(Exact, i128)> {
        let function = &self.planted.functions[self.planted.uses[self.mode][guard]?];
        let value = function.form(self.s, &self.y);
        Some((value, function.slope(&self.planted.slopes[self.mode])))
    }

    fn is_clock(&self, guard: usize) -> bool {
        self.planted.kinds.get(guard).is_some_and(|kind| kind.clock.is_some())
    }

    fn active(&self) -> impl Iterator<Item = usize> + use<> {
        let uses = self.planted.uses[self.mode];
        (0..G).filter(move |&guard| uses[guard].is_some())
    }

    /// The errors of the time at which a guard vanishes that vanishes now, and the size of its own
    /// rounding.
    fn time_errors(&self, guard: usize) -> Option<(Errors, f64)> {
        let s = double(self.s).abs();
        if self.is_clock(guard) {
            return Some((Vec::new(), ROUNDING * s));
        }
        let function = &self.planted.functions[self.planted.uses[self.mode][guard]?];
        let slope = function.slope(&self.planted.slopes[self.mode]) as f64 / 4.0;
        let mut errors = Vec::new();
        for i in 0..LINEAR {
            combine(&mut errors, -f64::from(function.components[i]) / slope, &self.errors[i]);
        }
        // Functions that are not linear have rounding errors of 8ε or 4ε of their own.
        let own = ROUNDING * ((function.size(self.s, &self.y) + 8.0) / slope.abs() + s);
        Some((errors, own))
    }

    /// Whether errors of the time and the state may move a guard by more than its own rounding.
    fn is_moved(&self, guard: usize, time: f64) -> bool {
        let Some(function) = self.planted.uses[self.mode][guard] else { return false };
        let function = &self.planted.functions[function];
        let mut errors = Vec::new();
        for i in 0..LINEAR {
            combine(&mut errors, f64::from(function.components[i]), &self.errors[i]);
        }
        let moved = bound(&errors) + f64::from(function.time).abs() * time;
        moved > ROUNDING * function.size(self.s, &self.y)
    }

    /// Whether a guard is the negative of what it is in another mode.
    fn is_negative(&self, mode: usize, guard: usize) -> bool {
        let of = |mode: usize| {
            let function = &self.planted.functions[self.planted.uses[mode][guard]?];
            Some((function.components, function.time, function.level))
        };
        let negated = of(mode).map(|(y, s, level)| (y.map(|factor| -factor), -s, -level));
        of(self.mode) == negated
    }

    fn source(&mut self, component: usize, size: f64) {
        let errors = &mut self.errors[component];
        errors.resize(self.sources + 1, 0.0);
        errors[self.sources] = size;
        self.sources += 1;
    }

    /// The time until a guard fires from a value that is not zero.
    fn until(&self, guard: usize) -> Result<Option<Exact>, Stop> {
        if let Some(clock) = &self.planted.kinds[guard].clock {
            let next = clock.iter().find(|time| **time > self.s);
            return Ok(next.map(|time| time - self.s));
        }
        let Some((value, slope)) = self.form(guard) else { return Ok(None) };
        if value == 0 || slope == 0 || (value > 0) == (slope > 0) {
            return Ok(None);
        }
        let fires = match self.planted.kinds[guard].direction {
            Direction::Rising => value < 0,
            Direction::Either => true,
            _ => value > 0,
        };
        let product = value.checked_mul(-4).ok_or(Stop::Here)?;
        match (fires, product % slope) {
            (false, _) => Ok(None),
            (true, 0) => Ok(Some(product / slope)),
            (true, _) => Err(Stop::Here),
        }
    }

    /// About the time until a guard fires, at most 1.
    fn free_time(&self) -> f64 {
        let mut time = 1.0_f64;
        for guard in self.active() {
            if let Some(clock) = &self.planted.kinds[guard].clock {
                let next = clock.iter().find(|time| **time > self.s);
                time = next.map_or(time, |next| time.min(double(next - self.s)));
            } else if let Some((value, slope)) = self.form(guard)
                && slope != 0
            {
                let there = -4.0 * double(value) / slope as f64;
                time = if there > 0.0 { time.min(there) } else { time };
            }
        }
        time
    }

    fn move_by(&mut self, time: Exact) -> Option<()> {
        for i in 0..LINEAR {
            self.y[i] += times(time, i128::from(self.planted.slopes[self.mode][i]))?;
        }
        self.s += time;
        Some(())
    }

    /// Whether a guard is zero or clearly not, in units of time by `slope`.
    fn is_clear(&self, value: Exact, slope: i128, guard: usize, errors: f64) -> bool {
        let function = &self.planted.functions[self.planted.uses[self.mode][guard].unwrap_or(0)];
        let size = function.size(self.s, &self.y) + 8.0;
        // Of the slopes that follow, none is above 4.
        let slope = (slope as f64 / 4.0).abs();
        let own = ROUNDING * (size + (slope + 4.0) * double(self.s).abs());
        value == 0 || double(value).abs() >= 64.0 * own + 8.0 * (slope + 4.0) * errors
    }

    /// The guards that fire first, and the time until then. Every other guard stays clearly away
    /// from zero there.
    fn advance(&mut self) -> Result<(Vec<usize>, Errors, f64), Stop> {
        let mut first: Option<Exact> = None;
        for guard in self.active() {
            if let Some(time) = self.until(guard)? {
                first = Some(first.map_or(time, |first| first.min(time)));
            }
        }
        let time = first.ok_or(Stop::Here)?;
        let scale = double(self.s).abs() + 1.0;
        self.counts.close += usize::from(double(time) < 1e-9 * scale);
        self.counts.closest += usize::from(double(time) < 1e-12 * scale);
        let mut firing = Vec::new();
        for guard in self.active() {
            if self.until(guard)? == Some(time) {
                firing.push(guard);
            }
        }
        for i in 0..LINEAR {
            let slope = f64::from(self.planted.slopes[self.mode][i]) / 4.0;
            let size = double(self.y[i]).abs() + slope.abs() * double(time);
            self.source(i, ROUNDING * size);
        }
        self.move_by(time).ok_or(Stop::Here)?;
        let (errors, own) = self.time_errors(firing[0]).ok_or(Stop::Here)?;
        let mut largest = own;
        for guard in self.active() {
            if firing.contains(&guard) {
                let (other, other_own) = self.time_errors(guard).ok_or(Stop::Here)?;
                let mut difference = errors.clone();
                combine(&mut difference, -1.0, &other);
                largest = largest.max(other_own);
                if bound(&difference) > 4.0 * (own + other_own) {
                    return Err(Stop::Here);
                }
            } else if !self.is_clock(guard)
                && let Some((value, slope)) = self.form(guard)
            {
                // Crossings that do not fire count as well, since slopes may turn here.
                let uncertain = match self.time_errors(guard) {
                    Some((mut other, _)) if slope != 0 => {
                        combine(&mut other, -1.0, &errors);
                        bound(&other)
                    }
                    _ => bound(&errors),
                };
                if !self.is_clear(value, slope, guard, uncertain) || (value == 0 && slope == 0) {
                    return Err(Stop::Here);
                }
            }
        }
        for (guard, kind) in self.planted.kinds.iter().enumerate() {
            // A clock that is not active here may be so right behind this place.
            let fires = firing.contains(&guard);
            let near = |time: &Exact| {
                let gap = double(*time - self.s).abs();
                gap < 64.0 * largest + 8.0 * bound(&errors) && !(fires && gap == 0.0)
            };
            if kind.clock.iter().flatten().any(near) {
                return Err(Stop::Here);
            }
        }
        Ok((firing, errors, largest))
    }

    /// The crossings that are facts at the start.
    fn at_start(&self) -> Result<Vec<usize>, Stop> {
        let mut firing = Vec::new();
        for guard in self.active().filter(|&guard| !self.is_clock(guard)) {
            let Some((value, slope)) = self.form(guard) else { continue };
            if value == 0 && slope == 0 || !self.is_clear(value, slope, guard, 0.0) {
                return Err(Stop::Here);
            }
            if value == 0 && self.leaves(guard, slope) {
                firing.push(guard);
            }
        }
        Ok(firing)
    }

    /// Whether a guard that is zero leaves zero in its direction.
    fn leaves(&self, guard: usize, slope: i128) -> bool {
        match self.planted.kinds[guard].direction {
            Direction::Rising => slope > 0,
            Direction::Either => slope != 0,
            _ => slope < 0,
        }
    }

    /// Lets everything act that happens at this instant.
    fn act(
        &mut self,
        firing: &[usize],
        (delay, own): (&Errors, f64),
        acts: &mut Vec<Act>,
    ) -> Result<(), Stop> {
        let planted = self.planted;
        let kinds = &planted.kinds;
        let (old, before) = (self.mode, self.errors.clone());
        let slopes = |mode: usize, i: usize| f64::from(planted.slopes[mode][i]) / 4.0;
        // How the state after the instant depends on that before it.
        let mut linear = [[0.0; LINEAR]; LINEAR];
        for (i, row) in linear.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        let mut pending: Vec<usize> =
            firing.iter().copied().filter(|&guard| kinds[guard].is_edge()).collect();
        let mut conditions: Vec<usize> =
            firing.iter().copied().filter(|&guard| !kinds[guard].is_edge()).collect();
        // The mode in which each pending guard has crossed.
        let mut crossed = [old; G];
        let mut done = Vec::new();
        let mut zeros = [true; G];
        let (begin, mut count) = (acts.len(), 0);
        loop {
            let mut candidates = pending.clone();
            for guard in self.active().filter(|&guard| !kinds[guard].is_edge()) {
                let Some((value, slope)) = self.form(guard) else { continue };
                if value == 0 && slope == 0 {
                    return Err(Stop::Here);
                }
                // Rounding so far may put it on the other side where it has not crossed now.
                let moved = self.is_moved(guard, bound(delay) + own);
                if value == 0 && !conditions.contains(&guard) && moved {
                    return Err(Stop::Here);
                }
                let errors = bound(delay) + own;
                if !self.is_clear(value, slope, guard, errors) {
                    return Err(Stop::Here);
                }
                if value < 0 || (value == 0 && slope < 0) {
                    // What a reset puts exactly on the limit acts now or a rounding later.
                    if done.contains(&guard) || value == 0 && !conditions.contains(&guard) {
                        return Err(Stop::Here);
                    }
                    candidates.push(guard);
                }
            }
            let rank = |guard: &usize| (-i32::from(kinds[*guard].priority), *guard);
            let Some(guard) = candidates.iter().copied().min_by_key(rank) else { break };
            pending.retain(|&other| other != guard);
            let from = self.mode;
            let there = planted.uses[from][guard];
            if kinds[guard].is_edge() && there != planted.uses[crossed[guard]][guard] {
                // A run can only tell that a function is another one by its value.
                if there.is_some() && self.form(guard).is_none_or(|(value, _)| value == 0) {
                    return Err(Stop::Here);
                }
                self.counts.preempted += 1;
                done.push(guard);
                let error = (0.0, [0.0; LINEAR]);
                acts.push(Act { s: self.s, guard, from, then: None, idle: false, error });
                continue;
            }
            if !kinds[guard].is_edge() && !conditions.contains(&guard) {
                self.counts.violated += 1;
            }
            conditions.retain(|&other| other != guard);
            done.push(guard);
            count += 1;
            if kinds[guard].terminal {
                let then = Some((from, self.y));
                acts.push(Act {
                    s: self.s,
                    guard,
                    from,
                    then,
                    idle: false,
                    error: (0.0, [0.0; LINEAR]),
                });
                self.finish(acts, begin, &linear, (old, &before), (delay, own), &slopes);
                return Err(Stop::Terminal(guard));
            }
            let forms: [_; G] = std::array::from_fn(|guard| self.form(guard));
            let y = self.y;
            self.y = planted.after(from, guard, &y).ok_or(Stop::Here)?;
            self.mode = planted.transitions[from][guard].to;
            let rows = linear;
            for (i, reset) in planted.transitions[from][guard].resets.iter().enumerate() {
                linear[i] = match *reset {
                    Reset::Keep | Reset::Add(_) => rows[i],
                    Reset::Set(_) => [0.0; LINEAR],
                    Reset::Halves(halves) => rows[i].map(|row| 0.5 * f64::from(halves) * row),
                    Reset::Take(other) => rows[other],
                };
            }
            let idle = self.mode == from && self.y == y;
            let moves = |i: usize| (self.y[i] - y[i]).abs() >= UNIT >> 30;
            if !idle && self.mode == from && !(0..LINEAR).any(moves) {
                // Rounding hides whether it changes anything.
                return Err(Stop::Here);
            }
            let then = Some((self.mode, self.y));
            acts.push(Act { s: self.s, guard, from, then, idle, error: (0.0, [0.0; LINEAR]) });
            for other in self.active() {
                if self.is_clock(other) {
                    continue;
                }
                let Some((value, slope)) = self.form(other) else { continue };
                if !self.is_clear(value, slope, other, bound(delay) + own) {
                    return Err(Stop::Here);
                }
                let same = planted.uses[from][other] == planted.uses[self.mode][other];
                let earlier = forms[other].filter(|_| same).map(|(value, _)| value);
                if other == guard {
                    continue;
                }
                // A reset to exactly zero is not defined for edge guards.
                if value == 0 && earlier != Some(0) {
                    zeros[other] = false;
                }
                let acted = done.contains(&other) && zeros[other];
                let known = !kinds[other].is_edge() || pending.contains(&other) || acted;
                if value == 0 && !known && self.leaves(other, slope) {
                    return Err(Stop::Here);
                }
                if !kinds[other].is_edge() || !kinds[other].sees_jumps {
                    continue;
                }
                if !same {
                    // To a run, the negative of a guard is the same guard.
                    if forms[other].is_some() && self.is_negative(from, other) {
                        return Err(Stop::Here);
                    }
                    continue;
                }
                let earlier = earlier.unwrap_or(0);
                if earlier == value {
                    continue;
                }
                if earlier == 0 || value == 0 {
                    return Err(Stop::Here);
                }
                let jumps = match kinds[other].direction {
                    Direction::Rising => earlier < 0 && value > 0,
                    Direction::Either => (earlier < 0) != (value < 0),
                    _ => earlier > 0 && value < 0,
                };
                if jumps {
                    if done.contains(&other) || pending.contains(&other) {
                        return Err(Stop::Here);
                    }
                    self.counts.jumps += 1;
                    crossed[other] = self.mode;
                    pending.push(other);
                }
            }
        }
        self.counts.dismissed += conditions.len();
        // What is zero when the instant is over.
        for guard in self.active().filter(|&guard| !self.is_clock(guard)) {
            let Some((value, slope)) = self.form(guard) else { continue };
            if value != 0 {
                continue;
            }
            let function = planted.uses[self.mode][guard];
            let acted = acts[begin..].iter().any(|act| {
                let same = planted.uses[act.from][guard] == function;
                act.guard == guard && act.then.is_some() && same
            });
            let defined = if kinds[guard].is_edge() {
                !self.leaves(guard, slope) || (acted && zeros[guard])
            } else {
                slope > 0
            };
            if slope == 0 || !defined {
                return Err(Stop::Here);
            }
        }
        self.counts.instants += usize::from(count > 0);
        self.counts.shared += usize::from(count > 1);
        self.counts.most = self.counts.most.max(count);
        self.finish(acts, begin, &linear, (old, &before), (delay, own), &slopes);
        Ok(())
    }

    /// Sets the errors after an instant.
    fn finish(
        &mut self,
        acts: &mut [Act],
        begin: usize,
        linear: &[[f64; LINEAR]; LINEAR],
        (old, before): (usize, &[Errors; LINEAR]),
        (delay, own): (&Errors, f64),
        slopes: &impl Fn(usize, usize) -> f64,
    ) {
        let late = self.sources;
        self.sources += 1;
        for i in 0..LINEAR {
            let mut errors = Vec::new();
            let mut turn = -slopes(self.mode, i);
            for j in 0..LINEAR {
                combine(&mut errors, linear[i][j], &before[j]);
                turn += linear[i][j] * slopes(old, j);
            }
            combine(&mut errors, turn, delay);
            errors.resize(late + 1, 0.0);
            errors[late] += 2.0 * own * turn;
            self.errors[i] = errors;
        }
        let time = bound(delay) + 2.0 * own;
        // Within the instant, slopes are at most 4.
        let state = self.errors.clone().map(|errors| bound(&errors) + 8.0 * time);
        for act in &mut acts[begin..] {
            act.error = (time, state);
        }
    }
}

impl Plan {
    /// The plan of a system up to at most `most` instants, or none if nothing happens whose answer
    /// is defined.
    pub fn new(planted: &Planted, most: usize, random: &mut fastrand::Rng) -> Option<Self> {
        let (s, mode, y) = planted.start;
        let errors: [Errors; LINEAR] = std::array::from_fn(|_| Vec::new());
        let counts = Counts::default();
        let mut walk = Walk { planted, s, mode, y, errors, sources: 0, counts };
        let mut acts = Vec::new();
        let firing = walk.at_start().ok()?;
        let mut stop = walk.act(&firing, (&Vec::new(), 0.0), &mut acts);
        if matches!(stop, Err(Stop::Here)) {
            return None;
        }
        walk.counts.at_start = acts.len();
        // What has been confirmed, with the time up to which nothing else happens.
        let mut good = None;
        for _ in 0..most {
            if let Err(Stop::Terminal(guard)) = stop {
                return Some(Self::ends(&walk, acts, walk.s, Some(guard)));
            }
            let here = walk.clone();
            let before = here.s;
            let known = acts.len();
            // The run may end between two instants that are far from each other.
            let middle = (0.5 * here.free_time() * 1_048_576.0).floor() as i128 * (UNIT >> 20);
            if middle > 0 {
                good = Some((here, known, middle));
            }
            let Ok((firing, delay, own)) = walk.advance() else { break };
            stop = walk.act(&firing, (&delay, own), &mut acts);
            if matches!(stop, Err(Stop::Here)) {
                acts.truncate(known);
                break;
            }
            // Or at an instant whose time is a double.
            if acts.len() > known
                && stop.is_ok()
                && random.f64() < 0.05
                && walk.s % (UNIT >> 40) == 0
                && bound(&delay) < 4.0 * own
                // Within the instant before, rounding of a guard hides that it goes anywhere.
                && walk.s - before > UNIT >> 20
            {
                let mut plan = Self::ends(&walk, acts.clone(), walk.s, None);
                plan.counts.at_end = acts.len() - known;
                return Some(plan);
            }
        }
        let (mut walk, known, time) = good?;
        acts.truncate(known);
        walk.move_by(time)?;
        (!acts.is_empty()).then(|| Self::ends(&walk, acts, walk.s, None))
    }

    fn ends(walk: &Walk, acts: Vec<Act>, end: Exact, terminal: Option<usize>) -> Self {
        let error = walk.errors.clone().map(|errors| bound(&errors));
        let Walk { mode, y: state, counts, .. } = *walk;
        Self { acts, end, terminal, mode, state, error, counts }
    }
}
