//! What was found, in sentences with their numbers.

use super::StiffSprings;
use super::fit::{Fits, FittedConstant};
use super::limit::BOUND_FACTOR;
use super::maxima::LargestRestitution;
use super::profile::{ComparedCollision, Profile};

impl StiffSprings {
    pub(super) fn headlines(&self) -> Vec<String> {
        let excess = &self.excess;
        let bound = format!(
            "The bound (27) of the paper lacks a factor (5/4)^{{3/5}} = {BOUND_FACTOR:.4}: |ε_t| \
             exceeds it by a factor of up to {:.4}, at κ = {:.4}, ψ = {:.4}.",
            excess.ratio, excess.worst.kappa, excess.worst.psi
        );
        self.fits.as_ref().map(|fits| self.result(fits)).into_iter().chain([bound]).collect()
    }

    pub(super) fn findings(&self) -> Vec<String> {
        let mut findings = Vec::new();
        findings.extend(self.fits.as_ref().map(|fits| self.result(fits)));
        findings.push(self.envelope_found());
        match &self.fits {
            Some(fits) => findings.extend(self.fits_found(fits)),
            None => findings.push(
                "Exponent and constant are not fitted: that needs a decade and a half of stiffnesses \
                 from κ = 1000 on."
                    .to_owned(),
            ),
        }
        findings.push(format!(
            "The inner problem alone gives the constant {:.15} and the correction {:.12} κ^{{−5/4}}, \
             in closed form. In it the last stick phase lasts a quarter of a period, from σ = {:.12} \
             to {:.12}.",
            self.peak.velocity, self.peak.correction, self.peak.onset, self.peak.release
        ));
        findings.push(self.convergence_found());
        let Profile { compared, compared_psi, .. } = &self.profile;
        findings.extend(compared.iter().filter_map(|found| profile_found(found, *compared_psi)));
        findings.push(format!(
            "Between κ = {:.6} and {:.6} collisions exceed the bound (27), |w_final| ≤ 1/√κ: by a \
             factor of {:.6} at κ = {:.6}, ψ = {:.6}. With its missing factor (5/4)^{{3/5}} = \
             {BOUND_FACTOR:.6} the bound holds there: the largest |w_final| is {:.4} of it.",
            self.excess.kappa.0,
            self.excess.kappa.1,
            self.excess.ratio,
            self.excess.worst.kappa,
            self.excess.worst.psi,
            self.excess.ratio / BOUND_FACTOR
        ));
        findings.extend(self.restitutions.iter().filter_map(|found| restitution_found(found)));
        findings.push(self.counts_found());
        findings
    }

    /// The main result.
    fn result(&self, fits: &Fits) -> String {
        format!(
            "|ε_t| falls as κ^{{−5/4}}, not as κ^{{−1/2}} like the bound (27) of the paper: the fitted \
             exponent is {}, and κ^{{5/4}}|w_final| with w = ψε_t tends to {} (theory: {:.13}).",
            shown(fits.exponent),
            shown(fits.constant),
            self.peak.velocity
        )
    }

    /// The largest velocities at both ends of the interval of κ.
    fn envelope_found(&self) -> String {
        let all = || self.velocities.iter().flatten();
        let integrated = all().filter(|largest| largest.integrated.is_finite());
        let off = integrated.clone().map(|found| (found.integrated - found.crest.velocity).abs());
        let [first, .., last] = &self.velocities[0][..] else { return String::new() };
        let highest = first.crest.velocity;
        let highest =
            if highest < 1e-3 { format!("{highest:.6e}") } else { format!("{highest:.6}") };
        let repeated = match integrated.count() {
            0 => "repeats none of them, which are too stiff".to_owned(),
            count => {
                format!(
                    "repeats {count} of {} tops within {:.1e}",
                    all().count(),
                    off.fold(0.0, f64::max)
                )
            }
        };
        format!(
            "The largest |w_final| around ψ = {} falls from {highest} at κ = {} to {:.6e} at κ = {}. \
             dop853 {repeated}.",
            first.psi,
            brief(first.kappa),
            last.crest.velocity,
            brief(last.kappa),
        )
    }

