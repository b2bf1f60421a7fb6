//! Pictures of collisions, maps and atlases, as SVG, PNG and PDF.
//!
//! The functions of [`pictures`] draw whole pictures from data: a [collision](pictures::collision),
//! a [gallery](pictures::gallery) of many, a [map](pictures::map), a computed
//! [grid](pictures::grid), an [atlas](pictures::atlas), a [chart](pictures::chart) of series; with
//! the features `practice` and `studies` also a fit, errors of time steps, and studies. Each
//! results in an [`Svg`], whose document is a file, and [`png()`] and [`pdf()`] make the same
//! picture.
//!
//! Pictures are made of the parts in [`canvas`]. Start reading in [`canvas::panel`] (axes, and what
//! is drawn against them), then [`pictures::course`] and [`pictures::collision`] (a picture).
//!
//! ```
//! use stickslip_figure::{pdf, pictures, png};
//! use stickslip_model::{Collider, Contact};
//!
//! let contact = Contact::new(63.0, 0.5, 0.0)?;
//! let collision = Collider::default().collide(contact)?;
//! let history = Collider::default().history(contact)?;
//! let svg = pictures::collision::draw(&collision, &history);
//! assert!(svg.document().starts_with("<svg"));
//! assert!(png(&svg)?.starts_with(b"\x89PNG"));
//! assert!(pdf(&svg)?.starts_with(b"%PDF"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod canvas;
mod error;
pub mod pictures;

pub use canvas::markup;
#[cfg(feature = "png")]
pub use canvas::pdf::pdf;
#[cfg(feature = "png")]
pub use canvas::raster::{gif, png};
pub use canvas::style;
pub use canvas::svg::Svg;
pub use error::FigureError;
pub use stickslip_model::text::number;

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
