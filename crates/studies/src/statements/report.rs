//! An audit as a study.

use serde_json::{Value, json};

use super::{Audit, Statement};
use crate::study::{Cell, Column, Study, Table};

/// The name of the layout of the JSON, with its version.
pub const SCHEMA: &str = "stickslip.audit/1";

impl Audit {
    /// The tables `audit` and `audit_evidence`, and all of it as JSON.
    #[must_use]
    pub fn study(&self) -> Study {
        let verdicts = self.statements.iter().map(|statement| {
            let Statement { number, paraphrase, place, finding } = statement;
            vec![
                Cell::Count(u64::from(*number)),
                Cell::Text((*paraphrase).to_owned()),
                Cell::Text((*place).to_owned()),
                Cell::Text(finding.verdict.to_string()),
                Cell::Text(finding.condition.clone().unwrap_or_default()),
                Cell::Text(finding.explanation.clone()),
                Cell::Text(statement.command()),
            ]
        });
        let evidence = self.statements.iter().flat_map(|statement| {
            let number = Cell::Count(u64::from(statement.number));
            let row = move |(name, value): &(String, Cell)| {
                vec![number.clone(), Cell::Text(name.clone()), value.clone()]
            };
            statement.finding.evidence.iter().map(row)
        });
        let column = |(name, meaning)| Column { name, meaning };
        Study {
            name: "audit",
            title: "Statements of the paper",
            findings: self.statements.iter().map(Statement::sentence).collect(),
            json: self.json(),
            tables: vec![
                Table {
                    name: "audit",
                    title: "Verdicts".to_owned(),
                    columns: [
                        ("number", "of the statement"),
                        ("statement", "what it says"),
                        ("place", "where in the paper"),
                        ("verdict", "whether it is true"),
                        ("condition", "under which it is"),
                        ("explanation", "why"),
                        ("command", "that tests it alone"),
                    ]
                    .map(column)
                    .to_vec(),
                    rows: verdicts.collect(),
                },
                Table {
                    name: "audit_evidence",
                    title: "Numbers from which the verdicts follow".to_owned(),
                    columns: [
                        ("number", "of the statement"),
                        ("name", "of the value"),
                        ("value", "in scaled units where no others are named"),
                    ]
                    .map(column)
                    .to_vec(),
                    rows: evidence.collect(),
                },
            ],
            pictures: Vec::new(),
        }
    }

    fn json(&self) -> Value {
        let statements = self.statements.iter().map(|statement| {
            let Statement { number, paraphrase, place, finding } = statement;
            let evidence = finding
                .evidence
                .iter()
                .map(|(name, value)| json!({ "name": name, "value": value.json() }));
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
    #[must_use]
    pub fn verdict(&self) -> String {
        match &self.finding.condition {
            Some(condition) => format!("{}: {condition}", self.finding.verdict),
            None => self.finding.verdict.to_string(),
        }
    }

    /// Number, statement and verdict in a line.
    fn sentence(&self) -> String {
        format!("{} {} {}", self.number, self.paraphrase, self.verdict())
    }
}
