//! Pictures exist, are valid, and are the same every time.

use std::fs;
use std::process::{Command, Output};

use assert_cmd::cargo::cargo_bin;
use roxmltree::{Document, Node};

use crate::Workspace;
use crate::impact::example;

/// The words of a text element, with its subscripts and superscripts.
fn words(node: Node<'_, '_>) -> String {
    node.descendants().filter(Node::is_text).filter_map(|text| text.text()).collect()
}

fn texts(document: &Document<'_>) -> Vec<String> {
    document.descendants().filter(|node| node.has_tag_name("text")).map(words).collect()
}

/// The groups of a class.
fn groups<'a, 'input>(document: &'a Document<'input>, class: &str) -> Vec<Node<'a, 'input>> {
    document.descendants().filter(|node| node.attribute("class") == Some(class)).collect()
}

/// Width and height of a PNG file. Every pixel of it must be readable.
fn png_size(file: &[u8]) -> (u32, u32) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let frame = reader.next_frame(&mut pixels).expect("pixels");
    (frame.width, frame.height)
}

#[test]
fn collisions_have_axes_phases_and_every_switch() {
    let workspace = Workspace::new();
    for (line, switches, slips) in [
        ("--kappa 63 --psi 0.5", 6, 4),
        ("--kappa 63 --psi 0.5 --method exact", 6, 4),
        ("--kappa 18 --psi 1 --damping 0.2 --method dopri5", 5, 3),
        ("--kappa 1e4 --psi 0.5", 72, 37),
        // Both pairs of switches lie within a millionth of an end of contact.
        ("--kappa 18 --psi 1e-7", 2, 2),
        ("--kappa 5 --psi 1e6", 0, 1),
        ("--kappa 1e-3 --psi 1e-13", 2, 2),
    ] {
        let ran = workspace.run(&format!("collide {line} --plot a.svg"));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
        let printed = format!("switches                    {switches}\n");
        assert!(ran.stdout.contains(&printed), "{line}: {}", ran.stdout);
        let svg = workspace.read("a.svg");
        let document = Document::parse(&svg).expect("XML");
        // There is a panel for the forces and a panel for the velocity.
        let marks = groups(&document, "switches");
        assert_eq!(marks.len(), 2);
        for group in marks {
            let lines = group.children().filter(|node| node.has_tag_name("line"));
            assert_eq!(lines.count(), switches, "{line}");
        }
        for group in groups(&document, "phases") {
            let spans = group.children().filter(|node| node.has_tag_name("rect"));
            assert_eq!(spans.count(), slips, "{line}");
        }
        let curves: Vec<_> =
            document.descendants().filter(|node| node.has_tag_name("polyline")).collect();
        assert_eq!(curves.len(), 4);
        for number in curves.iter().flat_map(|curve| {
            curve.attribute("points").expect("points").split([',', ' ']).collect::<Vec<_>>()
        }) {
            let length: f64 = number.parse().expect("a number");
            assert!((0.0..=760.0).contains(&length), "{line}: {number}");
        }
        let texts = texts(&document);
        for expected in
            ["force in units of m β2/5 gn6/5", "time t in units of β−2/5 gn−1/5", "slip +"]
        {
            assert!(texts.iter().any(|text| text == expected), "{line}: {expected} in {texts:?}");
        }
        // The key explains what is in the picture.
        assert_eq!(texts.iter().any(|text| text == "stick"), switches > 0, "{line}: {texts:?}");
        assert!(texts.iter().any(|text| text.starts_with("velocity w = (α/μ) gt/gn")), "{line}");
        let plural = if switches == 1 { "switch" } else { "switches" };
        assert!(texts[0].ends_with(&format!(" {switches} {plural}")), "{}", texts[0]);
    }
    workspace.run("collide --kappa 63 --psi 0.5 --plot a.svg");
    let svg = workspace.read("a.svg");
    let title = texts(&Document::parse(&svg).expect("XML"))[0].clone();
    assert_eq!(title, "κ = 63, ψ = 0.5, a = 0:  εt = −0.04165, 6 switches");
}

#[test]
fn a_picture_changes_no_number() {
    let workspace = Workspace::new();
    for line in [
        "--kappa 63 --psi 0.5",
        "--kappa 63 --psi 0.5 --method exact",
        "--kappa 18 --psi 1 --damping 0.2 --method dopri5",
        // Near a graze, where the collision is computed once more with twice the digits.
        "--kappa 63 --psi 1.9999",
    ] {
        let run = |more: &str| -> serde_json::Value {
            let ran = workspace.run(&format!("collide {line} --format json {more}"));
            assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
            serde_json::from_str(&ran.stdout).expect("JSON")
        };
        let (mut plain, mut drawn) = (run(""), run("--plot a.svg"));
        // The run that keeps the course repeats steps to the switches, and says so.
        for work in ["field", "resteps"] {
            let [less, more] = [&mut plain, &mut drawn].map(|object| {
                object["statistics"].as_object_mut().expect("an object").remove(work)
            });
            let count = |value: Option<serde_json::Value>| value.map(|count| count.as_u64());
            assert!(count(less) <= count(more), "{line}");
        }
        assert_eq!(plain, drawn, "{line}");
    }
}

