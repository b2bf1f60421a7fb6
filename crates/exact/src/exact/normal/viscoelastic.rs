//! The normal motion with damping: Taylor series around nodes that are tabulated over the damping.
//!
//! In s, with dt = 2u ds, the equations u′ = v, v′ = −2u²q and t′ = 2u with q = u² + a v are
//! polynomials, and their solution is smooth from the start to the end of contact, whatever the
//! damping a. The root coordinate of a moment is the distance in s from the nearer end of contact.
//!
//! Source files in reading order: `series` is the expansion around a node, `nodes` the table, and
//! `extremes` and `search` what the decisions need.

mod extremes;
mod nodes;
mod search;
mod series;

use std::cell::{Cell, OnceCell};

use stickslip_contact::EnergyLedger;
use stickslip_contact::numerics::root::Jet;

use self::extremes::{Extremes, LARGEST_MAXIMUM};
use self::nodes::{Grid, MOST_NODES, Nodes, Scale, middle};
use self::series::{State, Strengths, coefficients};
use super::{along_root, root_between};
use crate::exact::moment::{At, Half, Moment, Motion, Spring};
use crate::exact::normal::{ORDER, StickPhase, Trajectory};
use crate::exact::slip::SlipPhase;

/// Orders of the series around a node.
///
/// Half of the distance to the next node is about a tenth of the distance within which the terms
/// do not grow.
const ORDERS: usize = 17;

/// The normal motion for one damping.
#[derive(Debug)]
pub struct Viscoelastic {
    damping: f64,
    scale: Scale,
    /// The contact's end in S.
    end: f64,
    /// The place S at which the halves meet: where half of V is gone, roughly.
    middle: f64,
    /// The time at which they meet.
    middle_time: f64,
    /// The duration of the contact.
    contact_time: f64,
    /// 1 − V at the end.
    impulse: f64,
    halves: [Pieces; 2],
    extremes: OnceCell<Option<Extremes>>,
}

/// Changes of \[U, V, Q, T\] from a node.
type Series = [[f64; 4]; ORDERS];

/// The pieces of one half of the contact, each around a node.
#[derive(Debug)]
struct Pieces {
    grid: Grid,
    /// The number of nodes in the half itself. One more may be beyond.
    inner: usize,
    nodes: [Place; MOST_NODES],
    /// The series around the nodes, computed when they are needed.
    series: Vec<OnceCell<Series>>,
}

/// What is known of a node.
#[derive(Clone, Copy, Debug)]
struct Place {
    state: State<f64>,
    /// |V − V₀| and time, from the end of contact to which the half belongs.
    deficit: f64,
    near_time: f64,
}

impl Pieces {
    fn empty() -> Self {
        let state = State { u: 0.0, v: 1.0, q: 0.0 };
        Self {
            grid: Grid::WEAK,
            inner: 0,
            nodes: [Place { state, deficit: 0.0, near_time: 0.0 }; MOST_NODES],
            series: (0..MOST_NODES).map(|_| OnceCell::new()).collect(),
        }
    }
}

/// The normal motion at a moment, in the units of the trajectory.
#[derive(Clone, Copy, Debug)]
pub struct NormalMotion {
    u: f64,
    v: f64,
    deficit: f64,
    near_time: f64,
    /// F, dF/dT and d²F/dT².
    force: f64,
    force_rate: f64,
    force_bend: f64,
}

impl Motion for NormalMotion {
    fn normal(&self) -> [f64; 3] {
        [self.u * self.u, self.v, self.force]
    }

    fn deficit(&self) -> f64 {
        self.deficit
    }

    fn limit(&self, spring: &Spring) -> f64 {
        self.force * spring.compliance
    }

    fn limit_rate(&self, spring: &Spring) -> f64 {
        self.force_rate * spring.compliance
    }

    fn pull(&self, spring: &Spring) -> f64 {
        self.force + self.force_bend * spring.compliance
    }
}

