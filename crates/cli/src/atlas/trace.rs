//! An atlas made: boundaries traced, regions verified, both written.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use rayon::{ThreadPool, ThreadPoolBuilder};
use stickslip_model::Contact;
use stickslip_model::regularized::{GUARDS, Phase, Regularized, STATE};
use stickslip_solver::{Dop853, Margin, Options, Start};
use stickslip_tracer::{
    Curve, HybridFamily, Network, Node, Point, Problem, Subdivision, TraceError, TraceOptions,
    Vertex, VertexKind, trace,
};

use super::boundary::{Kind, itinerary};
use super::document::Document;
use super::frame::{Frame, scaled, traced};
use super::verification::{self, Report};
use super::{Atlas, Map, picture};
use crate::error::Failure;
use crate::figure::number;
use crate::output::OutputFile;
use crate::plan::TracePlan;

/// Traces the boundaries of the window and writes its atlas.
///
/// # Errors
/// A run fails, files cannot be written, or something speaks against the atlas; in the last case it is complete and says so.
pub fn run(plan: &TracePlan) -> Result<(), Failure> {
    if let Some(target) = &plan.plot {
        target.check()?;
    }
    let pool = ThreadPoolBuilder::new().num_threads(plan.threads.unwrap_or(0)).build()?;
    let failed = |error| Failure::output(&plan.out, error);
    let mut file = OutputFile::create(&plan.out).map_err(failed)?;

    let made = make(&pool, plan.frame, plan.tolerance)?;
    let bytes = made.file().map_err(failed)?;
    file.write_all(&bytes).map_err(failed)?;
    file.store().map_err(failed)?;
    let picture = match &plan.plot {
        Some(target) => Some(target.write(&picture::draw(&made.atlas))?),
        None => None,
    };
    // Both are complete before one of them gets its name.
    file.publish().map_err(failed)?;
    if let Some(picture) = picture {
        picture.publish()?;
    }
    made.objection(&plan.out).map_or(Ok(()), Err)
}

/// An atlas, and what its verification found.
#[derive(Clone, Debug)]
pub struct Made {
    /// The atlas.
    pub atlas: Atlas,
    /// What was found.
    pub report: Report,
}

/// Traces the boundaries in `frame`, accurate to `tolerance` in ψ, and verifies the regions.
///
/// # Errors
/// A run fails, or the curves make no regions.
pub fn make(pool: &ThreadPool, frame: Frame, tolerance: f64) -> Result<Made, Failure> {
    let (atlas, unresolved) = traced_atlas(frame, tolerance)?;
    let report = pool
        .install(|| verification::verify(&atlas, unresolved))
        .map_err(|error| Failure::Trace(error.to_string()))?;
    Ok(Made { atlas, report })
}

impl Made {
    /// The atlas as a file.
    ///
    /// # Errors
    /// It does not fit into memory.
    pub fn file(&self) -> io::Result<Vec<u8>> {
        let mut bytes = serde_json::to_vec(&Document::new(&self.atlas, self.report.clone()))?;
        bytes.push(b'\n');
        Ok(bytes)
    }

    /// What speaks against the atlas in the file `path`.
    pub fn objection(&self, path: &Path) -> Option<Failure> {
        let reason = self.report.objection()?;
        Some(Failure::Doubtful { path: path.to_owned(), reason })
    }

    /// What is in it and how it was verified, in a sentence.
    pub fn summary(&self) -> String {
        let Self { atlas: Atlas { map, .. }, report } = self;
        let agree = if report.agrees { "all agree with it" } else { "not all agree with it" };
        format!(
            "Traced were {} boundaries, {} vertices and {} regions. Of {} collisions computed at random points and beside boundaries \
             {agree}; with 95 % confidence less than {} of the plane is wrong.",
            map.curves().len(),
            map.vertices().len(),
            map.regions().len(),
            report.tried,
            number(report.share_wrong_bound, 2)
        )
    }
}

/// The atlas, and what the tracer could not explain.
fn traced_atlas(frame: Frame, tolerance: f64) -> Result<(Atlas, Vec<String>), Failure> {
    let window = frame.window();
    let fallback = frame.contact(&window.low).map_err(|error| Failure::Trace(error.to_string()))?;
    let family = HybridFamily {
        problem: Collisions { frame, fallback },
        method: Dop853,
        options: Options {
            rtol: 1e-14,
            atol: 1e-14,
            first_step: Some(0.1),
            max_step: 0.1,
            ..Options::default()
        },
        end: f64::INFINITY,
    };
    let options =
        TraceOptions { interpolation: frame.interpolation(tolerance), ..TraceOptions::default() };
    let network = trace(&family, &window, &options).map_err(|error| {
        Failure::Trace(match error {
            TraceError::Run { point, source } => {
                let [kappa, psi] = scaled(&point);
                format!("kappa = {kappa:?}, psi = {psi:?}: {}", source.kind)
            }
            error => error.to_string(),
        })
    })?;
    let unresolved = verification::unresolved(&network);
    let map = map(&frame, tolerance, network, &fallback)?;
    let unbounded = map
        .regions()
        .iter()
        .enumerate()
        .filter(|(_, region)| region.label.is_none())
        .map(|(index, region)| Ok((index, verification::itinerary(&frame, &region.sample)?)))
        .collect::<Result<BTreeMap<_, _>, String>>()
        .map_err(Failure::Trace)?;
    Ok((Atlas { frame, tolerance, map, unbounded }, unresolved))
}

/// Collisions at the traced points of a window.
struct Collisions {
    frame: Frame,
    /// Stands for places outside of the window at which κ is no number.
    fallback: Contact,
}

impl Problem<STATE, GUARDS> for Collisions {
    type System = Regularized;

    fn at(&self, point: &Point) -> (Regularized, Start<Phase, STATE>) {
        let contact = self.frame.contact(point).unwrap_or(self.fallback);
        let system = Regularized::new(contact);
        (system, Start { mode: Phase::first(&contact), s: 0.0, state: system.start() })
    }
}

/// The regions that the traced curves make. Points go through (κ, ψ), as they are written, so that a file makes the same regions
/// bit for bit.
fn map(
    frame: &Frame,
    tolerance: f64,
    network: Network<Vec<usize>, Margin>,
    any: &Contact,
) -> Result<Map, Failure> {
    let written = |point: &Point| traced(frame.snapped(scaled(point)));
    let curves = network.curves.into_iter().map(|curve| Curve {
        margin: Kind::of(any, &curve.margin),
        sides: curve.sides.map(|guards| itinerary(any, &guards)),
        nodes: curve
            .nodes
            .iter()
            .map(|node| Node { point: written(&node.point), tangent: node.tangent })
            .collect(),
        ends: curve.ends,
    });
    let curves: Vec<_> = curves.collect();
    let vertices = network.vertices.into_iter().enumerate().map(|(index, vertex)| {
        let ends = curves.iter().filter_map(|curve| curve.ends).flatten();
        let meeting = ends.filter(|&end| end == index).count();
        let kind = match vertex.kind {
            // The tracer names what it finds first; where others go on, boundaries meet.
            VertexKind::Degenerate if meeting > 2 => VertexKind::Crossing,
            kind => kind,
        };
        Vertex { point: written(&vertex.point), kind, margins: Vec::new() }
    });
    let vertices: Vec<_> = vertices.collect();
    let resolution = frame.resolution(tolerance);
    Subdivision::new(frame.window(), curves, vertices, resolution)
        .map_err(|error| Failure::Trace(error.to_string()))
}
