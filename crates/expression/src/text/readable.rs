//! Names that a text can have.

use std::borrow::Cow;
use std::collections::HashSet;

use super::formula::is_function;
use super::reader::RESERVED;
use crate::system::System;

impl System {
    /// The system with names that can be read. Systems that were not read may have others.
    pub(super) fn readable(&self) -> Cow<'_, Self> {
        let parameters = self.parameters.iter().map(|it| it.name.as_str());
        let names: Vec<&str> =
            parameters.chain(self.components.iter().map(|it| it.name.as_str())).collect();
        let modes: Vec<&str> = self.modes.iter().map(|it| it.name.as_str()).collect();
        let (new_names, new_modes) = (distinct(&names, "x"), distinct(&modes, "main"));
        if new_names == names && new_modes == modes {
            return Cow::Borrowed(self);
        }
        let mut readable = self.clone();
        let parameters = readable.parameters.iter_mut().map(|it| &mut it.name);
        let components = readable.components.iter_mut().map(|it| &mut it.name);
        let own =
            parameters.chain(components).chain(readable.modes.iter_mut().map(|it| &mut it.name));
        own.zip(new_names.into_iter().chain(new_modes)).for_each(|(own, name)| *own = name);
        Cow::Owned(readable)
    }
}

/// The same names where they can be read and are distinct, and others that are near.
fn distinct(names: &[&str], empty: &str) -> Vec<String> {
    let mut taken = HashSet::new();
    let own: HashSet<&str> = names.iter().copied().collect();
    let readable = |name: &&str| {
        let is_letter = |c: char| c.is_alphabetic() || c == '_';
        let mut new: String = name
            .chars()
            .map(|c| if is_letter(c) || c.is_alphanumeric() { c } else { '_' })
            .collect();
        match new.chars().next() {
            None => new.push_str(empty),
            Some(first) if !is_letter(first) => new.insert(0, '_'),
            _ => {}
        }
        let used = |new: &str, taken: &HashSet<String>| {
            taken.contains(new) || (new != *name && own.contains(new))
        };
        while RESERVED.contains(&&*new) || is_function(&new) || used(&new, &taken) {
            new.push('_');
        }
        taken.insert(new.clone());
        new
    };
    names.iter().map(readable).collect()
}
