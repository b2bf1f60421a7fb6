//! What was found, in sentences.

use super::limit::BOUND_FACTOR;

use super::Measurement;
use super::fit::{Estimate, Fits};
use super::points::Restitution;
use super::profile::{Compared, Profile};

impl Measurement {
    pub fn findings(&self) -> Vec<String> {
        let mut findings = vec![self.envelope_found()];
        match &self.fits {
            Some(fits) => findings.extend(self.fits_found(fits)),
            None => findings.push(
                "Exponent and constant are not fitted: that needs a decade and a half from κ = 1000 on."
                    .to_owned(),
            ),
        }
        findings.push(format!(
            "The inner problem alone gives the constant {:.15} and the correction {:.12} κ^{{−5/4}}, in closed form: the \
             last stick phase lasts a quarter of a period, from σ = {:.12} to {:.12}.",
            self.peak.velocity, self.peak.correction, self.peak.onset, self.peak.release
        ));
        findings.push(self.convergence_found());
        let Profile { compared, compared_psi, .. } = &self.profile;
        findings.extend(compared.iter().filter_map(|found| profile_found(found, *compared_psi)));
        findings.push(format!(
            "The bound (27), |w_final| ≤ 1/√κ, is exceeded between κ = {:.6} and {:.6}: by a factor of {:.6} at κ = {:.6}, \
             ψ = {:.6}. With its missing factor (5/4)^{{3/5}} = {BOUND_FACTOR:.6} it holds there: the largest is {:.4} of it.",
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

    /// What holds at the stiffest.
    fn envelope_found(&self) -> String {
        let points = || self.points.iter().flatten();
        let integrated = points().filter(|point| point.integrated.is_finite());
        let off = integrated.clone().map(|point| (point.integrated - point.crest.velocity).abs());
        let [first, .., last] = &self.points[0][..] else { return String::new() };
        format!(
            "The largest |w_final| falls from {:.6} at κ = {} to {:.6e} at κ = {} around ψ = {}; dop853 repeats {} of {} tops \
             within {:.1e}.",
            first.crest.velocity,
            brief(first.kappa),
            last.crest.velocity,
            brief(last.kappa),
            first.psi,
            integrated.count(),
            points().count(),
            off.fold(0.0, f64::max)
        )
    }

    fn fits_found(&self, fits: &Fits) -> [String; 3] {
        let Self { peak, .. } = self;
        [
            format!(
                "|w_final| = C κ^{{−p}} with p = {}; with the terms κ^{{−5/4}} and κ^{{−5/2}} beside it p = {}. Fitted to {} \
                 stiffnesses from 1000 on; values of ψ differ by {:.0e}, relative.",
                shown(fits.plain_exponent),
                shown(fits.exponent),
                fits.count,
                fits.spread
            ),
            format!(
                "κ^{{5/4}}|w_final| tends to {}, the inner problem's {:.13} within {:.0e}.",
                shown(fits.constant),
                peak.velocity,
                (fits.constant.value - peak.velocity).abs()
            ),
            format!(
                "It does so with the power κ^{{−{}}} and the coefficient {}; the theory says 5/4 and {:.9}.",
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
        format!("F(phase) with {most} coefficients of the phase changes by {}.", parts.join(", "))
    }

    fn counts_found(&self) -> String {
        let last = self.points.iter().filter_map(|points| points.last());
        let parts: Vec<String> = last
            .map(|point| {
                format!(
                    "{:.5} ({:.5} expected, {} switches) at ψ = {}",
                    point.count_ratio, point.count_expected, point.switch_count, point.psi
                )
            })
            .collect();
        let off = self.points.iter().flatten().map(|point| {
            let expected = point.count_expected / point.count_ratio * point.switch_count as f64;
            (point.switch_count as f64 - expected).abs()
        });
        format!(
            "Switches over √κ t_c/π at κ = {}: {}. No count is farther than {:.1} from the expected.",
            brief(self.kappas[self.kappas.len() - 1]),
            parts.join(", "),
            off.fold(0.0, f64::max)
        )
    }
}

fn profile_found(collisions: &[Compared], psi: f64) -> Option<String> {
    let first = collisions.first()?;
    let largest = |of: fn(&Compared) -> f64| collisions.iter().map(of).fold(0.0, f64::max);
    let difference = largest(|c| (c.velocity - c.inner).abs());
    Some(format!(
        "At κ = {}, {} collisions over one oscillation around ψ = {psi} lie on F(phase) within {difference:.2e}, which is {:.1} \
         κ^{{−5/4}}; √κ/π times the time left at the first switch gives their phase within {:.4}.",
        brief(first.kappa),
        collisions.len(),
        difference * first.kappa.powf(1.25),
        largest(|c| c.ahead.abs())
    ))
}

fn restitution_found(found: &[Restitution]) -> Option<String> {
    let [first, last] = [found.iter().find(|row| row.largest.is_some())?, found.last()?];
    Some(format!(
        "From ψ₀ = {} up to 2 the largest |ε_t| falls from {:.4} at κ = {} to {:.3e} at κ = {}, which is {:.3} κ^{{−5/4}}/ψ₀; \
         the bound (27) is {} at ψ₀.",
        first.from.name(),
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
fn shown(Estimate { value, uncertainty }: Estimate) -> String {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to 15")]
    let digits = (1.0 - uncertainty.log10()).floor().clamp(1.0, 15.0) as usize;
    format!("{value:.digits$} ± {uncertainty:.0e}")
}
