//! A table as a header for C.

use std::fmt::{Display, Write};

use stickslip_model::spheres::Surface;
use stickslip_model::{InvalidValue, Law, presets};
use stickslip_plane::CollisionPlane;

use super::chebyshev::{ACROSS, ALONG};
use super::settings::TableWindow;
use super::stretch::Stretch;
use super::table::{NO_REGION, RestitutionTable, TableVerification};

/// The header, with names between @ for what differs.
const TEMPLATE: &str = include_str!("header.h");

/// The function of regions.
const REGIONS: &str = "
static inline int @prefix@_region(double @x@, double @y@)
{
    uint32_t strip;
    double along, across;
    if (!@prefix@_place(@x@, @y@, &strip, &along, &across))
        return -1;
    return @prefix@_strip_regions[strip];
}
";

/// The function of ε_n.
const NORMALS: &str = "
static inline double @prefix@_eps_n(double @x@)
{
    uint32_t slab;
    double along;
    if (!@prefix@_slab(@x@, &slab, &along))
        return NAN;
    return @prefix@_value(@prefix@_normals[slab], along);
}
";

/// What κ and ψ are.
const SCALED: &str = " * Both arguments are numbers without units:
 *
 *   kappa = k_t/(alpha m beta^(4/5) g_n^(2/5))   scaled stiffness
 *   psi   = (g_t/g_n) alpha/mu                   reduced impact ratio
 *
 * with the effective mass m, the normal force rho x^(3/2) at the overlap x, beta = rho/m, the
 * coefficient of friction mu, the tangential inertia alpha (2/7 for homogeneous spheres), and the
 * normal and tangential velocities g_n > 0 and g_t > 0 before the impact.";

/// What the velocities are, and whose.
const VELOCITIES: &str = " * Both arguments are velocities of the surfaces at the contact before the
 * impact, in m/s: the normal velocity g_n > 0 and the tangential velocity g_t > 0, for two bodies with
 *
 *   effective mass            @MASS@ kg
 *   normal force / x^(3/2)    @ELASTIC@ kg/(s^2 m^0.5) at the overlap x
 *   damping time              @TIME@ s
 *   tangential stiffness      @STIFFNESS@ kg/s^2
 *   coefficient of friction   @FRICTION@
 *   tangential inertia        @ALPHA@ (2/7 for homogeneous spheres)";

/// As that, for another contact law than the paper's.
const OTHER_LAW: &str = " * Both arguments are velocities of the surfaces at the contact before the
 * impact, in m/s: the normal velocity g_n > 0 and the tangential velocity g_t > 0, for two bodies with,
 * in the SI units of the contact law,
 *
 *   effective mass                     @MASS@
 *   normal force / x or x^(3/2)        @ELASTIC@ at the overlap x
 *   damping / that                     @TIME@
 *   constant of tangential stiffness   @STIFFNESS@
 *   coefficient of friction            @FRICTION@
 *   tangential inertia                 @ALPHA@ (2/7 for homogeneous spheres)";

/// Checks that `prefix` can begin names in C.
///
/// # Errors
/// [`InvalidValue`]: it cannot.
pub fn require_prefix(prefix: &str) -> Result<(), InvalidValue> {
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let starts = prefix.starts_with(|c: char| c.is_ascii_alphabetic());
    let ok = starts && prefix.len() <= 64 && prefix.chars().all(is_name);
    let expected = "up to 64 ASCII letters, digits and _, and a letter first";
    InvalidValue::check("prefix", prefix, expected, ok)
}

