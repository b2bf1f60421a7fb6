//! An audit written: as text, as Markdown, and as a study.

use serde_json::{Value, json};

use super::{Audit, Statement};
use crate::schema;
use crate::study::{Cell, Column, Study, Table};

impl Audit {
    /// For a terminal.
    pub fn text(&self) -> String {
        self.statements.iter().map(Statement::text).collect::<Vec<_>>().join("\n")
    }

    /// A table of verdicts, and all statements below it.
    pub fn markdown(&self) -> String {
        let row = |statement: &Statement| {
            let Statement { number, paraphrase, place, .. } = statement;
            format!(
                "| {number} | {} | {place} | {} |\n",
                cell(paraphrase),
                cell(&statement.verdict())
            )
        };
        let rows: String = self.statements.iter().map(row).collect();
        let sections: String = self.statements.iter().map(Statement::markdown).collect();
        format!("| # | statement | in the paper | verdict |\n|---|---|---|---|\n{rows}{sections}")
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
            "schema": schema::AUDIT,
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
        let width = finding.evidence.iter().map(|(name, _)| name.chars().count()).max();
        let evidence = finding.evidence.iter().map(|(name, value)| {
            format!("  {name:width$}  {}\n", value.text(), width = width.unwrap_or(0))
        });
        format!(
            "Statement {number}, {place}: {paraphrase}\nVerdict: {}\n\n{}{}{}Alone: {}\n",
            self.verdict(),
            evidence.collect::<String>(),
            width.map_or("", |_| "\n"),
            wrapped(&finding.explanation),
            self.command(),
        )
    }

    fn markdown(&self) -> String {
        let Self { number, paraphrase, place, finding } = self;
        let row =
            |(name, value): &(String, Cell)| format!("| {} | {} |\n", cell(name), value.text());
        let rows: String = finding.evidence.iter().map(row).collect();
        let table = if rows.is_empty() {
            String::new()
        } else {
            format!("| evidence | value |\n|---|---|\n{rows}\n")
        };
        format!(
            "\n## {number}. {paraphrase}\n\n{place}. **{}.** {}\n\n{table}`{}`\n",
            self.verdict(),
            finding.explanation,
            self.command(),
        )
    }
}

/// `text` in a cell of a Markdown table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// `text` in lines for a terminal.
fn wrapped(text: &str) -> String {
    const WIDTH: usize = 96;
    let mut out = String::new();
    let mut column = 0;
    for word in text.split_whitespace() {
        let length = word.chars().count();
        if column > 0 && column + 1 + length > WIDTH {
            out.push('\n');
            column = 0;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out += word;
        column += length;
    }
    out.push('\n');
    out
}
