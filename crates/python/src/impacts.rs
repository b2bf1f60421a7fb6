//! Pairs of bodies in SI units, and their impacts.

use std::iter;
use std::ops::Range;

use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use stickslip_model::document::IMPACT;
use stickslip_model::spheres::{
    Body, Elasticity, Encounter, Forces, ImpactReport, Motion, Sphere, Vector3, Wall, WallMotion,
    quantity,
};
use stickslip_model::{CollisionError, Engine, InvalidValue};
use stickslip_practice::fit::FittedBodies;

use crate::arrays::{Columns, expect_equal, numbers};
use crate::engines::{Choice, LawChoice, document};
use crate::failure::{Failure, bad_input, failed, keeping};
use crate::parallel::Threads;

/// Radius in m, mass in kg, moment of inertia in kg m² or that of a homogeneous sphere, Young's
/// modulus in Pa, Poisson's ratio.
#[derive(FromPyObject)]
struct SphereArguments(f64, f64, Option<f64>, f64, f64);

/// The constants of a law in SI units, as JSON, and the name or the terms of the law.
#[derive(FromPyObject)]
struct ForcesArguments(String, String);

/// What the first sphere hits, if it is not a rigid wall.
#[derive(FromPyObject)]
enum OtherArguments {
    Sphere(SphereArguments),
    /// Young's modulus and Poisson's ratio.
    Wall(f64, f64),
}

/// Three vectors: of a sphere position, velocity and spin; of a wall a point, its normal and its
/// velocity.
#[derive(FromPyObject)]
struct MotionArguments([f64; 3], [f64; 3], [f64; 3]);

/// The mass in kg of a homogeneous sphere.
#[pyfunction]
pub fn homogeneous_mass(radius_m: f64, density_kg_per_m3: f64) -> PyResult<f64> {
    let radius_m = quantity::RADIUS.check(radius_m).map_err(bad_input)?;
    let density_kg_per_m3 = quantity::DENSITY.check(density_kg_per_m3).map_err(bad_input)?;
    Ok(Sphere::homogeneous_mass(radius_m, density_kg_per_m3))
}

/// Two bodies that collide.
#[pyclass(frozen, module = "stickslip._native")]
pub struct BodyPair {
    sphere: Sphere,
    other: Body,
    forces: Forces,
    reduced: stickslip_model::spheres::BodyPair,
}

impl BodyPair {
    /// What the contact feels of the bodies.
    pub fn reduced(&self) -> stickslip_model::spheres::BodyPair {
        self.reduced
    }

    /// The impact with velocities of the surfaces in m/s.
    fn report(&self, velocities: (f64, f64), engine: Engine) -> Result<ImpactReport, Failure> {
        let encounter =
            Encounter::of_velocities(&self.sphere, &self.other, velocities, self.forces)?;
        let (collision, _) = engine.collide(encounter.contact())?;
        let report = ImpactReport::new(&encounter, collision);
        report.require_finite().map_err(CollisionError::from)?;
        Ok(report)
    }

    /// The bodies of a fit.
    pub fn fitted(&self) -> FittedBodies {
        FittedBodies::of_sphere(&self.sphere, self.reduced)
    }
}

#[pymethods]
impl BodyPair {
    #[new]
    fn new(
        sphere: SphereArguments,
        other: Option<OtherArguments>,
        forces: ForcesArguments,
    ) -> PyResult<Self> {
        let sphere = sphere.checked().map_err(bad_input)?;
        let other = match other {
            Some(OtherArguments::Sphere(other)) => {
                Body::Sphere(other.checked().map_err(bad_input)?)
            }
            Some(OtherArguments::Wall(young_modulus_pa, poisson_ratio)) => {
                let elasticity = Elasticity { young_modulus_pa, poisson_ratio };
                Body::Wall(Wall { elasticity: Some(elasticity) })
            }
            None => Body::Wall(Wall { elasticity: None }),
        };
        let ForcesArguments(constants, law) = forces;
        let constants = serde_json::from_str(&constants).map_err(bad_input)?;
        let law = |damping| LawChoice(law.clone(), damping).law();
        let forces = Forces::new(law(0.0)?.0, &constants).map_err(bad_input)?;
        let reduced =
            stickslip_model::spheres::BodyPair::new(&sphere, &other, forces).map_err(bad_input)?;
        law(reduced.tangential_damping())?;
        Ok(Self { sphere, other, forces, reduced })
    }

