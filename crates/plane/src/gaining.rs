//! Where in a window a contact law gives back more tangential energy than it took: the regions in
//! which |ε_t| is above 1, with their boundary.

use stickslip_model::{Collider, Contact};
use stickslip_solver::Margin;
use stickslip_tracer::{Atlas, AtlasOptions, Curve, Location, Surveyor};

use crate::atlas::{AtlasError, Frame, polyline, require_traceable, trace_options};
use crate::chart::Chart;
use crate::family::CollisionPlane;
use crate::family::gaining::{GainingFamily, gains, is_level};
use crate::progress::{InParallel, Watch};

/// The regions of a window in which |ε_t| is above 1.
#[derive(Clone, Debug)]
pub struct Gaining {
    /// The window.
    pub frame: Frame,
    plane: CollisionPlane,
    /// All regions in traced coordinates, also those of the switches, which divide those that are
    /// asked for; with what speaks against them.
    pub atlas: Atlas<Vec<usize>, Margin>,
}

/// What the regions tell about a contact.
enum Traced {
    Outside,
    /// Whether |ε_t| is above 1.
    Region(bool),
    /// On a boundary, in a region in doubt, or in one that no boundary touches.
    Open,
}

/// Traces where |ε_t| is 1, accurate to `tolerance` in ψ, with the boundaries of the switches, and
/// compares the regions with runs.
///
/// Where the boundary begins, at κψ = 1 with κ = 1, 4.5, 10.5, … for Mindlin's stiffness and history
/// by displacement, it touches one of the switches. Within some 1e-6 of such a point changes stay
/// unresolved, and the regions beside it are in doubt: [`Gaining::gains`] computes the collision there.
///
/// ```
/// use stickslip_model::{Contact, presets};
/// use stickslip_plane::Range;
/// use stickslip_plane::atlas::Frame;
/// use stickslip_plane::gaining;
///
/// let law = presets::find("gran/hertz/history").ok_or("no such law")?.law;
/// let range = |low, high| Range { low, high };
/// let frame = Frame { law, ..Frame::new(range(1.2, 1.3), range(0.85, 1.0), 0.0) };
/// let gaining = gaining::trace(frame, frame.tolerances().usual)?;
/// assert!(gaining.agrees());
/// assert_eq!(gaining.boundaries().len(), 1);
/// let gains = |psi| Contact::new(1.25, psi, 0.0)?.with_law(law, 0.0).map(|at| gaining.gains(&at));
/// assert_eq!([gains(0.875)?, gains(0.99)?], [Some(true), Some(false)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`AtlasError`]: the window or the tolerance is not possible, a run fails, or the curves do not
/// make regions. What cannot be resolved is no error: [`Gaining::agrees`] tells.
pub fn trace(frame: Frame, tolerance: f64) -> Result<Gaining, AtlasError> {
    let plane = frame.plane()?;
    require_traceable(&plane, tolerance)?;
    let options = AtlasOptions {
        trace: trace_options(&plane, tolerance),
        tolerance: plane.sheet().resolution(tolerance),
        ..AtlasOptions::default()
    };
    let surveyor = Surveyor { options, executor: InParallel, watch: Watch::SILENT };
    let atlas = surveyor
        .atlas(&GainingFamily::new(plane), &plane.window())
        .map_err(|error| AtlasError::of_atlas(&plane, error))?;
    Ok(Gaining { frame, plane, atlas })
}

impl Gaining {
    /// The points (κ, ψ) along each boundary on which |ε_t| is 1. A boundary ends where the switches
    /// change, and another goes on there.
    #[must_use]
    pub fn boundaries(&self) -> Vec<Vec<[f64; 2]>> {
        let extent = self.atlas.plane.window().extent();
        self.curves().map(|curve| polyline(self.chart(), &extent, curve)).collect()
    }

    fn curves(&self) -> impl Iterator<Item = &Curve<Vec<usize>, Margin>> {
        self.atlas.plane.curves().iter().filter(|curve| is_level(&curve.margin))
    }

    fn chart(&self) -> &Chart {
        self.plane.chart()
    }

    /// Whether |ε_t| of a contact in the window is above 1. On a boundary, and in a region in doubt,
    /// the collision itself decides; damping and law are those of the window. `None` outside of it,
    /// and where the collision cannot be computed.
    #[must_use]
    pub fn gains(&self, contact: &Contact) -> Option<bool> {
        match self.traced(contact) {
            Traced::Outside => None,
            Traced::Region(gains) => Some(gains),
            Traced::Open => {
                let contact = self.plane.contact_at([contact.kappa(), contact.psi()]).ok()?;
                let collision = Collider::default().collide(contact).ok()?;
                Some(collision.eps_t().abs() > 1.0)
            }
        }
    }

    /// Whether the regions alone tell if |ε_t| of a contact is above 1.
    #[must_use]
    pub fn is_told(&self, contact: &Contact) -> bool {
        matches!(self.traced(contact), Traced::Region(_))
    }

    fn traced(&self, contact: &Contact) -> Traced {
        let point = self.chart().point(contact.kappa(), contact.psi());
        match self.atlas.plane.locate(&point) {
            Location::Outside => Traced::Outside,
            Location::Region(region) if !self.atlas.is_doubtful(region) => {
                let label = self.atlas.plane.regions()[region].label.as_ref();
                label.map_or(Traced::Open, |label| Traced::Region(gains(label)))
            }
            _ => Traced::Open,
        }
    }

    /// The least and the largest κ and ψ along the boundaries; `None` if there are none.
    #[must_use]
    pub fn extent(&self) -> Option<[[f64; 2]; 2]> {
        let boundaries = self.boundaries();
        let mut points = boundaries.iter().flatten();
        let &[kappa, psi] = points.next()?;
        let first = [[kappa, kappa], [psi, psi]];
        Some(points.fold(first, |[k, p], &[kappa, psi]| {
            [[k[0].min(kappa), k[1].max(kappa)], [p[0].min(psi), p[1].max(psi)]]
        }))
    }

    /// Whether nothing speaks against the regions: all changes are explained, and all runs agree.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.atlas.agrees()
    }
}
