//! One collision in the steps of a particle code.

use stickslip_model::{
    Contact, ContactEnd, CoulombTest, Damping, HistoryOf, Law, Normal, Reduction, Tangential, exact,
};

use super::adhesion::Adhesion;
use super::turning::Turning;

/// The duration of a contact with the normal force of `law` and without damping and adhesion, in
/// scaled units: π for a linear force, 3.218… for Hertz'.
pub fn undamped_contact_time(law: Law) -> f64 {
    match law.normal {
        Normal::Linear => std::f64::consts::PI,
        _ => exact::CONTACT_TIME,
    }
}

/// A collision as a particle code computes it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Stepped {
    /// Coefficient of normal restitution ε_n.
    pub eps_n: f64,
    /// Coefficient of tangential restitution ε_t; −1 is full reversal.
    pub eps_t: f64,
    /// Number of steps in contact, until the normal force is 0 for good.
    pub steps: u64,
    /// Largest (k dt² + 2 D dt)/4 over the steps and over both directions, with the stiffness k and
    /// the damping D at the overlap of the step. From 1 on, the oscillation of a spring is not
    /// resolved and grows from step to step, until friction cuts it off.
    pub stiffness: f64,
}

impl Stepped {
    /// Whether the steps resolve both springs: [`Self::stiffness`] stays below 1.
    pub fn is_stable(&self) -> bool {
        self.stiffness < 1.0
    }
}

/// What a step is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stepping {
    /// The scheme.
    pub scheme: Scheme,
    /// The greatest overlap of the contact without damping, friction and adhesion over the distance
    /// of the centres, for two equal spheres without spins whose normal turns; 0 for a normal that
    /// stands still, as on a wall. The result is that of the normal with which the contact began.
    pub overlap: f64,
    /// The numbers μ and α, of which the motion of turning spheres depends.
    pub reduction: Reduction,
}

/// Most steps of one contact.
const MOST_STEPS: f64 = 1e9;
/// How many times as long as it should a contact may last.
const LONGEST: f64 = 10.0;

/// Computes the collision of `contact` with the step `dt` in scaled units.
///
/// The contact begins after the part `phase` of a step, from 0 to below 1: the gap is then
/// phase·dt at the scaled velocity 1.
///
/// A contact that ends where the force does ([`ContactEnd::Force`]) is computed as particle codes
/// do it, with a force that is kept from attracting until the overlap vanishes. Without steps both
/// are the same.
///
/// `None` if spheres that turn pass each other in a step, if `dt` is not a finite number above 0,
/// if `phase` is not from 0 to below 1, if the contact has not ended after ten times `duration`
/// (its duration without steps) or after 10⁹ steps, as where adhesion holds the bodies together, or
/// if numbers are no longer finite.
pub fn step(
    contact: &Contact,
    dt: f64,
    phase: f64,
    stepping: &Stepping,
    duration: f64,
) -> Option<Stepped> {
    let Stepping { scheme, overlap, reduction } = *stepping;
    if !(dt > 0.0 && dt.is_finite() && (0.0..1.0).contains(&phase)) {
        return None;
    }
    let longest = LONGEST * f64::max(duration, undamped_contact_time(contact.law()));
    let most = (longest / dt + 10.0).min(MOST_STEPS);
    let mut rule = ForceRule::new(contact, dt, scheme);
    let mut state =
        State { x: -phase * dt, v: 1.0, w: contact.psi(), history: 0.0, root: 0.0, greatest: 0.0 };
    let mut turning =
        (overlap > 0.0).then(|| Turning::new(contact, overlap, reduction, phase * dt));
    let mut steps = 0;
    let mut stiffness: f64 = 0.0;
    loop {
        if let Some(turning) = &mut turning {
            let synchronized = scheme == Scheme::SynchronizedVerlet;
            (state.x, state.v, state.w) = turning.advance(dt, synchronized);
            if steps == 0 && state.x <= 0.0 && turning.parts() {
                return None;
            }
        } else {
            state.x += dt * state.v;
        }
        // Adhesion may hold bodies that no longer overlap.
        let last = rule.adhesion.filter(|_| steps > 0).map_or(0.0, |adhesion| adhesion.last);
        if state.x > last {
            steps += 1;
            if steps as f64 > most {
                return None;
            }
            let (v, w) = (state.v, state.w);
            let Some(number) = rule.advance(&mut state) else { break };
            stiffness = stiffness.max(number);
            if let Some(turning) = &mut turning {
                turning.push(state.v - v, state.w - w);
            }
        } else if steps > 0 || !state.v.is_finite() {
            break;
        }
    }
    if let Some(turning) = turning {
        (state.v, state.w) = turning.velocities();
    }
    let stepped = Stepped { eps_n: -state.v, eps_t: state.w / contact.psi(), steps, stiffness };
    let finite = stepped.eps_n.is_finite() && stepped.eps_t.is_finite() && stiffness.is_finite();
    finite.then_some(stepped)
}

