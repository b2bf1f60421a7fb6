//! Statements of the paper, tested and printed.

use stickslip_plane::progress::SILENT;
use stickslip_reproduction::statements::{Statement, run as test};
use stickslip_studies::Cell;

use super::{AuditFormat, ReproduceArguments};
use crate::error::Failure;
use crate::output::console::print;

/// Tests statements and prints them.
pub fn print_tested(arguments: &ReproduceArguments) -> Result<(), Failure> {
    let ReproduceArguments { statement, model, threads, .. } = arguments;
    let audit = threads.pool()?.install(|| test(*model, statement, SILENT))?;
    let text = match arguments.format {
        AuditFormat::Text => {
            audit.statements.iter().map(statement_in_text).collect::<Vec<_>>().join("\n")
        }
        AuditFormat::Json => format!("{:#}\n", audit.study().json),
        AuditFormat::Markdown => markdown(&audit.statements),
    };
    print(|out| out.write_all(text.as_bytes()))
}

/// A table of verdicts, followed by all statements.
fn markdown(statements: &[Statement]) -> String {
    let row = |statement: &Statement| {
        let Statement { number, paraphrase, place, .. } = statement;
        format!("| {number} | {} | {place} | {} |\n", cell(paraphrase), cell(&statement.verdict()))
    };
    let rows: String = statements.iter().map(row).collect();
    let sections: String = statements.iter().map(statement_in_markdown).collect();
    format!("| # | statement | in the paper | verdict |\n|---|---|---|---|\n{rows}{sections}")
}

/// A statement for a terminal.
fn statement_in_text(statement: &Statement) -> String {
    let Statement { number, paraphrase, place, finding } = statement;
    let width = finding.evidence.iter().map(|(name, _)| name.chars().count()).max();
    let evidence = finding.evidence.iter().map(|(name, value)| {
        format!("  {name:width$}  {}\n", value.text(), width = width.unwrap_or(0))
    });
    format!(
        "Statement {number}, {place}: {paraphrase}\nVerdict: {}\n\n{}{}{}Alone: {}\n",
        statement.verdict(),
        evidence.collect::<String>(),
        width.map_or("", |_| "\n"),
        wrapped(&finding.explanation),
        statement.command(),
    )
}

/// A statement with its evidence as a table.
fn statement_in_markdown(statement: &Statement) -> String {
    let Statement { number, paraphrase, place, finding } = statement;
    let row = |(name, value): &(String, Cell)| format!("| {} | {} |\n", cell(name), value.text());
    let rows: String = finding.evidence.iter().map(row).collect();
    let table = if rows.is_empty() {
        String::new()
    } else {
        format!("| evidence | value |\n|---|---|\n{rows}\n")
    };
    format!(
        "\n## {number}. {paraphrase}\n\n{place}. **{}.** {}\n\n{table}`{}`\n",
        statement.verdict(),
        finding.explanation,
        statement.command(),
    )
}

/// `text` for a cell of a Markdown table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// `text`, divided into lines for a terminal.
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
