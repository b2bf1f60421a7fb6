//! Collisions over a plane: of scaled numbers, or of the velocities of two spheres.

use serde::Deserialize;
use serde_json::{Value, json};
use stickslip_model::history::{History, Moment};
use stickslip_model::spheres::{Body, BodyPair, Material, Sphere, Surface};
use stickslip_model::{
    Collider, Collision, Contact, Engine, Friction, InvalidValue, Law, Reduction, Regime, Side,
    document, exact, linear, presets,
};
use stickslip_plane::{CollisionPlane, Range};
use stickslip_solver::Statistics;

use crate::axis::MapPoint;
use crate::itinerary;

/// The numbers of a moment of a course.
pub const MOMENT: usize = 9;

/// Collisions as a page describes them.
#[derive(Deserialize)]
pub struct SpheresRequest {
    axes: Axes,
    law: String,
    damping: f64,
    tangential_damping: f64,
    /// How friction decays with the velocity.
    #[serde(default)]
    friction: Friction,
    /// The force that separates the bodies, if the law is adhesive.
    #[serde(default)]
    pull_off: f64,
    mu: f64,
    alpha: f64,
    /// The spheres whose velocities are the axes.
    #[serde(default)]
    bodies: Option<Bodies>,
}

/// What the axes of a plane are.
#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "kebab-case")]
enum Axes {
    /// κ and ψ.
    KappaPsi,
    /// κ and g_t/g_n.
    KappaRatio,
    /// ακ and g_t/g_n, as in the figures of the paper.
    AxisRatio,
    /// The normal and the tangential velocity in m/s.
    Velocities,
}

/// Two homogeneous spheres: equal ones, or another one beside the first.
#[derive(Clone, Copy, Deserialize)]
struct Bodies {
    #[serde(flatten)]
    one: Ball,
    #[serde(default)]
    other: Option<Ball>,
    tangential_stiffness_kg_per_s2: f64,
    damping_time_s: f64,
}

/// A homogeneous sphere.
#[derive(Clone, Copy, Deserialize)]
struct Ball {
    radius_m: f64,
    young_modulus_pa: f64,
    poisson_ratio: f64,
    density_kg_per_m3: f64,
}

impl Ball {
    fn sphere(self) -> Result<Sphere, InvalidValue> {
        let Self { radius_m, young_modulus_pa, poisson_ratio, density_kg_per_m3 } = self;
        let expected = "a finite number above 0";
        let positive = density_kg_per_m3 > 0.0 && density_kg_per_m3.is_finite();
        InvalidValue::check("density_kg_per_m3", density_kg_per_m3, expected, positive)?;
        let material = Material { young_modulus_pa, poisson_ratio, density_kg_per_m3 };
        Ok(Sphere::homogeneous(radius_m, &material))
    }
}

impl Bodies {
    /// The pair that they are, with the friction `mu`.
    fn pair(self, mu: f64) -> Result<BodyPair, InvalidValue> {
        let Self { one, other, tangential_stiffness_kg_per_s2, damping_time_s } = self;
        let surface = Surface { friction: mu, tangential_stiffness_kg_per_s2, damping_time_s };
        let other = Body::Sphere(other.unwrap_or(one).sphere()?);
        BodyPair::new(&one.sphere()?, &other, &surface)
    }
}

/// Collisions over a plane.
pub struct Spheres {
    parameters: Parameters,
    /// The factor of the energy of the tangential motion, in units of that of the normal one.
    tangential: f64,
}

enum Parameters {
    /// κ and ψ of a unit along each axis.
    Scaled {
        units: [f64; 2],
        any: Contact,
    },
    Velocities(BodyPair),
}

impl Spheres {
    /// The collisions that a page describes.
    pub fn new(request: &SpheresRequest) -> Result<Self, Value> {
        let SpheresRequest { axes, damping, tangential_damping, mu, alpha, .. } = *request;
        let refused = |error: InvalidValue| json!({ "error": error.to_string() });
        let expected = "a finite number above 0; without friction, 0 with the velocities as axes";
        let least = if axes == Axes::Velocities { 0.0 } else { f64::MIN_POSITIVE };
        let accepted = mu >= least && mu.is_finite();
        InvalidValue::check("mu", mu, expected, accepted).map_err(refused)?;
        let accepted = alpha > 0.0 && alpha <= 1.0;
        InvalidValue::check("alpha", alpha, "above 0 to 1", accepted).map_err(refused)?;
        let Some(preset) = presets::find(&request.law) else {
            let unknown = || format!("no law is called {}", request.law);
            let why = presets::refusal(&request.law).map_or_else(unknown, str::to_owned);
            return Err(json!({ "error": why }));
        };
        let reduction = Reduction { mu, alpha };
        let units = match axes {
            Axes::KappaPsi => [1.0, 1.0],
            Axes::KappaRatio => [1.0, reduction.psi(1.0)],
            Axes::AxisRatio => [1.0 / alpha, reduction.psi(1.0)],
            Axes::Velocities => {
                let bodies = request.bodies.ok_or_else(|| json!({ "error": "no bodies" }))?;
                let pair = bodies.pair(mu).map_err(refused)?;
                let unit = pair.friction_unit();
                let tangential = unit * unit / pair.alpha;
                return Ok(Self { parameters: Parameters::Velocities(pair), tangential });
            }
        };
        let pull_off = if preset.law.normal.is_adhesive() { request.pull_off } else { 0.0 };
        let law = Law { friction: request.friction, pull_off, ..preset.law };
        let contact = Contact::new(1.0, 1.0, damping)
            .and_then(|contact| contact.with_law(law, tangential_damping));
        let any = contact.map_err(refused)?;
        Ok(Self { parameters: Parameters::Scaled { units, any }, tangential: mu * mu / alpha })
    }

