//! What speaks against an atlas, in sentences.

/// What speaks against an atlas, in sentences.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Doubts {
    /// Whether the trace came to its end.
    pub finished: bool,
    /// Runs that have another label than their region.
    pub mismatches: Vec<String>,
    /// What the trace could not explain.
    pub unresolved: Vec<String>,
    /// Contradictions between curves.
    pub findings: Vec<String>,
    /// Points without a known label.
    pub failed: Vec<String>,
}

impl Doubts {
    /// All sentences; if there is none, what else speaks against an atlas that does not agree.
    #[must_use]
    pub fn sentences(&self) -> Vec<String> {
        let Self { finished, mismatches, unresolved, findings, failed } = self;
        let all = mismatches.iter().chain(unresolved).chain(findings).chain(failed);
        let all: Vec<String> = all.cloned().collect();
        match (all.is_empty(), finished) {
            (false, _) => all,
            (true, true) => vec!["Euler's formula does not hold".to_owned()],
            (true, false) => vec!["it is not finished".to_owned()],
        }
    }

    /// The numbers of the sentences, and the first one.
    #[must_use]
    pub fn objection(&self) -> String {
        let Self { finished, mismatches, unresolved, findings, failed } = self;
        let open = if *finished { "" } else { "not finished; " };
        format!(
            "{open}{} mismatches, {} unresolved, {} findings, {} points without a label; the first: {}",
            mismatches.len(),
            unresolved.len(),
            findings.len(),
            failed.len(),
            self.sentences()[0]
        )
    }
}
