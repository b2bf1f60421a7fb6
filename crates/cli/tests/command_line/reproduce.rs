//! The page of `reproduce` is complete, needs nothing else, and is right.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use roxmltree::{Document, Node, ParsingOptions};

use crate::{Workspace, npz, rows, version_in_maps};

/// The run with two threads, whose files several tests read, also those of `notebooks_data`: with
/// 40 cells the table of Figure 1 has every fifth of the usual velocities.
pub static RUN: LazyLock<Workspace> = LazyLock::new(|| whole("out", 2));

/// The atlas of the whole plane by a command of its own, which `notebooks_data` reads too.
pub static ATLAS: LazyLock<Workspace> = LazyLock::new(|| {
    let workspace = Workspace::new();
    let line = "trace --kappa 0.05:100 --psi 0.01:3 --out atlas.json --plot atlas.svg";
    assert_eq!(workspace.run(line).code, 0);
    workspace
});

/// A run with so many threads.
fn whole(out: &str, threads: u8) -> Workspace {
    let workspace = Workspace::new();
    let ran = workspace.run(&format!("reproduce --out {out} --cells 40 --threads {threads}"));
    assert_eq!((ran.code, ran.stdout.as_str()), (0, ""), "{}", ran.stderr);
    let lines: Vec<&str> = ran.stderr.lines().collect();
    assert_eq!(lines[0], "1 of 10: Figure 1: pure Coulomb sliding");
    let page = format!("everything is on {out}/index.html");
    assert_eq!(lines[10..], ["beside it: Contact laws of particle codes", &page]);
    workspace
}

const PICTURES: [&str; 18] = [
    "asymptote_correction",
    "asymptote_counts",
    "asymptote_envelope",
    "asymptote_profile",
    "boundaries",
    "convergence_steps_switches",
    "convergence_steps_velocity",
    "convergence_tolerances_switches",
    "convergence_tolerances_velocity",
    "convergence_work",
    "figure1",
    "figure2",
    "figure3",
    "figure4",
    "figure5_axis",
    "figure5_printed",
    "figure6_axis",
    "figure6_printed",
];

const DATA: [&str; 37] = [
    "asymptote.json",
    "asymptote_collisions.csv",
    "asymptote_convergence.csv",
    "asymptote_counts.csv",
    "asymptote_envelope.csv",
    "asymptote_profile.csv",
    "asymptote_restitution.csv",
    "atlas.json",
    "audit.csv",
    "audit.json",
    "audit_evidence.csv",
    "boundaries.json",
    "convergence.json",
    "convergence_collisions.csv",
    "convergence_orders.csv",
    "convergence_steps.csv",
    "convergence_tolerances.csv",
    "figure1.csv",
    "figure1.json",
    "figure2.json",
    "figure2.npz",
    "figure3.json",
    "figure3_axis.npz",
    "figure3_printed.npz",
    "figure4.csv",
    "figure4.json",
    "figure4_axis.npz",
    "figure4_boundaries.json",
    "figure4_printed.npz",
    "figure5.csv",
    "figure5.json",
    "figure5_axis.csv",
    "figure5_printed.csv",
    "figure6.csv",
    "figure6.json",
    "figure6_axis.csv",
    "figure6_printed.csv",
];

/// What is on the page of contact laws, beside the other one.
pub const LAWS: usize = 27;

/// The files of the page of contact laws.
pub fn names_of_laws() -> Vec<String> {
    let pictures = (1..=LAWS)
        .flat_map(|law| ["forces", "maps"].map(|name| format!("law_{law:02}_{name}.svg")));
    let data = ["contact_laws.csv", "contact_laws.json"].map(str::to_owned);
    data.into_iter().chain(pictures).chain(["laws.html".to_owned()]).collect()
}

fn expected_names() -> Vec<String> {
    let pictures = PICTURES.iter().map(|name| format!("{name}.svg"));
    let pages = ["explorer.html", "index.html", "report.json", "report.md"].map(str::to_owned);
    let files = pictures.chain(DATA.map(str::to_owned)).chain(pages);
    let mut names: Vec<String> = files.chain(names_of_laws()).collect();
    names.sort();
    names
}

