//! What the page is told while it waits for an answer.

#[cfg(target_family = "wasm")]
#[allow(unsafe_code, reason = "the declaration of an import, which is safe to call")]
mod import {
    #[link(wasm_import_module = "env")]
    unsafe extern "C" {
        /// Takes a curve of an atlas that is being traced, as `length` pairs of values of the axes.
        pub safe fn curve(points: *const [f64; 2], length: usize);
    }
}

/// Shows a curve of the atlas that is being traced.
#[cfg(target_family = "wasm")]
pub fn show(points: &[[f64; 2]]) {
    import::curve(points.as_ptr(), points.len());
}

/// Elsewhere nobody is shown anything.
#[cfg(not(target_family = "wasm"))]
pub fn show(_points: &[[f64; 2]]) {}
