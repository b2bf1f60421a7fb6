//! Atlases over the damping.

use serde_json::Value;

use crate::{Workspace, stickslip};

#[test]
fn a_stack_has_the_fields_of_its_schema() {
    let workspace = Workspace::new();
    let line =
        "stack --kappa 1:5 --psi 0.5:1 --damping 0,0.41,0.4108,0.412 --out s.json --plot s.svg";
    let ran = workspace.run(line);
    assert_eq!((ran.code, ran.stdout.as_str(), ran.stderr.as_str()), (0, "", ""));
    assert_eq!(workspace.names(), ["s.json", "s.svg"]);
    let stack: Value = serde_json::from_str(&workspace.read("s.json")).expect("JSON");
    assert_eq!(stack["schema"], "stickslip.stack/1");
    assert_eq!((&stack["kappa"][1], &stack["agrees"]), (&5.0.into(), &true.into()));
    let layers = stack["layers"].as_array().expect("a list");
    let dampings: Vec<_> = layers.iter().map(|layer| layer["damping"].as_f64().unwrap()).collect();
    assert_eq!(dampings, [0.0, 0.41, 0.4108, 0.412]);
    assert_eq!(layers[0]["as_stacked"], Value::Null);
    assert!(layers[1..].iter().all(|layer| layer["as_stacked"] == true));
    let changes = stack["changes"].as_array().expect("a list");
    assert!(!changes.is_empty());
    let mut last = 0.41;
    for change in changes {
        let [low, high] = [0, 1].map(|end| change["between"][end].as_f64().unwrap());
        assert!(last <= low && low < high && high <= 0.412);
        last = high;
        if let Some(meeting) = change["meeting"].as_object() {
            assert!((low..=high).contains(&meeting["damping"].as_f64().unwrap()));
            assert!((1.0..=5.0).contains(&meeting["kappa"].as_f64().unwrap()));
        }
    }
    let picture = workspace.read("s.svg");
    let picture = roxmltree::Document::parse(&picture).expect("XML");
    let rings = picture.descendants().filter(|node| node.attribute("class") == Some("places"));
    assert_eq!(rings.count(), layers.len());
}

#[test]
fn dampings_that_do_not_ascend_are_refused() {
    for dampings in ["0.1", "0,0.1", "0.2,0.1", "0.1,0.1", "0.1,x", "-1,0.1,0.2"] {
        let line =
            format!("stack --kappa 5:8 --psi 0.5:1 --damping {dampings} --out nowhere/s.json");
        let ran = stickslip(&line);
        assert_eq!((ran.code, ran.stdout.as_str()), (2, ""), "{dampings}: {}", ran.stderr);
        assert!(ran.stderr.contains("--damping"), "{}", ran.stderr);
    }
}