/// Calls `f` with the normal motion for the damping `a`, above 0 and below 2¹⁴.
///
/// Each thread keeps the last one: a map or an atlas has one damping, and a trajectory costs as
/// much as a collision. What it has expanded already changes no result.
pub fn with<R>(a: f64, f: impl FnOnce(&Viscoelastic) -> R) -> R {
    thread_local! {
        static LAST: Cell<Option<Box<Viscoelastic>>> = const { Cell::new(None) };
    }
    let mut path = LAST.take().unwrap_or_else(|| Box::new(Viscoelastic::empty()));
    if path.damping != a {
        path.prepare(a);
    }
    let result = f(&path);
    LAST.set(Some(path));
    result
}

impl Viscoelastic {
    /// A place for a trajectory, as yet of none.
    fn empty() -> Self {
        Self {
            damping: f64::NAN,
            scale: Scale::new(0.0, 0.0),
            end: 0.0,
            middle: 0.0,
            middle_time: 0.0,
            contact_time: 0.0,
            impulse: 0.0,
            halves: [Pieces::empty(), Pieces::empty()],
            extremes: OnceCell::new(),
        }
    }

    /// Makes this the trajectory for the damping `a`.
    fn prepare(&mut self, a: f64) {
        // What is kept belongs to no damping until all of it is there.
        self.damping = f64::NAN;
        let root = a.sqrt();
        let table = Nodes::of(root);
        let rows = table.at(root);
        let [end, contact_time, impulse, end_u] = rows[0];
        self.scale = Scale::new(root, a);
        let Strengths { alpha, beta } = self.scale.strengths;
        let end_v = if self.scale.strong { -alpha * (end_u * end_u) } else { 1.0 - impulse };
        let end_u = if self.scale.strong { end_u } else { (beta * -end_v / alpha).sqrt() };
        (self.end, self.contact_time, self.impulse) = (end, contact_time, impulse);
        self.middle = middle(self.scale.strong);
        let lengths = self.middle();
        let starts = [(1.0, -1.0, 0.0, beta), (end_v, 1.0, end_u, 0.0)];
        let mut rows = &rows[1..];
        for (index, half) in self.halves.iter_mut().enumerate() {
            let (grid, count) = (table.grids[index], table.counts[index]);
            let (first_v, sign, first_u, first_q) = starts[index];
            half.grid = grid;
            half.inner = grid.within(lengths[index]);
            let (mut deficit, mut near_time) = (0.0, 0.0);
            for (index, &[u, q, change, time]) in rows[..count].iter().enumerate() {
                // At both ends U and Q are known without a table. The first switch under a weak
                // damping and the last one depend on their digits.
                let (u, q) = if index == 0 { (first_u, first_q) } else { (u, q) };
                let rough = first_v + sign * deficit;
                let v = if self.scale.strong { q - alpha * (u * u) } else { rough };
                half.nodes[index] = Place { state: State { u, v, q }, deficit, near_time };
                deficit += change;
                near_time += time;
            }
            rows = &rows[count..];
            for series in &mut half.series[..count] {
                *series = OnceCell::new();
            }
        }
        self.extremes.take();
        // The halves meet at a node.
        let first = &self.halves[0];
        self.middle_time = first.nodes[first.grid.nearest(self.middle)].near_time;
        self.damping = a;
    }

    /// The pieces of a half.
    fn half(&self, half: Half) -> &Pieces {
        match half {
            Half::Compression => &self.halves[0],
            Half::Decompression => &self.halves[1],
        }
    }

    /// The moment at the place `s`.
    fn moment(&self, s: f64) -> Moment {
        if s <= self.middle {
            Moment { half: Half::Compression, root: s }
        } else {
            Moment { half: Half::Decompression, root: (self.end - s).max(0.0) }
        }
    }

    /// The place of `moment`.
    fn place(&self, moment: Moment) -> f64 {
        match moment.half {
            Half::Compression => moment.root,
            Half::Decompression => self.end - moment.root,
        }
    }
}

impl Trajectory for Viscoelastic {
    type Motion = NormalMotion;

    const STARTS_IN_SLIP: bool = false;
    const REFINES: bool = false;

