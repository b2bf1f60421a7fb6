//! Collisions over the (κ, ψ) plane, as a family that the tracer can follow.

use stickslip_model::exact;
use stickslip_model::regularized::{GUARDS, Phase, Regularized, STATE};
use stickslip_model::spheres::BodyPair;
use stickslip_model::{CollisionError, Contact, Damping, Engine, InvalidValue, Law, Normal};
use stickslip_solver::margin::Margin;
use stickslip_solver::{Dop853, Options, Start};
use stickslip_tracer::{
    Family, FreeRun, Point, Window,
    hybrid::{FamilyError, HybridFamily, Itinerary, Problem},
};

pub(crate) mod gaining;
pub(crate) mod general;

pub use gaining::GainingFamily;
pub use general::GeneralFamily;

use crate::chart::{Chart, Range};
use crate::label::{CollisionEvent, CollisionLabel};
use crate::oblique::Oblique;
use crate::sheet::Sheet;

/// Collisions over a window of two parameters: κ and ψ at one scaled damping, or the velocities of
/// two bodies.
///
/// For two bodies κ and the damping vary together with the normal velocity, which no plane over κ
/// and ψ at one damping serves. Everything above works on any plane.
///
/// They are traced in the coordinates of a [`Chart`]; [`Self::point`] and [`Self::parameters`]
/// convert.
///
/// ```
/// use stickslip_plane::CollisionPlane;
/// use stickslip_tracer::{TraceOptions, trace, regions::{Location, Subdivision}};
///
/// let plane = CollisionPlane::new((5.0, 8.0), (0.8, 1.2), 0.0)?;
/// let network = trace(&plane.family(), &plane.window(), &TraceOptions::default())?;
/// let regions = Subdivision::new(plane.window(), network.curves, network.vertices, 1e-9)?;
///
/// let place = plane.point(7.5, 1.1);
/// let Location::Region(region) = regions.locate(&place) else { panic!("on a boundary") };
/// // As many guards fire as the collision has switches.
/// let switches = regions.regions()[region].label.as_ref().map(Vec::len);
/// let collision = stickslip_model::exact::collide(plane.contact(&place)?)?;
/// assert_eq!(switches, Some(collision.switches.len()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct CollisionPlane {
    sheet: Sheet,
    parameters: Parameters,
    /// The contact at the lower ends of both parameters. All contacts have its law.
    first: Contact,
}

/// What is computed of a plane, where a law with adhesion is refused.
const BOUNDARIES: &str = "boundaries are";

/// What the two parameters of a plane are.
#[derive(Clone, Copy, Debug)]
enum Parameters {
    /// κ and ψ, at one damping.
    Scaled,
    /// κ at normal incidence and ψ, at one speed.
    Oblique(Oblique),
    /// The normal and the tangential velocity in m/s of two bodies.
    Velocities(BodyPair),
}

/// Collisions as a family of runs.
///
/// The paper's law is traced with the exact engine. Its margins are the numbers by which it
/// decides, and take a fortieth of the instructions of integrated ones. The integrator, which then
/// has no part in the atlas, verifies it.
#[derive(Clone, Copy, Debug)]
pub enum CollisionFamily {
    /// Computed by the exact solution.
    Exact(CollisionPlane),
    /// Computed by integration.
    Integrated(HybridFamily<CollisionPlane, Dop853, STATE, GUARDS>),
    /// Collisions with another law than the paper's, computed by integration.
    General(GeneralFamily),
    /// Collisions with any law, with labels that also say whether |ε_t| is above 1.
    Gaining(GainingFamily),
}

