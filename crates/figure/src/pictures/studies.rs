//! The pictures of studies: a function for each study draws all that was measured.
//!
//! Start reading in [`stiff_springs`]; then [`convergence`], [`own_system`] and [`contact_laws`].

pub mod contact_laws;
pub mod convergence;
pub mod own_system;
pub mod stiff_springs;

use crate::canvas::svg::Svg;

/// A picture with what a reader needs to understand it.
#[derive(Debug)]
pub struct Picture {
    /// The stem of the name of its file.
    pub name: String,
    /// What the picture shows, as [markup](crate::markup).
    pub caption: String,
    /// The picture itself.
    pub svg: Svg,
}

impl Picture {
    /// A picture with its name and caption.
    pub fn new(name: &str, caption: &str, svg: Svg) -> Self {
        Self { name: name.to_owned(), caption: caption.to_owned(), svg }
    }
}
