//! Pictures: each is XML, its texts lie inside and apart, and its legend names what it shows.

mod atlases;
mod charts;
mod collisions;
mod examples;
mod families;
mod layout;
mod maps;
mod pdfs;
mod stacks;
mod svg;
mod unusual;
