//! The angles at which the switches of impacts of one speed change.

use stickslip_tracer::{Cubic, Node, Point, TraceOptions, trace};

use super::error::AtlasError;
use super::regions::CollisionAtlas;
use crate::chart::Range;
use crate::family::CollisionPlane;
use crate::oblique::Oblique;

/// The places at which the switches change, as far as the tracer found them.
#[derive(Clone, Debug, PartialEq)]
pub struct ObliqueBoundaries {
    /// The angles from the normal in rad, in rising order.
    pub angles_rad: Vec<f64>,
    /// Whether the tracer could explain everything that it saw.
    pub resolved: bool,
}

/// The boundaries are traced in a window of κ that reaches so far in ln κ to both sides.
const REACH: f64 = 0.05;

impl Oblique {
    /// All angles in a range at which the switches change. They are traced around κ, in two
    /// dimensions, since the tracer decides where samples would guess. They are accurate to about
    /// 1e-9.
    ///
    /// ```
    /// use stickslip_model::spheres::{BodyPair, Material, Surface};
    /// use stickslip_plane::{Oblique, Range};
    ///
    /// let steel = Material { young_modulus_pa: 210e9, poisson_ratio: 0.3, density_kg_per_m3:
    /// 7850.0 }; let surface =
    ///     Surface { friction: 0.4, tangential_stiffness_kg_per_s2: 1e9, damping_time_s: 0.0 };
    /// let oblique = Oblique::new(BodyPair::equal_spheres(0.02, &steel, &surface)?, 20.0)?;
    /// let found = oblique.boundaries(Range { low: 0.1, high: 1.5 })?;
    /// // The last one is the boundary of sliding throughout the contact.
    /// let last = found.angles_rad.last().ok_or("no boundary")?;
    /// let switches = |angle| {
    ///     let contact = oblique.contact(angle).unwrap();
    ///     stickslip_model::exact::collide(contact).unwrap().switches.len()
    /// };
    /// assert!(found.resolved && switches(last - 1e-6) == 2 && switches(last + 1e-6) == 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`AtlasError`]: the range is not between 0 and π/2, or an impact cannot be computed.
    pub fn boundaries(&self, angles_rad: Range) -> Result<ObliqueBoundaries, AtlasError> {
        let psi = (self.psi(angles_rad.low), self.psi(angles_rad.high));
        let kappa = (self.kappa() * (-REACH).exp(), self.kappa() * REACH.exp());
        let plane = CollisionPlane::oblique(*self, kappa, psi)?;
        plane.require_smooth()?;
        let x = plane.point(self.kappa(), psi.0).x;
        let network = trace(&plane.family(), &plane.window(), &TraceOptions::default())
            .map_err(|error| AtlasError::of(&plane, error))?;
        let nodes = network.curves.iter().flat_map(|curve| curve.nodes.windows(2));
        let places = nodes.flat_map(|nodes| crossings(nodes, x));
        let angle = |place| self.angle_rad(plane.parameters(&place)[1]);
        let mut angles_rad: Vec<f64> = places.map(angle).collect();
        angles_rad.sort_by(f64::total_cmp);
        Ok(ObliqueBoundaries { angles_rad, resolved: network.unresolved.is_empty() })
    }
}

impl CollisionAtlas {
    /// ψ of all boundaries at `kappa`, in ascending order. They are as accurate as the boundaries.
    pub fn boundaries_at(&self, kappa: f64) -> Vec<f64> {
        let x = self.plane.chart().abscissa(kappa);
        let curves = self.regions.curves().iter().flat_map(|curve| curve.nodes.windows(2));
        let psi = curves.flat_map(|nodes| crossings(nodes, x));
        let mut psi: Vec<f64> = psi.map(|place| self.plane.parameters(&place)[1]).collect();
        psi.sort_by(f64::total_cmp);
        psi
    }
}

/// The places at which the cubic between two nodes crosses the line at `x`.
pub fn crossings(nodes: &[Node], x: f64) -> Vec<Point> {
    let [first, second] = nodes else { return Vec::new() };
    let cubic = Cubic::between(first, second);
    let right = |t: f64| cubic.at(t).x > x;
    let mut found = Vec::new();
    let mut from = 0.0;
    for to in cubic.monotone_cuts().into_iter().chain([1.0]) {
        if right(from) != right(to) {
            found.push(cubic.at(crossing(from, to, right)));
        }
        from = to;
    }
    found
}

/// The place between `from` and `to` at which `right` changes, by bisection to the last bit.
fn crossing(mut from: f64, mut to: f64, right: impl Fn(f64) -> bool) -> f64 {
    let at_start = right(from);
    loop {
        let middle = f64::midpoint(from, to);
        if middle <= from || middle >= to {
            return middle;
        }
        if right(middle) == at_start { from = middle } else { to = middle }
    }
}
