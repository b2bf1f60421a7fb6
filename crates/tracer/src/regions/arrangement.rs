//! Curves cut into monotone pieces that have an order, and what follows from the order.
//!
//! In reading order: `piece` (edges and their monotone pieces), `slabs` (the order of the pieces),
//! `faces` and `union` (which sides of edges belong to one face), `crossing` (edges that cross
//! without a vertex).

pub mod crossing;
pub mod faces;
pub mod piece;
pub mod slabs;
pub mod union;