impl RestitutionTable {
    /// The table as a self-contained header for C99, whose names begin with `prefix`. Functions and
    /// arguments are explained in it.
    ///
    /// # Errors
    /// [`InvalidValue`]: the prefix cannot begin names in C.
    pub fn c_header(&self, prefix: &str) -> Result<String, InvalidValue> {
        require_prefix(prefix)?;
        let arrays = self.arrays();
        let with_regions = !arrays.regions.is_empty();
        let (normal, constants) = self.c_normal();
        let mut functions = String::new();
        functions.push_str(if arrays.normals.is_empty() { "" } else { NORMALS });
        functions.push_str(if with_regions { REGIONS } else { "" });
        let region = if with_regions {
            "the number of the region of the atlas, an index of @prefix@_itineraries; or -1"
        } else {
            "not in this file, which was written without regions"
        };
        let mut text = TEMPLATE.to_owned();
        let mut fill = |name: &str, value: &str| text = text.replace(name, value);
        fill("@FUNCTIONS@", &functions);
        fill("@REGION@", region);
        fill("@NORMAL@", normal);
        fill("@AXES@", &self.c_explanation());
        fill("@CONSTANTS@", &constants);
        fill("@ARRAYS@", &self.c_arrays());
        fill("@SUMMARY@", &self.summary());
        for (name, value) in [
            ("@X_LOW@", self.sides[0].low),
            ("@X_HIGH@", self.sides[0].high),
            ("@Y_LOW@", self.sides[1].low),
            ("@Y_HIGH@", self.sides[1].high),
            ("@BOUND@", self.bound),
        ] {
            fill(name, &format!("{value:?}"));
        }
        for (name, keys) in [("SLAB", arrays.slab_keys), ("STRIP", arrays.strip_keys)] {
            fill(&format!("@{name}_SHIFT@"), &keys.shift.to_string());
            fill(&format!("@{name}_FIRST@"), &format!("UINT64_C({})", keys.first));
        }
        fill("@SLABS@", &arrays.scales.len().to_string());
        for (axis, name) in ["x", "y"].into_iter().zip(self.c_names()) {
            fill(&format!("@{axis}@"), name);
            fill(&format!("@{}@", axis.to_uppercase()), &name.to_uppercase());
        }
        fill("@prefix@", prefix);
        fill("@PREFIX@", &prefix.to_uppercase());
        Ok(text)
    }

    /// The names of both axes.
    fn c_names(&self) -> [&'static str; 2] {
        match self.window {
            TableWindow::Scaled { .. } => CollisionPlane::SCALED,
            TableWindow::Velocities { .. } => ["g_n", "g_t"],
        }
    }

    /// What the header says of ε_n, and its constants.
    fn c_normal(&self) -> (&'static str, String) {
        if let (TableWindow::Scaled { damping, .. }, Some(eps_n)) =
            (self.window, self.constant_eps_n)
        {
            let constants =
                format!("#define @PREFIX@_DAMPING {damping:?}\n#define @PREFIX@_EPS_N {eps_n:?}\n");
            return ("@PREFIX@_EPS_N\n *       the coefficient of normal restitution", constants);
        }
        let function = "double @prefix@_eps_n(double @x@)\n *       the coefficient of normal \
                        restitution; NAN outside the table";
        (function, String::new())
    }

    /// What the arguments of the functions are.
    fn c_explanation(&self) -> String {
        let TableWindow::Velocities { pair, .. } = self.window else { return SCALED.to_owned() };
        let Surface { friction, tangential_stiffness_kg_per_s2, damping_time_s } = pair.surface;
        let mut text = if pair.law == Law::PAPER { VELOCITIES } else { OTHER_LAW }.to_owned();
        if pair.law.damping.is_hysteretic() {
            let (name, value) = pair.damping_constant();
            let line = format!(" *   {name:<35}{value:?}");
            text = text.replace(" *   damping / that                     @TIME@", &line);
        }
        for (name, value) in [
            ("@MASS@", pair.effective_mass_kg),
            ("@ELASTIC@", pair.elastic_constant),
            ("@TIME@", damping_time_s),
            ("@STIFFNESS@", tangential_stiffness_kg_per_s2),
            ("@FRICTION@", friction),
            ("@ALPHA@", pair.alpha),
        ] {
            text = text.replace(name, &format!("{value:?}"));
        }
        text
    }

    fn summary(&self) -> String {
        let ([x, y], [x_name, y_name]) = (self.sides, self.c_names());
        let rest = match self.window {
            TableWindow::Scaled { damping, .. } => {
                format!(" at the scaled damping\n * {damping:?}")
            }
            TableWindow::Velocities { .. } => " in m/s".to_owned(),
        };
        let (law, tangential_damping) = match self.window {
            TableWindow::Scaled { law, tangential_damping, .. } => (law, tangential_damping),
            TableWindow::Velocities { pair, .. } => (pair.law, pair.tangential_damping()),
        };
        let source = if law == Law::PAPER {
            "(Schwager, Becker and Poeschel, Eur. Phys. J. E\n * 27, 107, 2008)".to_owned()
        } else {
            let named = presets::ALL.iter().find(|preset| preset.law == law);
            let name = named.map_or_else(|| law.equations(), |preset| preset.name.to_owned());
            format!("with the law\n * {name} and the tangential damping {tangential_damping:?},")
        };
        let TableVerification { points, largest_error, .. } = self.verification;
        format!(
            "The restitution of two frictional spheres {source} for {x_name} from {:?} to {:?} and {y_name} from {:?} to {:?}{rest}. \
             Errors are below\n * {:?}; at {points} points that of eps_t was at most \
             {largest_error:.2e}. Written by stickslip.",
            x.low, x.high, y.low, y.high, self.bound,
        )
    }

