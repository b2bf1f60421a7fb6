//! The page that computes is written with the view that is asked for.

use std::process::Command;

use crate::Workspace;

#[test]
fn the_page_shows_a_view() {
    let workspace = Workspace::new();
    for (link, view) in [
        ("preset=figure3", "preset=figure3"),
        ("file:///home/me/explorer.html#law=paper&damping=0.1", "law=paper&amp;damping=0.1"),
    ] {
        let ran = workspace.run(&format!("explore --no-open --link {link} --out page.html"));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, "the explorer is page.html\n"));
        let meta = format!(r#"<meta name="stickslip-view" content="{view}">"#);
        assert_eq!(workspace.read("page.html").matches(&meta).count(), 1, "{link}");
    }
}

#[test]
fn the_page_shows_a_system() {
    let workspace = Workspace::new();
    workspace.write("mine.slip", "state x = 1\nx' = -x\nend = 1\n");
    let ran = workspace.run("explore mine.slip --no-open --out page.html");
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    let view = r#"content="tab=system&amp;text=state%20x%20%3D%201%0Ax%27%20"#;
    assert!(workspace.read("page.html").contains(view));

    workspace.write("mine.slip", "state x = 1\nx' = -z\n");
    let ran = workspace.run("explore mine.slip --no-open --out other.html");
    assert_eq!(ran.code, 2);
    assert!(ran.stderr.contains("line 2, column 7"), "{}", ran.stderr);
    assert_eq!(workspace.names(), ["mine.slip", "page.html"]);
}

/// Where nothing can open a page, it is written all the same, and the program says so.
#[cfg(target_os = "linux")]
#[test]
fn a_page_that_nothing_opens_is_written() {
    let workspace = Workspace::new();
    let page = workspace.path("page.html");
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("stickslip"));
    command.args(["explore", "--out"]).arg(&page).env("PATH", workspace.path("nowhere"));
    let ran = command.output().expect("the program runs");
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert_eq!(ran.status.code(), Some(1), "{said}");
    assert!(said.contains(&format!("error: no browser opens {}: ", page.display())), "{said}");
    assert!(page.exists());
}
