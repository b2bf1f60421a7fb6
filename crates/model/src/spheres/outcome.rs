//! The outcome of an encounter: motions, switches and energy in SI units.

use nalgebra::Vector3;
use smallvec::SmallVec;
use stickslip_contact::{Collision, FEW_SWITCHES, Regime, Side, Switch};

use super::encounter::{Encounter, Motion, Partner};
use super::observed::Observed;

/// Two bodies after their collision.
#[derive(Clone, Debug, PartialEq)]
pub struct ImpactOutcome {
    /// Whether the bodies stay together for ever, held by adhesion: then what would be after the
    /// contact is NaN, and the rest is up to where that is certain ([`Collision::adheres`]).
    pub adheres: bool,
    /// Motions after the contact. Positions are those at impact, and a wall keeps its motion.
    pub motions: [Motion; 2],
    /// Impulse on the first body in N s; the second body receives the opposite one.
    pub impulse_n_s: Vector3<f64>,
    /// Coefficient of normal restitution ε_n.
    pub eps_n: f64,
    /// Coefficient of tangential restitution ε_t = g_t(t_c)/g_t(0); −1 is full reversal. `None` in
    /// a central impact.
    pub eps_t: Option<f64>,
    /// Duration of the contact in s.
    pub contact_time_s: f64,
    /// Every switch between slip and stick, in order of time; none in a central impact.
    pub switches: SmallVec<[ForceSwitch; FEW_SWITCHES]>,
    /// The energy before, during and after the contact.
    pub energy: EnergyAccount,
    /// The quantities that experiments report.
    pub observed: Observed,
}

/// A switch between Coulomb sliding and the spring, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ForceSwitch {
    /// Time since the start of contact in s.
    pub time_s: f64,
    /// Time until the end of contact in s.
    pub time_left_s: f64,
    /// The regime that begins.
    pub to: Regime,
    /// The side of the sliding that begins or, at a switch to stick, of the sliding that ends.
    pub side: Side,
    /// Elongation ζ of the tangential spring in m; `None` in other laws than the paper's, where the
    /// force is not that of a spring of one stiffness.
    pub spring_m: Option<f64>,
    /// Tangential velocity of the surfaces along t in m/s.
    pub velocity_m_per_s: f64,
    /// Size of the normal force F_n in N; with adhesion its elastic part, below 0 where the bodies
    /// attract each other.
    pub normal_force_n: f64,
    /// Tangential force F_t, −k_t ζ in the paper's law, in N on the first body along t; at a switch
    /// |F_t| = μ |F_n|, and with adhesion μ (F_n + 2 F_po).
    pub tangential_force_n: f64,
}

/// The energy account of a collision in J: where its energy went.
///
/// Kinetic energies of the spheres include rotation, in the frame in which the motions are given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyAccount {
    /// Kinetic energy at impact.
    pub kinetic_before_j: f64,
    /// Kinetic energy after the contact.
    pub kinetic_after_j: f64,
    /// Work of a moving wall on the sphere, impulse · velocity of the wall.
    pub work_of_wall_j: f64,
    /// Energy taken by Coulomb sliding; in other laws than the paper's, lost in slip.
    pub sliding_j: f64,
    /// Energy taken by the damping of the normal force, or its hysteresis.
    pub damping_j: f64,
    /// Energy taken by the tangential dashpot in stick; 0 in the paper's law.
    pub tangential_damping_j: f64,
    /// Energy left in the tangential spring when the contact ends; in other laws than the paper's,
    /// lost in stick to the spring.
    pub spring_left_j: f64,
    /// Energy left in the compression when the contact ends; 0 without damping.
    pub compression_left_j: f64,
}

impl EnergyAccount {
    /// Energy in J that the account does not explain. It measures the errors of the calculation.
    pub fn unbalanced_j(&self) -> f64 {
        self.kinetic_before_j + self.work_of_wall_j
            - self.kinetic_after_j
            - self.sliding_j
            - self.damping_j
            - self.tangential_damping_j
            - self.spring_left_j
            - self.compression_left_j
    }
}

