//! Twice the digits for collisions near a graze.
//!
//! Where a guard crosses zero with a small slope, an error δ of the state moves the switch by δ
//! divided by that slope: at a relative distance d from a graze, switch times are less accurate
//! than the state by 1/√d. The integrator has already decided which switches there are. Here a
//! Taylor method with [`DoubleDouble`] numbers follows the same itinerary once more. Its errors are
//! near 1e-21, so that times are accurate to rounding.

use smallvec::SmallVec;
use stickslip_contact::numerics::double_double::DoubleDouble;
use stickslip_contact::phase::Phase;
use stickslip_contact::regularized::{Regularized, STATE};
use stickslip_contact::{Collision, Contact, EnergyLedger, FEW_SWITCHES, Regime, Side};
use stickslip_solver::{EmbeddedPair, Observer, Options, Start, SwitchEvent, run_with};

/// Degree of the Taylor series.
const DEGREE: usize = 24;
/// Size of the first terms that a step neglects.
const TOLERANCE: f64 = 1e-22;

/// Number of phases up to which nothing is allocated.
const PHASES: usize = FEW_SWITCHES + 1;
/// Phases with their lengths in s.
type Phases = SmallVec<[(Phase, f64); PHASES]>;

/// Replaces times, states, restitution and energies of `collision`, except the energy taken by
/// damping, by values computed with twice the digits.
///
/// Returns false and changes nothing if Newton's method leaves the neighbourhood of a switch that
/// the integrator found.
pub(crate) fn refine(pair: EmbeddedPair, options: &Options, collision: &mut Collision) -> bool {
    let contact = collision.contact;
    let Some(phases) = phases(pair, options, contact) else { return false };
    let mut state = FineState::start(contact);
    let mut sliding = ZERO;
    let mut ends = SmallVec::<[FineState; PHASES]>::new();
    for (index, (phase, length)) in phases.iter().enumerate() {
        let exit = phases.get(index + 1).map(|(next, _)| *next);
        let Some(end) = state.follow(contact, *phase, exit, *length) else { return false };
        if phase.regime == Regime::Slip {
            sliding = sliding.plus(state.slid(&end, contact, phase.side));
        }
        state = end.enter(contact, *phase, exit);
        ends.push(end);
    }
    let (Some(last), Some((phase, _))) = (ends.last().copied(), phases.last()) else {
        return false;
    };
    let spring = last.spring(contact, *phase).nearest();
    // The last of the phases ends with the contact. After these switches there may be others that
    // are too short for the integrator.
    let switched = &ends[..ends.len() - 1];
    let mut time = DoubleDouble(0.0, 0.0);
    for (switch, end) in collision.switches.iter_mut().zip(switched) {
        time = time.plus(end.t);
        switch.time = time.nearest();
        switch.velocity = end.w.nearest();
    }
    collision.contact_time = time.plus(last.t).nearest();
    let mut left = last.t;
    let ended = collision.switches.iter_mut().zip(switched).zip(&phases);
    for ((switch, end), (phase, _)) in ended.rev() {
        switch.time_left = left.nearest();
        left = left.plus(end.t);
        switch.spring = end.spring(contact, *phase).nearest();
    }
    collision.eps_n = -last.v.nearest();
    collision.final_velocity = last.w.nearest();
    collision.energy = EnergyLedger {
        tangential_final: 0.5 * collision.final_velocity * collision.final_velocity,
        sliding: sliding.nearest(),
        spring_left: 0.5 * contact.kappa() * spring * spring,
        normal_final: 0.5 * collision.eps_n * collision.eps_n,
        compression_left: 0.4 * last.u.nearest().max(0.0).powi(5),
        ..collision.energy
    };
    true
}

/// The phases that the integrator finds, with their lengths in s.
fn phases(pair: EmbeddedPair, options: &Options, contact: Contact) -> Option<Phases> {
    /// Records phases with their lengths, and where the last one ended.
    #[derive(Default)]
    struct Itinerary(Phases, f64);

    impl Observer<Phase, STATE> for Itinerary {
        fn on_switch(&mut self, event: &SwitchEvent<Phase, STATE>) {
            self.0.push((event.from, event.s - self.1));
            self.1 = event.s;
        }
    }

    let system = Regularized::new(contact);
    let start = Start { mode: Phase::first(&contact), s: 0.0, state: system.start() };
    let mut itinerary = Itinerary::default();
    let _ = run_with(pair, &system, start, f64::INFINITY, options, &mut itinerary).ok()?;
    Some(itinerary.0)
}

