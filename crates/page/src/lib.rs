//! The explorer as one HTML page, which is made by `web/build.mjs`.
//!
//! ```
//! std::fs::write(std::env::temp_dir().join("stickslip-explorer.html"), stickslip_page::PAGE)?;
//! # Ok::<(), std::io::Error>(())
//! ```

/// The page. Any browser of 2023 or newer opens it from the disk.
pub const PAGE: &str = include_str!("../explorer.html");

#[doc = include_str!("../README.md")]
#[cfg(doctest)]
pub struct Readme;
