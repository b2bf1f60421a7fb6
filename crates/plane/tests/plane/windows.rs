//! Windows whose atlases several tests share.

use std::sync::OnceLock;

use stickslip_plane::Range;
use stickslip_plane::atlas::{CollisionAtlas, Frame, trace};
use stickslip_plane::progress::SILENT;

/// An undamped window.
pub fn frame(kappa: (f64, f64), psi: (f64, f64)) -> Frame {
    let range = |(low, high)| Range { low, high };
    Frame::new(range(kappa), range(psi), 0.0)
}

/// The atlas of `frame` with the usual tolerance.
pub fn traced(frame: Frame) -> CollisionAtlas {
    trace(frame, frame.tolerances().usual, SILENT).unwrap()
}

/// Two boundaries that cross at κ = 19.35, ψ = 0.605, and the four regions around the crossing.
pub fn crossing() -> &'static CollisionAtlas {
    static ATLAS: OnceLock<CollisionAtlas> = OnceLock::new();
    ATLAS.get_or_init(|| traced(frame((18.0, 21.0), (0.55, 0.65))))
}

/// A window without a boundary: its only region slides throughout.
pub fn empty() -> &'static CollisionAtlas {
    static ATLAS: OnceLock<CollisionAtlas> = OnceLock::new();
    ATLAS.get_or_init(|| traced(frame((5.0, 6.0), (2.5, 3.0))))
}
