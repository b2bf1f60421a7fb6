//! What the program says about itself.

use std::process::Command;

use crate::stickslip;

/// The value on the line `name` of `--version`.
fn field<'a>(text: &'a str, name: &str) -> &'a str {
    let line = text.lines().find_map(|line| line.strip_prefix(name));
    line.unwrap_or_else(|| panic!("no {name} in {text}")).trim()
}

#[test]
fn the_short_version_is_name_and_number() {
    let ran = stickslip("-V");
    let version = format!("stickslip {}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!((ran.code, ran.stdout, ran.stderr.as_str()), (0, version, ""));
}

#[test]
fn the_long_version_has_what_a_report_needs() {
    let ran = stickslip("--version");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    let text = ran.stdout.as_str();
    assert_eq!(text.lines().next(), Some(concat!("stickslip ", env!("CARGO_PKG_VERSION"))));

    let fused = cfg!(any(target_feature = "fma", target_arch = "aarch64"));
    let products = if fused { "fused products" } else { "rounded products" };
    assert!(field(text, "built for").contains(std::env::consts::ARCH), "{text}");
    assert!(field(text, "built for").ends_with(&format!(", {products}")), "{text}");
    let (_, features) = field(text, "processor").split_once(": ").expect("a processor");
    for (name, present) in
        [("sse2", cfg!(target_feature = "sse2")), ("avx2", cfg!(target_feature = "avx2"))]
    {
        assert_eq!(features.split(' ').any(|feature| feature == name), present, "{text}");
    }
    assert!(field(text, "compiler").starts_with("rustc 1."), "{text}");
    let profile = field(text, "profile");
    assert!(profile.starts_with("debug, opt-level") || profile.starts_with("release, opt-level"));
    let threads = field(text, "threads").strip_suffix(" here").expect("threads of this machine");
    assert!(threads.parse::<usize>().is_ok_and(|count| count > 0), "{text}");
}

#[test]
fn the_commit_is_that_of_the_repository() {
    let git = Command::new("git").args(["rev-parse", "HEAD"]).output();
    let head = git.ok().filter(|git| git.status.success()).map(|git| git.stdout);
    let head = head.map_or("not known".to_owned(), |head| String::from_utf8(head).expect("ASCII"));
    let ran = stickslip("--version");
    let commit = field(&ran.stdout, "commit");
    assert_eq!(commit.strip_suffix(", with changes").unwrap_or(commit), head.trim());
}

#[test]
fn all_schemas_are_listed() {
    let ran = stickslip("--version");
    let listed: Vec<_> = field(&ran.stdout, "schemas").split(' ').collect();
    assert_eq!(listed.len(), 18);
    let point = stickslip("collide --kappa 18 --psi 1 --format json");
    let point: serde_json::Value = serde_json::from_str(&point.stdout).expect("JSON");
    assert!(listed.contains(&point["schema"].as_str().expect("a schema")));
}