/// The contact at one moment: u, v, velocity w, spring y (in stick only) and the time t since the
/// phase began.
#[derive(Clone, Copy, Debug)]
struct FineState {
    u: DoubleDouble,
    v: DoubleDouble,
    w: DoubleDouble,
    y: DoubleDouble,
    t: DoubleDouble,
}

const ZERO: DoubleDouble = DoubleDouble(0.0, 0.0);

impl FineState {
    fn start(contact: Contact) -> Self {
        Self {
            u: ZERO,
            v: DoubleDouble(1.0, 0.0),
            w: DoubleDouble(contact.psi(), 0.0),
            y: ZERO,
            t: ZERO,
        }
    }

    /// F = u(u² + a v).
    fn force(&self, contact: Contact) -> DoubleDouble {
        self.u.times(self.end_guard(contact))
    }

    /// u² + a v.
    fn end_guard(&self, contact: Contact) -> DoubleDouble {
        self.u.times(self.u).plus(self.v.scaled(contact.damping()))
    }

    /// dF/ds = u(2u v + a v') + v(u² + a v).
    fn force_slope(&self, contact: Contact) -> DoubleDouble {
        let deceleration = self.u.times(self.force(contact)).scaled(-2.0);
        let inner = self.u.times(self.v).scaled(2.0).plus(deceleration.scaled(contact.damping()));
        self.u.times(inner).plus(self.v.times(self.end_guard(contact)))
    }

    fn spring(&self, contact: Contact, phase: Phase) -> DoubleDouble {
        match phase.regime {
            Regime::Slip => {
                let limit = self.force(contact).over(DoubleDouble(contact.kappa(), 0.0));
                limit.scaled(phase.side.sign())
            }
            Regime::Stick => self.y,
        }
    }

    /// Energy taken by sliding on `side` from here to `end`: ∫ F (s w − dL/dt) dt, with F dt = −dv.
    fn slid(&self, end: &Self, contact: Contact, side: Side) -> DoubleDouble {
        let slowed = self.v.minus(end.v);
        let mean = self.w.scaled(side.sign()).minus(slowed.scaled(0.5));
        let [force, end_force] = [self, end].map(|moment| moment.force(contact));
        let stored = end_force.times(end_force).minus(force.times(force)).scaled(0.5);
        slowed.times(mean).minus(stored.over(DoubleDouble(contact.kappa(), 0.0)))
    }

    /// The function that vanishes where `phase` changes into `exit`, or where the contact ends.
    fn guard(&self, contact: Contact, phase: Phase, exit: Option<Phase>) -> DoubleDouble {
        let kappa = contact.kappa();
        match exit {
            None if contact.damping() > 0.0 => self.end_guard(contact),
            None => self.u,
            Some(next) if next.regime == Regime::Slip => {
                self.force(contact).minus(self.y.scaled(next.side.sign()).scaled(kappa))
            }
            Some(_) => {
                let pull = self.w.scaled(phase.side.sign()).scaled(kappa);
                pull.times(self.u).scaled(2.0).minus(self.force_slope(contact))
            }
        }
    }

    /// The state after the switch that ends `phase`.
    fn enter(&self, contact: Contact, phase: Phase, exit: Option<Phase>) -> Self {
        let y = match exit {
            Some(next) if next.regime == Regime::Stick => self.spring(contact, phase),
            _ => ZERO,
        };
        Self { y, t: ZERO, ..*self }
    }

    /// Follows `phase` from here to its end, which is about `length` away.
    fn follow(
        &self,
        contact: Contact,
        phase: Phase,
        exit: Option<Phase>,
        length: f64,
    ) -> Option<Self> {
        let mut series = Series::new(contact, phase, self);
        let mut left = length;
        loop {
            let h = series.reach();
            if left <= h {
                return series.guard_zero(contact, phase, exit, left);
            }
            let next = series.at(h);
            left -= h;
            series = Series::new(contact, phase, &next);
        }
    }
}

/// The Taylor series of the state in s.
struct Series {
    side: Option<Side>,
    start: FineState,
    u: [DoubleDouble; DEGREE + 1],
    v: [DoubleDouble; DEGREE + 1],
    w: [DoubleDouble; DEGREE + 1],
    y: [DoubleDouble; DEGREE + 1],
}

