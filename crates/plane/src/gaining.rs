//! Where in a window a contact law gives back more tangential energy than it took: the regions in
//! which |ε_t| is above 1, with their boundary.

use stickslip_model::Contact;
use stickslip_solver::margin::Margin;
use stickslip_tracer::{Atlas, AtlasOptions, Curve, Effort, Names, Point, Surveyor};

use crate::atlas::{
    AtlasError, BoundaryKind, Frame, itinerary, polyline, require_traceable, trace_options,
};
use crate::family::gaining::{gains, level};
use crate::family::general::failed;
use crate::family::{CollisionFamily, CollisionPlane};
use crate::label::CollisionLabel;
use crate::progress::{InParallel, Watch};

/// The name of the layout of its file, with its version.
#[cfg(feature = "serde")]
pub const SCHEMA: &str = "stickslip.gaining/1";

/// The regions of a window in which |ε_t| is above 1.
#[derive(Clone, Debug)]
pub struct Gaining {
    /// The window.
    pub frame: Frame,
    /// The accuracy of the lines in ψ.
    pub tolerance: f64,
    plane: CollisionPlane,
    family: CollisionFamily,
    /// The regions in traced coordinates, with what speaks against them.
    pub atlas: Atlas<CollisionLabel, Margin>,
}

/// A line in the window on which |ε_t| is 1.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct GainingLine {
    /// ε_t along the line: 1 or −1.
    pub eps_t: f64,
    /// Whether |ε_t| is above 1 on the left of the line, in the order of its points, with κ to the
    /// right and ψ upwards. On the other side it is not.
    pub gains_left: bool,
    /// Points (κ, ψ), so close that straight lines between them look smooth in a picture of the
    /// window.
    pub points: Vec<[f64; 2]>,
}

/// Traces where |ε_t| is 1, accurate to `tolerance` in ψ, and compares the regions with runs.
///
/// The lines have a vertex where the switches change, and go on behind it with a kink. Regions are
/// told apart by |ε_t| alone, so that an atlas of the switches has no part in them, and they none
/// in it.
///
/// ```
/// use stickslip_model::{Contact, presets};
/// use stickslip_plane::Range;
/// use stickslip_plane::atlas::Frame;
/// use stickslip_plane::gaining;
/// use stickslip_plane::progress::SILENT;
///
/// let law = presets::find("gran/hertz/history").ok_or("no such law")?.law;
/// let range = |low, high| Range { low, high };
/// let frame = Frame { law, ..Frame::new(range(1.2, 1.3), range(0.85, 1.0), 0.0) };
/// let gaining = gaining::trace(frame, frame.tolerances().usual, SILENT)?;
/// assert!(gaining.agrees());
/// let [line] = &gaining.lines()[..] else { panic!("one line") };
/// assert_eq!(line.eps_t, -1.0);
/// let gains = |psi| Contact::new(1.25, psi, 0.0)?.with_law(law, 0.0).map(|at| gaining.gains(&at));
/// assert_eq!([gains(0.875)?, gains(0.99)?], [Some(true), Some(false)]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`AtlasError`]: the window or the tolerance is not possible, a run fails, or the curves do not
/// make regions. An unresolved boundary is not an error: see [`Gaining::agrees`].
pub fn trace<'w>(
    frame: Frame,
    tolerance: f64,
    watch: impl Into<Watch<'w>>,
) -> Result<Gaining, AtlasError> {
    trace_with(frame, tolerance, Effort::Default, watch.into())
}

/// As [`trace`], with another effort. It is compiled once, in this crate, as with atlases.
///
/// # Errors
/// As [`trace`].
pub fn trace_with(
    frame: Frame,
    tolerance: f64,
    effort: Effort,
    watch: Watch<'_>,
) -> Result<Gaining, AtlasError> {
    let plane = frame.plane()?;
    require_traceable(&plane, tolerance)?;
    let options = effort.applied(AtlasOptions {
        trace: trace_options(&plane, tolerance),
        tolerance: plane.sheet().resolution(tolerance),
        ..AtlasOptions::default()
    });
    let surveyor = Surveyor { options, executor: InParallel, watch };
    let family = plane.gaining();
    let atlas =
        surveyor.atlas(&family, &plane.window()).map_err(|error| AtlasError::of(&plane, error))?;
    Ok(Gaining { frame, tolerance, plane, family, atlas })
}

