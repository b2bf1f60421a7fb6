//! Texts that are no systems: refused with their place, and without a panic.

use crate::checks;
use stickslip_expression::{Graph, Next, System};
use stickslip_solver::{EmbeddedPair, Options};

#[track_caller]
fn refused(text: &str, line: usize, column: usize, message: &str) {
    let error = System::parse(text).expect_err(text);
    assert_eq!((error.line, error.column), (line, column), "{error}");
    assert!(error.message.contains(message), "{error}");
    assert_eq!(error.source, text.lines().nth(line - 1).unwrap_or(""));
    let shown = error.to_string();
    assert!(shown.ends_with('^'), "{shown}");
}

#[test]
fn places_and_hints() {
    let ball = "parameter gravity = 9.81\nstate height = 1, speed = 0\nheight' = speed\n";
    let with = |rest: &str| format!("{ball}{rest}");
    refused(&with("speed' = -gravty"), 4, 11, "`gravty` is not known; did you mean `gravity`?");
    refused(&with(""), 4, 1, "mode `main` has no equation for `speed`");
    refused(&with("speed' = -gravity height"), 4, 19, "expected the end of the line");
    refused(&with("speed' = -gravity*(1 + 2"), 4, 25, "expected )");
    refused(&with("speed' = 2gravity"), 4, 10, "followed by a letter");
    refused(&with("speed' = 1e999"), 4, 10, "too large");
    refused(&with("speed' = 1 $ 2"), 4, 12, "no meaning");
    refused(&with("speed' = 1\nwhen hight < 0"), 5, 6, "did you mean `height`?");
    refused(&with("speed' = 1\nwhen gravity < 0"), 5, 6, "never changes");
    refused(
        &with("speed' = 1\nwhen height < 0 -> flor\nmode floor"),
        5,
        20,
        "did you mean `floor`?",
    );
    refused(&with("speed' = 1\nwhen height"), 5, 6, "expected a condition");
    refused(&with("speed' = height < 0"), 4, 10, "expected a number");
    refused(&with("speed' = 1\nspeed := 2"), 5, 1, "expected a rule");
    refused(&with("speed' = 1\nwhen height < 0\nspeed := 2\nspeed := 3"), 7, 1, "two values");
    refused(&with("speed' = 1\nwhen height < 0 < 1"), 5, 17, "one comparison");
    refused(&with("speed' = 1\nwhen height < 0 \"floor"), 5, 17, "does not end");
    refused(&with("speed' = b\nb = 2"), 4, 10, "defined in line 5");
    refused(&with("a = b\nb = a\nspeed' = a"), 4, 5, "defined in line 5");
    refused(&with("a = a\nspeed' = a"), 4, 5, "`a` is not known");
    refused(&with("gravity = 2\nspeed' = 1"), 4, 1, "already defined");
    refused(&with("sin = 2\nspeed' = 1"), 4, 1, "is a function");
    refused(&with("t = 2\nspeed' = 1"), 4, 1, "meaning of its own");
    refused(&with("speed' = sin"), 4, 10, "expected sin(…)");
    refused(&with("speed' = atan2(1)"), 4, 10, "expected 2");
    refused(&with("whn height < 0"), 4, 1, "did you mean `when`?");
    refused(&with("height'' = 1"), 4, 8, "expected =");
    refused(&with("speed' = 1\nat height"), 5, 4, "numbers and parameters alone");
    refused(&with("speed' = 1\nend = speed"), 5, 7, "numbers and parameters alone");
    refused(&with("speed' = 1\nstart in nowhere"), 5, 10, "no mode `nowhere`");
    refused(&with("mode a\nspeed' = 1\nspeed' = 2"), 6, 1, "two equations");
    refused(&with("speed' = polygon(t)"), 4, 19, "has 0 points; expected two or more");
    refused(&with("speed' = spline(t, 0: 1)"), 4, 24, "has 1 points; expected two or more");
    refused(&with("speed' = spline(t, 0: 1, 0: 2)"), 4, 26, "0 is not above 0");
    refused(&with("speed' = spline(t, 0: 1, gravity: 2)"), 4, 26, "expected a number");
    refused(&with("speed' = polygon(t, 0: 1, 2)"), 4, 28, "expected :");
    refused(&with("polygon = 2\nspeed' = 1"), 4, 1, "is a function");
    refused("parameter a = 1 in 2:3\nstate x = 0\nx' = a", 1, 20, "does not contain 1");
    refused("parameter a = b", 1, 15, "not known");
    refused("state x = t", 1, 11, "numbers and parameters alone");
    refused("discrete n = 0\nn' = 1", 2, 1, "is discrete");
    refused("mode a\nmode a", 2, 6, "two modes");
    refused("state x = 0\nx' = 1 ** 2", 2, 8, "expected ^");
    refused("state x = \0", 1, 11, "no meaning");
    refused("state x = 0\nr = x''\nx' = 1\nwhen r < q", 4, 10, "not known");
    refused("state x = 0, y = 0\nr = y'\nx' = r\ny' = r", 2, 6, "needs that of `y`");
}

