//! An audit as a study.

use serde_json::{Value, json};

use stickslip_studies::{Cell, Study, StudyColumn, StudyTable};

use super::Audit;
use super::spring::Spring;
use super::statement::{Statement, StatementVerdict};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.audit/1";
/// The title of the study.
pub const TITLE: &str = "Statements of the paper";

const VERDICTS: [StudyColumn; 7] = [
    StudyColumn::headed("number", "#", "number of the statement"),
    StudyColumn::headed("statement", "statement", "the statement in other words"),
    StudyColumn::headed("place", "in the paper", "place of the statement in the paper"),
    StudyColumn::headed("verdict", "verdict", "whether the statement is true"),
    StudyColumn::headed("condition", "condition", "the condition under which it is true"),
    StudyColumn::headed("explanation", "explanation", "the reason for the verdict"),
    StudyColumn::headed("command", "command", "the command that tests this statement alone"),
];

const EVIDENCE: [StudyColumn; 3] = [
    StudyColumn::headed("number", "#", "number of the statement"),
    StudyColumn::headed("name", "evidence", "name of the value"),
    StudyColumn::headed("value", "value", "the value, in scaled units where no others are named"),
];

impl Audit {
    /// The number of statements with a verdict.
    pub fn count(&self, verdict: StatementVerdict) -> usize {
        self.statements.iter().filter(|statement| statement.finding.verdict == verdict).count()
    }

    /// The tables `audit` and `audit_evidence`, and all of it as JSON.
    pub fn study(&self) -> Study {
        let verdicts = self.statements.iter().map(|statement| {
            let Statement { number, paraphrase, place, finding } = statement;
            vec![
                usize::from(*number).into(),
                (*paraphrase).into(),
                (*place).into(),
                finding.verdict.to_string().into(),
                finding.condition.clone().unwrap_or_default().into(),
                finding.explanation.clone().into(),
                statement.command().into(),
            ]
        });
        let evidence = self.statements.iter().flat_map(|Statement { number, finding, .. }| {
            let row = |(name, value): &(String, Cell)| {
                vec![usize::from(*number).into(), name.as_str().into(), value.clone()]
            };
            finding.evidence.iter().map(row)
        });
        Study {
            name: "audit",
            title: TITLE,
            headlines: vec![self.headline()],
            findings: self.statements.iter().map(Statement::sentence).collect(),
            json: self.json(),
            tables: vec![
                StudyTable {
                    name: "audit",
                    title: "Verdicts".to_owned(),
                    columns: VERDICTS.to_vec(),
                    rows: verdicts.collect(),
                },
                StudyTable {
                    name: "audit_evidence",
                    title: "Numbers from which the verdicts follow".to_owned(),
                    columns: EVIDENCE.to_vec(),
                    rows: evidence.collect(),
                },
            ],
        }
    }

    /// The numbers of statements with each verdict.
    fn headline(&self) -> String {
        if self.statements.is_empty() {
            return "No statement of the paper was tested.".to_owned();
        }
        let verdicts = [
            (StatementVerdict::Holds, "holds", "hold"),
            (
                StatementVerdict::HoldsWithACondition,
                "holds under a condition",
                "hold under a condition",
            ),
            (StatementVerdict::DoesNotHold, "does not hold", "do not hold"),
            (StatementVerdict::CannotBeDecided, "cannot be decided", "cannot be decided"),
        ];
        let parts = verdicts.map(|(verdict, one, several)| match self.count(verdict) {
            1 => format!("1 {one}"),
            count => format!("{count} {several}"),
        });
        let found = verdicts.iter().zip(parts).filter(|(verdict, _)| self.count(verdict.0) > 0);
        let mut parts: Vec<_> = found.map(|(_, part)| part).collect();
        let last = parts.pop().unwrap_or_default();
        let and = if parts.is_empty() { "" } else { " and " };
        let of = match self.spring {
            Spring::Reset => "Of",
            Spring::Unreset => "With a spring that is not reset while sliding, of",
        };
        let count = self.statements.len();
        format!("{of} {count} statements of the paper, {}{and}{last}.", parts.join(", "))
    }

    fn json(&self) -> Value {
        let statements = self.statements.iter().map(|statement| {
            let Statement { number, paraphrase, place, finding } = statement;
            let evidence = finding
                .evidence
                .iter()
                .map(|(name, value)| json!({ "name": name, "value": value }));
            json!({
                "number": number,
                "statement": paraphrase,
                "place": place,
                "verdict": finding.verdict.to_string(),
                "condition": finding.condition,
                "evidence": evidence.collect::<Vec<_>>(),
                "explanation": finding.explanation,
                "command": statement.command(),
            })
        });
        json!({
            "schema": SCHEMA,
            "model": self.spring.name(),
            "statements": statements.collect::<Vec<_>>(),
        })
    }
}

impl Statement {
    /// The verdict with its condition.
    pub fn verdict(&self) -> String {
        match &self.finding.condition {
            Some(condition) => format!("{}: {condition}", self.finding.verdict),
            None => self.finding.verdict.to_string(),
        }
    }

    /// The number, the statement and the verdict in a line.
    fn sentence(&self) -> String {
        format!("Statement {}: {} Verdict: {}.", self.number, self.paraphrase, self.verdict())
    }
}
