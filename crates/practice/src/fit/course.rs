//! The fit as a function of the angle, and where the switches change along it.

use stickslip_model::{CollisionError, CollisionFailure, Engine};
use stickslip_plane::atlas::{AtlasError, ObliqueBoundaries};
use stickslip_plane::{Oblique, Range};

use super::FitError;
use super::bodies::{FittedBodies, Units, Values};
use super::data::{Datum, Measured};
use super::problem::predicted_at;

/// The best fit at all angles, at one speed.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct FittedCourse {
    /// The angles from the normal in rad.
    pub angles_rad: Range,
    /// Where the switches change, in rising order of angles.
    pub boundaries: Vec<Boundary>,
    /// Whether the tracer of boundaries could explain everything that it saw.
    pub resolved: bool,
    /// Why no boundaries are traced, if they are not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub untraced: Option<String>,
    /// What the model says of each measured quantity, at the best and the next minima.
    #[serde(skip)]
    pub curves: Vec<FittedCurve>,
}

/// An angle at which the switches change.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Boundary {
    /// The angle from the normal in rad.
    pub angle_rad: f64,
    /// The itinerary at smaller angles.
    pub below: String,
    /// The itinerary at larger angles.
    pub above: String,
}

/// A quantity over the angle, by one of the minima.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedCurve {
    /// The quantity.
    pub quantity: Measured,
    /// The index of the minimum.
    pub minimum: usize,
    /// Angles from the normal in degrees, and the quantity as [`Measured::shown`], up to the angle
    /// at which adhesion holds the bodies together.
    pub points: Vec<(f64, f64)>,
}

/// Minima that have curves.
pub const DRAWN: usize = 3;
/// Points of a curve.
const POINTS: u32 = 361;

impl FittedCourse {
    /// The course of `minima`, the best one first, over the angles of the data and some more.
    ///
    /// # Errors
    /// [`FitError`]: an impact cannot be computed.
    pub fn new(
        bodies: &FittedBodies,
        units: &Units,
        data: &[Datum],
        minima: &[Values],
    ) -> Result<Option<Self>, FitError> {
        let angles = data.iter().map(Datum::angle_rad).filter(|angle| *angle > 0.0);
        let (least, most) = angles
            .fold((f64::INFINITY, 0.0), |(least, most): (f64, f64), angle| {
                (least.min(angle), most.max(angle))
            });
        let Some(best) = minima.first().filter(|_| most > 0.0) else { return Ok(None) };
        let right = std::f64::consts::FRAC_PI_2;
        let angles_rad = Range { low: 0.5 * least, high: 0.5 * (most + right) };
        let oblique = Oblique::new(bodies.with(units, best), units.speed_m_per_s)?;
        let (found, untraced) = match oblique.boundaries(angles_rad) {
            Err(AtlasError::Parameter(reason)) => {
                (ObliqueBoundaries { angles_rad: Vec::new(), resolved: false }, Some(reason))
            }
            found => (found.map_err(Box::new)?, None),
        };
        let ends = [&[angles_rad.low], &found.angles_rad[..], &[angles_rad.high]].concat();
        let itinerary = |ends: &[f64]| {
            let contact = oblique.contact(f64::midpoint(ends[0], ends[1]))?;
            let found = Engine::Auto.collide(contact);
            let (collision, _) = found.map_err(|source| CollisionFailure::new(&contact, source))?;
            Ok(collision.itinerary())
        };
        let itineraries: Result<Vec<String>, FitError> = ends.windows(2).map(itinerary).collect();
        let itineraries = itineraries?;
        let boundaries = found.angles_rad.iter().zip(itineraries.windows(2));
        let boundaries = boundaries.map(|(angle, sides)| Boundary {
            angle_rad: *angle,
            below: sides[0].clone(),
            above: sides[1].clone(),
        });
        // Some laws have boundaries on which only the order of other events changes.
        let boundaries = boundaries.filter(|it| it.below != it.above).collect();
        let curves = curves(bodies, units, data, minima, angles_rad)?;
        let (resolved, untraced) = (found.resolved, untraced.map(|reason| reason.to_string()));
        Ok(Some(Self { angles_rad, boundaries, resolved, untraced, curves }))
    }
}

fn curves(
    bodies: &FittedBodies,
    units: &Units,
    data: &[Datum],
    minima: &[Values],
    angles_rad: Range,
) -> Result<Vec<FittedCurve>, FitError> {
    let measured = |quantity: &Measured| data.iter().any(|datum| datum.quantity == *quantity);
    let mut curves = Vec::new();
    for quantity in Measured::ALL.into_iter().filter(measured) {
        for (minimum, values) in minima.iter().take(DRAWN).enumerate() {
            let point = |index: u32| {
                let part = f64::from(index) / f64::from(POINTS - 1);
                let angle = angles_rad.low + part * (angles_rad.high - angles_rad.low);
                match predicted_at(bodies, units, values, quantity, angle) {
                    Ok(value) => Ok(Some((angle.to_degrees(), quantity.shown(value)))),
                    Err(FitError::Contact(CollisionFailure {
                        source: CollisionError::Adheres { .. },
                        ..
                    })) => Ok(None),
                    Err(error) => Err(error),
                }
            };
            let points: Result<Vec<_>, FitError> =
                (0..POINTS).filter_map(|index| point(index).transpose()).collect();
            curves.push(FittedCurve { quantity, minimum, points: points? });
        }
    }
    Ok(curves)
}
