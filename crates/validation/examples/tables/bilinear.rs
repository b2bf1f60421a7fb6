//! A table of ε_t on a grid, even in ln κ and ψ, as many codes have it.

use std::error::Error;

use rayon::prelude::*;
use stickslip_practice::tables::TableSettings;

pub struct Bilinear {
    pub sizes: [usize; 2],
    low: [f64; 2],
    /// Grid steps over ln κ and ψ.
    scales: [f64; 2],
    values: Vec<f64>,
}

impl Bilinear {
    /// The table of `bytes` bytes, with as many points along ψ as along ln κ.
    pub fn of_size(settings: &TableSettings, bytes: usize) -> Result<Self, Box<dyn Error>> {
        let size = (bytes / 8).isqrt();
        let [kappa, psi] = settings.window.sides();
        let low = [kappa.low.ln(), psi.low];
        let steps = (size - 1) as f64;
        let scales = [steps / (kappa.high / kappa.low).ln(), steps / (psi.high - psi.low)];
        let at = |k: usize| {
            let kappa = (low[0] + (k / size) as f64 / scales[0]).exp();
            super::exact_eps_t([kappa, low[1] + (k % size) as f64 / scales[1]])
        };
        let values: Vec<f64> = (0..size * size).into_par_iter().map(at).collect();
        if values.iter().any(|value| value.is_nan()) {
            return Err("a collision of the grid cannot be computed".into());
        }
        Ok(Self { sizes: [size; 2], low, scales, values })
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub fn eps_t(&self, kappa: f64, psi: f64) -> f64 {
        let [size, _] = self.sizes;
        let x = (kappa.ln() - self.low[0]) * self.scales[0];
        let y = (psi - self.low[1]) * self.scales[1];
        // Points of the window have coordinates from 0 to size - 1.
        let [i, j] = [x, y].map(|place| (place.max(0.0) as usize).min(size - 2));
        let (x, y) = (x - i as f64, y - j as f64);
        let at = |i: usize, j: usize| self.values[i * size + j];
        let low = at(i, j) * (1.0 - y) + at(i, j + 1) * y;
        let high = at(i + 1, j) * (1.0 - y) + at(i + 1, j + 1) * y;
        low * (1.0 - x) + high * x
    }
}