/// The rows of a table, each with its fields by the names of their columns.
fn table(name: &str) -> Vec<BTreeMap<String, String>> {
    let rows = rows(&RUN.read(name));
    let row = |row: &Vec<String>| rows[0].iter().cloned().zip(row.iter().cloned()).collect();
    rows[1..].iter().map(row).collect()
}

/// The page of `text`, which is XML.
pub fn page(text: &str) -> Document<'_> {
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).expect("XML")
}

#[test]
fn the_page_is_complete_and_needs_nothing_else() {
    assert_eq!(RUN.names_in("out"), expected_names());
    let text = RUN.read("out/index.html");
    let page = page(&text);
    for name in ["script", "link", "img", "iframe", "object", "base"] {
        assert!(!page.descendants().any(|node| node.has_tag_name(name)), "{name}");
    }
    assert!(!text.contains("url(") && !text.contains("@import"));
    let named = |name: &str| page.descendants().any(|node| node.attribute("id") == Some(name));
    for node in page.descendants().filter(Node::is_element) {
        assert_eq!(node.attribute("src"), None);
        let Some(target) = node.attribute("href") else { continue };
        let there = match target.split_once('#') {
            Some(("", name)) => named(name),
            _ if target.starts_with("data:image/png;base64,") => {
                node.has_tag_name("image") || node.tag_name().name() == "image"
            }
            Some((file, _)) => RUN.path("out").join(file).is_file(),
            None => RUN.path("out").join(target).is_file(),
        };
        assert!(there, "{}", &target[..target.len().min(60)]);
    }
    // Each picture is on the page once, and in a file of its own.
    let pictures: Vec<_> = page.descendants().filter(|node| node.has_tag_name("figure")).collect();
    assert_eq!(pictures.len(), PICTURES.len());
    for name in PICTURES {
        let svg = RUN.read(&format!("out/{name}.svg"));
        assert_eq!(text.matches(&svg).count(), 1, "{name}");
        Document::parse(&svg).expect("XML");
    }
    // Identifiers are unique.
    let mut ids: Vec<_> = page.descendants().filter_map(|node| node.attribute("id")).collect();
    let count = ids.len();
    ids.sort_unstable();
    ids.dedup();
    assert_eq!(ids.len(), count);
}

/// A picture and the contents come first, each figure above what was found of it, and panels side
/// by side are parts that a narrow page shows below each other.
#[test]
fn the_page_is_in_the_order_of_reading() {
    let text = RUN.read("out/index.html");
    let page = page(&text);
    let tags = |node: Node<'_, '_>| -> Vec<String> {
        let children = node.children().filter(Node::is_element);
        children.map(|child| child.tag_name().name().to_owned()).collect()
    };
    let find = |name: &str| page.descendants().find(|node| node.has_tag_name(name));
    let header = find("header").expect("a header");
    assert_eq!(tags(header), ["h1", "p", "p", "a", "nav"]);
    let target = |node: Node<'_, '_>| node.attribute("href").expect("a link").to_owned();
    let inside = |node: Node<'_, '_>, name: &str| -> Vec<String> {
        node.descendants().filter(|node| node.has_tag_name(name)).map(target).collect()
    };
    assert_eq!(inside(header, "use"), ["#picture-boundaries"]);
    let sections = page.descendants().filter(|node| node.has_tag_name("section"));
    let (mut contents, mut stacked) = (vec!["#boundaries".to_owned()], 0);
    for section in sections {
        contents.push(format!("#{}", section.attribute("id").expect("a name")));
        let tags = tags(section);
        let figure = tags.iter().position(|tag| tag == "figure");
        assert!(figure.is_none_or(|place| place == 1 && tags[0] == "h2"), "{tags:?}");
        for part in section.descendants().filter(|node| node.attribute("class") == Some("part")) {
            let view: Vec<f64> = part
                .attribute("viewBox")
                .expect("a view")
                .split(' ')
                .map(|side| side.parse().expect("a number"))
                .collect();
            let whole = part.parent().and_then(|figure| {
                figure.descendants().find(|node| node.has_attribute("font-family"))
            });
            let side = |name: &str| -> f64 {
                let side = whole.and_then(|whole| whole.attribute(name)).expect("a side");
                side.parse().expect("a number")
            };
            assert!(view[0] >= 0.0 && view[0] + view[2] <= side("width") + 1e-9, "{view:?}");
            assert!(view[1] > 0.0 && view[1] + view[3] <= side("height") + 1e-9, "{view:?}");
            stacked += 1;
        }
    }
    assert_eq!(inside(header, "a"), contents);
    // Two panels of Figures 2, 3 and 4, one of Figure 1, and Figure 5 with its legends.
    assert_eq!(stacked, 1 + 3 * 2 + 2 * 3);
}

