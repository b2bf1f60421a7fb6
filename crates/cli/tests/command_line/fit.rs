//! Fits of measured impacts.

use serde_json::Value;

use crate::{Workspace, stickslip};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../");

/// The example in SI units.
fn example() -> String {
    format!(
        "fit {ROOT}examples/oblique_impacts.csv --bodies \
         {ROOT}examples/aluminium_oxide_on_glass.json --speed 3.9"
    )
}

/// A few exact data: e_t of the centre with κ = 6, μ = 0.2 and α = 2/7, to five digits.
const SCALED: &str = "\
centre_impact_angle_deg,centre_e_t,centre_e_t_error
4,0.61437,0.01
10,0.57341,0.01
";

#[test]
fn the_example_as_json_and_picture() {
    let workspace = Workspace::new();
    let picture = workspace.path("fit.svg");
    let line = format!("{} --format json --plot {}", example(), picture.display());
    let ran = stickslip(&line);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
    let found: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!(found["schema"], "stickslip.fit/1");
    let best = &found["minima"][0];
    let number = |value: &Value| value.as_f64().expect("a number");
    assert!((number(&best["kappa"]) - 2.8666).abs() < 1e-3, "{best}");
    // k_t and κ are the same stiffness.
    let ratio = number(&best["kappa"]) / number(&best["stiffness"]);
    assert!((ratio / number(&found["kappa_of_unit_stiffness"]) - 1.0).abs() < 1e-12);
    assert!(number(&best["root_mean_squares"][0]["value"]) < 0.0335, "{best}");
    assert_eq!(found["intervals"][0]["pieces"].as_array().map(Vec::len), Some(2));
    assert_eq!(found["mindlin"]["excluded"], true);
    assert_eq!(found["residuals"][0]["row"], 2);
    let boundaries = found["course"]["boundaries"].as_array().expect("boundaries");
    let switches: Vec<_> = boundaries.iter().map(|it| (&it["below"], &it["above"])).collect();
    assert_eq!(switches, [(&"+o-o+".into(), &"+o-".into()), (&"+o-".into(), &"+".into())]);
    assert!(workspace.read("fit.svg").contains("best fit"));
}

#[test]
fn the_example_as_tables() {
    let ran = stickslip(&format!("{} --range kappa=1:10", example()));
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
    for part in [
        "κ and the damping are those of normal incidence at 3.9",
        "Warning: Mindlin's",
        "k_t [kg/s²]",
        "2.866624",
        "+o- below, + above",
    ] {
        assert!(ran.stdout.contains(part), "{part}: {}", ran.stdout);
    }
}

/// Rebound angles are printed in degrees, like the angles of impact, whichever unit the data have.
/// JSON says rad in the names, and its numbers are in rad.
#[test]
fn all_angles_of_the_tables_are_in_degrees() {
    let angles = [(20.0_f64, 14.0_f64), (40.0, 31.0)];
    let degrees = angles.map(|(impact, rebound)| format!("{impact:?},{rebound:?},0.5\n"));
    let radians = angles.map(|(impact, rebound)| (impact.to_radians(), rebound.to_radians()));
    let error = 0.5_f64.to_radians();
    let radians = radians.map(|(impact, rebound)| format!("{impact:?},{rebound:?},{error:?}\n"));
    let header =
        "centre_impact_angle_deg,centre_rebound_angle_deg,centre_rebound_angle_deg_error\n";
    let fit = |data: String, format: &str| {
        let workspace = Workspace::with_input(&data);
        let ran = stickslip(&format!(
            "fit {} --free kappa --mu 0.2 --range kappa=1:3 --eps-n 1 --format {format}",
            workspace.path("in.csv").display()
        ));
        assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
        ran.stdout
    };
    let in_degrees = format!("{header}{}", degrees.concat());
    let table = fit(in_degrees.clone(), "table");
    assert!(table.contains("rms centre_rebound_angle_deg"), "{table}");
    assert!(!table.contains("_rad"), "{table}");
    let rows = table.lines().filter(|line| line.starts_with("centre_rebound_angle_deg"));
    let cells: Vec<Vec<&str>> = rows.map(|row| row.split_whitespace().collect()).collect();
    assert_eq!(cells[0][2..5], ["20.000", "14.00000", "0.50000"], "{table}");
    assert_eq!(cells[1][2..5], ["40.000", "31.00000", "0.50000"], "{table}");

    let found: Value = serde_json::from_str(&fit(in_degrees, "json")).expect("JSON");
    let number = |value: &Value| value.as_f64().expect("a number");
    for (residual, cells) in found["residuals"].as_array().expect("residuals").iter().zip(&cells) {
        assert_eq!(residual["quantity"], "centre_rebound_angle_rad");
        for (name, cell) in [("value", 3), ("error", 4), ("predicted", 5), ("residual", 6)] {
            let shown = format!("{:.5}", number(&residual[name]).to_degrees());
            assert_eq!(shown, cells[cell], "{name}");
        }
    }
    let root_mean_square = number(&found["minima"][0]["root_mean_squares"][0]["value"]);
    assert!(table.contains(&format!("{:.5}", root_mean_square.to_degrees())), "{table}");

    let in_radians = format!("{}{}", header.replace("_deg", "_rad"), radians.concat());
    assert_eq!(fit(in_radians, "table"), table);
}