impl Series {
    fn new(contact: Contact, phase: Phase, start: &FineState) -> Self {
        let side = (phase.regime == Regime::Slip).then_some(phase.side);
        let blank = [ZERO; DEGREE + 1];
        let mut series = Self { side, start: *start, u: blank, v: blank, w: blank, y: blank };
        (series.u[0], series.v[0], series.w[0], series.y[0]) = (start.u, start.v, start.w, start.y);
        // uu = u², f = u² + a v.
        let (mut uu, mut f) = (blank, blank);
        for k in 0..DEGREE {
            uu[k] = product(&series.u, &series.u, k);
            f[k] = uu[k].plus(series.v[k].scaled(contact.damping()));
            let next = DoubleDouble((k + 1) as f64, 0.0);
            series.u[k + 1] = series.v[k].over(next);
            series.v[k + 1] = product(&uu, &f, k).scaled(-2.0).over(next);
            if side.is_none() {
                let rate = product(&series.u, &series.y, k).scaled(-2.0).scaled(contact.kappa());
                series.y[k + 1] = product(&series.u, &series.w, k).scaled(2.0).over(next);
                series.w[k + 1] = rate.over(next);
            }
        }
        series
    }

    /// The step at which the last six terms are below the tolerance. Fewer would not do: at the
    /// start of contact only every fifth term differs from 0.
    fn reach(&self) -> f64 {
        (DEGREE - 5..=DEGREE).fold(1.0, |reach: f64, k| {
            let size = |terms: &[DoubleDouble; DEGREE + 1]| terms[k].0.abs();
            let largest = size(&self.u).max(size(&self.v)).max(size(&self.w)).max(size(&self.y));
            reach.min((TOLERANCE / largest.max(f64::MIN_POSITIVE)).powf(1.0 / k as f64))
        })
    }

    /// The state at a distance `h` from the start of the series.
    fn at(&self, h: f64) -> FineState {
        let (u, v) = (value(&self.u, h), value(&self.v, h));
        let (w, y) = match self.side {
            // s w − v is constant while sliding.
            Some(side) => (self.start.w.plus(v.minus(self.start.v).scaled(side.sign())), ZERO),
            None => (value(&self.w, h), value(&self.y, h)),
        };
        // t' = 2u, integrated term by term.
        let t = (0..DEGREE)
            .rev()
            .fold(ZERO, |sum, k| {
                sum.scaled(h).plus(self.u[k].over(DoubleDouble((k + 1) as f64, 0.0)))
            })
            .scaled(2.0)
            .scaled(h);
        FineState { u, v, w, y, t: self.start.t.plus(t) }
    }

    /// The state where the guard vanishes, by Newton's method from `h`.
    fn guard_zero(
        &self,
        contact: Contact,
        phase: Phase,
        exit: Option<Phase>,
        mut h: f64,
    ) -> Option<FineState> {
        let guard = |h: f64| self.at(h).guard(contact, phase, exit);
        let first = h;
        let mut moved = f64::INFINITY;
        for _ in 0..20 {
            let reach = 1e-4 * h;
            let rise = guard(h + reach).minus(guard(h - reach)).nearest();
            let slope = rise / ((h + reach) - (h - reach));
            let shift = -guard(h).nearest() / slope;
            h += shift;
            // When the shifts stop shrinking, only the rounding of h is left.
            if shift.abs() <= f64::EPSILON * h || shift.abs() >= moved && moved < 1e-12 * h {
                return ((h - first).abs() <= 0.3 * first).then(|| self.at(h));
            }
            moved = shift.abs();
        }
        None
    }
}

/// The k-th coefficient of a product of two series, by four sums that do not wait for each other.
fn product(
    a: &[DoubleDouble; DEGREE + 1],
    b: &[DoubleDouble; DEGREE + 1],
    k: usize,
) -> DoubleDouble {
    let mut sums = [ZERO; 4];
    for j in 0..=k {
        sums[j % 4] = sums[j % 4].plus(a[j].times(b[k - j]));
    }
    sums[0].plus(sums[1]).plus(sums[2].plus(sums[3]))
}

/// The value of a series at a distance `h`.
fn value(terms: &[DoubleDouble; DEGREE + 1], h: f64) -> DoubleDouble {
    terms.iter().rev().fold(ZERO, |sum, &term| sum.scaled(h).plus(term))
}
