//! The page with everything: one file that needs no other, no network and no scripts.
//!
//! It is well-formed XML as well, so that any tool can read it.

use super::markup::{escaped, html as markup};
use super::section::Section;
use crate::figure::number;
use crate::study::{Cell, Picture, Study, Table};

/// The title of the page and of the report.
pub const TITLE: &str = "Tangential restitution of viscoelastic spheres, computed anew";

/// What stands above everything.
pub const INTRODUCTION: [&str; 2] = [
    "The figures of T. Schwager, V. Becker and T. Pöschel, Coefficient of tangential restitution for viscoelastic spheres, Eur. Phys. J. E \
     27, 107 (2008), computed anew with every switch between sliding and sticking. Numbers in brackets are those of its equations.",
    "Lengths, times and forces are scaled as there. κ is the scaled stiffness of the tangential spring (24), g_n and g_t are the normal \
     and the tangential impact velocity, ψ = (α/μ) g_t/g_n, a is the scaled damping. The axis that Figures 3 to 6 of the paper call \
     κ can be read in two ways, as κ of (24) and as ακ; both are shown.",
];

const STYLE: &str = include_str!("page.css");
/// Pictures are not shown smaller than that, in parts of their size: letters would become too
/// small.
const LEAST_SCALE: f64 = 0.7;

/// The page.
pub fn html(sections: &[Section]) -> String {
    let contents = all(sections, entry);
    let introduction = all(INTRODUCTION, |text| format!("<p>{}</p>\n", markup(text)));
    let body = all(sections, section);
    format!(
        r#"<!DOCTYPE html>
<html xmlns="http://www.w3.org/1999/xhtml" lang="en">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<title>{TITLE}</title>
<style>
{STYLE}</style>
</head>
<body>
<header>
<h1>{TITLE}</h1>
{introduction}</header>
<nav>
<ul>
{contents}</ul>
</nav>
<main>
{body}</main>
<footer>
<p>Made by <code>{} reproduce</code>, version {}. The same as data: <a href="report.json">report.json</a>; as text: <a href="report.md">report.md</a>.</p>
</footer>
</body>
</html>
"#,
        crate::NAME,
        env!("CARGO_PKG_VERSION"),
    )
}

fn entry(section: &Section) -> String {
    let study = &section.study;
    format!("<li><a href=\"#{}\">{}</a></li>\n", study.name, escaped(study.title))
}

fn section(section: &Section) -> String {
    let Study { name, title, findings, tables, pictures, .. } = &section.study;
    let title = escaped(title);
    let objections = all(&section.objections, |objection| {
        format!("<p class=\"objection\">{}</p>\n", escaped(&objection.to_string()))
    });
    let findings = all(findings, |finding| format!("<li>{}</li>\n", markup(finding)));
    let pictures = all(pictures, figure);
    let shown = tables.iter().filter(|table| section.shown.contains(&table.name));
    let tables = all(shown, table);
    let numbers = (format!("{name}.json"), "all numbers");
    let data = all(section.data().into_iter().chain([numbers]), |(file, title)| {
        format!("<li><a href=\"{0}\">{0}</a> {1}</li>\n", escaped(&file), markup(title))
    });
    format!(
        "<section id=\"{name}\">\n<h2>{title}</h2>\n{objections}<ul class=\"findings\">\n{findings}</ul>\n{pictures}{tables}\
         <ul class=\"data\">\n{data}</ul>\n</section>\n"
    )
}

fn figure(picture: &Picture) -> String {
    let Picture { name, caption, svg } = picture;
    let (width, least) = (svg.width(), (LEAST_SCALE * svg.width()).round());
    format!(
        "<figure>\n<div class=\"wide\"><div style=\"min-width:{least}px;max-width:{width}px\">\n{}</div></div>\n\
         <figcaption>{} <a href=\"{name}.svg\">{name}.svg</a></figcaption>\n</figure>\n",
        svg.document(),
        markup(caption),
    )
}

fn table(table: &Table) -> String {
    let first = table.rows.first().into_iter().flatten();
    let head = all(table.columns.iter().zip(first), |(column, below)| {
        format!("<th class=\"{}\">{}</th>", class(below), markup(column.meaning))
    });
    let rows = all(&table.rows, |row| format!("<tr>{}</tr>\n", all(row, cell)));
    format!(
        "<div class=\"wide\"><table>\n<caption>{}</caption>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{rows}</tbody>\n</table></div>\n",
        markup(&table.title)
    )
}

fn cell(cell: &Cell) -> String {
    let content = match cell {
        Cell::Number(value) if value.is_nan() => String::new(),
        Cell::Number(value) => markup(&number(*value, 5)),
        Cell::Count(count) => count.to_string(),
        Cell::Text(text) => markup(text),
    };
    format!("<td class=\"{}\">{content}</td>", class(cell))
}

fn class(cell: &Cell) -> &'static str {
    match cell {
        Cell::Number(_) | Cell::Count(_) => "number",
        Cell::Text(text) if !text.contains(' ') => "word",
        Cell::Text(_) => "words",
    }
}

/// One after the other.
fn all<T>(items: impl IntoIterator<Item = T>, write: impl Fn(T) -> String) -> String {
    items.into_iter().map(write).collect()
}
