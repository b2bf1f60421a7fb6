//! The file of an atlas, schema [`SCHEMA`]: its layout, how it is made, and how it is read back.
//!
//! Points stand in it as κ and ψ. Traced points go through these before regions are made of them,
//! so that what is traced and what is read have the same regions, bit for bit.
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
