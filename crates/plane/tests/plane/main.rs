//! Grids, sweeps and atlases of the crate, through its public interface.

mod atlas;
#[cfg(feature = "serde")]
mod document;
mod gaining;
#[cfg(feature = "geojson")]
mod geojson;
mod grid;
mod laws;
mod refusal;
mod stack;
mod sweep;
mod tile;
mod windows;
