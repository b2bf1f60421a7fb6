//! The parts of the reproduction: where two of them compute the same, and what a page needs of
//! them.

use std::sync::LazyLock;

use stickslip_plane::progress::SILENT;
use stickslip_reproduction::figures::{ReportSection, Reproduction, headlines};
use stickslip_reproduction::statements::{
    self, Audit, Evidence, Spring, Statement, StatementFinding, StatementVerdict,
};
use stickslip_studies::paper::{Reading, STIFFNESS, psi};
use stickslip_studies::{Cell, StudyTable, convergence};

/// All parts but the study of convergence, which has tests of its own and takes long.
static SECTIONS: LazyLock<Vec<ReportSection>> = LazyLock::new(|| {
    let reproduction = Reproduction::new(24, Spring::Reset);
    let parts = Reproduction::parts().iter();
    let parts = parts.filter(|part| part.title != convergence::TITLE);
    parts.map(|part| part.run(&reproduction).expect("a section")).collect()
});

fn section(name: &str) -> &'static ReportSection {
    SECTIONS.iter().find(|section| section.study.name == name).expect("the section")
}

fn table(section: &'static ReportSection, name: &str) -> &'static StudyTable {
    section.study.tables.iter().find(|table| table.name == name).expect("the table")
}

/// The ψ of the boundaries on the line of the points, in rising order: read off the atlas by Figure
/// 4.
fn boundaries_of_figure_4(reading: Reading) -> Vec<f64> {
    let table = table(section("figure4"), "figure4");
    let column = |name| table.columns.iter().position(|column| column.name == name).unwrap();
    let (axis, low) = (column("axis"), column("ratio_low"));
    let ends = table.rows.iter().filter(|row| row[axis] == Cell::from(reading.axis()));
    let ends = ends.map(|row| match row[low] {
        Cell::Number(ratio) => psi(ratio),
        _ => panic!("{row:?}"),
    });
    let mut ends: Vec<f64> = ends.filter(|psi| *psi > 0.0).collect();
    ends.reverse();
    ends
}

/// The same boundaries as statement 6 has them: traced in a narrow window and solved for.
fn boundaries_of_the_statements(reading: Reading) -> Vec<f64> {
    let audit = section("audit").audit.as_ref().expect("an audit");
    let at = format!(" at κ = {},", reading.kappa(STIFFNESS));
    let evidence = audit.statements[5].finding.evidence.iter();
    let boundaries = evidence.filter(|(name, _)| name.contains("boundary") && name.contains(&at));
    boundaries
        .map(|(_, value)| match value {
            Cell::Number(psi) => *psi,
            value => panic!("{value:?}"),
        })
        .collect()
}

/// Two independent computations. The largest differences in ψ are 8.6e-11 at κ = 18 and 9.3e-11 at
/// κ = 63: the atlas interpolates to 1e-10, and the statements solve to rounding.
#[test]
fn figure_4_and_the_statements_have_the_same_boundaries() {
    for (reading, count) in [(Reading::Printed, 7), (Reading::Axis, 15)] {
        let (read, solved) =
            (boundaries_of_figure_4(reading), boundaries_of_the_statements(reading));
        assert_eq!((read.len(), solved.len()), (count, count), "{reading:?}");
        let off = read.iter().zip(&solved).map(|(read, solved)| (read - solved).abs());
        let off = off.fold(0.0, f64::max);
        println!("{reading:?}: {off:e}");
        assert!(off < 1e-9, "{reading:?}: {off:e}");
    }
}

#[test]
fn columns_of_tables_on_a_page_have_short_headings() {
    let shown = ["figure4", "figure5", "figure6", "audit", "audit_evidence"];
    let mut found = Vec::new();
    for section in SECTIONS.iter() {
        for table in section.shown.iter().map(|name| table(section, name)) {
            found.push(table.name);
            for column in &table.columns {
                let heading = column.heading();
                let words = heading.split(' ').count();
                assert!(words <= 3 && heading.chars().count() <= 14, "{}: {heading}", table.name);
                assert!(!heading.contains("_count"), "{}: {heading}", table.name);
            }
            let rows = table.rows.iter();
            assert!(rows.map(Vec::len).all(|length| length == table.columns.len()));
        }
    }
    assert_eq!(found, shown);
}

#[test]
fn headlines_say_what_was_found() {
    let headlines = headlines(&SECTIONS);
    for parts in [
        &["drawn over ακ", "up to 4 at κ = 18 and up to 8 at ακ = 18"][..],
        &["33 regions", "none of 21852"],
        &[
            "κ^{−5/4}",
            "exponent is 1.24999999999",
            "tends to 4.48484235",
            "theory: 4.4848423519475",
        ],
        &["(27)", "1.1199", "κ = 1.5204", "ψ = 0.9997"],
        &["Of 25 statements", "7 hold, 9 hold under a condition and 9 do not hold"],
    ] {
        let says = |headline: &&String| parts.iter().all(|part| headline.contains(part));
        assert_eq!(headlines.iter().filter(says).count(), 1, "{parts:?} in {headlines:#?}");
    }
    assert_eq!(headlines.len(), 5);
    // The study's own first finding is the same sentence.
    assert_eq!(section("asymptote").study.findings[0], section("asymptote").study.headlines[0]);
}

#[test]
fn the_audit_is_there_as_data() {
    let audit = section("audit").audit.as_ref().expect("an audit");
    assert_eq!(audit.statements.len(), usize::from(statements::COUNT));
    assert_eq!(audit.count(StatementVerdict::HoldsWithACondition), 9);
    let others = SECTIONS.iter().filter(|section| section.study.name != "audit");
    assert!(others.map(|section| &section.audit).all(Option::is_none));
}

/// The headline of an audit says what its verdicts are, whatever they are.
#[test]
fn the_headline_of_another_model_has_other_numbers() {
    let audit = statements::run(Spring::Unreset, &[1, 4, 16], SILENT).expect("an audit");
    let headline = &audit.study().headlines[0];
    assert_eq!(
        headline,
        "With a spring that is not reset while sliding, of 3 statements of the paper, 2 hold and 1 \
         does not hold."
    );
    let open = |number| Statement {
        number,
        paraphrase: "",
        place: "",
        finding: StatementFinding::new(
            StatementVerdict::CannotBeDecided,
            Evidence::default(),
            String::new(),
        ),
    };
    let audit = Audit { spring: Spring::Reset, statements: vec![open(1), open(2)] };
    let headline = &audit.study().headlines[0];
    assert_eq!(headline, "Of 2 statements of the paper, 2 cannot be decided.");
}