    /// α and μ.
    #[getter]
    fn reduction(&self) -> (f64, f64) {
        (self.reduced.alpha, self.reduced.surface.friction)
    }

    /// Tangential damping (γ_t/γ_n)/α of all impacts.
    #[getter]
    fn tangential_damping(&self) -> f64 {
        self.reduced.tangential_damping()
    }

    /// The scaled force that separates the bodies, at a normal velocity in m/s.
    fn pull_off(&self, normal_m_per_s: f64) -> PyResult<f64> {
        let impact = self.reduced.impact(normal_m_per_s, normal_m_per_s).map_err(bad_input)?;
        Ok(impact.contact.law().pull_off)
    }

    /// κ, ψ, damping and the unit of time in s for each pair of velocities in m/s.
    fn contacts<'py>(
        &self,
        py: Python<'py>,
        normal: PyReadonlyArray1<'py, f64>,
        tangential: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        expect_equal([normal.len()?, tangential.len()?])?;
        let [mut kappa, mut psi, mut damping, mut unit] = [const { Vec::new() }; 4];
        let velocities = numbers(&normal)?.into_iter().zip(numbers(&tangential)?);
        for (index, (normal, tangential)) in velocities.enumerate() {
            let impact = self
                .reduced
                .impact(normal, tangential)
                .map_err(|error| Failure::from(error).exception(&format!("[{index}] ")))?;
            kappa.push(impact.contact.kappa());
            psi.push(impact.contact.psi());
            damping.push(impact.contact.damping());
            unit.push(impact.time_unit_s);
        }
        PyTuple::new(py, [kappa, psi, damping, unit].map(|column| column.into_pyarray(py)))
    }

    /// The impacts of the bodies with velocities of their surfaces in m/s: their collisions as
    /// columns, and their other numbers, those of [`write_numbers`] one impact after another, NaN
    /// where there is none.
    fn impacts<'py>(
        &self,
        py: Python<'py>,
        velocities: (PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>),
        engine: Choice,
        strict: bool,
        threads: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyArray1<f64>>)> {
        expect_equal([velocities.0.len()?, velocities.1.len()?])?;
        let (normal, tangential) = (numbers(&velocities.0)?, numbers(&velocities.1)?);
        let engine = engine.engine((self.reduced.law, self.reduced.tangential_damping()))?;
        let spheres = match self.other {
            Body::Sphere(_) => 2,
            Body::Wall(_) => 1,
        };
        let work = |part: Range<usize>| {
            let (mut columns, mut values) = (Columns::default(), Vec::new());
            for index in part {
                match self.report((normal[index], tangential[index]), engine) {
                    Ok(report) => {
                        let collision = &report.collision;
                        if report.encounter.is_central() {
                            columns.push_central(collision);
                        } else {
                            columns.push(collision);
                        }
                        write_numbers(&report, &mut values);
                    }
                    Err(failure) => {
                        columns.push_failure(index, failure);
                        let count = NUMBERS + NUMBERS_OF_SPHERE * spheres;
                        values.extend(iter::repeat_n(f64::NAN, count));
                    }
                }
            }
            (columns, values)
        };
        let (mut columns, mut values) = (Columns::default(), Vec::new());
        let count = normal.len();
        let threads = Threads::new(threads, count)?.telling(progress);
        let ended = threads.each(py, count, work, |(part, found)| {
            if let (true, Some((index, failure))) = (strict, part.failures.first()) {
                let place = if count == 1 { String::new() } else { format!("[{index}] ") };
                return Err(failure.exception(&place));
            }
            columns.append(part);
            values.extend(found);
            Ok(())
        });
        let found = (columns.into_dictionary(py)?, values.into_pyarray(py));
        ended.map_err(|error| keeping(py, error, || found.clone().into_bound_py_any(py)))?;
        Ok(found)
    }

    /// The impact of the two bodies with these motions, as the JSON that the program prints.
    fn encounter(
        &self,
        py: Python<'_>,
        motion: MotionArguments,
        other: MotionArguments,
        engine: Choice,
    ) -> PyResult<String> {
        let engine = engine.engine((self.reduced.law, self.reduced.tangential_damping()))?;
        let first = (&self.sphere, &motion.of_sphere());
        let encounter = match &self.other {
            Body::Sphere(sphere) => {
                Encounter::of_spheres(first, (sphere, &other.of_sphere()), self.forces)
            }
            Body::Wall(wall) => Encounter::with_wall(first, (wall, &other.of_wall()), self.forces),
        };
        let encounter = encounter.map_err(bad_input)?;
        let (collision, statistics) =
            py.detach(|| engine.collide(encounter.contact())).map_err(Failure::from)?;
        let report = ImpactReport::new(&encounter, collision);
        report.require_finite().map_err(failed)?;
        document(IMPACT, &report, &engine, statistics.as_ref())
    }
}