#[test]
fn all_forms_say_the_same() {
    let report: serde_json::Value =
        serde_json::from_str(&RUN.read("out/report.json")).expect("JSON");
    assert_eq!(report["schema"], "stickslip.report/1");
    let parts = report["parts"].as_array().expect("parts");
    let markdown = RUN.read("out/report.md");
    let html = RUN.read("out/index.html");
    // The page has 2×10⁻³ where the other forms have 2e-3.
    let in_one_notation = |text: &str| text.replace("×10−", "e-").replace("×10", "e");
    let text = |node: Node<'_, '_>| -> String {
        let texts = node.descendants().filter(Node::is_text).filter_map(|text| text.text());
        in_one_notation(&texts.collect::<String>())
    };
    let page = page(&html);
    let on_page: Vec<String> =
        page.descendants().filter(|node| node.has_tag_name("li")).map(text).collect();
    let article = |number: &serde_json::Value| {
        let id = format!("statement-{number}");
        text(page.descendants().find(|node| node.attribute("id") == Some(&id)).expect("an article"))
    };
    // Parentheses after `^` or `_` are not shown.
    let plain = |markup: &str| {
        let raised: Vec<&str> = markup.split(['^', '_']).collect();
        let unwrapped = raised[1..].iter().map(|part| match part.strip_prefix('(') {
            Some(inside) => inside.replacen(')', "", 1),
            None => (*part).to_owned(),
        });
        let whole: String = std::iter::once(raised[0].to_owned()).chain(unwrapped).collect();
        in_one_notation(&whole.replace(['{', '}', '`'], ""))
    };
    let (mut findings, mut statements) = (0, 0);
    for part in parts {
        assert_eq!(part["objections"], serde_json::json!([]));
        let name = part["name"].as_str().expect("a name");
        let numbers = RUN.read(&format!("out/{name}.json"));
        let mut numbers: serde_json::Value = serde_json::from_str(&numbers).expect("JSON");
        let fields = numbers.as_object_mut().expect("an object");
        for name in ["title", "findings"] {
            assert_eq!(fields.remove(name).as_ref(), Some(&part[name]));
        }
        assert!(fields.remove("files").is_some());
        assert_eq!(part["numbers"], numbers);
        for finding in part["findings"].as_array().expect("findings") {
            let finding = finding.as_str().expect("a sentence");
            assert!(markdown.contains(finding), "{finding}");
            // Statements of the paper are shown with their evidence instead.
            assert!(name == "audit" || on_page.contains(&plain(finding)), "{finding}");
            findings += 1;
        }
        for statement in numbers["statements"].as_array().into_iter().flatten() {
            let shown = article(&statement["number"]);
            for field in ["statement", "verdict", "condition", "explanation"] {
                let Some(words) = statement[field].as_str() else { continue };
                assert!(shown.contains(&plain(words)), "{field}: {words} in {shown}");
                statements += usize::from(field == "verdict");
            }
        }
    }
    assert_eq!((parts.len(), statements), (10, 25));
    assert!(findings > 15, "{findings}");
}

