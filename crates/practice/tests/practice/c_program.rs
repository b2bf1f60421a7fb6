//! Programs in C that use the header of a table.

use std::fs::File;
use std::path::Path;
use std::process::Command;

/// Whether there is a compiler.
pub fn can_be_compiled() -> bool {
    Command::new("cc").arg("--version").output().is_ok()
}

/// What `main.c` in a directory prints when it reads `points.txt`, compiled with `options` too.
pub fn printed(directory: &Path, options: &[&str]) -> String {
    let built = Command::new("cc")
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O1"])
        .args(["-ffp-contract=off", "-o", "main", "main.c", "-lm"])
        .args(options)
        .current_dir(directory)
        .output()
        .expect("a compiler");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let input = File::open(directory.join("points.txt")).expect("points");
    let ran = Command::new(directory.join("main")).stdin(input).output().expect("a program");
    assert!(ran.status.success());
    String::from_utf8(ran.stdout).expect("text")
}
