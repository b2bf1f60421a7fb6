//! The plane that a map or an atlas shows: two axes, and what there is at each of their points.

use std::ops::Range;

use serde::Deserialize;
use serde_json::{Value, json};

use crate::atlas;
use crate::axis::Axis;
use crate::axis::MapPoint;
use crate::spheres::{Spheres, SpheresRequest};
use crate::system::{SystemPlane, SystemRequest};

/// A plane as a page describes it.
#[derive(Deserialize)]
pub struct SceneRequest {
    x: Axis,
    y: Axis,
    #[serde(flatten)]
    kind: KindRequest,
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
enum KindRequest {
    Spheres(Box<SpheresRequest>),
    System(SystemRequest),
}

/// A plane.
pub struct Scene {
    axes: [Axis; 2],
    /// What there is at its points.
    pub kind: Kind,
}

/// What there is at the points of a plane.
pub enum Kind {
    /// Collisions of two spheres.
    Spheres(Box<Spheres>),
    /// Runs of a system that is a text.
    System(Box<SystemPlane>),
}

impl Scene {
    /// The plane that a page describes.
    pub fn new(SceneRequest { x, y, kind }: SceneRequest) -> Result<Self, Value> {
        x.check("x")?;
        y.check("y")?;
        let kind = match kind {
            KindRequest::Spheres(request) => Kind::Spheres(Box::new(Spheres::new(&request)?)),
            KindRequest::System(request) => Kind::System(Box::new(SystemPlane::new(&request)?)),
        };
        Ok(Self { axes: [x, y], kind })
    }

    /// The names of the values of a point.
    pub fn fields(&self) -> [&str; 4] {
        match &self.kind {
            Kind::Spheres(_) => ["eps_t", "contact_time", "energy_lost", "eps_n"],
            Kind::System(plane) => plane.fields(),
        }
    }

    /// The collisions of the plane.
    pub fn spheres(&self) -> Result<&Spheres, Value> {
        match &self.kind {
            Kind::Spheres(spheres) => Ok(spheres),
            Kind::System(_) => Err(json!({ "error": "the scene has no collisions" })),
        }
    }

    /// Computes rows of a map, from the top, and hands on each point.
    pub fn map(
        &self,
        [columns, rows]: [usize; 2],
        part: Range<usize>,
        mut take: impl FnMut(MapPoint),
    ) {
        let centre = |index: usize, count: usize| (index as f64 + 0.5) / count as f64;
        let [x, y] = &self.axes;
        let mut compute: Box<dyn FnMut([f64; 2]) -> MapPoint + '_> = match &self.kind {
            Kind::Spheres(spheres) => Box::new(spheres.points()),
            Kind::System(plane) => Box::new(|point| plane.point(point)),
        };
        for row in part.start..part.end.min(rows) {
            let y = y.at(1.0 - centre(row, rows));
            for column in 0..columns {
                take(compute([x.at(centre(column, columns)), y]));
            }
        }
    }

    /// The boundaries and regions of the plane.
    pub fn atlas(&self) -> Result<Value, String> {
        let [x, y] = &self.axes;
        match &self.kind {
            Kind::Spheres(spheres) => atlas::of_spheres(spheres, [x, y]),
            Kind::System(plane) => atlas::of_system(plane, [x, y]),
        }
    }
}
