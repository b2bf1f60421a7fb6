//! The lists of options in docs/command-line.md are made of the help texts of the program.

use std::collections::HashMap;
use std::path::Path;
use std::{env, fs};

use clap::{Arg, Command};

/// Where this is set, the page is written anew.
const UPDATE: &str = "UPDATE_EXPECT";

const BEGIN: &str = "<!-- options of ";
const END: &str = "<!-- end -->";

/// The most columns of a line.
const WIDTH: usize = 100;

#[test]
fn the_page_has_the_options_of_the_program() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/command-line.md");
    let page = fs::read_to_string(&path).expect("the page");
    let made = with_lists(&page);
    if env::var_os(UPDATE).is_some() {
        fs::write(&path, &made).expect("the page is written");
        return;
    }
    let different = page.lines().zip(made.lines()).find(|(old, new)| old != new);
    assert!(
        page == made,
        "docs/command-line.md has other options than the program, first {different:#?}; run\n\
         {UPDATE}=1 cargo test -p stickslip-cli --test command_line option_lists\n\
         to write its lists anew"
    );
}

#[test]
fn an_option_stands_once() {
    let page =
        with_lists(&format!("{BEGIN}map -->\n{END}\n{BEGIN}trace -->\nstale lines\n{END}\n"));
    assert_eq!(page.matches("- `--mu M`: Coefficient").count(), 1, "{page}");
    assert!(page.replace("\n  ", " ").contains("`--mu`, `--alpha`, `--damping`, "), "{page}");
    assert!(page.contains("- as for `map`: "), "{page}");
    assert!(!page.contains("stale lines"), "{page}");
    assert!(page.lines().all(|line| line.chars().count() <= WIDTH), "{page}");
}

/// The page with its lists made anew. Every command has one.
fn with_lists(page: &str) -> String {
    let mut program = stickslip_cli::commands();
    program.build();
    let mut seen = HashMap::new();
    let mut text = String::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        text += line;
        text.push('\n');
        let Some(name) = line.strip_prefix(BEGIN).and_then(|rest| rest.strip_suffix(" -->")) else {
            continue;
        };
        let command = program.find_subcommand(name).expect("a command");
        text.extend(["\n", &list(command, &mut seen), "\n", END, "\n"]);
        assert!(lines.any(|line| line == END), "the list of {name} has no end");
    }
    text
}

/// An item, and the command that had it first.
type Seen = HashMap<String, String>;

/// The options of a command as a list. What another command has too stands there only once.
fn list(command: &Command, seen: &mut Seen) -> String {
    let mut items = Vec::new();
    let mut elsewhere: Vec<(String, Vec<String>)> = Vec::new();
    for arg in command.get_arguments().filter(|arg| !arg.is_hide_set() && arg.get_id() != "help") {
        let item = item(arg);
        let Some(first) = seen.get(&item) else {
            seen.insert(item.clone(), command.get_name().to_owned());
            items.push(item);
            continue;
        };
        match elsewhere.iter_mut().find(|(command, _)| command == first) {
            Some((_, names)) => names.push(name(arg)),
            None => elsewhere.push((first.clone(), vec![name(arg)])),
        }
    }
    for (first, names) in elsewhere {
        items.push(wrapped(&format!("- as for `{first}`: {}", names.join(", "))));
    }
    items.concat()
}

fn item(arg: &Arg) -> String {
    let help = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let (values, default) = (values(arg), default(arg));
    wrapped(&format!("- {}: {}{values}{default}", spelling(arg), in_code(&help)))
}

/// The lines of an item.
fn wrapped(item: &str) -> String {
    let mut text = String::new();
    let mut width = 0;
    for word in item.split(' ') {
        let wide = word.chars().count();
        match width {
            0 => {}
            _ if width + 1 + wide > WIDTH => {
                text += "\n  ";
                width = 2;
            }
            _ => {
                text.push(' ');
                width += 1;
            }
        }
        text += word;
        width += wide;
    }
    text + "\n"
}

/// The option alone, or the name of its value where it has no name.
fn name(arg: &Arg) -> String {
    arg.get_long().map_or_else(|| spelling(arg), |long| format!("`--{long}`"))
}

/// The option with the name of its value.
fn spelling(arg: &Arg) -> String {
    let long = arg.get_long().map(|long| format!("--{long}"));
    let takes_value = arg.get_action().takes_values();
    let value = arg.get_value_names().filter(|_| takes_value).and_then(<[_]>::first);
    let many = arg.get_num_args().is_some_and(|count| count.max_values() > 1);
    let value = value.map(|name| format!("{name}{}", if many { "…" } else { "" }));
    let words: Vec<String> = long.into_iter().chain(value).collect();
    format!("`{}`", words.join(" "))
}

/// The default as help texts show it, if they do not tell it themselves.
fn default(arg: &Arg) -> String {
    let defaults = arg.get_default_values().iter().map(|value| value.to_string_lossy());
    let defaults = defaults.collect::<Vec<_>>().join(",");
    match (arg.is_required_set(), arg.get_action().takes_values() && !defaults.is_empty()) {
        (true, _) => " (required)".to_owned(),
        (false, true) => format!(" [default: {defaults}]"),
        (false, false) => String::new(),
    }
}

/// The words that an option accepts.
fn values(arg: &Arg) -> String {
    let values = arg.get_possible_values().into_iter().filter(|_| arg.get_action().takes_values());
    let values = values.map(|value| match value.get_help() {
        Some(help) => format!("`{}` ({help})", value.get_name()),
        None => format!("`{}`", value.get_name()),
    });
    let values: Vec<String> = values.collect();
    if values.is_empty() { String::new() } else { format!(": {}", values.join(", ")) }
}

/// A help text whose options are set as code, also the name `-`, which else may begin a list.
fn in_code(help: &str) -> String {
    let word = |word: &str| match word.trim_end_matches([',', ';', '.', ':']) {
        option if option == "-" || option.starts_with("--") => {
            format!("`{option}`{}", &word[option.len()..])
        }
        _ => word.to_owned(),
    };
    help.split(' ').map(word).collect::<Vec<_>>().join(" ")
}