/// Where the bodies are, and what the contact remembers.
struct State {
    /// Overlap.
    x: f64,
    /// Its rate, in the middle of the last step.
    v: f64,
    /// Reduced tangential velocity, in the middle of the last step.
    w: f64,
    /// Elongation or force of the spring.
    history: f64,
    /// √x, or the contact radius, one step before; 0 before the contact.
    root: f64,
    /// Greatest overlap so far.
    greatest: f64,
}

/// What decides on forces.
struct ForceRule {
    law: Law,
    adhesion: Option<Adhesion>,
    /// Whether the force is kept from attracting.
    limited: bool,
    kappa: f64,
    damping: f64,
    tangential_damping: f64,
    dt: f64,
    scheme: Scheme,
    /// Whether no step with overlap has been taken.
    first: bool,
}

impl ForceRule {
    fn new(contact: &Contact, dt: f64, scheme: Scheme) -> Self {
        let law = contact.law();
        let adhesion = Adhesion::new(&law);
        Self {
            law,
            adhesion,
            limited: law.limit_damping
                || law.end == ContactEnd::Force && adhesion.is_none()
                || law.damping.is_hysteretic(),
            kappa: contact.kappa(),
            damping: contact.damping(),
            tangential_damping: contact.tangential_damping(),
            dt,
            scheme,
            first: true,
        }
    }

    /// Advances both velocities by a step, with the forces at the overlap, and returns the
    /// [`Stepped::stiffness`] of the step. `None` where a limited force has vanished: the overlap
    /// falls in free flight, in which a force would attract until the end.
    fn advance(&mut self, state: &mut State) -> Option<f64> {
        let Self { law, adhesion, dt, .. } = *self;
        state.greatest = state.greatest.max(state.x);
        let ([elastic, slope], root) = match (adhesion, law.damping) {
            (Some(adhesion), _) => {
                let radius = adhesion.radius(state.x);
                (adhesion.elastic(radius), radius)
            }
            (None, Damping::Yielding) => self.yielding(state),
            (None, _) => (self.elastic(state), state.x.sqrt()),
        };
        let eta = match law.damping {
            Damping::None | Damping::Hysteretic | Damping::Hardening | Damping::Yielding => 0.0,
            Damping::Linear => self.damping,
            Damping::Viscoelastic => self.damping * root,
            Damping::Tsuji => self.damping * root.sqrt(),
        };
        let normal = elastic + eta * state.v;
        if self.limited && normal <= 0.0 {
            return None;
        }
        let k = match law.tangential {
            Tangential::Constant => self.kappa,
            Tangential::Mindlin => self.kappa * root,
        };
        let dashpot = self.tangential_damping * eta;
        let limit = match adhesion {
            Some(Adhesion { pull_off, .. }) => (elastic + 2.0 * pull_off).abs(),
            None => normal.abs() * law.friction.share(state.w),
        };
        let tangential = self.tangential_force(state, (k, dashpot), limit, root);
        state.v -= dt * normal;
        state.w -= dt * tangential;
        let number = |k: f64, damping: f64| 0.25 * dt * (k * dt + 2.0 * damping);
        Some(f64::max(number(slope, eta), number(k, dashpot)))
    }

    /// The force without dashpot, and its slope.
    fn elastic(&self, state: &State) -> [f64; 2] {
        let (pushed, factor) = self.pushed(state);
        match self.law.normal {
            Normal::Linear => [factor * pushed, factor],
            _ => [factor * pushed * pushed.sqrt(), 1.5 * factor * pushed.sqrt()],
        }
    }

    /// The same of bodies that yield, and the contact radius.
    fn yielding(&self, state: &State) -> ([f64; 2], f64) {
        let State { x, greatest, .. } = *state;
        let from = (1.25 / (self.damping * self.damping)).powf(0.4);
        let loading = |x: f64| {
            let least = f64::min(x, from).sqrt();
            [least * (1.5 * x - 0.5 * f64::min(x, from)), 1.5 * least]
        };
        if x == greatest || greatest <= from {
            return (loading(x), x.sqrt());
        }
        // With the radius r the overlap falls by the r-th part of the greatest one.
        let radius = greatest * greatest.sqrt() / loading(greatest)[0];
        let pushed = f64::max(0.0, x - greatest * (1.0 - 1.0 / radius));
        let root = (radius * pushed).sqrt();
        ([root * pushed, 1.5 * root], root)
    }

