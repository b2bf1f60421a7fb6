//! Scripts for shells. All commands are in them, and the shells that are installed can read them.

use std::process::Command;

use crate::{Workspace, stickslip};

const COMMANDS: [&str; 16] = [
    "collide",
    "impact",
    "laws",
    "map",
    "join",
    "trace",
    "stack",
    "locate",
    "reproduce",
    "asymptote",
    "converge",
    "timestep",
    "fit",
    "table",
    "completions",
    "man",
];

#[test]
fn every_script_has_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ran = stickslip(&format!("completions {shell}"));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{shell}");
        for part in COMMANDS.into_iter().chain(["kappa", "damping", "threads"]) {
            assert!(ran.stdout.contains(part), "{shell}: no {part}");
        }
    }
}

#[test]
fn installed_shells_read_their_scripts() {
    let workspace = Workspace::new();
    for shell in ["bash", "zsh", "fish"] {
        workspace.write("script", stickslip(&format!("completions {shell}")).stdout);
        let read = Command::new(shell).arg("-n").arg(workspace.path("script")).output();
        match read {
            Ok(read) => assert!(
                read.status.success() && read.stderr.is_empty(),
                "{shell}: {}",
                String::from_utf8_lossy(&read.stderr)
            ),
            Err(_) => println!("skipped: there is no {shell}"),
        }
    }
}

/// What bash offers for the last of `words`, if it is installed.
fn offered(words: &[&str]) -> Option<String> {
    let workspace = Workspace::new();
    let script = stickslip("completions bash").stdout;
    let line = words.join(" ");
    let last = words.len() - 1;
    let (word, before) = (words[last], words[last - 1]);
    let script = format!(
        "{script}\nCOMP_WORDS=({line}); COMP_CWORD={last}\n\
         _stickslip stickslip '{word}' '{before}'\necho \"${{COMPREPLY[@]}}\"\n"
    );
    workspace.write("script", script);
    let ran = Command::new("bash").arg(workspace.path("script")).output().ok()?;
    Some(String::from_utf8(ran.stdout).expect("UTF-8"))
}

#[test]
fn bash_completes_commands_options_and_values() {
    for (words, expected) in [
        (&["stickslip", "col"][..], "collide\n"),
        (&["stickslip", "collide", "--kap"], "--kappa\n"),
        (&["stickslip", "collide", "--method", "dop"], "dopri5 dop853\n"),
    ] {
        if let Some(offered) = offered(words) {
            assert_eq!(offered, expected, "{words:?}");
        }
    }
}

#[test]
fn an_unknown_shell_is_refused() {
    let ran = stickslip("completions csh");
    assert_eq!((ran.code, ran.stdout.as_str()), (2, ""));
    for part in ["csh", "bash", "elvish", "fish", "powershell", "zsh"] {
        assert!(ran.stderr.contains(part), "no {part} in {}", ran.stderr);
    }
}