/// The numbers of an impact beside its collision, without those of its spheres.
const NUMBERS: usize = 20;
/// The numbers of each sphere.
const NUMBERS_OF_SPHERE: usize = 6;

/// Writes the numbers of an impact in the order that `stickslip.impacts` expects.
fn write_numbers(report: &ImpactReport, out: &mut Vec<f64>) {
    let ImpactReport { encounter, collision, outcome, .. } = report;
    let (contact, observed, energy) = (&collision.contact, &outcome.observed, &outcome.energy);
    out.extend([contact.kappa(), report.psi(), contact.damping()]);
    out.extend([outcome.contact_time_s, encounter.impact.time_unit_s]);
    out.extend([observed.patch_impact_angle_rad, observed.patch_rebound_angle_rad]);
    out.push(observed.centre_e_t.unwrap_or(f64::NAN));
    out.extend([observed.centre_impact_angle_rad, observed.centre_rebound_angle_rad]);
    out.push(observed.impulse_ratio);
    out.extend([energy.kinetic_before_j, energy.kinetic_after_j, energy.work_of_wall_j]);
    out.extend([energy.sliding_j, energy.damping_j, energy.tangential_damping_j]);
    out.extend([energy.spring_left_j, energy.compression_left_j, energy.unbalanced_j()]);
    for motion in report.spheres() {
        out.extend(motion.velocity_m_per_s.iter().chain(motion.spin_rad_per_s.iter()));
    }
}

impl SphereArguments {
    fn checked(&self) -> Result<Sphere, InvalidValue> {
        let Self(radius_m, mass_kg, moment, young_modulus_pa, poisson_ratio) = *self;
        let radius_m = quantity::RADIUS.check(radius_m)?;
        let mass_kg = quantity::MASS.check(mass_kg)?;
        let sphere = Sphere {
            radius_m,
            mass_kg,
            moment_of_inertia_kg_m2: moment
                .unwrap_or_else(|| Sphere::homogeneous_moment(radius_m, mass_kg)),
            elasticity: Elasticity { young_modulus_pa, poisson_ratio },
        };
        sphere.validate()?;
        Ok(sphere)
    }
}

impl MotionArguments {
    fn of_sphere(&self) -> Motion {
        let [position_m, velocity_m_per_s, spin_rad_per_s] = self.vectors();
        Motion { position_m, velocity_m_per_s, spin_rad_per_s }
    }

    fn of_wall(&self) -> WallMotion {
        let [point_m, normal, velocity_m_per_s] = self.vectors();
        WallMotion { point_m, normal, velocity_m_per_s }
    }

    fn vectors(&self) -> [Vector3<f64>; 3] {
        [self.0, self.1, self.2].map(Vector3::from)
    }
}
