//! What the study says.

use stickslip_model::SpringEnergy;
use stickslip_model::text::number;

use super::ContactLaws;

impl ContactLaws {
    pub(super) fn findings(&self) -> Vec<String> {
        let count = self.laws.len();
        let cells = self.settings.cells;
        let created = |spring: SpringEnergy| spring.creates();
        let creating = self.laws.iter().filter(|law| created(law.spring())).count();
        let mut findings = vec![
            format!(
                "{count} laws over {cells} × {cells} collisions each, κ from {} to {} and ψ from {} \
                 to {}, without damping and with a = {}, b = {}.",
                number(self.settings.kappa.low, 4),
                number(self.settings.kappa.high, 4),
                number(self.settings.psi.low, 4),
                number(self.settings.psi.high, 4),
                number(self.settings.damping, 4),
                number(self.settings.tangential_damping, 4),
            ),
            format!(
                "The springs of {creating} of the {count} laws can create energy: their stiffness \
                 changes with the load, and their history is not rescaled where it must be."
            ),
        ];
        let gaining: Vec<_> = self.laws.iter().filter(|law| law.undamped.gaining > 0).collect();
        for law in &gaining {
            let (eps_t, [kappa, psi]) = law.undamped.largest;
            findings.push(format!(
                "`{}` without damping: {} of {} collisions have |ε_t| above 1, at most {} at κ = {}, \
                 ψ = {}; with damping {}.",
                law.named.names[0],
                law.undamped.gaining,
                law.undamped.collisions,
                number(eps_t, 5),
                number(kappa, 4),
                number(psi, 4),
                law.damped.gaining,
            ));
        }
        if gaining.is_empty() {
            findings.push("No collision has |ε_t| above 1.".to_owned());
        }
        findings
    }
}
