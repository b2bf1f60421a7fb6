//! Pictures: each is XML, its texts lie inside and apart, and its legend names what it shows.

mod atlases;
mod charts;
mod collisions;
mod examples;
mod families;
mod inside;
mod layout;
mod maps;
mod panels;
mod stacks;
mod svg;
mod unusual;

// Where modules of the crate find each other.
use inside::canvas;