#[test]
fn another_law_in_scaled_units() {
    let workspace = Workspace::with_input(SCALED);
    let line = format!(
        "fit {} --law granular/hertz/tsuji/mindlin --free kappa --mu 0.2 --range kappa=1:3 --eps-n 0.9 \
         --format json",
        workspace.path("in.csv").display()
    );
    let ran = stickslip(&line);
    assert_eq!((ran.code, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
    let found: Value = serde_json::from_str(&ran.stdout).expect("JSON");
    assert_eq!(found["speed_m_per_s"], Value::Null);
    assert!((found["eps_n"].as_f64().expect("a number") - 0.9).abs() < 1e-9);
    assert_eq!(found["minima"][0]["mu"], 0.2);
}

/// Whoever asks for the impossible reads what is wrong and what is expected.
#[test]
fn bad_data_and_options_are_refused() {
    let data = "centre_impact_angle_deg,centre_e_t\n10,0.7\n20,0.6\n";
    let cases: [(&str, &str, &str); 29] = [
        ("", "", "is empty; expected a header row"),
        ("centre_impact_angle_deg,centre_e_t\n", "", "has no rows"),
        ("centre_impact_angle_deg,centre_e_t\n10,\n", "", "0 data; expected 1 to"),
        (
            "centre_impact_angle_deg,centre_e_t\n10,0.7\n",
            "",
            "1 data of the tangential motion for 2",
        ),
        (
            "centre_impact_angle_deg,centre_e_t\n10,nan\n20,1\n",
            "",
            "line 2: centre_e_t = 'nan' is not a number",
        ),
        (
            "centre_impact_angle_deg,centre_e_t\n90,0.7\n20,1\n",
            "",
            "centre_impact_angle_deg = 90.0 is out of range",
        ),
        (
            "centre_impact_angle_deg,centre_e_t\n-1,0.7\n20,1\n",
            "",
            "expected an angle from 0 to below 90",
        ),
        (
            "centre_impact_angle_deg,centre_e_t\n0,0.7\n20,1\n",
            "",
            "tangential_m_per_s = 0.0 is out of range",
        ),
        ("centre_impact_angle_deg,e_t\n10,0.7\n", "", "column 'e_t' is unknown; expected"),
        ("centre_impact_angle_deg,centre_e_t,centre_e_t\n10,1,1\n", "", "are both given"),
        ("centre_e_t\n0.7\n", "", "no impact; expected"),
        (
            "centre_impact_angle_deg,centre_e_t,centre_e_t_error\n10,0.7,0\n20,1,1\n",
            "",
            "row 2: centre_e_t_error = 0.0",
        ),
        (
            "centre_impact_angle_deg,centre_e_t,centre_e_t_error\n10,0.7,\n20,1,1\n",
            "",
            "has no error, and others have one",
        ),
        (
            "centre_impact_angle_deg,centre_e_t,eps_t\n10,0.7,1\n20,1,1\n",
            "",
            "have no errors; expected errors",
        ),
        (
            "centre_impact_angle_deg,spin_rad_per_s\n10,7\n20,1\n",
            "",
            "none where no bodies are known",
        ),
        (
            "centre_impact_angle_deg,speed_m_per_s,centre_e_t\n10,7,1\n20,1,1\n",
            "",
            "has no meaning without bodies",
        ),
        (
            "centre_impact_angle_deg,centre_rebound_angle_deg\n10,95\n20,1\n",
            "",
            "row 2: centre_rebound_angle_deg = 95.0 is out of range; expected an angle between -90",
        ),
        (
            "centre_impact_angle_deg,centre_rebound_angle_rad\n10,-1.6\n20,1\n",
            "",
            "centre_rebound_angle_rad = -1.6 is out of range; expected an angle between -π/2",
        ),
        (data, "--law nonsense", "is neither a file nor a name"),
        (data, "--law gran/hooke", "kappa is free, but the law has no spring"),
        (data, "--free kappa,k_t --mu 0.2", "kappa is free twice"),
        (data, "--free kappa", "--mu is missing"),
        (data, "--free kappa,mu --mu 0", "expected"),
        (data, "--free kappa,friction", "nothing that can be fitted is named"),
        (data, "--law yade/FrictPhys_CundallStrack --eps-n 0.9", "since this law has no damping"),
        (
            data,
            "--law granular/dmt/mass_velocity/mindlin --pull-off 0.1 --free damping,mu --kappa 3",
            "too much of it holds the bodies together",
        ),
        (data, "--free damping,mu --kappa 3", "0 data of eps_n for 1 free"),
        (data, "--range kappa=0:3", "cannot be used; expected two rising numbers above 0"),
        (data, "--level 1", "level = 1.0 is out of range"),
    ];
    for (text, options, expected) in cases {
        let workspace = Workspace::with_input(text);
        let ran = stickslip(&format!("fit {} {options}", workspace.path("in.csv").display()));
        assert_eq!(ran.code, 2, "{text} {options}: {} {}", ran.stdout, ran.stderr);
        assert!(ran.stderr.contains(expected), "{text} {options}: {}", ran.stderr);
    }
    // Boundaries of a friction that decays are not traced, and the fit is none the worse.
    let workspace = Workspace::with_input(data);
    let file = workspace.path("in.csv");
    let decaying = "--free mu --kappa 3 --dynamic-friction 0.5 --friction-decay 2";
    let ran = stickslip(&format!("fit {} {decaying}", file.display()));
    assert_eq!(ran.code, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.contains("not traced: the law has a friction that decays"),
        "{}",
        ran.stdout
    );
}