    fn fits_found(&self, fits: &Fits) -> [String; 3] {
        let Self { peak, .. } = self;
        [
            format!(
                "The fit |w_final| = C κ^{{−p}} gives p = {}; with the terms κ^{{−5/4}} and κ^{{−5/2}} \
                 beside it p = {}. It covers {} stiffnesses from 1000 on; between the values of ψ \
                 |w_final| differs by {:.0e}, relative.",
                shown(fits.plain_exponent),
                shown(fits.exponent),
                fits.count,
                fits.spread
            ),
            format!(
                "κ^{{5/4}}|w_final| tends to {}, which is the constant {:.13} of the inner problem \
                 within {:.0e}.",
                shown(fits.constant),
                peak.velocity,
                (fits.constant.value - peak.velocity).abs()
            ),
            format!(
                "It does so with the power κ^{{−{}}} and the coefficient {}; the theory says 5/4 and \
                 {:.9}.",
                shown(fits.power),
                shown(fits.correction),
                peak.correction
            ),
        ]
    }

    fn convergence_found(&self) -> String {
        let all = &self.profile.convergence;
        let most = all.iter().map(|row| row.coefficients).max().unwrap_or(0);
        let rows = all.iter().filter(|row| row.coefficients == most);
        let parts: Vec<String> =
            rows.map(|row| format!("{:.0e} from σ = {}", row.difference, row.start)).collect();
        format!(
            "F(phase) with {most} coefficients of the phase changes with its start by {}.",
            parts.join(", ")
        )
    }

    fn counts_found(&self) -> String {
        let last = self.velocities.iter().filter_map(|by_kappa| by_kappa.last());
        let parts: Vec<String> = last
            .map(|found| {
                format!(
                    "{:.5} ({:.5} expected, {} switches) at ψ = {}",
                    found.count_ratio, found.count_expected, found.switch_count, found.psi
                )
            })
            .collect();
        let off = self.velocities.iter().flatten().map(|found| {
            let expected = found.count_expected / found.count_ratio * found.switch_count as f64;
            (found.switch_count as f64 - expected).abs()
        });
        format!(
            "The number of switches over √κ t_c/π at κ = {} is {}. No count is farther than {:.1} from \
             the expected one.",
            brief(self.kappas[self.kappas.len() - 1]),
            parts.join(", "),
            off.fold(0.0, f64::max)
        )
    }
}

fn profile_found(collisions: &[ComparedCollision], psi: f64) -> Option<String> {
    let first = collisions.first()?;
    let largest = |of: fn(&ComparedCollision) -> f64| collisions.iter().map(of).fold(0.0, f64::max);
    let difference = largest(|collision| (collision.velocity - collision.inner).abs());
    Some(format!(
        "At κ = {}, {} collisions over one oscillation around ψ = {psi} lie on F(phase) within \
         {difference:.2e}, which is {:.1} κ^{{−5/4}}. √κ/π times the time left at the first switch \
         gives their phase within {:.4}.",
        brief(first.kappa),
        collisions.len(),
        difference * first.kappa.powf(1.25),
        largest(|collision| collision.ahead.abs())
    ))
}

fn restitution_found(found: &[LargestRestitution]) -> Option<String> {
    let [first, last] = [found.iter().find(|row| row.largest.is_some())?, found.last()?];
    Some(format!(
        "From ψ₀ = {} up to 2 the largest |ε_t| falls from {:.4} at κ = {} to {:.3e} at κ = {}, which \
         is {:.3} κ^{{−5/4}}/ψ₀. The bound (27) at ψ₀ is {}.",
        first.start.name(),
        first.eps_t(),
        brief(first.kappa),
        last.eps_t(),
        brief(last.kappa),
        last.eps_t() * last.lowest * last.kappa.powf(1.25),
        brief(1.0 / (last.lowest * last.kappa.sqrt()))
    ))
}

/// A number with at most five digits.
fn brief(value: f64) -> String {
    let rounded = format!("{value:.4e}").parse().unwrap_or(value);
    if rounded < 1e5 { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A value with as many digits as its uncertainty leaves.
fn shown(FittedConstant { value, uncertainty }: FittedConstant) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to 15")]
    let digits = (1.0 - uncertainty.log10()).floor().clamp(1.0, 15.0) as usize;
    format!("{value:.digits$} ± {uncertainty:.0e}")
}