#[test]
fn the_line_of_the_points_has_the_known_numbers_of_switches() {
    let counts = |axis: &str| -> Vec<String> {
        let rows = table("out/figure4.csv").into_iter().filter(|row| row["axis"] == axis);
        rows.map(|row| row["switch_count"].clone()).collect()
    };
    assert_eq!(counts("ακ").join(" "), "0 2 4 6 8 6 8 6 4 6 4 2 4 2 4 2");
    assert_eq!(counts("κ").join(" "), "0 2 4 2 4 2 4 2");
    // Both lines have no gaps.
    let rows = table("out/figure4.csv");
    for pair in rows.windows(2).filter(|pair| pair[0]["axis"] == pair[1]["axis"]) {
        assert_eq!(pair[0]["ratio_low"], pair[1]["ratio_high"]);
    }
    // With an independent engine, the count changes at every end.
    for row in rows.iter().filter(|row| row["ratio_low"] != "0.0") {
        let end: f64 = row["ratio_low"].parse().expect("a number");
        let counts = [1.0 - 1e-6, 1.0 + 1e-6].map(|factor| {
            let ratio = end * factor;
            let line = format!("collide --kappa {} --ratio {ratio:?} --format json", row["kappa"]);
            let object: serde_json::Value =
                serde_json::from_str(&RUN.run(&line).stdout).expect("JSON");
            object["switch_count"].as_u64().expect("a count")
        });
        assert_eq!(counts[0].abs_diff(counts[1]), 2, "{end}");
        assert_eq!(counts[1].to_string(), row["switch_count"]);
    }
}

#[test]
fn the_points_are_what_the_paper_says_of_them() {
    let points = table("out/figure5.csv");
    let of = |name: &str| {
        let row = points.iter().find(|row| row["axis"] == "ακ" && row["point"] == name);
        row.unwrap_or_else(|| panic!("no point {name}"))
    };
    let number = |name: &str, column: &str| -> f64 { of(name)[column].parse().expect("a number") };
    // The largest compression.
    let middle = 0.5 * 3.21806545971904;
    assert!(of("a")["first_switch"].is_empty());
    for name in ["b", "c", "d"] {
        assert!(number(name, "first_switch") > middle, "{name}");
    }
    let before = middle - number("e", "first_switch");
    assert!(before > 0.0 && before < 0.1, "{before}");
    let [i, j, k] = ["i", "j", "k"].map(|name| number(name, "switch_count"));
    assert_eq!([j - i, j - k], [2.0, 2.0]);
    assert_eq!(number("o", "switch_count"), 2.0);
    // Both readings have the same ratios. With κ as printed there are at most four switches.
    let printed: Vec<_> = points.iter().filter(|row| row["axis"] == "κ").collect();
    assert_eq!(printed.len(), 16);
    for row in printed {
        assert_eq!(row["ratio"], of(&row["point"])["ratio"]);
        assert!(row["switch_count"].parse::<u32>().expect("a count") <= 4);
    }
}

#[test]
fn a_stiff_spring_has_neither_the_switches_nor_the_minimum_of_the_paper() {
    let rows = table("out/figure6.csv");
    let numbers: Vec<[f64; 3]> = rows
        .iter()
        .map(|row| {
            ["kappa", "switch_count", "first_minimum"]
                .map(|column| row[column].parse().expect("a number"))
        })
        .collect();
    for (row, [kappa, switches, minimum]) in
        numbers.iter().zip([[100.0, 4.0, 0.951], [350.0, 10.0, 0.878]])
    {
        assert_eq!(row[..2], [kappa, switches]);
        assert!((row[2] - minimum).abs() < 1e-3, "{row:?}");
    }
}

