//! What a page asks for, and the answers.

use serde::Deserialize;
use serde_json::{Value, json};
use stickslip_model::presets;

use crate::scene::{Scene, SceneRequest};
use crate::{spheres, system};

/// A request, by its field `do`.
#[derive(Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub enum Request {
    /// The version of the engines.
    About,
    /// All contact laws that have a name.
    Laws,
    /// Shows another plane from now on.
    Scene { scene: Box<SceneRequest> },
    /// The boundaries and regions of the scene.
    Atlas,
    /// The collision at a point of the scene.
    Collision { x: f64, y: f64 },
    /// The intervals between boundaries on a line of one κ, without damping.
    Line { kappa: f64, highest: f64 },
    /// The boundaries that have closed forms.
    Limits { kappa: [f64; 2] },
    /// What a text of a system consists of, or where its mistake is.
    Parse { text: String },
    /// A run of a system.
    Run(system::RunRequest),
}

/// The answer to a request about the scene that is shown.
pub fn answer(request: Request, shown: &mut Option<Scene>) -> Result<Value, Value> {
    let said = |error: String| json!({ "error": error });
    match request {
        Request::About => Ok(json!({ "version": env!("CARGO_PKG_VERSION") })),
        Request::Laws => Ok(laws()),
        Request::Scene { scene } => {
            let scene = shown.insert(Scene::new(*scene)?);
            Ok(json!({ "fields": scene.fields() }))
        }
        Request::Atlas => of(shown.as_ref())?.atlas().map_err(said),
        Request::Collision { x, y } => {
            of(shown.as_ref())?.spheres()?.document([x, y]).map_err(said)
        }
        Request::Line { kappa, highest } => spheres::line(kappa, highest).map_err(said),
        Request::Limits { kappa } => Ok(spheres::limits(kappa)),
        Request::Parse { text } => system::parse(&text),
        Request::Run(request) => request.run(),
    }
}

fn of(shown: Option<&Scene>) -> Result<&Scene, Value> {
    shown.ok_or_else(|| json!({ "error": "there is no scene" }))
}

fn laws() -> Value {
    let law = |preset: &presets::Preset| {
        json!({
            "name": preset.name,
            "code": preset.code,
            "equations": preset.law.equations(),
            "energy": preset.law.spring_energy().to_string(),
            "tangential": preset.tangential_damping,
            "law": preset.law,
            "source": preset.source,
            "checked": preset.checked,
        })
    };
    presets::ALL.iter().chain(presets::ADHESIVE).map(law).collect()
}
