//! Manual pages are complete, and groff renders them without a warning.

use std::process::Command;

use crate::{Workspace, stickslip};

const PAGES: [&str; 26] = [
    "stickslip-asymptote.1",
    "stickslip-basins.1",
    "stickslip-branch.1",
    "stickslip-collide.1",
    "stickslip-completions.1",
    "stickslip-converge.1",
    "stickslip-curve.1",
    "stickslip-explore.1",
    "stickslip-fit.1",
    "stickslip-impact.1",
    "stickslip-join.1",
    "stickslip-laws.1",
    "stickslip-locate.1",
    "stickslip-man.1",
    "stickslip-map.1",
    "stickslip-orbit.1",
    "stickslip-regions.1",
    "stickslip-reproduce.1",
    "stickslip-run.1",
    "stickslip-section.1",
    "stickslip-stack.1",
    "stickslip-system.1",
    "stickslip-table.1",
    "stickslip-timestep.1",
    "stickslip-trace.1",
    "stickslip.1",
];

/// The page as a terminal shows it, without attributes; `None` if groff is not installed.
fn rendered(page: &std::path::Path) -> Option<String> {
    let arguments = ["-k", "-man", "-Tutf8", "-ww", "-P-cbou", "-rLL=110n"];
    let ran = Command::new("groff").args(arguments).arg(page).output();
    let Ok(ran) = ran else {
        println!("skipped: there is no groff");
        return None;
    };
    assert_eq!(String::from_utf8_lossy(&ran.stderr), "", "{}", page.display());
    Some(String::from_utf8(ran.stdout).expect("UTF-8"))
}

#[test]
fn one_page_has_all_commands() {
    let ran = stickslip("man");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let title = concat!(".TH stickslip 1 \"\" \"stickslip ", env!("CARGO_PKG_VERSION"), "\"");
    assert!(ran.stdout.contains(title), "{}", &ran.stdout[..300]);
    let workspace = Workspace::new();
    workspace.write("stickslip.1", &ran.stdout);
    let Some(text) = rendered(&workspace.path("stickslip.1")) else { return };
    for part in [
        "\nCOLLIDE\n",
        "\nMAP\n",
        "\nMAN\n",
        "--kappa <K>",
        "  stickslip collide --kappa 63 --psi 0.5\n",
        "Exit codes: 0 done, 1 the computation failed, 2 bad usage or bad input.",
        "damping a = A β^⅖ g_n^⅕",
    ] {
        assert!(text.contains(part), "no {part:?} in {text}");
    }
}

#[test]
fn a_directory_gets_a_page_for_each_command() {
    let workspace = Workspace::new();
    let ran = workspace.run("man --out new/pages");
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    assert_eq!(workspace.names_in("new/pages"), PAGES);
    for name in PAGES {
        let Some(text) = rendered(&workspace.path("new/pages").join(name)) else { return };
        assert!(text.contains("\nSYNOPSIS\n") && text.contains("\nNOTES\n"), "{name}: {text}");
    }
}

#[test]
fn a_file_instead_of_the_directory_is_refused() {
    let workspace = Workspace::with_input("");
    let ran = workspace.run("man --out in.csv");
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    assert!(ran.stderr.contains("--out in.csv is not a directory"), "{}", ran.stderr);
}
