//! The files of a crate do not need each other in a circle.
//!
//! A file is a module. What its code names by `use` or by a path is followed through re-exports to
//! the file that defines it: that file is needed. A re-export alone needs nothing, and tests may
//! need what they like. A module and what is below it are one thing in parts, and may need each
//! other.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::architecture::sources;
use crate::root;
use crate::rust::{Used, code, defined, is_word, uses, without_tests};

/// The path of a module, without the name of its crate.
pub type Module = Vec<String>;

/// The code of one file.
pub struct File {
    /// What is left without comments, texts, tests and `use`.
    pub code: String,
    pub uses: Vec<Used>,
    defined: BTreeSet<String>,
}

impl File {
    fn new(text: &str) -> Self {
        let (uses, code) = uses(&without_tests(&code(text)));
        Self { defined: defined(&code), uses, code }
    }

    /// The path under which a name was imported.
    fn import(&self, name: &str) -> Option<&[String]> {
        self.uses.iter().find(|used| used.name == name).map(|used| &used.path[..])
    }
}

/// The files of a crate by their modules.
pub struct Crate(pub BTreeMap<Module, File>);

impl Crate {
    pub fn read(folder: &Path) -> Self {
        let module = |path: &PathBuf| {
            let path = path.strip_prefix(folder).expect("below the folder").with_extension("");
            let names = path.iter().map(|name| name.to_str().expect("UTF-8").to_owned());
            let mut module: Module = names.collect();
            module.pop_if(|last| last == "lib" || last == "main");
            module
        };
        let read = |path: &PathBuf| File::new(&fs::read_to_string(path).expect("a source"));
        let paths = sources(folder.to_owned()).into_iter();
        // A program of one call beside a library is none of its modules.
        let paths =
            paths.filter(|path| !folder.join("lib.rs").exists() || !path.ends_with("main.rs"));
        Self(paths.map(|path| (module(&path), read(&path))).collect())
    }

    /// The module in which a path begins, and the rest of the path; `None` in another crate.
    fn begin(&self, module: &Module, path: &[String], depth: usize) -> Option<(Module, Module)> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => return Some((Vec::new(), rest.to_vec())),
            "self" => return Some((module.clone(), rest.to_vec())),
            "super" => {
                let ups = path.iter().take_while(|name| *name == "super").count();
                let kept = module.len().checked_sub(ups)?;
                return Some((module[..kept].to_vec(), path[ups..].to_vec()));
            }
            _ => {}
        }
        if self.0.contains_key(&[&module[..], &path[..1]].concat()) {
            return Some((module.clone(), path.to_vec()));
        }
        let imported = self.0.get(module)?.import(first).filter(|it| *it != path && depth < 9)?;
        let (module, begun) = self.begin(module, imported, depth + 1)?;
        Some((module, [&begun[..], rest].concat()))
    }

    /// The file that defines what a path in `module` names, and whether the path is that of a
    /// module itself.
    pub fn resolve(
        &self,
        module: &Module,
        path: &[String],
        depth: usize,
    ) -> Option<(Module, bool)> {
        let (mut module, mut path) = self.begin(module, path, depth)?;
        while let Some((first, rest)) = path.clone().split_first() {
            let below = [&module[..], std::slice::from_ref(first)].concat();
            let file = self.0.get(&module)?;
            if self.0.contains_key(&below) && !(rest.is_empty() && file.defined.contains(first)) {
                (module, path) = (below, rest.to_vec());
                continue;
            }
            if file.defined.contains(first) || depth > 8 {
                return Some((module, false));
            }
            if let Some(imported) = file.import(first) {
                let path = [imported, rest].concat();
                return self.resolve(&module, &path, depth + 1);
            }
            let globs = file.uses.iter().filter(|used| used.name == "*");
            let mut found = globs.filter_map(|used| {
                let (target, _) = self.resolve(&module, &used.path, depth + 1)?;
                let found = self.0[&target].defined.contains(first);
                found.then_some((target, false))
            });
            return found.next_back().or(Some((module, false)));
        }
        Some((module, true))
    }

    /// The files that each file needs, but for those above and below it.
    fn needs(&self) -> BTreeMap<&Module, BTreeSet<Module>> {
        self.0.iter().map(|(module, file)| (module, self.needs_of(module, file))).collect()
    }

    fn needs_of(&self, module: &Module, file: &File) -> BTreeSet<Module> {
        let mut needed = BTreeSet::new();
        let mut need = |path: &[String]| {
            // A name of a module alone needs nothing of it.
            if let Some((target, false)) = self.resolve(module, path, 0)
                && !target.starts_with(module)
                && !module.starts_with(&target)
            {
                needed.insert(target);
            }
        };
        let words = paths(&file.code);
        for used in file.uses.iter().filter(|used| used.name != "*") {
            if !used.public || words.iter().any(|path| path[0] == used.name) {
                need(&used.path);
            }
        }
        words.iter().filter(|path| path.len() > 1).for_each(|path| need(path));
        for used in file.uses.iter().filter(|used| used.name == "*") {
            let Some((target, true)) = self.resolve(module, &used.path, 0) else { continue };
            for word in words.iter().filter(|path| self.0[&target].defined.contains(&path[0])) {
                need(&[&used.path[..], &word[..1]].concat());
            }
        }
        needed
    }
}

