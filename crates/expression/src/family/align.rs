//! One list of rules for all modes, so that an itinerary says which rules act.

use std::collections::HashSet;

use crate::system::{Mode, Rule, System, Trigger};

/// One list of rules for all modes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleOrder {
    /// The names of the rules.
    pub names: Vec<String>,
    /// The place in that list of each rule of each mode.
    pub places: Vec<Vec<usize>>,
}

impl RuleOrder {
    /// The list in which rules of several modes with one label are one, as long as all modes have
    /// them in one order.
    #[must_use]
    pub fn of(system: &System) -> Self {
        let own: Vec<Vec<String>> =
            (0..system.modes.len()).map(|mode| names(system, mode)).collect();
        let (names, places) = merge(&own);
        Self { names, places }
    }

    /// Whether there is a place of its own for each rule of each mode.
    pub(super) fn fits(&self, system: &System) -> bool {
        let fits = |(mode, places): (&Mode, &Vec<usize>)| {
            let different: HashSet<_> = places.iter().collect();
            let all = different.len() == mode.rules.len() && places.len() == mode.rules.len();
            all && places.iter().all(|&place| place < self.names.len())
        };
        self.places.len() == system.modes.len() && system.modes.iter().zip(&self.places).all(fits)
    }

    /// The system with this list of rules in each mode, some of which never act.
    pub(super) fn align(&self, system: &System) -> System {
        let mut aligned = system.clone();
        for (mode, places) in aligned.modes.iter_mut().zip(&self.places) {
            let never = Rule::new(Trigger::At(Vec::new()));
            let mut rules = vec![never; self.names.len()];
            for (rule, &place) in mode.rules.drain(..).zip(places) {
                rules[place] = rule;
            }
            mode.rules = rules;
        }
        aligned
    }
}

/// Names of the rules of a mode, all different.
fn names(system: &System, mode: usize) -> Vec<String> {
    let (single, mode) = (system.modes.len() == 1, &system.modes[mode]);
    let mut taken = HashSet::new();
    let name = |(place, rule): (usize, &Rule)| {
        let own = rule.name(place);
        // Without a label, "when 1" of one mode is not that of another.
        let own = if single || rule.label.is_some() { own } else { qualified(&own, &mode.name) };
        let mut name = own.clone();
        for number in 2.. {
            if taken.insert(name.clone()) {
                break;
            }
            name = format!("{own} ({number})");
        }
        name
    };
    mode.rules.iter().enumerate().map(name).collect()
}

fn qualified(name: &str, mode: &str) -> String {
    format!("{name} of {mode}")
}

/// One list that keeps the order of each of several, and where each of their names is in it.
fn merge(lists: &[Vec<String>]) -> (Vec<String>, Vec<Vec<usize>>) {
    let mut places: Vec<Vec<usize>> = lists.iter().map(|_| Vec::new()).collect();
    let mut merged: Vec<String> = Vec::new();
    let rest = |places: &[Vec<usize>], list: usize| places[list].len();
    while let Some(first) = (0..lists.len()).find(|&list| rest(&places, list) < lists[list].len()) {
        let head = |list: usize| lists[list].get(rest(&places, list));
        let comes_later = |name: &String| {
            let later = |list: usize| lists[list].iter().skip(rest(&places, list) + 1);
            (0..lists.len()).any(|list| later(list).any(|other| other == name))
        };
        let next = (first..lists.len()).filter_map(head).find(|name| !comes_later(name));
        let place = merged.len();
        if let Some(name) = next.cloned() {
            let with: Vec<usize> =
                (0..lists.len()).filter(|&list| head(list) == Some(&name)).collect();
            for list in with {
                places[list].push(place);
            }
            merged.push(name);
        } else {
            // The modes have them in different orders: this one has a rule of its own.
            merged.push(format!("{} ({})", lists[first][places[first].len()], place + 1));
            places[first].push(place);
        }
    }
    (merged, places)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn merged(lists: &[&[&str]]) -> (Vec<String>, Vec<Vec<usize>>) {
        let owned = |list: &&[&str]| list.iter().map(|&name| name.to_owned()).collect();
        merge(&lists.iter().map(owned).collect::<Vec<_>>())
    }

    #[test]
    fn the_order_of_each_mode_stays() {
        let (list, places) = merged(&[&["a", "c"], &["b", "c", "d"], &[], &["d"]]);
        assert_eq!(list, ["a", "b", "c", "d"]);
        assert_eq!(places, [vec![0, 2], vec![1, 2, 3], vec![], vec![3]]);
    }

    #[test]
    fn rules_in_different_orders_are_different() {
        let (list, places) = merged(&[&["a", "b"], &["b", "a"]]);
        assert_eq!(list, ["a (1)", "b", "a"]);
        assert_eq!(places, [vec![0, 1], vec![1, 2]]);
    }
}
