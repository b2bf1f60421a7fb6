//! An atlas made: boundaries traced, regions verified, both written.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use rayon::{ThreadPool, ThreadPoolBuilder};
use stickslip_model::Contact;
use stickslip_model::regularized::{GUARDS, Phase, Regularized, STATE};
use stickslip_solver::{Dop853, Margin, Options, Start};
use stickslip_tracer::{
    Curve, Extremum, FamilyError, HybridFamily, Network, Node, Point, Problem, Subdivision,
    TraceError, TraceOptions, Tracer, Vertex,
};

use super::boundary::{Kind, itinerary};
use super::document::Document;
use super::frame::{Frame, scaled, traced};
use super::verification::{self, Report};
use super::{Atlas, Map, geojson, picture};
use crate::error::Failure;
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
    let file = Output::create(&plan.out)?;
    let geography = plan.geojson.as_deref().map(Output::create).transpose()?;

    let (atlas, extrema, report) = make(plan, &pool)?;
    let objection = report.objection();

    let document = Document::new(&atlas, &extrema, report);
    let file = file.write(|out| serde_json::to_writer(out, &document).map_err(Into::into))?;
    let geography = match geography {
        Some(file) => Some(file.write(|out| geojson::write(out, &atlas.map, &document))?),
        None => None,
    };
    let picture = match &plan.plot {
        Some(target) => Some(target.write(&picture::draw(&atlas))?),
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
    match objection {
        Some(reason) => Err(Failure::Doubtful { path: plan.out.clone(), reason }),
        None => Ok(()),
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

    /// Writes all of it, with the end of a line.
    fn write(
        mut self,
        content: impl FnOnce(&mut BufWriter<&mut OutputFile>) -> io::Result<()>,
    ) -> Result<Self, Failure> {
        let mut out = BufWriter::new(&mut self.file);
        let written =
            content(&mut out).and_then(|()| out.write_all(b"\n")).and_then(|()| out.flush());
        drop(out);
        written
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

/// The atlas with the extrema of its boundaries and its verification. As long as this comes upon other switches than the atlas has, the tracer looks again there.
fn make(plan: &TracePlan, pool: &ThreadPool) -> Result<(Atlas, Vec<Extremum>, Report), Failure> {
    let frame = plan.frame;
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
    let options = TraceOptions {
        interpolation: frame.interpolation(plan.tolerance),
        ..TraceOptions::default()
    };
    let mut tracer = Tracer::new(&family, &window, &options).map_err(failure)?;
    tracer.explore().map_err(failure)?;
    let mut round = 1;
    loop {
        let mut network = tracer.network();
        network.name_vertices();
        let unresolved = verification::unresolved(&network);
        let atlas = atlas(plan, network, &fallback)?;
        let (report, brackets) = pool
            .install(|| verification::verify(&atlas, unresolved, round))
            .map_err(|error| Failure::Trace(error.to_string()))?;
        let again = round < ROUNDS && tracer.look_between(&brackets).map_err(failure)?;
        if !again {
            return Ok((atlas, tracer.extrema().map_err(failure)?, report));
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
    plan: &TracePlan,
    network: Network<Vec<usize>, Margin>,
    fallback: &Contact,
) -> Result<Atlas, Failure> {
    let frame = plan.frame;
    let map = map(&frame, plan.tolerance, network, fallback)?;
    let unbounded = map
        .regions()
        .iter()
        .enumerate()
        .filter(|(_, region)| region.label.is_none())
        .map(|(index, region)| Ok((index, verification::itinerary(&frame, &region.sample)?)))
        .collect::<Result<BTreeMap<_, _>, String>>()
        .map_err(Failure::Trace)?;
    Ok(Atlas { frame, tolerance: plan.tolerance, map, unbounded })
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
