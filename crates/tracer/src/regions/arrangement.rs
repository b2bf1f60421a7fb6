//! Curves cut into monotone pieces that have an order, and what follows from the order.
//!
//! Walls through the ends of all pieces divide the plane into slabs. One structure then gives
//! faces, islands, point location and vertical distances. A list of half-edges would need the order
//! of curves that leave a vertex with one tangent, as at cusps and touches. Faces are joined
//! through the gaps between pieces and need that order only where one curve leaves the window's
//! edge, since the part of the edge up to the next vertex may be too short for a gap. Faces are
//! counted in the plane, and vertices, edges and components in the graph, so that Euler's formula
//! is a check.
//!
//! In reading order: `piece` (edges and their monotone pieces), `slabs` (the order of the pieces),
//! `faces` and `union` (which sides of edges belong to one face), `crossing` (edges that cross
//! without a vertex).

pub mod crossing;
pub mod faces;
pub mod piece;
pub mod slabs;
pub mod union;
