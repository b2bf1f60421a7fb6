//! First coordinates that differ by rounding alone.

use crate::cubic::Cubic;

/// The different first coordinates of nodes and vertices, in ascending order.
///
/// Along a boundary that runs straight up they differ by rounding. The boundary is vertical only if
/// they are one number.
pub struct Abscissae {
    /// The least and the greatest of each group, with the number that stands for it.
    groups: Vec<[f64; 3]>,
    rounding: f64,
}

impl Abscissae {
    /// Groups the coordinates `values` of a window from `low` to `high`. Coordinates that differ
    /// from `low` or `high` by rounding become `low` or `high`.
    pub fn new(low: f64, high: f64, values: impl Iterator<Item = f64>) -> Self {
        let rounding = 16.0 * f64::EPSILON * low.abs().max(high.abs()).max(high - low);
        let mut values: Vec<f64> = values.chain([low, high]).collect();
        values.sort_by(f64::total_cmp);
        let mut groups: Vec<[f64; 3]> = Vec::new();
        for value in values {
            match groups.last_mut() {
                Some([_, greatest, chosen]) if value - *greatest <= rounding => {
                    *greatest = value;
                    if value == low || value == high {
                        *chosen = value;
                    }
                }
                _ => groups.push([value; 3]),
            }
        }
        Self { groups, rounding }
    }

    /// Whether a cubic between two places with one abscissa is vertical up to rounding.
    pub fn is_straight(&self, cubic: &Cubic) -> bool {
        let first = cubic.points[0].x;
        cubic.points.iter().all(|point| (point.x - first).abs() <= 16.0 * self.rounding)
    }

    /// The number that stands for a coordinate.
    pub fn of(&self, value: f64) -> f64 {
        let index = self.groups.partition_point(|[_, greatest, _]| *greatest < value);
        match self.groups.get(index) {
            Some([least, _, chosen]) if *least <= value => *chosen,
            _ => value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Abscissae;

    #[test]
    fn rounding_is_removed_and_nothing_else() {
        let near = |x: f64, ulps: f64| x + ulps * f64::EPSILON;
        let values = [near(0.5, 3.0), 0.5, near(0.5, -5.0), 0.75, near(1.0, -2.0), 0.5001];
        let abscissae = Abscissae::new(0.0, 1.0, values.into_iter());
        let first = abscissae.of(near(0.5, -5.0));
        assert_eq!(abscissae.of(0.5), first);
        assert_eq!(abscissae.of(near(0.5, 3.0)), first);
        assert_eq!(abscissae.of(0.5001), 0.5001);
        assert_eq!(abscissae.of(near(1.0, -2.0)), 1.0);
        // A number that was not among the coordinates stays.
        assert_eq!(abscissae.of(0.3), 0.3);
    }
}
