//! What the model says of the data.

use stickslip_model::{Collider, Collision, CollisionError, CollisionFailure, Contact, Engine};

use super::FitError;
use super::bodies::{FittedBodies, Units, Values};
use super::data::{Datum, Measured};

/// Some of the data, and the bodies.
#[derive(Clone, Debug)]
pub struct Problem {
    pub bodies: FittedBodies,
    pub units: Units,
    impacts: Vec<Impact>,
    /// Standard errors, 1 where none are given.
    pub errors: Vec<f64>,
    /// What was measured.
    pub observed: Vec<f64>,
}

/// An impact, and what was measured of it.
#[derive(Clone, Debug)]
struct Impact {
    normal_m_per_s: f64,
    tangential_m_per_s: f64,
    quantities: Vec<Measured>,
}

/// A collision with its impact.
struct Collided<'a> {
    bodies: &'a FittedBodies,
    impact: &'a Impact,
    eps_n: f64,
    eps_t: f64,
}

impl Problem {
    pub fn new<'a>(
        bodies: FittedBodies,
        units: Units,
        data: impl Iterator<Item = &'a Datum>,
    ) -> Self {
        let mut impacts: Vec<Impact> = Vec::new();
        let (mut errors, mut observed) = (Vec::new(), Vec::new());
        for datum in data {
            let &Datum { normal_m_per_s, tangential_m_per_s, quantity, .. } = datum;
            errors.push(datum.error.unwrap_or(1.0));
            observed.push(datum.value);
            match impacts.last_mut() {
                Some(last)
                    if last.normal_m_per_s == normal_m_per_s
                        && last.tangential_m_per_s == tangential_m_per_s =>
                {
                    last.quantities.push(quantity);
                }
                _ => impacts.push(Impact {
                    normal_m_per_s,
                    tangential_m_per_s,
                    quantities: vec![quantity],
                }),
            }
        }
        Self { bodies, units, impacts, errors, observed }
    }

    /// The largest √(κ/κ₀) of the impacts, where κ₀ is κ at normal incidence.
    pub fn steepest(&self) -> Result<f64, FitError> {
        let values = Values { kappa: 1.0, mu: 1.0, tangential_damping: 0.0, damping: 0.0 };
        let mut steepest: f64 = 1.0;
        for impact in &self.impacts {
            steepest = steepest.max(self.contact(impact, &values)?.kappa().sqrt());
        }
        Ok(steepest)
    }

    /// Appends what the model says of each datum.
    ///
    /// # Errors
    /// An impact cannot be computed, or adhesion holds its bodies together.
    pub fn predict(&self, values: &Values, predicted: &mut Vec<f64>) -> Result<(), FitError> {
        let mut collision = None;
        for impact in &self.impacts {
            let contact = self.contact(impact, values)?;
            let collision = collision.get_or_insert_with(|| Collision::before(contact));
            Engine::Auto
                .collide_into(contact, collision)
                .map_err(|source| CollisionFailure::new(&contact, source))?;
            if collision.adheres {
                let held = CollisionError::Adheres { time: collision.contact_time };
                return Err(CollisionFailure::new(&contact, held).into());
            }
            let collided = self.collided(impact, collision.eps_n, collision.eps_t());
            predicted.extend(impact.quantities.iter().map(|quantity| collided.value(*quantity)));
        }
        Ok(())
    }

    /// Appends what the model says, with the derivatives with respect to κ at normal incidence and
    /// μ; `None` where derivatives do not exist, because a switch is a graze or the law is not the
    /// paper's.
    pub fn predict_with_slopes(&self, values: &Values) -> Result<Option<Slopes>, FitError> {
        let mut slopes = Slopes::default();
        for impact in &self.impacts {
            let contact = self.contact(impact, values)?;
            if !contact.obeys_paper() {
                return Ok(None);
            }
            let Ok(found) = Collider::default().sensitivity(contact) else { return Ok(None) };
            let eps_t = found.eps_t;
            let collided = self.collided(impact, found.eps_n.value, eps_t.value);
            // κ is proportional to κ at normal incidence, ψ to 1/μ.
            let by_kappa = eps_t.kappa * contact.kappa() / values.kappa;
            let by_mu = -eps_t.psi * contact.psi() / values.mu;
            for quantity in &impact.quantities {
                let slope = collided.slope(*quantity);
                slopes.predicted.push(collided.value(*quantity));
                slopes.kappa.push(slope * by_kappa);
                slopes.mu.push(slope * by_mu);
            }
        }
        Ok(Some(slopes))
    }

    /// Sum of the squares of the differences over their errors.
    pub fn misfit(&self, predicted: &[f64]) -> f64 {
        let data = predicted.iter().zip(&self.observed).zip(&self.errors);
        data.map(|((predicted, observed), error)| ((observed - predicted) / error).powi(2)).sum()
    }

    /// The misfit of some values.
    ///
    /// # Errors
    /// An impact cannot be computed.
    pub fn misfit_at(&self, values: &Values) -> Result<f64, FitError> {
        let mut predicted = Vec::with_capacity(self.observed.len());
        self.predict(values, &mut predicted)?;
        Ok(self.misfit(&predicted))
    }

    fn contact(&self, impact: &Impact, values: &Values) -> Result<Contact, FitError> {
        let pair = self.bodies.with(&self.units, values);
        // The normal motion of a central impact is the same as of any other.
        let tangential = if impact.tangential_m_per_s > 0.0 {
            impact.tangential_m_per_s
        } else {
            impact.normal_m_per_s
        };
        Ok(pair.impact(impact.normal_m_per_s, tangential)?.contact)
    }

    fn collided<'a>(&'a self, impact: &'a Impact, eps_n: f64, eps_t: f64) -> Collided<'a> {
        Collided { bodies: &self.bodies, impact, eps_n, eps_t }
    }
}

