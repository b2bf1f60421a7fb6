//! JSON files of atlases.

use std::path::Path;

use serde::Deserialize;
use stickslip_orbits::document::{self as orbits, OrbitRegions, REGIONS};
use stickslip_orbits::{FollowedOrbits, OrbitBoundary, OrbitNames};
use stickslip_plane::atlas::{AtlasDocument, CollisionAtlas, SCHEMA};
use stickslip_plane::sealed;
use stickslip_solver::margin::Margin;
use stickslip_tracer::{Atlas, RunNames, hybrid::Itinerary};

use super::{json, source};
use crate::error::FileError;

/// Largest number of bytes of a file. Atlases of large windows have some ten million.
const MOST_BYTES: u64 = 1 << 30;

/// The field that is read before the others.
#[derive(Deserialize)]
struct Schema {
    schema: String,
}

/// An atlas of any kind.
#[derive(Debug)]
pub enum AnyAtlas {
    /// Of collisions.
    Collisions(Box<CollisionAtlas>),
    /// Of a system of one's own.
    Runs(Box<NamedAtlas<Itinerary, Margin, RunNames>>),
    /// Of the regions of a periodic orbit.
    Orbits(Box<NamedAtlas<FollowedOrbits, OrbitBoundary, OrbitNames>>),
}

/// An atlas with its names.
#[derive(Debug)]
pub struct NamedAtlas<Label, Margin, Names> {
    /// The atlas.
    pub atlas: Atlas<Label, Margin>,
    /// Its names.
    pub names: Names,
}

/// Reads an atlas; `-` is standard input.
///
/// # Errors
/// [`FileError::Input`]: the file cannot be read, does not hold an atlas, or contradicts itself.
pub fn read(path: &Path) -> Result<AnyAtlas, FileError> {
    let unusable = |reason: String| FileError::input(source::shown(path), reason);
    let text = source::read(path, MOST_BYTES)?;
    let Schema { schema } = json::parse(&text).map_err(unusable)?;
    sealed::check(&text).map_err(|damaged| unusable(damaged.to_string()))?;
    if schema == stickslip_tracer::document::SCHEMA {
        let document: stickslip_tracer::document::FamilyAtlasDocument<Itinerary, Margin> =
            json::parse(&text).map_err(unusable)?;
        let names = document.names();
        let atlas = document.atlas().map_err(|error| unusable(error.to_string()))?;
        return Ok(AnyAtlas::Runs(Box::new(NamedAtlas { atlas, names })));
    }
    if schema == REGIONS {
        let document: orbits::Document<OrbitRegions> = json::parse(&text).map_err(unusable)?;
        let (atlas, names) = document.read().map_err(|error| unusable(error.to_string()))?;
        return Ok(AnyAtlas::Orbits(Box::new(NamedAtlas { atlas, names })));
    }
    if schema != SCHEMA {
        return Err(unusable(format!(
            "schema is {schema:?}; expected {SCHEMA:?} or {:?}, which stickslip trace writes, or \
             {REGIONS:?} of stickslip regions",
            stickslip_tracer::document::SCHEMA
        )));
    }
    let document: AtlasDocument = json::parse(&text).map_err(unusable)?;
    let atlas = CollisionAtlas::try_from(document).map_err(|error| unusable(error.to_string()))?;
    Ok(AnyAtlas::Collisions(Box::new(atlas)))
}
