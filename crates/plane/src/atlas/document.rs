//! The file of an atlas, schema [`SCHEMA`]: its layout, how it is made, and how it is read back.
//!
//! Start reading in `layout`; then `write` and `read`, with `error` for what a reader refuses.

mod error;
mod layout;
mod read;
mod write;

pub use error::AtlasDocumentError;
pub use layout::{
    AtlasDocument, BoundaryEnd, BoundaryFields, ExtremalParameter, ExtremumFields, RegionFields,
    SCHEMA, Switching, VertexFields, WindowFields,
};