/// What the model says of the data, with its derivatives.
#[derive(Clone, Debug, Default)]
pub struct Slopes {
    pub predicted: Vec<f64>,
    pub kappa: Vec<f64>,
    pub mu: Vec<f64>,
}

impl Collided<'_> {
    /// The impulse along the surfaces is α m (1 − ε_t) g_t, against the motion.
    fn value(&self, quantity: Measured) -> f64 {
        let alpha = self.bodies.pair.alpha;
        let centre = 1.0 - alpha * (1.0 - self.eps_t);
        match quantity {
            Measured::EpsN => self.eps_n,
            Measured::EpsT => self.eps_t,
            Measured::CentreRestitution => centre,
            Measured::Spin => self.spin_unit() * (1.0 - self.eps_t),
            Measured::ReboundAngle => {
                let Impact { normal_m_per_s, tangential_m_per_s, .. } = *self.impact;
                (centre * tangential_m_per_s).atan2(self.eps_n * normal_m_per_s)
            }
        }
    }

    /// The derivative of [`Self::value`] with respect to ε_t.
    fn slope(&self, quantity: Measured) -> f64 {
        let alpha = self.bodies.pair.alpha;
        match quantity {
            Measured::EpsN => 0.0,
            Measured::EpsT => 1.0,
            Measured::CentreRestitution => alpha,
            Measured::Spin => -self.spin_unit(),
            Measured::ReboundAngle => {
                let along = alpha * self.impact.tangential_m_per_s;
                let normal = self.eps_n * self.impact.normal_m_per_s;
                along * self.value(quantity).cos().powi(2) / normal
            }
        }
    }

    fn spin_unit(&self) -> f64 {
        let pair = &self.bodies.pair;
        let arm = self.bodies.arm_per_inertia.unwrap_or(f64::NAN);
        arm * pair.alpha * pair.effective_mass_kg * self.impact.tangential_m_per_s
    }
}

/// What the model says of one quantity at some angle.
///
/// # Errors
/// The impact cannot be computed.
pub fn predicted_at(
    bodies: &FittedBodies,
    units: &Units,
    values: &Values,
    quantity: Measured,
    angle_rad: f64,
) -> Result<f64, FitError> {
    let datum = Datum::at_angle(angle_rad, units.speed_m_per_s, quantity, 0.0, None);
    let problem = Problem::new(*bodies, *units, std::iter::once(&datum));
    let mut predicted = Vec::with_capacity(1);
    problem.predict(values, &mut predicted)?;
    Ok(predicted[0])
}
