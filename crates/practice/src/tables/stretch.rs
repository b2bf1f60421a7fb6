//! Coordinates that make square roots smooth.

/// How a coordinate from 0 to 1 is stretched before a polynomial is evaluated.
///
/// Behind a graze ε_t is a power series in the square root of the distance from the boundary, and
/// so is a boundary beside the place where it turns back. In the root as a coordinate both are
/// smooth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stretch {
    /// The coordinate itself.
    None,
    /// The root of the distance from 0.
    Low,
    /// 1 minus the root of the distance from 1.
    High,
}

impl Stretch {
    /// The stretched coordinate of `z` in [0, 1].
    #[inline(always)]
    pub(super) fn of(self, z: f64) -> f64 {
        match self {
            Self::None => z,
            Self::Low => z.sqrt(),
            Self::High => 1.0 - (1.0 - z).sqrt(),
        }
    }

    /// The coordinate whose stretched one is `s`.
    pub(super) fn inverse(self, s: f64) -> f64 {
        match self {
            Self::None => s,
            Self::Low => s * s,
            Self::High => 1.0 - (1.0 - s) * (1.0 - s),
        }
    }

    /// Both halves of an interval with this stretch: the place between them, and their stretches. A
    /// half that does not touch the root is not stretched.
    pub(super) fn halves(self) -> (f64, [Self; 2]) {
        let halves = match self {
            Self::None => [Self::None; 2],
            Self::Low => [Self::Low, Self::None],
            Self::High => [Self::None, Self::High],
        };
        (self.inverse(0.5), halves)
    }
}

#[cfg(test)]
mod tests {
    use super::Stretch;

    #[test]
    fn the_inverse_leads_back() {
        for stretch in [Stretch::None, Stretch::Low, Stretch::High] {
            for k in 0..=64 {
                let s = f64::from(k) / 64.0;
                let error = (stretch.of(stretch.inverse(s)) - s).abs();
                assert!(error < 1e-15, "{stretch:?} {s}: {error}");
            }
        }
    }
}