    /// The contact at a point of the plane.
    fn contact(&self, [x, y]: [f64; 2]) -> Result<Contact, InvalidValue> {
        match &self.parameters {
            Parameters::Scaled { units, any } => {
                Contact::new(x * units[0], y * units[1], any.damping())?
                    .with_law(any.law(), any.tangential_damping())
            }
            Parameters::Velocities(pair) => Ok(pair.impact(x, y)?.contact),
        }
    }

    /// The collisions between two values of each axis, and the parameters of a unit along both.
    pub fn plane(&self, [x, y]: [Range; 2]) -> Result<(CollisionPlane, [f64; 2]), InvalidValue> {
        match self.parameters {
            Parameters::Scaled { units: [of_x, of_y], any } => {
                let (x, y) = ((x.low * of_x, x.high * of_x), (y.low * of_y, y.high * of_y));
                let plane = CollisionPlane::new(x, y, any.damping())?;
                Ok((plane.with_law(any.law(), any.tangential_damping())?, [of_x, of_y]))
            }
            Parameters::Velocities(pair) => {
                Ok((CollisionPlane::velocities(pair, [x, y])?, [1.0, 1.0]))
            }
        }
    }

    /// Computes the points of a map, in one collision's memory.
    pub fn points(&self) -> impl FnMut([f64; 2]) -> MapPoint {
        let mut collision = None;
        move |point| {
            let Ok(contact) = self.contact(point) else { return MapPoint::FAILED };
            let collision = collision.get_or_insert_with(|| Collision::before(contact));
            // The exact solution of a linear contact is faster than the integrator.
            let computed = if linear::solves(&contact) && !contact.obeys_paper() {
                linear::collide_into(contact, collision).is_ok()
            } else {
                collide_into(contact, collision).is_ok()
            };
            if !computed || collision.require_finite().is_err() {
                return MapPoint::FAILED;
            }
            let lost = self.energy_lost(collision);
            let values = [collision.eps_t(), collision.contact_time, lost, collision.eps_n];
            #[expect(clippy::cast_possible_truncation, reason = "for a picture")]
            let values = values.map(|value| value as f32);
            let count = u16::try_from(collision.switches.len()).unwrap_or(u16::MAX - 1);
            MapPoint { values, count, code: itinerary::of_collision(collision) }
        }
    }

    /// The part of the energy of both motions that is lost.
    fn energy_lost(&self, collision: &Collision) -> f64 {
        let psi = collision.contact.psi();
        let tangential = |w: f64| self.tangential * w * w;
        let after = collision.eps_n * collision.eps_n + tangential(collision.final_velocity);
        1.0 - after / (1.0 + tangential(psi))
    }

    /// The collision at a point as the program prints it, with an estimate of its error.
    pub fn document(&self, point: [f64; 2]) -> Result<Value, String> {
        let contact = self.contact(point).map_err(|error| error.to_string())?;
        let engine = Engine::Auto.resolved(&contact);
        let (collision, statistics) = collide(contact)?;
        let estimate = engine.estimate(&collision).ok();
        let work = (estimate.as_ref(), statistics.as_ref());
        let document = document::new(document::COLLISION, &collision, &engine, work);
        let mut document = document.map_err(|error| error.to_string())?;
        document.insert("energy_lost".to_owned(), self.energy_lost(&collision).into());
        document.insert("code".to_owned(), itinerary::of_collision(&collision).into());
        if let Parameters::Velocities(pair) = self.parameters {
            let impact = pair.impact(point[0], point[1]).map_err(|error| error.to_string())?;
            let units = json!({
                "time_s": impact.time_unit_s,
                "length_m": impact.length_unit_m(),
                "force_n": impact.force_unit_n(),
            });
            document.insert("units".to_owned(), units);
        }
        Ok(Value::Object(document))
    }