    fn c_arrays(&self) -> String {
        let arrays = self.arrays();
        let stretch = |stretch: &Stretch| *stretch as u8;
        let stretches = |of: &[Stretch]| of.iter().map(stretch).collect::<Vec<_>>();
        let (graphs, _) = arrays.graphs.as_chunks::<ALONG>();
        let (rows, _) = arrays.rows.as_chunks::<ACROSS>();
        let mut out = String::new();
        list(&mut out, "uint32_t", "slab_hints", &arrays.slab_hints);
        doubles(&mut out, "walls", &arrays.walls);
        doubles(&mut out, "scales", &arrays.scales);
        list(&mut out, "unsigned char", "slab_stretches", &stretches(&arrays.slab_stretches));
        list(&mut out, "uint32_t", "first_strips", &arrays.first_strips);
        let (normals, _) = arrays.normals.as_chunks::<ALONG>();
        if !normals.is_empty() {
            nested(&mut out, "normals", normals);
        }
        nested(&mut out, "graphs", graphs);
        let keys = arrays.strip_hints.len() / arrays.scales.len();
        open(&mut out, "uint16_t", "strip_hints", &format!("[][{keys}]"));
        for row in arrays.strip_hints.chunks(keys) {
            out.push('{');
            lines(&mut out, row.iter().map(ToString::to_string));
            out.push_str("},\n");
        }
        out.push_str("};\n");
        list(&mut out, "unsigned char", "strip_stretches", &stretches(&arrays.strip_stretches));
        list(&mut out, "uint32_t", "first_rows", &arrays.first_rows);
        nested(&mut out, "rows", rows);
        if !arrays.regions.is_empty() {
            let number = |&region: &u32| if region == NO_REGION { -1 } else { i64::from(region) };
            let regions: Vec<i64> = arrays.regions.iter().map(number).collect();
            list(&mut out, "int", "strip_regions", &regions);
            let names: Vec<_> = self.regions.iter().map(|name| format!("\"{name}\"")).collect();
            list(&mut out, "char *const", "itineraries", &names);
        }
        out
    }
}

/// Adds an array, in lines of up to 100 characters.
fn list(out: &mut String, kind: &str, name: &str, values: &[impl Display]) {
    open(out, kind, name, &format!("[{}]", values.len()));
    lines(out, values.iter().map(ToString::to_string));
    out.push_str("};\n");
}

fn doubles(out: &mut String, name: &str, values: &[f64]) {
    open(out, "double", name, &format!("[{}]", values.len()));
    lines(out, values.iter().map(|value| shortest(*value)));
    out.push_str("};\n");
}

fn nested<const N: usize>(out: &mut String, name: &str, values: &[[f64; N]]) {
    open(out, "double", name, &format!("[{}][{N}]", values.len()));
    for row in values {
        out.push('{');
        for (k, value) in row.iter().enumerate() {
            if k > 0 {
                out.push(',');
            }
            out.push_str(&shortest(*value));
        }
        out.push_str("},\n");
    }
    out.push_str("};\n");
}

fn open(out: &mut String, kind: &str, name: &str, shape: &str) {
    // Writing to a string cannot fail.
    let _ = writeln!(out, "static const {kind} @prefix@_{name}{shape} = {{");
}

fn lines(out: &mut String, values: impl Iterator<Item = String>) {
    let mut length = 0;
    for value in values {
        if length + value.len() + 1 > 100 {
            out.push('\n');
            length = 0;
        }
        length += value.len() + 1;
        out.push_str(&value);
        out.push(',');
    }
    out.push('\n');
}

/// The shortest text that reads back as the same double in C.
fn shortest(value: f64) -> String {
    let (plain, scientific) = (format!("{value:?}"), format!("{value:e}"));
    // 1e0 would do for 1.0, and 0 for 0.0.
    let plain = plain.strip_suffix(".0").map_or(plain.clone(), |whole| format!("{whole}."));
    let plain = match plain.strip_prefix("-0.") {
        Some(rest) if !rest.is_empty() => format!("-.{rest}"),
        _ => match plain.strip_prefix("0.") {
            Some(rest) if !rest.is_empty() => format!(".{rest}"),
            _ => plain,
        },
    };
    if scientific.len() < plain.len() { scientific } else { plain }
}
