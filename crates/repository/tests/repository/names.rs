//! What users meet has one name each: no two public types of the library crates share one, and a
//! crate exports few names at its root.

use std::collections::{BTreeMap, BTreeSet};

use crate::circles::{Crate, Module};
use crate::root;
use crate::rust::is_word;

/// What the facade has.
const CRATES: [&str; 13] = [
    "contact",
    "exact",
    "expression",
    "figure",
    "model",
    "number",
    "orbits",
    "plane",
    "practice",
    "reproduction",
    "solver",
    "studies",
    "tracer",
];

/// The most names at the root of a crate, beside its modules.
const MOST: usize = 40;

/// The public items of some kinds that code defines.
fn public(code: &str, kinds: &[&str]) -> BTreeSet<String> {
    let items = code.split("pub ").skip(1).filter_map(|item| {
        let (kind, rest) = item.split_once(' ')?;
        let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
        kinds.contains(&kind).then(|| rest[..end].to_owned())
    });
    items.collect()
}

/// The public types of a crate, each with the module that defines it.
fn types(of: &Crate) -> BTreeSet<(String, Module)> {
    const KINDS: [&str; 4] = ["struct", "enum", "trait", "type"];
    let (mut found, mut modules) = (BTreeSet::new(), vec![Module::new()]);
    while let Some(module) = modules.pop() {
        let file = &of.0[&module];
        found.extend(public(&file.code, &KINDS).into_iter().map(|name| (name, module.clone())));
        for used in file.uses.iter().filter(|used| used.public) {
            let Some((target, whole)) = of.resolve(&module, &used.path, 0) else { continue };
            let there = public(&of.0[&target].code, &KINDS).into_iter();
            let taken = there.filter(|name| whole || used.path.last() == Some(name));
            found.extend(taken.map(|name| (name, target.clone())));
        }
        let below = public(&file.code, &["mod"]).into_iter();
        modules.extend(below.map(|name| [&module[..], &[name]].concat()));
    }
    found
}

#[test]
fn no_two_public_types_share_a_name() {
    let mut places: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for name in CRATES {
        for (kind, module) in types(&Crate::read(&root().join("crates").join(name).join("src"))) {
            // The readme of each crate, as a doctest.
            if kind != "Readme" {
                let place = format!("{name}::{}", module.join("::"));
                places.entry(kind).or_default().insert(place);
            }
        }
    }
    assert!(places.len() > 300, "{}", places.len());
    places.retain(|_, places| places.len() > 1);
    assert!(places.is_empty(), "{places:#?}");
}

#[test]
fn crates_export_few_names_at_their_roots() {
    for name in CRATES {
        let folder = root().join("crates").join(name).join("src");
        let exported =
            Crate::read(&folder).0[&Module::new()].uses.iter().filter(|it| it.public).count();
        assert!(exported <= MOST, "{name}: {exported}");
    }
}