    /// Appends the course at a point to `numbers`; returns the number of its moments. It has
    /// `least` even intervals, or as many as each swing of the spring needs to look smooth.
    pub fn course(
        &self,
        point: [f64; 2],
        least: usize,
        numbers: &mut Vec<f64>,
    ) -> Result<usize, String> {
        const OF_A_SWING: f64 = 24.0;
        const MOST: f64 = 2000.0;
        let contact = self.contact(point).map_err(|error| error.to_string())?;
        let history = if contact.obeys_paper() {
            History::exact(contact)
        } else {
            Collider::default().history(contact)
        };
        let history = history.map_err(|error| error.to_string())?;
        let swings = history.duration() * contact.kappa().sqrt() / std::f64::consts::TAU;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to MOST")]
        let intervals = least.max((OF_A_SWING * swings).min(MOST) as usize);
        for Moment { snapshot, regime, side, .. } in history.moments(intervals) {
            let sliding = match (regime, side) {
                (Regime::Stick, _) => 0.0,
                (Regime::Slip, Side::Positive) => 1.0,
                (Regime::Slip, Side::Negative) => -1.0,
            };
            let moment: [f64; MOMENT] = [
                snapshot.time,
                snapshot.compression,
                snapshot.normal_velocity,
                snapshot.normal_force,
                snapshot.spring,
                snapshot.tangential_force,
                snapshot.velocity,
                sliding,
                snapshot.limit,
            ];
            numbers.extend(moment);
        }
        Ok(numbers.len() / MOMENT)
    }
}

/// The collision of a contact by the best engine for it, as [`Engine::Auto`] has it. An engine that
/// is chosen at run time would bring methods along that the page does not need.
pub fn collide(contact: Contact) -> Result<(Collision, Option<Statistics>), String> {
    let mut collision = Collision::before(contact);
    let statistics = collide_into(contact, &mut collision)?;
    collision.require_finite().map_err(|error| error.to_string())?;
    Ok((collision, statistics))
}

fn collide_into(contact: Contact, collision: &mut Collision) -> Result<Option<Statistics>, String> {
    if contact.obeys_paper() {
        exact::collide_into(contact, collision).map_err(|error| error.to_string())?;
        return Ok(None);
    }
    let found = Collider::default().collide_into(contact, collision);
    found.map(Some).map_err(|error| error.to_string())
}

/// The intervals of ψ from 0 to `highest` in which a contact of stiffness `kappa` has one
/// itinerary, from above: their ends and itineraries. Damping is 0.
///
/// Boundaries are found between even steps, of which there are [`STEPS`], by bisection.
pub fn line(kappa: f64, highest: f64) -> Result<Value, String> {
    const STEPS: u32 = 2000;
    let itinerary = |psi: f64| -> Result<String, String> {
        let contact = Contact::new(kappa, psi, 0.0).map_err(|error| error.to_string())?;
        Ok(exact::collide(contact).map_err(|error| error.to_string())?.itinerary())
    };
    let step = highest / f64::from(STEPS);
    let (mut upper, mut above) = (highest, itinerary(highest)?);
    let mut intervals = Vec::new();
    for index in (1..STEPS).rev() {
        let psi = step * f64::from(index);
        let here = itinerary(psi)?;
        if here == above {
            continue;
        }
        let (mut low, mut high) = (psi, psi + step);
        for _ in 0..50 {
            let middle = f64::midpoint(low, high);
            if itinerary(middle)? == above { high = middle } else { low = middle }
        }
        intervals.push(json!({ "low": high, "high": upper, "itinerary": above }));
        (upper, above) = (high, here);
    }
    intervals.push(json!({ "low": 0.0, "high": upper, "itinerary": above }));
    Ok(intervals.into())
}

/// The boundaries that have closed forms: points (κ, ψ) of the highest one, above which the whole
/// contact is sliding, and the κ at which boundaries end as ψ → 0.
pub fn limits([low, high]: [f64; 2]) -> Value {
    const POINTS: u32 = 200;
    const MOST: u32 = 400;
    let ok = low > 0.0 && low < high && high.is_finite();
    let at = |index: u32| low * (high / low).powf(f64::from(index) / f64::from(POINTS));
    let places = (0..=POINTS).filter(|_| ok).map(at);
    let top: Vec<[f64; 2]> = places.map(|kappa| [kappa, exact::top_boundary(kappa)]).collect();
    let small = (1..=MOST).map(exact::small_impact_boundary);
    let small: Vec<f64> = small.filter(|kappa| (low..=high).contains(kappa)).collect();
    json!({ "top": top, "small": small })
}