    fn motion(&self, moment: Moment) -> NormalMotion {
        let pieces = self.half(moment.half);
        let index = pieces.grid.nearest(moment.root);
        let Place { state, deficit, near_time } = pieces.nodes[index];
        let sign = moment.half.sign();
        let distance = moment.root - pieces.grid.place(index);
        let [du, dv, dq, dt] = if distance == 0.0 {
            [0.0; 4]
        } else {
            let series =
                pieces.series[index].get_or_init(|| coefficients(&state, &self.scale.strengths));
            evaluate(series, sign * distance)
        };
        let (u, q) = (state.u + du, state.q + dq);
        let (deficit, near_time) = (deficit - sign * dv, near_time + sign * dt);
        let Strengths { alpha, beta } = self.scale.strengths;
        let v = if self.scale.strong { q - alpha * (u * u) } else { state.v + dv };
        let half = 0.5 / u;
        let (u2, vq) = (u * u, v * q);
        // F = UQ and dF/dT = F′/(2U); see PROOFS.md.
        let force_rate = half * vq + u * (alpha * v - beta * u * q);
        let bend = 2.0 * alpha * v * v
            - q * (u * q + 3.0 * beta * u * v + 2.0 * alpha * u * u2)
            - 2.0 * half * half * (v * vq)
            + 2.0 * beta * (u * u2) * (beta * u * q - alpha * v);
        NormalMotion { u, v, deficit, near_time, force: u * q, force_rate, force_bend: half * bend }
    }

    fn middle(&self) -> [f64; 2] {
        [self.middle, self.end - self.middle]
    }

    fn time_unit(&self) -> f64 {
        1.0 / (self.scale.factor * self.scale.factor)
    }

    fn energy(&self) -> EnergyLedger {
        let State { u, .. } = self.halves[1].nodes[0].state;
        let (normal_initial, v) = (0.5, self.restitution());
        let normal_final = 0.5 * v * v;
        let compression_left = 0.4 * self.scale.strengths.alpha * u * (u * u) * (u * u);
        // For a weak damping this is rounding, which may have either sign.
        let damping = (normal_initial - normal_final - compression_left).max(0.0);
        EnergyLedger {
            normal_initial,
            normal_final,
            damping,
            compression_left,
            ..EnergyLedger::default()
        }
    }

    fn restitution(&self) -> f64 {
        -self.halves[1].nodes[0].state.v
    }

    fn contact_time(&self) -> f64 {
        self.contact_time
    }

    fn impulse(&self) -> f64 {
        self.impulse
    }

    fn near_time(&self, at: &At<NormalMotion>) -> f64 {
        at.motion.near_time
    }

    fn elapsed(&self, from: &At<NormalMotion>, to: &At<NormalMotion>) -> f64 {
        let (first, last) = (from.motion.near_time, to.motion.near_time);
        match (from.moment.half, to.moment.half) {
            (Half::Compression, Half::Compression) => last - first,
            (Half::Decompression, Half::Decompression) => first - last,
            _ => self.time_left(from) - self.time_left(to),
        }
    }

    fn time_along_root(&self, at: &At<NormalMotion>) -> [f64; 2] {
        [at.moment.half.sign() * 2.0 * at.motion.u, 2.0 * at.motion.v]
    }

    fn after(&self, from: &At<NormalMotion>, duration: f64, slack: f64) -> Moment {
        self.shifted(from, duration, slack)
    }

    fn before(&self, until: &At<NormalMotion>, duration: f64, slack: f64) -> Moment {
        self.shifted(until, -duration, slack)
    }

    fn above(&self, force: f64, omega: f64) -> Option<[Moment; 2]> {
        // A few swings are followed sooner than the calm between them is found.
        const FEW: f64 = 6.0;
        let swings = omega * self.contact_time / std::f64::consts::PI;
        if swings < FEW { None } else { self.stronger_than(force) }
    }

    fn exit_after_impact(&self, spring: &Spring, psi: f64) -> Option<Moment> {
        // With V = 1 and t = U², D κ/U is β + αU² − κψU.
        let Strengths { alpha, beta } = self.scale.strengths;
        let pull = spring.kappa * psi;
        let square = pull * pull - 4.0 * alpha * beta;
        let root = 2.0 * beta / (pull + square.max(0.0).sqrt());
        (root < self.middle).then_some(Moment { half: Half::Compression, root })
    }