#[test]
fn curves_pass_through_the_switches() {
    let workspace = Workspace::new();
    let line = "collide --kappa 63 --psi 0.5 --format json --plot a.svg";
    let object: serde_json::Value =
        serde_json::from_str(&workspace.run(line).stdout).expect("JSON");
    let svg = workspace.read("a.svg");
    let document = Document::parse(&svg).expect("XML");
    let number = |node: Node<'_, '_>, name: &str| -> f64 {
        node.attribute(name).expect(name).parse().expect("a number")
    };
    // The marks give the scale of time. F_n at the largest compression gives the scale of forces.
    let marks: Vec<f64> = groups(&document, "switches")[0]
        .children()
        .filter(Node::is_element)
        .map(|mark| number(mark, "x1"))
        .collect();
    let switches = object["switches"].as_array().expect("an array");
    let time = |i: usize| switches[i]["time"].as_f64().expect("a number");
    let scale = (marks[5] - marks[0]) / (time(5) - time(0));
    let curve = |i: usize| -> Vec<(f64, f64)> {
        let curves = document.descendants().filter(|node| node.has_tag_name("polyline"));
        let points = curves.map(|node| node.attribute("points").expect("points")).nth(i);
        let pair = |point: &str| {
            let (x, y) = point.split_once(',').expect("a pair");
            (x.parse().expect("a number"), y.parse().expect("a number"))
        };
        points.expect("a curve").split(' ').map(pair).collect()
    };
    let (normal, tangential) = (curve(0), curve(2));
    let zero = normal[0].1;
    let highest = normal.iter().fold(zero, |highest, point| highest.min(point.1));
    let force = (zero - highest) / 1.25_f64.powf(0.6);
    for (i, switch) in switches.iter().enumerate() {
        let x = marks[0] + scale * (time(i) - time(0));
        assert!((marks[i] - x).abs() < 0.03);
        let y = zero + force * 63.0 * switch["spring"].as_f64().expect("a number");
        let near = |&(px, py): &(f64, f64)| (px - x).abs() < 0.15 && (py - y).abs() < 0.15;
        assert!(tangential.iter().any(near), "switch {i} at {x}, {y}");
    }
}

#[test]
fn maps_have_axes_keys_and_labels() {
    let workspace = Workspace::new();
    for (line, title, rows) in [
        ("--psi 0:2.9", "90 × 70 collisions, a = 0", "ψ = (α/μ) gt/gn"),
        ("--ratio 0:3.5 --mu 0.4", "90 × 70 collisions, μ = 0.4, α = 0.285714, a = 0", "gt/gn"),
    ] {
        let line = format!("map --kappa 0:20 {line} --size 90x70 --method exact --out m.npz");
        let ran = workspace.run(&format!("{line} --plot m.svg"));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{line}");
        let svg = workspace.read("m.svg");
        let document = Document::parse(&svg).expect("XML");
        let texts = texts(&document);
        for expected in [title, rows, "scaled stiffness κ", "tangential restitution εt"] {
            assert!(texts.iter().any(|text| text == expected), "{expected} in {texts:?}");
        }
        let inside = |class: &str| -> Vec<String> {
            groups(&document, class)[0]
                .children()
                .filter(|node| node.has_tag_name("text"))
                .map(words)
                .collect()
        };
        assert_eq!(inside("counts")[..3], ["0", "2", "4"]);
        let mut regions = inside("regions");
        regions.sort();
        regions.dedup();
        assert_eq!(regions, ["0", "2", "4"]);
        assert_eq!(document.descendants().filter(|node| node.has_tag_name("image")).count(), 3);
        fs::remove_file(workspace.path("m.npz")).expect("the map is there");
    }
    assert_eq!(workspace.names(), ["m.svg"]);
}

#[test]
fn a_map_of_a_million_points_is_a_small_file() {
    let workspace = Workspace::new();
    let line = "map --kappa 0:70 --psi 0:2.9 --size 1000x1000 --method exact --out m.npz";
    assert_eq!(workspace.run(&format!("{line} --plot m.svg")).code, 0);
    let size = fs::metadata(workspace.path("m.svg")).expect("the picture").len();
    // 104 000 was measured.
    assert!(size < 200_000, "{size}");
}