impl Encounter {
    /// The outcome, given the `collision` of [`Self::contact`] from any engine.
    pub fn outcome(&self, collision: &Collision) -> ImpactOutcome {
        let impact = &self.impact;
        let pair = &impact.pair;
        let [m, alpha] = [pair.effective_mass_kg, pair.alpha];
        let eps_t = self.tangent.map(|_| collision.eps_t());
        let along_normal = m * (1.0 + collision.eps_n) * self.normal_m_per_s;
        let along_tangent =
            eps_t.map_or(0.0, |eps_t| alpha * m * (eps_t - 1.0) * self.tangential_m_per_s);
        let tangent = self.tangent.unwrap_or_default();
        let impulse = self.normal * along_normal + tangent * along_tangent;
        // The force of the second body is the opposite one, and so is its lever arm.
        let twist = self.normal.cross(&tangent) * -along_tangent;
        let [one, two] = &self.partners;
        let motions = [one.after(impulse, twist), two.after(-impulse, twist)];

        let wall = self.partners.iter().find(|partner| partner.sphere.is_none());
        let kinetic = |motions: [&Motion; 2]| one.energy(motions[0]) + two.energy(motions[1]);
        let normal_unit_j = m * self.normal_m_per_s * self.normal_m_per_s;
        let slope = pair.friction_unit() / alpha;
        let tangential_unit_j =
            if self.tangent.is_some() { alpha * slope * slope * normal_unit_j } else { 0.0 };
        let ledger = &collision.energy;
        let energy = EnergyAccount {
            kinetic_before_j: kinetic([&one.motion, &two.motion]),
            kinetic_after_j: kinetic([&motions[0], &motions[1]]),
            work_of_wall_j: wall.map_or(0.0, |wall| impulse.dot(&wall.motion.velocity_m_per_s)),
            sliding_j: ledger.sliding * tangential_unit_j,
            damping_j: ledger.damping * normal_unit_j,
            tangential_damping_j: ledger.tangential_damping * tangential_unit_j,
            spring_left_j: ledger.spring_left * tangential_unit_j,
            compression_left_j: ledger.compression_left * normal_unit_j,
        };
        let switches =
            if self.tangent.is_some() { self.switches(collision) } else { SmallVec::new() };
        ImpactOutcome {
            adheres: collision.adheres,
            motions,
            impulse_n_s: impulse,
            eps_n: collision.eps_n,
            eps_t,
            contact_time_s: collision.contact_time * impact.time_unit_s,
            switches,
            energy,
            observed: Observed::new(self, collision.eps_n, eps_t, &motions),
        }
    }

    fn switches(&self, collision: &Collision) -> SmallVec<[ForceSwitch; FEW_SWITCHES]> {
        let impact = &self.impact;
        let surface = &impact.pair.surface;
        let in_si = |switch: &Switch| {
            let of_paper = impact.contact.obeys_paper();
            let spring_m = of_paper.then(|| impact.spring_m(switch.spring));
            let force = surface.friction * impact.force_unit_n() * impact.contact.force_unit();
            let pull_n = spring_m.map_or(force * switch.spring, |spring_m| {
                surface.tangential_stiffness_kg_per_s2 * spring_m
            });
            let law = impact.contact.law();
            let limit_n = pull_n.abs() / (surface.friction * law.friction.share(switch.velocity));
            ForceSwitch {
                time_s: switch.time * impact.time_unit_s,
                time_left_s: switch.time_left * impact.time_unit_s,
                to: switch.to,
                side: switch.side,
                spring_m,
                velocity_m_per_s: impact.velocity_m_per_s(switch.velocity),
                normal_force_n: limit_n - 2.0 * law.pull_off * impact.force_unit_n(),
                tangential_force_n: -pull_n,
            }
        };
        collision.switches.iter().map(in_si).collect()
    }
}

impl Partner {
    /// The motion after `impulse` at the point of contact, whose angular momentum on a sphere is
    /// `twist` times the arm.
    fn after(&self, impulse: Vector3<f64>, twist: Vector3<f64>) -> Motion {
        let Some(sphere) = self.sphere else { return self.motion };
        Motion {
            velocity_m_per_s: self.motion.velocity_m_per_s + impulse / sphere.mass_kg,
            spin_rad_per_s: self.motion.spin_rad_per_s
                + twist * (self.arm_m / sphere.moment_of_inertia_kg_m2),
            ..self.motion
        }
    }

    /// Kinetic energy in J with `motion`; a wall has none.
    fn energy(&self, motion: &Motion) -> f64 {
        self.sphere.map_or(0.0, |sphere| {
            0.5 * sphere.mass_kg * motion.velocity_m_per_s.norm_squared()
                + 0.5 * sphere.moment_of_inertia_kg_m2 * motion.spin_rad_per_s.norm_squared()
        })
    }
}