#[test]
fn data_are_what_the_other_commands_make() {
    let steel = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/steel_pair.json");
    RUN.write("steel.json", fs::read(steel).expect("the example"));
    for (line, out) in [
        ("--kappa 0:20 --ratio 0:3.5", "figure3_printed"),
        ("--kappa 0:70 --ratio 0:3.5", "figure3_axis"),
        ("--kappa 0:20 --ratio 0:4", "figure4_printed"),
        ("--kappa 0:70 --ratio 0:4", "figure4_axis"),
        ("--bodies steel.json --normal 0:200 --tangential 0:200", "figure2"),
    ] {
        let line = format!("map {line} --size 40x40 --method exact --out {out}.npz");
        assert_eq!(RUN.run(&line).code, 0, "{line}");
        let name = format!("{out}.npz");
        let [ours, theirs] = [RUN.path(&name), RUN.path("out").join(&name)]
            .map(|path| fs::read(path).expect("a map"));
        assert!(ours == theirs, "{out}");
    }
    let arrays = npz(&RUN.path("out/figure4_axis.npz"));
    let names: Vec<&str> = arrays.iter().map(|(name, _)| name.as_str()).collect();
    let facts = ["mu", "alpha", "damping", "method", "version"];
    assert_eq!(names[..5], ["kappa", "psi", "ratio", "eps_t", "switch_count"]);
    assert_eq!(names[5..], facts);
    let facts: Vec<_> = arrays[5..].iter().flat_map(|(_, array)| array.fields()).collect();
    let alpha = format!("{:?}", 2.0 / 7.0);
    assert_eq!(facts, ["0.4", &alpha, "0.0", "exact", &version_in_maps()]);

    assert!(ATLAS.read("atlas.json") == RUN.read("out/atlas.json"));
    assert!(ATLAS.read("atlas.svg") == RUN.read("out/boundaries.svg"));
    // The boundaries of Figure 4 are also an atlas.
    RUN.write("points.csv", "kappa,psi\n63,0.5\n");
    let line = "locate --atlas out/figure4_boundaries.json --batch points.csv --out located.csv";
    assert_eq!(RUN.run(line).code, 0);
    assert!(RUN.read("located.csv").contains(",6,+o-o+o-,"));
}

#[test]
#[ignore = "long; .ci/run --long runs it"]
fn the_same_bytes_with_one_thread() {
    let one_thread = whole("new/out", 1);
    assert_eq!(one_thread.names_in("new/out"), expected_names());
    for name in expected_names() {
        let [one, two] =
            [one_thread.path("new/out"), RUN.path("out")].map(|out| fs::read(out.join(&name)));
        assert!(one.expect("a file") == two.expect("a file"), "{name}");
    }
}

#[test]
fn files_that_were_made_before_a_failure_stay() {
    let workspace = Workspace::new();
    // A picture cannot take the name of a directory.
    fs::create_dir_all(workspace.path("out/figure3.svg")).expect("a directory");
    let ran = workspace.run("reproduce --out out --cells 8");
    assert_eq!(ran.code, 1);
    let expected = "error: out/figure3.svg: cannot be written: is a directory\n";
    assert!(ran.stderr.ends_with(expected), "{}", ran.stderr);
    // There are all files of Figures 1 and 2, and those of Figure 3 that come before the picture.
    // There is no page, and no file is incomplete.
    let mut names = expected_names();
    names.retain(|name| {
        ["figure1", "figure2"].iter().any(|figure| name.starts_with(figure))
            || ["figure3.svg", "figure3_axis.npz", "figure3_printed.npz"].contains(&name.as_str())
    });
    assert_eq!(workspace.names_in("out"), names);
}

#[test]
fn bad_directories_are_refused_before_any_work() {
    let workspace = Workspace::with_input("a file");
    for (line, code, expected) in [
        ("reproduce", 2, "--out <DIR>"),
        (
            "reproduce --out in.csv",
            2,
            "error: --out in.csv is not a directory; expected a directory, or a name that is not taken\n",
        ),
        ("reproduce --out in.csv/out", 1, "error: in.csv/out: cannot be written: "),
        ("reproduce --out out --threads 0", 2, "0 is not in 1..=1024"),
    ] {
        let ran = workspace.run(line);
        assert_eq!(ran.code, code, "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains(expected), "{line}: {}", ran.stderr);
        assert!(!ran.stderr.contains("1 of 10"), "{line}");
    }
    assert_eq!(workspace.names(), ["in.csv"]);
    assert_eq!(workspace.read("in.csv"), "a file");
}