    /// The part of the overlap that pushes, and the factor of the stiffness.
    fn pushed(&self, state: &State) -> (f64, f64) {
        let State { x, greatest, .. } = *state;
        if !self.law.damping.is_hysteretic() || x == greatest {
            return (x, 1.0);
        }
        let factor = 1.0 + self.damping;
        let power = match self.law.normal {
            Normal::Linear => -1.0,
            _ => -2.0 / 3.0,
        };
        (f64::max(0.0, x - greatest * (1.0 - factor.powf(power))), factor)
    }

    /// The tangential force against the motion, with the history that it leaves.
    fn tangential_force(
        &mut self,
        state: &mut State,
        (k, dashpot): (f64, f64),
        limit: f64,
        root: f64,
    ) -> f64 {
        if self.law.rescaled && root < state.root {
            state.history *= root / state.root;
        }
        state.root = root;
        let elapsed = match self.scheme {
            Scheme::Elapsed if self.first => (state.x / state.v).min(self.dt),
            _ => self.dt,
        };
        self.first = false;
        let viscous = dashpot * state.w;
        let (beside, viscous) = match self.law.coulomb_test {
            CoulombTest::Spring if self.law.remembers() => (viscous, 0.0),
            CoulombTest::Spring | CoulombTest::Total => (0.0, viscous),
        };
        let trial = match self.law.history {
            HistoryOf::Displacement => {
                state.history += state.w * elapsed;
                k * state.history + viscous
            }
            HistoryOf::Force => {
                state.history += k * state.w * elapsed;
                state.history + viscous
            }
            HistoryOf::None => return viscous.abs().min(limit).copysign(viscous),
        };
        if trial.abs() <= limit {
            return trial + beside;
        }
        if state.history == 0.0 {
            return 0.0;
        }
        let force = limit.copysign(trial);
        state.history = match self.law.history {
            HistoryOf::Displacement => (force - viscous) / k,
            HistoryOf::Force | HistoryOf::None => force - viscous,
        };
        force
    }
}

/// A scheme of a particle code.
///
/// All advance velocity v and overlap x by leaps, v_{n+½} = v_{n−½} + dt f_n and
/// x_{n+1} = x_n + dt v_{n+½}. The force f_n is that at the overlap x_n and the velocity v_{n−½}.
/// Velocity Verlet whose forces see the velocities of half steps (LAMMPS, MercuryDPM), leapfrog
/// (YADE) and semi-implicit Euler (MFiX) are this same sequence. In each step, in this order: the
/// history is rescaled, if the law says so; it advances by v_{n−½}; the tangential force follows
/// from it; and where that exceeds Coulomb's limit, it is cut off and the history is reset to it.
///
/// Sources: LAMMPS 29 Sep 2021 `pair_gran_hooke_history.cpp`, `pair_gran_hertz_history.cpp`,
/// `pair_granular.cpp` (all `compute`), `fix_nve_sphere.cpp`; MercuryDPM (kuwt/MercuryDPM_fork)
/// `BaseParticle.cc`, `SlidingFrictionInteraction.cc`; MFiX 21.3.2 `calc_force_dem.f`,
/// `cfnewvalues.f` with `INTG_EULER`; YADE 2021.01a `NewtonIntegrator.cpp` for the motion alone.
/// Only LAMMPS was run and compared. Schemes of other kinds, such as MFiX' Adams–Bashforth, are not
/// computed.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Scheme {
    /// The history advances by a whole step in the first step of a contact too, as in LAMMPS,
    /// MercuryDPM and MFiX 21.3.2. Bodies touch where the overlap at the end of a step is above 0,
    /// and the history is forgotten where it is not.
    #[default]
    Lammps,
    /// In the first step of a contact the history advances by the time since the contact began,
    /// x/v, but by a whole step at most, as in an older MFiX (truongd8593/mfix, commit 01e0f96,
    /// `calc_force_dem.f`, `DTSOLID_TMP`). What else is special there was not compared.
    Elapsed,
    /// As [`Self::Lammps`], but velocities are taken along the normal in the middle of the step,
    /// where they belong, and the normal force acts along it (`synchronized_verlet` of LAMMPS, pull
    /// request 4351, compared with the version of 22 July 2025). Without an
    /// [overlap](Stepping::overlap) it is the same.
    #[serde(rename = "synchronized_verlet")]
    SynchronizedVerlet,
}

impl Scheme {
    /// All schemes.
    pub const ALL: [Self; 3] = [Self::Lammps, Self::Elapsed, Self::SynchronizedVerlet];

    /// The name of the scheme: `lammps`, `elapsed` or `synchronized_verlet`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lammps => "lammps",
            Self::Elapsed => "elapsed",
            Self::SynchronizedVerlet => "synchronized_verlet",
        }
    }

    /// The scheme with this [`Self::name`].
    pub fn find(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|scheme| scheme.name() == name)
    }
}