    fn last_time_at(&self, force: f64) -> Option<Moment> {
        // Near the end F falls at an even rate.
        let end = self.motion(Moment::END);
        let root = force / (-end.force_rate * 2.0 * end.u);
        (root < self.end - self.middle).then_some(Moment { half: Half::Decompression, root })
    }

    fn turns(&self, spring: &Spring) -> Option<[Moment; 2]> {
        if self.scale.strong || spring.kappa >= LARGEST_MAXIMUM {
            return None;
        }
        self.turns_between_nodes(spring).or_else(|| {
            let extremes = self.extremes.get_or_init(|| Extremes::of(self)).as_ref()?;
            extremes.turns(self, spring)
        })
    }

    /// With V constant, L is least where U is 1/√3 of that at the end; where U vanishes, L̇ is
    /// infinite, and from there on time would run back.
    fn beyond_end(&self) -> f64 {
        /// As far as the expansion is good.
        const FARTHEST: f64 = 0.05;
        /// The part of U that is lost, a little more than 1 − 1/√3.
        const PART: f64 = 0.45;
        let State { u, v, .. } = self.halves[1].nodes[0].state;
        FARTHEST.min(PART * u / -v)
    }

    fn split(&self) -> Moment {
        let extremes = self.extremes.get_or_init(|| Extremes::of(self));
        extremes.as_ref().map_or(Moment::START, |extremes| extremes.split(self))
    }

    fn meeting(&self, spring: &Spring, sliding: &SlipPhase, low: Moment, high: Moment) -> Moment {
        let (low, high, guess) = self.around_meeting(spring, sliding, low, high);
        root_between(self, low, high, guess, |at| -> Jet {
            let (guard, rate) = (sliding.guard(spring, at), -at.motion.pull(spring));
            along_root(self, at, guard, rate, 0.0)
        })
    }

    fn refined_exit(&self, _: &StickPhase, _: f64, end: Moment, _: f64) -> Moment {
        end
    }

    fn series_radius(&self, at: &At<NormalMotion>) -> f64 {
        // The nearest singularity is where U vanishes, and |V| ≤ 1.
        0.75 * at.motion.u * at.motion.u
    }

    /// From Ẋ = V, V̇ = −F, X = U² and F = U (αX + βV).
    fn force_series(&self, at: &At<NormalMotion>) -> [f64; ORDER] {
        let (alpha, beta) = (self.scale.strengths.alpha, self.scale.strengths.beta);
        let NormalMotion { u: root, v: speed, force, .. } = at.motion;
        let [mut u, mut x, mut v, mut q, mut f] = [[0.0; ORDER]; 5];
        (u[0], x[0], v[0], q[0], f[0]) = (root, root * root, speed, force / root, force);
        for n in 1..ORDER {
            let order = n as f64;
            x[n] = v[n - 1] / order;
            v[n] = -f[n - 1] / order;
            q[n] = alpha * x[n] + beta * v[n];
            let inner: f64 = (1..n).map(|j| u[j] * u[n - j]).sum();
            u[n] = (x[n] - inner) / (2.0 * root);
            f[n] = (0..=n).map(|j| u[j] * q[n - j]).sum();
        }
        f
    }
}

/// The value of a series without its constant term. Even and odd powers are summed separately: two
/// short dependency chains instead of a long one.
fn evaluate(series: &Series, s: f64) -> [f64; 4] {
    let s2 = s * s;
    let mut odd = series[ORDERS - 1];
    let mut even = series[ORDERS - 2];
    for k in (0..ORDERS / 2).rev() {
        for lane in 0..4 {
            odd[lane] = odd[lane] * s2 + series[2 * k][lane];
        }
        if k > 0 {
            for lane in 0..4 {
                even[lane] = even[lane] * s2 + series[2 * k - 1][lane];
            }
        }
    }
    std::array::from_fn(|lane| s * (odd[lane] + s * even[lane]))
}
