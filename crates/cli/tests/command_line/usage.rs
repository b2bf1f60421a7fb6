//! Bad usage: exit code 2, nothing on standard output, a message that says what is expected.

use crate::stickslip;

/// Runs `collide` with `line`, which must be refused with a message that contains all of `parts`.
fn refused(line: &str, parts: &[&str]) {
    let ran = stickslip(&format!("collide {line}"));
    assert_eq!(ran.code, 2, "{line}: {}", ran.stderr);
    assert_eq!(ran.stdout, "", "{line}");
    for part in parts {
        assert!(ran.stderr.contains(part), "{line}: no {part:?} in {}", ran.stderr);
    }
}

#[test]
fn every_parameter_out_of_range() {
    let (positive, or_zero) = ("a finite number above 0", "a finite number, 0 or above");
    for (option, others, expected, bad) in [
        ("--kappa", "--psi 1", or_zero, &["-1", "inf", "-inf", "nan", "1e400"][..]),
        ("--psi", "--kappa 1", positive, &["0", "-2/7", "inf", "nan", "2/0", "abc", "1e-400"]),
        ("--ratio", "--kappa 1", positive, &["0", "-1", "inf", "nan", "1/2/3", "0x1"]),
        ("--mu", "--kappa 1 --ratio 1", or_zero, &["-0.4", "inf", "nan", "1,5"]),
        (
            "--alpha",
            "--kappa 1 --ratio 1",
            "a number above 0, at most 1",
            &["0", "-1", "1.0000001", "8/7", "inf", "nan"],
        ),
        (
            "--damping",
            "--kappa 1 --psi 1",
            "a finite number, 0 or above",
            &["-1e-9", "inf", "nan", "x"],
        ),
        ("--rtol", "--kappa 1 --psi 1", "1e-15 to 0.1", &["0", "1e-16", "0.2", "-1", "nan"]),
        ("--atol", "--kappa 1 --psi 1", "a finite number above 0", &["0", "-1", "inf", "nan"]),
        ("--threads", "--kappa 1 --psi 1", "1..=1024", &["0", "-1", "1025"]),
    ] {
        for value in bad {
            let line = format!("{others} {option} {value}");
            refused(&line, &[option, &format!("'{value}'"), expected]);
        }
    }
}

#[test]
fn words_that_an_option_does_not_know() {
    refused("--kappa 1 --psi 1 --method euler", &["euler", "dopri5", "dop853", "exact"]);
    refused("--kappa 1 --psi 1 --format xml", &["xml", "table", "json"]);
    refused("--kappa 1 --psi 1 --threads two", &["--threads", "two"]);
}

#[test]
fn psi_and_ratio_given_both_or_not_at_all() {
    refused("--kappa 63 --psi 1 --ratio 2", &["--psi", "--ratio", "exactly one"]);
    refused("--kappa 63", &["--psi", "--ratio", "exactly one"]);
}

#[test]
fn a_collision_without_kappa() {
    refused("--psi 1", &["--kappa"]);
    refused("", &["--kappa"]);
}

#[test]
fn options_without_effect() {
    refused("--kappa 1 --psi 1 --mu 0.3", &["--mu", "--psi", "--ratio"]);
    refused("--kappa 1 --psi 1 --alpha 1/2", &["--alpha", "--psi", "--ratio"]);
    refused("--kappa 1 --psi 1 --method exact --rtol 1e-9", &["--rtol", "1e-9", "exact"]);
    refused("--kappa 1 --psi 1 --method exact --atol 1e-9", &["--atol", "1e-9", "exact"]);
    refused("--kappa 1 --psi 1 --out x.csv", &["--batch"]);
    refused("--kappa 1 --psi 1 --events x.csv", &["--batch"]);
    refused("--batch x.csv --out y.csv --format json", &["--batch", "--format"]);
}

#[test]
fn a_psi_that_overflows() {
    refused("--kappa 1 --ratio 1e308 --mu 1e-9", &["ratio·alpha/mu", "inf", "above 0"]);
    refused("--kappa 1 --ratio 1e-308 --mu 1e300", &["ratio·alpha/mu", "0", "above 0"]);
}

#[test]
fn a_file_for_results_without_a_batch() {
    refused("--kappa 18 --psi 1 --out x.csv", &["--batch"]);
}

#[test]
fn unknown_commands_and_options() {
    refused("--kappa 1 --psi 1 --frobnicate", &["--frobnicate"]);
    for line in ["", "frobnicate"] {
        let ran = stickslip(line);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{line}");
        assert!(ran.stderr.contains("Usage: stickslip"), "{}", ran.stderr);
    }
}

#[test]
fn help_is_a_result() {
    let ran = stickslip("collide --help");
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""));
    for part in ["--kappa", "at most 1", "1e-15 to 0.1", "Examples:", "Exit codes:", "2/7"] {
        assert!(ran.stdout.contains(part), "no {part:?} in {}", ran.stdout);
    }
}
