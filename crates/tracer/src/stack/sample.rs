//! The atlases between which a search looks for changes.

use crate::atlas::AtlasOf;
use crate::family::Family;
use crate::stack::structure::Structure;

/// An atlas at a value of the third parameter, with its structure.
pub(super) struct Sample<F: Family> {
    pub value: f64,
    pub atlas: AtlasOf<F>,
    pub structure: Structure<F::Label>,
}
