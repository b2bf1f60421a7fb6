//! The report as text and for programs.

use std::fmt::Write;

use serde_json::{Value, json};
use stickslip_figure::number;
use stickslip_reproduction::figures::ReportSection;
use stickslip_studies::{Cell, StudyTable};

use super::{INTRODUCTION, TITLE};
use crate::schema;

/// Everything for programs, schema "stickslip.report/1".
pub fn json(sections: &[ReportSection]) -> String {
    let parts: Vec<Value> = sections.iter().map(part).collect();
    let report = json!({
        "schema": schema::REPORT,
        "program": { "name": crate::NAME, "version": env!("CARGO_PKG_VERSION") },
        "title": TITLE,
        "parts": parts,
    });
    format!("{report:#}\n")
}

fn part(section: &ReportSection) -> Value {
    let study = &section.study;
    let objections: Vec<String> = section.objections.iter().map(ToString::to_string).collect();
    let pictures = section.pictures.iter().map(
        |picture| json!({ "file": format!("{}.svg", picture.name), "caption": picture.caption }),
    );
    let data = section.data();
    let data = data.iter().map(|(name, title)| json!({ "file": name, "title": title }));
    json!({
        "name": study.name,
        "title": study.title,
        "objections": objections,
        "findings": study.findings,
        "pictures": pictures.collect::<Vec<_>>(),
        "data": data.collect::<Vec<_>>(),
        "numbers": study.json,
    })
}

/// Everything for readers of text.
pub fn markdown(sections: &[ReportSection]) -> String {
    let mut text = format!("# {TITLE}\n");
    for paragraph in INTRODUCTION {
        append(&mut text, format_args!("\n{paragraph}\n"));
    }
    for section in sections {
        let study = &section.study;
        append(&mut text, format_args!("\n## {}\n\n", study.title));
        for objection in &section.objections {
            append(&mut text, format_args!("> {objection}\n\n"));
        }
        for finding in &study.findings {
            append(&mut text, format_args!("- {finding}\n"));
        }
        for picture in &section.pictures {
            let (name, caption) = (&picture.name, &picture.caption);
            append(&mut text, format_args!("\n![{name}]({name}.svg)\n\n{caption}\n"));
        }
        for table in study.tables.iter().filter(|table| section.shown.contains(&table.name)) {
            append(&mut text, format_args!("\n{}", rows(table)));
        }
        text.push('\n');
        for (name, title) in section.data() {
            append(&mut text, format_args!("- [{name}]({name}): {title}\n"));
        }
        append(&mut text, format_args!("- [{0}.json]({0}.json): all numbers\n", study.name));
    }
    text
}

fn rows(table: &StudyTable) -> String {
    let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
    let cell = |cell: &Cell| match cell {
        Cell::Number(value) if !value.is_nan() => number(*value, 5),
        // A bar would begin a new cell.
        other => other.text().replace('|', "\\|"),
    };
    let head = line(table.columns.iter().map(|column| column.meaning.to_owned()).collect());
    let rule = line(vec!["---".to_owned(); table.columns.len()]);
    let rows = table.rows.iter().map(|row| line(row.iter().map(cell).collect()));
    [head, rule].into_iter().chain(rows).collect()
}

fn append(text: &mut String, more: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(more);
}
