//! Errors of runs, in the words of a system.

use stickslip_solver::RunError;

use crate::system::System;

impl System {
    /// What an error of a run says, with the names of rules, modes and components.
    ///
    /// ```
    /// use stickslip_expression::System;
    /// use stickslip_solver::{EmbeddedPair, Options};
    ///
    /// let system = System::parse(
    ///     "state x = 0\nmode up\n  x' = 1\n  when x > 1 \"top\" -> down\nmode down\n  x' = 1\n  \
    ///      when x < 2 \"bottom\" -> up\nstart in up\nend = 5",
    /// )?;
    /// let run = system.with(&[])?.record(EmbeddedPair::Dop853, 5.0, &Options::default());
    /// let said = system.explained(&run.unwrap_err());
    /// assert!(said.contains("`top` of mode up, `bottom` of mode down"), "{said}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn explained(&self, error: &RunError) -> String {
        match error {
            RunError::Cycle { s, count, cycle } => {
                let named = cycle.iter().map(|(rule, mode)| {
                    // Modes are counted, and an error has them as text.
                    let mode = mode.parse().ok().and_then(|mode: usize| self.modes.get(mode));
                    match mode.and_then(|mode| Some((mode, mode.rules.get(*rule)?))) {
                        Some((mode, own)) => format!("`{}` of mode {}", own.name(*rule), mode.name),
                        None => format!("rule {rule}"),
                    }
                });
                let named = named.collect::<Vec<_>>().join(", ");
                format!(
                    "{count} rules follow each other at t = {s}, and no end is in sight: {named}, \
                     again and again. They may contradict each other there, or the state has to \
                     slide along a surface"
                )
            }
            RunError::GuardNotANumber { guard, .. }
            | RunError::GuardIdenticallyZero { guard, .. }
            | RunError::GuardUnresolved { guard, .. } => {
                let rules = self.modes.iter().filter_map(|mode| mode.rules.get(*guard));
                let mut named: Vec<String> = rules.map(|rule| rule.name(*guard)).collect();
                named.dedup();
                format!("{error}; guard {guard} is that of rule `{}`", named.join("` or `"))
            }
            RunError::State { component, .. } => match self.components.get(*component) {
                Some(own) => format!("{error}; component {component} is `{}`", own.name),
                None => error.to_string(),
            },
            error => error.to_string(),
        }
    }
}