impl Gaining {
    /// The lines on which |ε_t| is 1. A line ends where the switches change, and another goes on
    /// there.
    pub fn lines(&self) -> Vec<GainingLine> {
        let extent = self.atlas.plane.window().extent();
        let line = |curve: &Curve<CollisionLabel, Margin>| {
            let eps_t = level(&curve.margin)?;
            let points = polyline(self.plane.chart(), &extent, curve);
            Some(GainingLine { eps_t, gains_left: gains(&curve.sides[0]), points })
        };
        self.atlas.plane.curves().iter().filter_map(line).collect()
    }

    /// Whether |ε_t| of the collision with κ and ψ of a contact is above 1; damping and law are
    /// taken from the window. On a line, and where regions are in doubt, the collision itself
    /// decides. `None` outside of the window, and where the collision cannot be computed.
    pub fn gains(&self, contact: &Contact) -> Option<bool> {
        let point = self.plane.point(contact.kappa(), contact.psi());
        let label = self.atlas.decide(&self.family, &point).ok()??;
        (label != failed()).then(|| gains(&label))
    }

    /// The least and the largest κ and ψ along the lines; `None` if there are none.
    pub fn extent(&self) -> Option<[[f64; 2]; 2]> {
        let lines = self.lines();
        let mut points = lines.iter().flat_map(|line| &line.points);
        let &[kappa, psi] = points.next()?;
        let first = [[kappa, kappa], [psi, psi]];
        Some(points.fold(first, |[k, p], &[kappa, psi]| {
            [[k[0].min(kappa), k[1].max(kappa)], [p[0].min(psi), p[1].max(psi)]]
        }))
    }

    /// Whether nothing speaks against the regions: all changes are explained, and all runs agree.
    pub fn agrees(&self) -> bool {
        self.atlas.agrees()
    }

    /// What speaks against the lines, in sentences; none if nothing does.
    pub fn objections(&self) -> Vec<String> {
        self.atlas.doubts(self).map_or_else(Vec::new, |doubts| doubts.sentences())
    }

    /// The numbers of objections and the first one; `None` if nothing speaks against the lines.
    pub fn objection(&self) -> Option<String> {
        self.atlas.doubts(self).map(|doubts| doubts.objection())
    }
}

#[cfg(feature = "serde")]
impl Gaining {
    /// The lines in the layout of their file, [`SCHEMA`].
    pub fn document(&self) -> serde_json::Value {
        serde_json::json!({
            "schema": SCHEMA,
            "window": crate::atlas::WindowFields::new(&self.frame),
            "tolerance": self.tolerance,
            "agrees": self.agrees(),
            "objections": self.objections(),
            "lines": self.lines(),
        })
    }
}

impl Names<CollisionLabel, Margin> for Gaining {
    fn axes(&self) -> [&str; 2] {
        self.plane.names()
    }

    fn parameters(&self, point: &Point) -> [f64; 2] {
        self.plane.parameters(point)
    }

    fn point(&self, [x, y]: [f64; 2]) -> Point {
        self.plane.point(x, y)
    }

    fn text(&self, label: &CollisionLabel) -> String {
        let text = match label.last() {
            _ if gains(label) => "|eps_t| above 1",
            None => "|eps_t| up to 1",
            Some(_) => return itinerary(self.plane.first(), label),
        };
        text.to_owned()
    }

    fn kind(&self, margin: &Margin) -> &'static str {
        match level(margin) {
            Some(_) => "gain",
            None => BoundaryKind::of(self.plane.first(), margin).name(),
        }
    }
}