#[test]
fn png_has_twice_the_pixels() {
    let workspace = Workspace::new();
    workspace.run("collide --kappa 63 --psi 0.5 --plot a.PNG");
    assert_eq!(png_size(&fs::read(workspace.path("a.PNG")).expect("the picture")), (1520, 1120));
    workspace.run("map --kappa 0:20 --psi 0:2 --size 9x7 --out m.csv --plot m.png");
    assert_eq!(png_size(&fs::read(workspace.path("m.png")).expect("the picture")), (2048, 912));
}

#[test]
fn the_same_bytes_every_time_with_any_number_of_threads_and_without_fonts() {
    let workspace = Workspace::new();
    for (line, format) in [
        ("collide --kappa 1e4 --psi 0.5", "svg"),
        ("collide --kappa 1e4 --psi 0.5", "png"),
        ("map --kappa 0:20 --psi 0:2.9 --size 60x50 --damping 0.1 --out m.npz", "svg"),
        ("map --kappa 0:20 --psi 0:2.9 --size 60x50 --damping 0.1 --out m.npz", "png"),
    ] {
        let pictures = [1, 2, 7].map(|threads| {
            let name = format!("{threads}.{format}");
            // Without a home and a configuration, fonts of the system cannot be found.
            let output = Command::new(cargo_bin!("stickslip"))
                .current_dir(workspace.path("."))
                .env_clear()
                .args(line.split(' '))
                .args(["--threads", &threads.to_string(), "--plot", &name])
                .output()
                .expect("the program starts");
            assert!(output.status.success(), "{line}");
            fs::read(workspace.path(&name)).expect("the picture")
        });
        assert!(pictures[0] == pictures[1] && pictures[0] == pictures[2], "{line} {format}");
    }
}

#[test]
fn points_without_result_are_drawn_grey() {
    let workspace = Workspace::new();
    // The exact solution does not take κ above 1e16.
    let line = "map --kappa 0:4e16 --psi 3:4 --size 4x2 --method exact --out m.csv --plot m.svg";
    let ran = workspace.run(line);
    assert_eq!(ran.code, 1, "{}", ran.stderr);
    assert_eq!(workspace.names(), ["m.csv", "m.svg"]);
    let svg = workspace.read("m.svg");
    let texts = texts(&Document::parse(&svg).expect("XML"));
    assert!(texts.iter().any(|text| text == "scaled stiffness κ (×1016)"), "{texts:?}");
}

#[test]
fn a_picture_is_refused_before_anything_is_done() {
    let workspace = Workspace::new();
    for line in [
        "collide --kappa 63 --psi 0.5 --plot a.ps",
        "collide --kappa 63 --psi 0.5 --plot svg",
        "map --kappa 0:20 --psi 0:2 --size 9x7 --out m.npz --plot m.jpeg",
    ] {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}");
        for part in ["--plot", ".svg", ".png"] {
            assert!(ran.stderr.contains(part), "{line}: {}", ran.stderr);
        }
    }
    let ran = workspace.run("collide --batch in.csv --out out.csv --plot a.svg");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("--plot") && ran.stderr.contains("--batch"), "{}", ran.stderr);

    workspace.write("full.svg", "kept");
    fs::create_dir(workspace.path("d.svg")).expect("a directory");
    for line in [
        "collide --kappa 63 --psi 0.5 --plot no/a.svg",
        "collide --kappa 63 --psi 0.5 --plot d.svg",
        "map --kappa 0:20 --psi 0:2 --size 9x7 --out m.npz --plot no/m.png",
    ] {
        let ran = workspace.run(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (1, ""), "{line}");
        assert!(ran.stderr.contains("cannot be written"), "{line}: {}", ran.stderr);
    }
    // A collision that cannot be computed leaves the old picture.
    let ran = workspace.run("collide --kappa 1e17 --psi 1 --method exact --plot full.svg");
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    assert_eq!(workspace.read("full.svg"), "kept");
    assert_eq!(workspace.names(), ["d.svg", "full.svg"]);
}

#[test]
fn a_collision_with_too_many_steps_for_a_picture_says_so() {
    let workspace = Workspace::new();
    let line = "collide --kappa 1e12 --psi 0.5 --method exact";
    let ran = workspace.run(&format!("{line} --plot a.svg"));
    assert_eq!((ran.code, ran.stdout.as_str()), (1, ""));
    for part in ["kappa = 1000000000000.0", "StepLimit"] {
        assert!(ran.stderr.contains(part), "{}", ran.stderr);
    }
    assert_eq!(workspace.names(), [""; 0]);
}

/// Runs a command line under a limit that a shell sets.
#[cfg(unix)]
fn limited(workspace: &Workspace, limit: &str, line: &str) -> Output {
    Command::new("sh")
        .current_dir(workspace.path("."))
        .args(["-c", &format!("{limit}; exec \"$0\" {line}")])
        .arg(cargo_bin!("stickslip"))
        .output()
        .expect("a shell")
}