/// The files that need each other in circles: those that are left when again and again those are
/// taken away that need no other one, or that no other one needs.
fn circles(mut needs: BTreeMap<&Module, BTreeSet<Module>>) -> Vec<String> {
    loop {
        let needed: BTreeSet<Module> = needs.values().flatten().cloned().collect();
        let there: BTreeSet<Module> = needs.keys().map(|module| (*module).clone()).collect();
        needs.retain(|module, needs| needed.contains(*module) && !needs.is_disjoint(&there));
        if needs.len() == there.len() {
            return needs.keys().map(|module| module.join("::")).collect();
        }
        for needs in needs.values_mut() {
            needs.retain(|module| there.contains(module));
        }
    }
}

/// All names in code, each with what follows it behind double colons.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut paths: Vec<Vec<String>> = Vec::new();
    let (mut rest, mut joined) = (code, false);
    while let Some(next) = rest.chars().next() {
        if is_word(next) {
            let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
            let word = rest[..end].to_owned();
            match paths.last_mut().filter(|_| joined) {
                Some(path) => path.push(word),
                None => paths.push(vec![word]),
            }
            rest = &rest[end..];
            joined = rest
                .trim_start()
                .strip_prefix("::")
                .is_some_and(|rest| rest.trim_start().starts_with(is_word));
            if joined {
                rest = rest.trim_start()[2..].trim_start();
            }
        } else {
            rest = &rest[next.len_utf8()..];
            joined = false;
        }
    }
    paths
}

#[test]
fn files_do_not_need_each_other_in_circles() {
    let mut arrows = 0;
    for entry in fs::read_dir(root().join("crates")).expect("the crates") {
        let folder = entry.expect("a crate").path().join("src");
        let read = Crate::read(&folder);
        let needs = read.needs();
        arrows += needs.values().map(BTreeSet::len).sum::<usize>();
        let circles = circles(needs);
        assert!(circles.is_empty(), "{}: {circles:?}", folder.display());
    }
    assert!(arrows > 1000, "{arrows}");
}

/// A crate of files with their texts.
fn written(files: &[(&str, &str)]) -> Crate {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, text).expect("a file");
    }
    Crate::read(folder.path())
}

#[test]
fn circles_are_found() {
    let circle = |files: &[(&str, &str)]| circles(written(files).needs());
    let none: [&str; 0] = [];
    let lib = ("lib.rs", "mod a;\nmod b;\npub use a::A;\npub use b::B;\n");
    let (a, b) = (("a.rs", "use crate::b::B;\npub struct A(B);\n"), ("b.rs", "pub struct B;\n"));
    assert_eq!(circle(&[lib, a, b]), none);
    for text in [
        "use super::a::A;\npub struct B(Box<A>);\n",
        "use crate::{self, A as Other};\npub struct B(Box<Other>);\n",
        "use crate::a;\npub struct B(Box<a::A>);\n",
        "pub struct B(Box<super::A>);\n",
        "use crate::a::*;\npub struct B(Box<A>);\n",
        "pub struct B;\nconst TEXT: &str = \"// }\";\nimpl From<crate::a::A> for B {}\n",
    ] {
        assert_eq!(circle(&[lib, a, ("b.rs", text)]), ["a", "b"], "{text}");
    }
    for text in [
        "pub use crate::a::A;\npub struct B;\n",
        "//! [`A`](crate::a::A)\n/* crate::a::A */\npub struct B;\n",
        "pub struct B;\n#[cfg(test)]\nmod tests {\n    use crate::a::A;\n    fn f(_: A) {}\n}\n",
        "pub struct B;\nconst TEXT: &str = \"crate::a::A\";\n",
    ] {
        assert_eq!(circle(&[lib, a, ("b.rs", text)]), none, "{text}");
    }
    // A module and what is below it may need each other, but not a file beside both.
    let below = ("a/below.rs", "use super::A;\npub struct Below(Box<A>);\n");
    let above = ("a.rs", "mod below;\npub use below::Below;\npub struct A(Below);\n");
    assert_eq!(circle(&[lib, above, below, b]), none);
    let beside = ("b.rs", "use crate::a::Below;\npub struct B(Below);\n");
    let below = ("a/below.rs", "use crate::B;\npub struct Below(Box<B>);\n");
    assert_eq!(circle(&[lib, above, below, beside]), ["a::below", "b"]);
}
