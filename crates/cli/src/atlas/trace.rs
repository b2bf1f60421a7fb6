//! An atlas made: boundaries traced, regions verified, both written.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::Path;

use rayon::{ThreadPool, ThreadPoolBuilder};
use stickslip::collisions::CollisionFamilyError;
use stickslip_model::{Contact, InvalidParameter};
use stickslip_solver::Margin;
use stickslip_tracer::{
    Curve, Extremum, Network, Node, Point, Subdivision, TraceError, TraceOptions, Tracer, Vertex,
};

use super::boundary::{Kind, itinerary};
use super::document::Document;
use super::frame::{Frame, scaled, traced};
use super::verification::{self, Report};
use super::{Atlas, Map, geojson, picture};
use crate::error::Failure;
use crate::figure::number;
use crate::output::OutputFile;
use crate::plan::TracePlan;

/// Traces the boundaries of the window and writes its atlas.
///
/// # Errors
/// A run fails, files cannot be written, or something speaks against the atlas; in the last case it
/// is complete and says so.
pub fn run(plan: &TracePlan) -> Result<(), Failure> {
    if let Some(target) = &plan.plot {
        target.check()?;
    }
    let pool = ThreadPoolBuilder::new().num_threads(plan.threads.unwrap_or(0)).build()?;
    let file = Output::create(&plan.out)?;
    let geography = plan.geojson.as_deref().map(Output::create).transpose()?;

    let made = make(&pool, plan.frame, plan.tolerance)?;
    let file = file.write(made.file())?;
    let geography = match geography {
        Some(file) => Some(file.write(geojson::file(&made.atlas.map, &made.document()))?),
        None => None,
    };
    let picture = match &plan.plot {
        Some(target) => Some(target.write(&picture::draw(&made.atlas))?),
        None => None,
    };
    // All are complete before one of them gets its name.
    file.publish()?;
    if let Some(geography) = geography {
        geography.publish()?;
    }
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
    /// The extrema of its boundaries.
    pub extrema: Vec<Extremum>,
    /// What was found.
    pub report: Report,
}

impl Made {
    /// The atlas as it is written.
    fn document(&self) -> Document {
        Document::new(&self.atlas, &self.extrema, self.report.clone())
    }

    /// The atlas as a file.
    ///
    /// # Errors
    /// It does not fit into memory.
    pub fn file(&self) -> io::Result<Vec<u8>> {
        let mut bytes = serde_json::to_vec(&self.document())?;
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
        let Self { atlas: Atlas { map, .. }, report, .. } = self;
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

/// A file of text with its name for errors.
struct Output<'a> {
    path: &'a Path,
    file: OutputFile,
}

impl<'a> Output<'a> {
    fn create(path: &'a Path) -> Result<Self, Failure> {
        let file = OutputFile::create(path).map_err(|error| Failure::output(path, error))?;
        Ok(Self { path, file })
    }

    /// Writes all of it.
    fn write(mut self, content: io::Result<Vec<u8>>) -> Result<Self, Failure> {
        content
            .and_then(|content| self.file.write_all(&content))
            .and_then(|()| self.file.store())
            .map_err(|error| Failure::output(self.path, error))?;
        Ok(self)
    }

    fn publish(self) -> Result<(), Failure> {
        self.file.publish().map_err(|error| Failure::output(self.path, error))
    }
}

/// How often a verification may send the tracer back.
const ROUNDS: u64 = 8;

/// Traces the boundaries in `frame`, accurate to `tolerance` in ψ, and verifies the regions. As
/// long as this comes upon other switches than the atlas has, the tracer looks again there.
///
/// # Errors
/// A run fails, or the curves make no regions.
pub fn make(pool: &ThreadPool, frame: Frame, tolerance: f64) -> Result<Made, Failure> {
    let invalid = |error: InvalidParameter| Failure::Trace(error.to_string());
    let plane = frame.plane().map_err(invalid)?;
    let window = plane.window();
    let any = plane.contact(&window.low).map_err(invalid)?;
    let family = plane.family();
    let options =
        TraceOptions { interpolation: frame.interpolation(tolerance), ..TraceOptions::default() };
    let mut tracer = Tracer::new(&family, &window, &options).map_err(failure)?;
    tracer.explore().map_err(failure)?;
    let mut round = 1;
    loop {
        let mut network = tracer.network();
        network.name_vertices();
        let unresolved = verification::unresolved(&network);
        let atlas = atlas(frame, tolerance, network, &any)?;
        let (report, brackets) = pool
            .install(|| verification::verify(&atlas, unresolved, round))
            .map_err(|error| Failure::Trace(error.to_string()))?;
        let again = round < ROUNDS && tracer.look_between(&brackets).map_err(failure)?;
        if !again {
            let extrema = tracer.extrema().map_err(failure)?;
            return Ok(Made { atlas, extrema, report });
        }
        round += 1;
    }
}

fn failure(error: TraceError<CollisionFamilyError>) -> Failure {
    Failure::Trace(match error {
        TraceError::Run { point, source } => {
            let [kappa, psi] = scaled(&point);
            format!("kappa = {kappa:?}, psi = {psi:?}: {source}")
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

/// The regions that the traced curves make. Points go through (κ, ψ), as they are written, so that
/// a file makes the same regions bit for bit.
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
    let vertices = network.vertices.into_iter().map(|vertex| Vertex {
        point: written(&vertex.point),
        kind: vertex.kind,
        margins: Vec::new(),
    });
    let vertices: Vec<_> = vertices.collect();
    let resolution = frame.resolution(tolerance);
    Subdivision::new(frame.window(), curves, vertices, resolution)
        .map_err(|error| Failure::Trace(error.to_string()))
}