/// A limit on the size of files stands for a disk that is full when the picture is written.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing() {
    let workspace = Workspace::new();
    let map = "map --kappa 0:20 --psi 0:2 --size 3x2 --out m.csv --plot m.svg";
    for (line, left) in [
        ("collide --kappa 63 --psi 0.5 --plot a.svg", &[][..]),
        ("collide --kappa 63 --psi 0.5 --plot a.png", &[]),
        // The table would fit, but the map and its picture are published together.
        (map, &["m.csv.tiles"]),
    ] {
        // The limit, in units of 1024 or 512 bytes, is below the size of any picture. The signal
        // that would kill the process is ignored.
        let output = limited(&workspace, "trap '' XFSZ; ulimit -f 4", line);
        let stderr = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(1), "{line}: {stderr}");
        assert!(stderr.contains("cannot be written"), "{stderr}");
        assert!(output.stdout.is_empty());
        assert_eq!(workspace.names(), left, "{line}");
    }
    let ran = workspace.run(map);
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert_eq!(workspace.names(), ["m.csv", "m.svg"]);
    assert!(ran.stderr.contains("going on with 1 of 1 tiles"), "{}", ran.stderr);
}

#[test]
fn collisions_are_animated() {
    let workspace = Workspace::new();
    let line = "collide --kappa 63 --psi 0.5 --animate";
    let ran = workspace.run(&format!("{line} a.gif"));
    assert_eq!((ran.code, ran.stderr.as_str(), ran.said.as_str()), (0, "", "wrote a.gif\n"));
    assert!(fs::read(workspace.path("a.gif")).unwrap().starts_with(b"GIF89a"));
    let ran = workspace.run(&format!("{line} a.avi"));
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("expected a name that ends in .gif or .mp4"), "{}", ran.stderr);
    // A film needs ffmpeg, and without it nothing is begun.
    let mut command = Command::new(cargo_bin("stickslip"));
    command.args(line.split(' ')).arg(workspace.path("a.mp4")).env("PATH", "");
    let ran = command.output().expect("the program runs");
    assert_eq!(ran.status.code(), Some(1));
    let stderr = String::from_utf8(ran.stderr).expect("UTF-8");
    assert!(stderr.contains("expected ffmpeg among the programs"), "{stderr}");
    assert_eq!(workspace.names(), ["a.gif"]);
    assert_eq!(workspace.run(&format!("{line} a.gif --course a.gif")).code, 2);
    let spheres = example("steel_spheres.json");
    let ran = workspace.run(&format!("impact {} --animate b.gif", spheres.display()));
    assert_eq!((ran.code, ran.said.as_str()), (0, "wrote b.gif\n"), "{}", ran.stderr);
    assert!(fs::read(workspace.path("b.gif")).unwrap().starts_with(b"GIF89a"));
}

/// Too few files may be open for the outputs.
#[cfg(target_os = "linux")]
#[test]
fn too_many_open_files_are_named() {
    let workspace = Workspace::with_input("kappa,psi\n18,1\n");
    let mut named = 0;
    for limit in 4..12 {
        let line = "collide --batch in.csv --out o";
        let output = limited(&workspace, &format!("ulimit -n {limit}"), line);
        let stderr = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(!stderr.contains("uncategorized"), "{stderr}");
        named += usize::from(stderr.contains("o: cannot be written: Too many open files"));
    }
    assert!(named > 0);
}

#[test]
fn impacts_are_drawn_in_si_units() {
    let workspace = Workspace::new();
    let file = crate::impact::example("steel_pair.json");
    let line = format!("impact {} --speed 2 --plot a.svg", file.display());
    let ran = workspace.run(&format!("{line} --angle 0.5"));
    assert_eq!((ran.code, ran.stderr.as_str(), ran.said.as_str()), (0, "", "wrote a.svg\n"));
    let svg = workspace.read("a.svg");
    for name in ["force [N]", "time [s]", "velocity of the surfaces [m/s]"] {
        assert!(svg.contains(name), "{name}");
    }
    let switches = ran.stdout.lines().find(|line| line.starts_with("switches")).unwrap();
    let count: usize = switches.split_whitespace().last().unwrap().parse().unwrap();
    let document = Document::parse(&svg).expect("XML");
    for group in groups(&document, "switches") {
        let lines = group.children().filter(|node| node.has_tag_name("line"));
        assert_eq!(lines.count(), count);
    }
    let ran = workspace.run(&format!("{line} --angle 0"));
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    assert!(ran.stderr.contains("nothing is tangential in a central impact"), "{}", ran.stderr);
}
