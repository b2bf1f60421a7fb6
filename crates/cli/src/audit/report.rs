//! An audit written: as text, as Markdown, and as a study.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use super::{Audit, Statement};
use crate::study::{Cell, Column, Study, Table};

impl Audit {
    /// For a terminal.
    pub fn text(&self) -> String {
        self.statements.iter().map(Statement::text).collect::<Vec<_>>().join("\n")
    }

    /// A table of verdicts, and all statements below it.
    pub fn markdown(&self) -> String {
        let mut out =
            String::from("| # | statement | in the paper | verdict |\n|---|---|---|---|\n");
        for statement in &self.statements {
            let Statement { number, paraphrase, place, .. } = statement;
            // Writing into a string does not fail.
            let _ =
                writeln!(out, "| {number} | {paraphrase} | {place} | {} |", statement.verdict());
        }
        for statement in &self.statements {
            out += &statement.markdown();
        }
        out
    }

    /// The tables `audit` and `audit_evidence`, and all of it as JSON.
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
            let evidence = finding.evidence.iter().map(|(name, value)| {
                let value = match value {
                    Cell::Number(number) => json!(number),
                    Cell::Count(count) => json!(count),
                    Cell::Text(text) => json!(text),
                };
                (name.clone(), value)
            });
            json!({
                "number": number,
                "statement": paraphrase,
                "place": place,
                "verdict": finding.verdict.to_string(),
                "condition": finding.condition,
                "evidence": evidence.collect::<Map<_, _>>(),
                "explanation": finding.explanation,
                "command": statement.command(),
            })
        });
        json!({
            "schema": "stickslip.audit/1",
            "model": self.model.name(),
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

    /// Number, statement and verdict in a line.
    fn sentence(&self) -> String {
        format!("{} {} {}", self.number, self.paraphrase, self.verdict())
    }

    fn text(&self) -> String {
        let Self { number, paraphrase, place, finding } = self;
        let mut out = format!("Statement {number}, {place}: {paraphrase}\n");
        out += &format!("Verdict: {}\n\n", self.verdict());
        let width = finding.evidence.iter().map(|(name, _)| name.chars().count()).max();
        for (name, value) in finding.evidence.iter() {
            let width = width.unwrap_or(0);
            out += &format!("  {name:width$}  {}\n", value.text());
        }
        out += if width.is_some() { "\n" } else { "" };
        out += &format!("{}\n", finding.explanation);
        out += &format!("Alone: {}\n", self.command());
        out
    }

    fn markdown(&self) -> String {
        let Self { number, paraphrase, place, finding } = self;
        let mut out = format!("\n## {number}. {paraphrase}\n\n");
        out += &format!("{place}. **{}.** {}\n\n", self.verdict(), finding.explanation);
        if finding.evidence.iter().next().is_some() {
            out += "| evidence | value |\n|---|---|\n";
        }
        for (name, value) in finding.evidence.iter() {
            out += &format!("| {name} | {} |\n", value.text());
        }
        out += &format!("\n`{}`\n", self.command());
        out
    }
}
