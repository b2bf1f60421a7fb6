//! An atlas made: boundaries traced, regions verified, both written.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use rayon::{ThreadPool, ThreadPoolBuilder};
use stickslip::collisions::CollisionPlane;
use stickslip_model::Contact;
use stickslip_solver::Margin;
use stickslip_tracer::{
    Curve, FamilyError, Network, Node, Point, Subdivision, TraceError, TraceOptions, Tracer,
    Vertex, VertexKind,
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

/// How often a verification may send the tracer back.
const ROUNDS: u64 = 8;

/// Traces the boundaries in `frame`, accurate to `tolerance` in ψ, and verifies the regions. As long as this comes upon other
/// switches than the atlas has, the tracer looks again there.
///
/// # Errors
/// A run fails, or the curves make no regions.
pub fn make(pool: &ThreadPool, frame: Frame, tolerance: f64) -> Result<Made, Failure> {
    let window = frame.window();
    let any = frame.contact(&window.low).map_err(|error| Failure::Trace(error.to_string()))?;
    let Frame { kappa, psi, damping, .. } = frame;
    let plane = CollisionPlane::new((kappa.low, kappa.high), (psi.low, psi.high), damping)
        .map_err(|error| Failure::Trace(error.to_string()))?;
    let family = plane.family();
    let options =
        TraceOptions { interpolation: frame.interpolation(tolerance), ..TraceOptions::default() };
    let mut tracer = Tracer::new(&family, &window, &options).map_err(failure)?;
    tracer.explore().map_err(failure)?;
    let mut round = 1;
    loop {
        let network = tracer.network();
        let unresolved = verification::unresolved(&network);
        let atlas = atlas(frame, tolerance, network, &any)?;
        let (report, brackets) = pool
            .install(|| verification::verify(&atlas, unresolved, round))
            .map_err(|error| Failure::Trace(error.to_string()))?;
        let again = round < ROUNDS && tracer.look_between(&brackets).map_err(failure)?;
        if !again {
            return Ok(Made { atlas, report });
        }
        round += 1;
    }
}

fn failure(error: TraceError<FamilyError>) -> Failure {
    Failure::Trace(match error {
        TraceError::Run { point, source } => {
            let [kappa, psi] = scaled(&point);
            format!("kappa = {kappa:?}, psi = {psi:?}: {}", source.kind)
        }
        error => error.to_string(),
    })
}

/// The atlas of a network.
fn atlas(
    frame: Frame,
    tolerance: f64,
    network: Network<Vec<usize>, Margin>,
    any: &Contact,
) -> Result<Atlas, Failure> {
    let map = map(&frame, tolerance, network, any)?;
    let unbounded = map
        .regions()
        .iter()
        .enumerate()
        .filter(|(_, region)| region.label.is_none())
        .map(|(index, region)| Ok((index, verification::itinerary(&frame, &region.sample)?)))
        .collect::<Result<BTreeMap<_, _>, String>>()
        .map_err(Failure::Trace)?;
    Ok(Atlas { frame, tolerance, map, unbounded })
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