#[test]
fn nothing_is_too_deep_or_too_long() {
    for (open, close) in [("(", ")"), ("-", ""), ("sin(", ")"), ("2^", ""), ("not ", "")] {
        let text = format!("state x = 0\nx' = {}1{}", open.repeat(10_000), close.repeat(10_000));
        let _ = System::parse(&text);
    }
    let deep = format!("state x = 0\nx' = {}1", "if x < 0 then 1 else ".repeat(10_000));
    assert!(System::parse(&deep).unwrap_err().message.contains("nested"));
    let parentheses = format!("state x = 0\nx' = {}", "(".repeat(1_000_000));
    assert!(System::parse(&parentheses).unwrap_err().message.contains("nested"));
    let sum = format!("state x = 0\nx' = 0{}", " + x".repeat(100_000));
    let system = System::parse(&sum).expect("a long sum");
    assert_eq!(System::parse(&system.text()).expect("its text").text(), system.text());
    let lines: Vec<String> = (0..100_000).map(|k| format!("a{k} = {k} + t\n")).collect();
    let lines = lines.concat();
    assert!(System::parse(&format!("state x = 0\n{lines}x' = a7")).is_ok());
    let modes: Vec<String> = (0..50_000).map(|k| format!("mode m{k}\nx' = {k}\n")).collect();
    let modes = modes.concat();
    assert!(System::parse(&format!("state x = 0\n{modes}")).is_ok());
    let primes = "'".repeat(11);
    let primes = format!("state x = 1\nx' = sin(x*t)\nr = exp(x*t){primes}\nwhen r < 0");
    assert!(System::parse(&primes).unwrap_err().message.contains("at most 10"));
}

/// Random texts of words and signs of the language, and systems with random damage.
#[test]
fn no_text_panics() {
    let mut numbers = fastrand::Rng::with_seed(5);
    let words = [
        "parameter",
        "state",
        "discrete",
        "mode",
        "when",
        "at",
        "every",
        "from",
        "start",
        "in",
        "end",
        "if",
        "then",
        "else",
        "and",
        "or",
        "not",
        "rises",
        "falls",
        "crosses",
        "through",
        "priority",
        "jumps",
        "t",
        "pi",
        "x",
        "y",
        "a",
        "sin(",
        "max(",
        "(",
        ")",
        "=",
        "'",
        ":=",
        "->",
        "<",
        ">",
        "==",
        "+",
        "-",
        "*",
        "/",
        "^",
        "%",
        ",",
        ":",
        "1",
        "0",
        "2.5e3",
        "\"b\"",
        "\n",
        "\n",
        "\n",
        "#",
    ];
    let belt = "parameter a = 1\nstate x = 0, y = a\nx' = y\ny' = -x\nwhen x' < a \"b\" -> m\n  x := 1\n\
                at 1, 2 if x < y -> m else -> n\nmode m\nmode n\nstart in m\nend = 3\n";
    let mut read = 0;
    for round in 0..30_000 {
        let mut text = String::new();
        if round % 2 == 0 {
            for _ in 0..numbers.usize(1..40) {
                text += words[numbers.usize(..words.len())];
                text.push(' ');
            }
        } else {
            let pieces: Vec<&str> = belt.split_inclusive([' ', '\n']).collect();
            for piece in pieces {
                match numbers.u8(..150) {
                    0 => {}
                    1 => text += words[numbers.usize(..words.len())],
                    2 => text = text + piece + piece,
                    _ => text += piece,
                }
            }
        }
        read += u32::from(checks::text(text.as_bytes()).unwrap_or_else(|it| panic!("{it}")));
    }
    for seed in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../fuzz/seeds/systems"))
        .expect("the seeds")
    {
        let bytes = std::fs::read(seed.expect("a seed").path()).expect("a file");
        assert_eq!(checks::text(&bytes), Ok(true));
        // Cut anywhere, and with one byte changed.
        for _ in 0..300 {
            let mut damaged = bytes[..numbers.usize(1..bytes.len())].to_vec();
            let place = numbers.usize(..damaged.len());
            damaged[place] = numbers.u8(..);
            checks::text(&damaged).unwrap_or_else(|it| panic!("{it}"));
        }
    }
    assert!(read > 1000, "{read}");
}

/// Formulas without a value: the run is refused, and nothing overflows.
#[test]
fn what_has_no_value_ends_in_an_error() {
    for formula in ["x^(0/0)", "x^log(-1)", "0/0", "sqrt(-x)", "x^-1e9", "mod(x, 0)"] {
        for rule in ["x' = 1\nwhen G < 1 -> end", "x' = G"] {
            let text = format!("state x = 2\n{}\nend = 3", rule.replace('G', formula));
            let Ok(system) = System::parse(&text) else { continue };
            let runnable = system.with(&[]).expect("no parameters");
            let _ = runnable.record(EmbeddedPair::Dop853, 3.0, &Options::default());
        }
    }
}

/// Systems that are made by hand.
#[test]
fn parts_that_do_not_fit_are_refused() {
    let whole = || {
        let text =
            "parameter a = 1\nstate x = a\nmode m\nx' = a\nwhen x > 2 -> n\nx := 0\nmode n\nx' = t";
        System::parse(text).expect("a system")
    };
    let damages: [fn(&mut System); 9] = [
        |it| it.first = 2,
        |it| it.modes.clear(),
        |it| it.components.clear(),
        |it| it.parameters.clear(),
        |it| it.modes[0].rules[0].next = Next::Mode(2),
        |it| it.modes[0].rules[0].next = Next::Slide { slide: 0, guard: None },
        |it| it.modes[0].rules[0].changes[0].0 = 1,
        |it| it.graph = Graph::default(),
        |it| it.end = Some(it.modes[1].slopes[0]),
    ];
    assert!(whole().with(&[1.0]).is_ok());
    for damage in damages {
        let mut damaged = whole();
        damage(&mut damaged);
        let values = damaged.values();
        let error = damaged.with(&values).expect_err("a damaged system");
        assert!(error.to_string().contains("; expected "), "{error}");
    }
}
