//! What must hold of any text, for tests and for fuzzing.

use stickslip_expression::{By, System, SystemFamily};
use stickslip_solver::{EmbeddedPair, Options};
use stickslip_tracer::{Family, Point};

/// A text is refused, or reads the same when it is written or formatted; and a run of it, a label
/// of its family and its derivatives end, with or without a result. Whether the text is a system.
///
/// # Errors
/// What does not hold.
pub fn text(bytes: &[u8]) -> Result<bool, String> {
    let Ok(text) = std::str::from_utf8(bytes) else { return Ok(false) };
    let formatted = stickslip_expression::format(text);
    let Ok(system) = System::parse(text) else { return Ok(false) };
    let same = |name: &str, other: &str| match System::parse(other) {
        Ok(again) if again.text() == system.text() => Ok(()),
        Ok(again) => Err(format!("{name} reads as\n{}\nof\n{text}", again.text())),
        Err(error) => Err(format!("{name}: {error}\n{other}\nof\n{text}")),
    };
    same("the text that is written", &system.text())?;
    same("the formatted text", &formatted.map_err(|error| format!("{error}\n{text}"))?)?;
    let values = system.values();
    let Ok(runnable) = system.with(&values) else { return Ok(true) };
    let options = Options { max_steps: 200, max_switches: 20, ..Options::with_tolerance(1e-6) };
    let end = runnable.end().min(runnable.start().s + 10.0);
    for pair in [EmbeddedPair::Dop853, EmbeddedPair::Dopri5] {
        let _ = runnable.record(pair, end, &options);
    }
    let by: Vec<By> = (0..values.len().min(2)).map(By::Parameter).collect();
    let _ = system.sensitivities(&by, &values, EmbeddedPair::Dop853, Some(end), &options);
    if let [x, y, ..] = values[..] {
        let family = SystemFamily::new(&system, [0, 1], &values, Some(end), options);
        let family = family.map_err(|error| format!("{error}\n{text}"))?;
        let _ = family.label(&Point::new(x, y));
    }
    Ok(true)
}
