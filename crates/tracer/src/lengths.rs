//! The lengths by which a search decides what is close, short or accurate.

/// Lengths in the coordinates of a window. Each is a fraction of the window's shorter extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lengths {
    /// The window's shorter extent, on which margins vary.
    pub scale: f64,
    /// How far beyond the window the family is asked, and how far ends of one branch may be apart.
    pub beyond: f64,
    /// How far around a vertex others are looked for, and thin regions beside a place. A branch
    /// begins with a step of this length.
    pub around: f64,
    /// The step of a difference that gives a gradient. If margins have an error of 1e-14, its error
    /// is least, 5e-10.
    pub difference: f64,
    /// Where two curves touch with a curvature of 1, the region between them is wider than the
    /// error of margins this far from the vertex.
    pub clear: f64,
    /// Closer to a vertex, wedges may be too thin for labels. Places with larger errors do not
    /// count.
    pub close: f64,
    /// The shortest piece of a curve that is divided or examined.
    pub piece: f64,
    /// What half of the digits determine: ends of margins in a wedge, and updates whose error of
    /// second order is beyond the digits. Also the reach of an edge, of the window or of a cell.
    pub half: f64,
    /// The largest error of a place at which boundaries touch, where gradients are parallel that
    /// may be one-sided. Also the shortest difference beside a place where a margin is singular.
    pub touch: f64,
    /// Places closer together count as one.
    pub same: f64,
    /// The error of a place that is solved for by gradients or tangents.
    pub solved: f64,
    /// The shortest step. A branch that fails there stalls.
    pub least: f64,
}

impl Lengths {
    /// As fractions of 1.
    pub const PARTS: Self = Self::of(1.0);

    /// The lengths in a window with this shorter extent.
    pub const fn of(scale: f64) -> Self {
        Self {
            scale,
            beyond: 1e-2 * scale,
            around: 1e-3 * scale,
            difference: 3e-5 * scale,
            clear: 3e-5 * scale,
            close: 1e-5 * scale,
            piece: 1e-6 * scale,
            half: 1e-7 * scale,
            touch: 1e-8 * scale,
            same: 1e-9 * scale,
            solved: 1e-10 * scale,
            least: 1e-12 * scale,
        }
    }
}

/// Lengths in the search for changes of a third parameter. In units of the width of a bracket, if
/// nothing else is said.
pub(crate) mod of_stack {
    use super::Lengths;

    /// The step of a difference of values in the box of a search. If values have an error of 1e-14,
    /// the slope is good to 1e-9.
    pub const STEP: f64 = Lengths::PARTS.close;
    /// The step of a difference of slopes. Also the last update from which a place in doubt is
    /// looked at once more.
    pub const LONG_STEP: f64 = Lengths::PARTS.around;
    /// How far the third unknown passes to see whether a margin passes through zero.
    pub const PASSAGE: f64 = 0.1 * LONG_STEP;
    /// The longest update that is not only a direction.
    pub const STRIDE: f64 = 0.2;
    /// The distances from a meeting of atlases that are far from it.
    pub const FAR: [f64; 2] = [5.0, 50.0];
    /// The interval in which an atlas far from a meeting may be, and the greatest distance of a
    /// meeting from the change that it explains.
    pub const NARROW: f64 = 400.0;
    /// The greatest distance of such a meeting, as a part of the value.
    pub const UNSEEN: f64 = 4e-3;
    /// The greatest gap between brackets that are joined.
    pub const GAP: f64 = 10.0;
}

/// Angles in radians, or their sines.
pub(crate) mod angle {
    /// Boundaries that may touch close by meet at less.
    pub const PARALLEL: f64 = 0.1;
    /// Boundaries must meet at more where a short update to a place without one of their margins is
    /// trusted: its error is of second order.
    pub const TRANSVERSAL: f64 = 0.03;
    /// Curves that meet at less are tangent.
    pub const TANGENT: f64 = 0.02;
    /// The order of edges around a vertex is sure if they enclose more.
    pub const ORDERED: f64 = 1e-3;
    /// Three unit vectors with a smaller volume lie in a plane: derivatives are good to 1e-9, and
    /// derivatives of slopes to 1e-6.
    pub const PLANE: f64 = 1e-5;
    /// On a boundary that is straight, tangents turn by less, from errors.
    pub const STRAIGHT: f64 = 1e-6;
    /// Boundaries that meet at less are one.
    pub const DEPENDENT: f64 = 1e-7;
}