impl CollisionPlane {
    /// The names of κ and ψ as parameters.
    pub const SCALED: [&'static str; 2] = ["kappa", "psi"];
    /// The names of the two velocities as parameters.
    pub const VELOCITIES: [&'static str; 2] = ["normal_m_per_s", "tangential_m_per_s"];

    /// Collisions with κ and ψ between two values each.
    ///
    /// # Errors
    /// [`InvalidValue`]: a value that no collision can have.
    pub fn new(kappa: (f64, f64), psi: (f64, f64), damping: f64) -> Result<Self, InvalidValue> {
        let sides = [kappa, psi].map(|(low, high)| Range { low, high });
        let expected = "a finite number above 0";
        InvalidValue::check("kappa", kappa.0, expected, kappa.0 > 0.0)?;
        let first = Contact::new(kappa.0, psi.0, damping)?;
        Contact::new(kappa.1, psi.1, damping)?;
        let sheet = Sheet { sides, chart: Chart::of(sides[0], sides[1]), integrated: false };
        Ok(Self { sheet, parameters: Parameters::Scaled, first })
    }

    /// Impacts of a pair at one speed, at different angles: κ belongs to normal incidence, and ψ to
    /// the angle at which tan θ = ψ μ/α. Stiffness and damping of the collisions depend on the
    /// normal velocity.
    ///
    /// # Errors
    /// [`InvalidValue`]: a value that no collision can have.
    pub fn oblique(
        oblique: Oblique,
        kappa: (f64, f64),
        psi: (f64, f64),
    ) -> Result<Self, InvalidValue> {
        let BodyPair { law, .. } = oblique.pair;
        law.require_no_adhesion(BOUNDARIES)?;
        let damping = oblique.pair.tangential_damping();
        let plane = Self::new(kappa, psi, oblique.at(1.0, psi.0)?.damping())?;
        let parameters = Parameters::Oblique(oblique);
        Ok(Self { parameters, ..plane.with_law(law, damping)? })
    }

    /// Impacts of a pair with normal and tangential velocities of the surfaces in m/s between two
    /// values each. The normal velocity decides κ and the damping, and both together decide ψ.
    ///
    /// ```
    /// use stickslip_model::spheres::{BodyPair, Material, Surface};
    /// use stickslip_plane::{CollisionPlane, Range};
    ///
    /// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3:
    /// 7850.0 }; let surface =
    ///     Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 1e-6 };
    /// let pair = BodyPair::equal_spheres(0.02, &steel, &surface)?;
    /// let sides = [Range { low: 0.1, high: 10.0 }, Range { low: 0.01, high: 20.0 }];
    /// let plane = CollisionPlane::velocities(pair, sides)?;
    /// let impact = pair.impact(2.0, 0.5)?;
    /// assert_eq!(plane.contact_at([2.0, 0.5])?, impact.contact);
    /// # Ok::<(), stickslip_model::InvalidValue>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidValue`]: a velocity is not above 0, a value that no collision can have, or a law
    /// with adhesion.
    pub fn velocities(pair: BodyPair, sides: [Range; 2]) -> Result<Self, InvalidValue> {
        pair.law.require_no_adhesion(BOUNDARIES)?;
        let [normal, tangential] = sides;
        let first = pair.impact(normal.low, tangential.low)?.contact;
        let chart = Chart::of_velocities(normal, tangential);
        let sheet = Sheet { sides, chart, integrated: !first.obeys_paper() };
        let plane = Self { sheet, parameters: Parameters::Velocities(pair), first };
        plane.corners().into_iter().try_for_each(|corner| plane.contact_at(corner).map(drop))?;
        Ok(plane)
    }

    /// The same collisions in other traced coordinates.
    pub fn with_chart(self, chart: Chart) -> Self {
        Self { sheet: Sheet { chart, ..self.sheet }, ..self }
    }

    /// The same collisions with another law.
    ///
    /// # Errors
    /// [`InvalidValue`]: no collision has this law with the dampings, or it has adhesion.
    pub fn with_law(self, law: Law, tangential_damping: f64) -> Result<Self, InvalidValue> {
        law.require_no_adhesion(BOUNDARIES)?;
        let first = self.first.with_law(law, tangential_damping)?;
        let sheet = Sheet { integrated: !first.obeys_paper(), ..self.sheet };
        Ok(Self { sheet, first, ..self })
    }

    /// The names of the two parameters.
    pub fn names(&self) -> [&'static str; 2] {
        match self.parameters {
            Parameters::Scaled | Parameters::Oblique(_) => Self::SCALED,
            Parameters::Velocities(_) => Self::VELOCITIES,
        }
    }

    /// The window in its traced coordinates.
    pub fn sheet(&self) -> &Sheet {
        &self.sheet
    }

    /// The traced coordinates.
    pub fn chart(&self) -> &Chart {
        &self.sheet.chart
    }

    /// The traced point of two parameters: κ and ψ, or the velocities.
    pub fn point(&self, x: f64, y: f64) -> Point {
        self.chart().point(x, y)
    }

    /// The two parameters of a traced point: the inverse of [`Self::point`].
    pub fn parameters(&self, point: &Point) -> [f64; 2] {
        self.chart().parameters(point)
    }

    /// The window in traced coordinates.
    pub fn window(&self) -> Window {
        self.sheet.window()
    }

    /// The parameters of the four corners of the window.
    pub fn corners(&self) -> [[f64; 2]; 4] {
        let [x, y] = self.sheet.sides;
        [[x.low, y.low], [x.high, y.low], [x.low, y.high], [x.high, y.high]]
    }

    /// The collision with two parameters: κ and ψ, or the velocities.
    ///
    /// # Errors
    /// [`InvalidValue`]: no collision has these values.
    pub fn contact_at(&self, [x, y]: [f64; 2]) -> Result<Contact, InvalidValue> {
        match &self.parameters {
            Parameters::Scaled => Contact::new(x, y, self.first.damping())?
                .with_law(self.first.law(), self.first.tangential_damping()),
            Parameters::Oblique(oblique) => oblique.at(x, y),
            Parameters::Velocities(pair) => pair.impact(x, y).map(|impact| impact.contact),
        }
    }

    /// The collision at a traced point.
    ///
    /// The tracer also computes places a little outside the window, where ψ could fall to 0 or
    /// below. There ψ is kept at half of the window's lower end.
    ///
    /// # Errors
    /// [`InvalidValue`]: κ or ψ is beyond the range of numbers.
    pub fn contact(&self, point: &Point) -> Result<Contact, InvalidValue> {
        let [x, y] = self.parameters(point);
        match self.parameters {
            Parameters::Scaled | Parameters::Oblique(_) => {
                self.contact_at([x, y.max(0.5 * self.sheet.sides[1].low)])
            }
            // Logarithms lead to no velocity of 0.
            Parameters::Velocities(_) => self.contact_at([x, y]),
        }
    }

    /// The collisions as a family: by the exact solution wherever there is one, which makes a trace
    /// ten times as fast, and by integration elsewhere.
    pub fn family(self) -> CollisionFamily {
        match Engine::Auto.resolved(&self.first) {
            Engine::Exact => CollisionFamily::Exact(self),
            _ => self.integrated(),
        }
    }

    /// The collisions as a family that is always integrated. Margins are accurate to about 1e-14.
    pub fn integrated(self) -> CollisionFamily {
        if !self.first.obeys_paper() {
            return CollisionFamily::General(self.general());
        }
        let (method, options, end) = (Dop853, precise(), f64::INFINITY);
        CollisionFamily::Integrated(HybridFamily { problem: self, method, options, end })
    }

    /// The collisions, integrated as for any law, with one more boundary: where |ε_t| is 1.
    pub fn gaining(self) -> CollisionFamily {
        CollisionFamily::Gaining(GainingFamily::new(&self))
    }

    /// The collisions, integrated as for any law.
    fn general(self) -> GeneralFamily {
        GeneralFamily::new(&self, precise())
    }

    /// The contact at the lower ends of both parameters.
    pub(crate) fn first(&self) -> &Contact {
        &self.first
    }

    /// Whether the collisions obey the paper's law.
    pub(crate) fn obeys_paper(&self) -> bool {
        self.first.obeys_paper()
    }

    /// Contacts with the first and the last of all normal motions of the plane, one of which has
    /// the largest κ.
    pub(crate) fn normal_motions(&self) -> [Contact; 2] {
        let Window { low, high } = self.window();
        [low, high].map(|corner| self.contact_or_any(&corner))
    }

    /// Refuses planes whose boundaries may have kinks: those with a friction that decays, which has
    /// one where the velocity reverses, and those with a hysteretic force in which a slip may graze
    /// its end at greatest compression, where this force has a kink, or where bodies yield.
    ///
    /// With the stiffness k = dF/dx a slip is left where s κ w − dF/dt falls through 0, and that
    /// has the rate F (k − κ) at greatest compression: where κ is between both stiffnesses, there
    /// is a minimum without a slope of 0.
    ///
    /// # Errors
    /// [`InvalidValue`] has the interval of κ and those that are expected.
    pub fn require_smooth(&self) -> Result<(), InvalidValue> {
        /// How far traces go beyond the window, as a part of κ.
        const BEYOND: f64 = 0.05;
        let motions = self.normal_motions();
        let [one, other] = motions.map(|contact| contact.kappa());
        let (low, high) = (one.min(other), one.max(other));
        let damping = motions.map(|contact| contact.damping()).into_iter().fold(0.0, f64::max);
        let law = self.first.law();
        if !law.friction.is_constant() {
            let phrase = "has a friction that decays, with a kink where the velocity reverses, which \
                          is not traced";
            return Err(InvalidValue::phrase("the law", phrase, "one coefficient of friction"));
        }
        if !law.damping.is_hysteretic() || !law.remembers() || damping == 0.0 {
            return Ok(());
        }
        if law.damping == Damping::Yielding {
            let expected = "at most 1, which is a normal velocity of yield: beyond, a slip may \
                            graze its end where bodies begin to yield, which is not traced";
            return InvalidValue::check("damping", damping, expected, damping <= 1.0);
        }
        let (loading, power) = match law.normal {
            Normal::Linear => (1.0, 1.0),
            _ => (1.5 * 1.25_f64.powf(0.2), 2.0 / 3.0),
        };
        let (least, most) =
            (loading / (1.0 + BEYOND), loading * (1.0 + damping).powf(power) * (1.0 + BEYOND));
        let expected = format!(
            "below {least:.4} or above {most:.4}: between both stiffnesses of a hysteretic force a \
             slip may graze its end at greatest compression, which is not traced"
        );
        InvalidValue::check("kappa", [low, high], expected, high <= least || low >= most)
    }

    /// The contact at a traced point. Where a parameter is not a number there is nothing to find,
    /// and any contact will do.
    pub(crate) fn contact_or_any(&self, point: &Point) -> Contact {
        self.contact(point).unwrap_or(self.first)
    }
}

impl Problem<STATE, GUARDS> for CollisionPlane {
    type System = Regularized;

    fn at(&self, point: &Point) -> (Regularized, Start<Phase, STATE>) {
        let contact = self.contact_or_any(point);
        let system = Regularized::new(contact);
        (system, Start { mode: Phase::first(&contact), s: 0.0, state: system.start() })
    }
}

/// Options with which margins are accurate to about 1e-14.
fn precise() -> Options {
    Options { rtol: 1e-14, atol: 1e-14, first_step: Some(0.1), max_step: 0.1, ..Options::default() }
}

/// The label of a collision with the paper's law in which `guards` fire.
fn events(guards: &[usize]) -> CollisionLabel {
    guards.iter().filter_map(|&guard| CollisionEvent::fired(guard)).collect()
}

/// The label of an integrated collision. All contacts end, so that any other itinerary
/// is an error.
fn fired(
    family: &HybridFamily<CollisionPlane, Dop853, STATE, GUARDS>,
    point: &Point,
    itinerary: Itinerary,
) -> Result<CollisionLabel, CollisionError> {
    if let Itinerary::Fires(guards) = itinerary {
        return Ok(events(&guards));
    }
    Err(match family.outcome(point) {
        Ok((outcome, time)) => CollisionError::Unfinished { outcome, time },
        Err(error) => error.into(),
    })
}

/// The error of a run; its place is known.
fn of_run(error: FamilyError) -> CollisionError {
    error.error.into()
}

impl Family for CollisionFamily {
    type Label = CollisionLabel;
    type Margin = Margin;
    type Error = CollisionError;

    fn label(&self, point: &Point) -> Result<CollisionLabel, CollisionError> {
        Ok(match self {
            Self::Exact(plane) => {
                CollisionEvent::label(&exact::collide(plane.contact_or_any(point))?)
            }
            Self::Integrated(family) => fired(family, point, family.label(point).map_err(of_run)?)?,
            Self::General(family) => family.label(point),
            Self::Gaining(family) => family.label(point)?,
        })
    }

    fn margin(&self, point: &Point, margin: &Margin) -> Result<Option<f64>, CollisionError> {
        Ok(match self {
            Self::Exact(plane) => exact::margin(&plane.contact_or_any(point), margin)?,
            Self::Integrated(family) => family.margin(point, margin).map_err(of_run)?,
            Self::General(family) => family.margin(point, margin),
            Self::Gaining(family) => family.margin(point, margin)?,
        })
    }

    fn moved(&self, point: &Point, margin: &Margin) -> Result<Margin, CollisionError> {
        Ok(match self {
            Self::Exact(plane) => exact::moved(&plane.contact_or_any(point), margin)?,
            Self::Integrated(family) => family.moved(point, margin).map_err(of_run)?,
            Self::General(family) => {
                family.near_miss(point, margin).map_or_else(|| margin.clone(), |(moved, _)| moved)
            }
            Self::Gaining(family) => family.moved(point, margin)?,
        })
    }

    fn is_sure(&self, margin: &Margin) -> bool {
        match self {
            Self::Exact(_) => true,
            Self::Integrated(family) => family.is_sure(margin),
            Self::General(_) => general::is_sure(margin),
            Self::Gaining(family) => family.is_sure(margin),
        }
    }

    fn cusps(&self, margin: &Margin) -> Vec<[Margin; 2]> {
        match self {
            Self::Exact(plane) => exact::cusps(&plane.first, margin),
            Self::Integrated(_) | Self::General(_) | Self::Gaining(_) => Vec::new(),
        }
    }

    fn swallowtail(&self, margin: &Margin) -> Option<[Margin; 3]> {
        match self {
            Self::Exact(plane) => exact::swallowtail(&plane.first, margin),
            Self::Integrated(_) | Self::General(_) | Self::Gaining(_) => None,
        }
    }

    fn free_run(&self, point: &Point) -> Result<FreeRun<CollisionLabel, Margin>, CollisionError> {
        Ok(match self {
            Self::Exact(plane) => {
                let found = exact::margins(&plane.contact_or_any(point))?;
                FreeRun { label: events(&found.fired), margins: found.near_misses }
            }
            Self::Integrated(family) => {
                let FreeRun { label, margins } = family.free_run(point).map_err(of_run)?;
                FreeRun { label: fired(family, point, label)?, margins }
            }
            Self::General(family) => family.free_run(point),
            Self::Gaining(family) => family.free_run(point)?,
        })
    }
}
