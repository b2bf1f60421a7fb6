//! One boundary, followed from a place on it, with what the caller wants to know along it.

use crate::curve::{Curve, Node};
use crate::family::Family;
use crate::options::TraceOptions;
use crate::tracing::branch::BoundaryWalk;
use crate::tracing::end::End;
use crate::tracing::extrema::{Bracket, solve};
use crate::tracing::runs::{Runs, Traced};
use crate::tracing::seed::{Seed, SeedOf};
use crate::watch::{Progress, Watch};
use crate::window::{Point, Window};

/// A function of the two parameters whose values are recorded along a boundary. It may return NaN
/// where it is not defined.
pub type Monitor<'a> = &'a dyn Fn(&Point) -> f64;

/// One boundary, with the values of monitors.
#[derive(Clone, Debug)]
pub struct Followed<Label, Margin> {
    /// The margin that vanishes at the seed. Along the boundary its hints move.
    pub margin: Margin,
    /// The labels on the left and on the right, seen in the direction of the boundary.
    pub sides: [Label; 2],
    /// The nodes in order. A closed boundary ends with its first node.
    pub nodes: Vec<Node>,
    /// Why the boundary starts and ends where it does; `None` if it is closed.
    pub ends: Option<[End<Margin>; 2]>,
    /// The values of each monitor at the nodes.
    pub values: Vec<Vec<f64>>,
    /// Where monitors vanish, ordered by monitor and then by node.
    pub zeros: Vec<MonitorZero>,
}

/// A place on a boundary at which a monitor changes its sign.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MonitorZero {
    /// The index of the monitor.
    pub monitor: usize,
    /// The node at or behind which the zero lies, before the next node.
    pub node: usize,
    /// The zero, on the boundary to its tolerance. `None` if it could not be solved for: the
    /// boundary has no margin between these nodes, or the monitor jumps or is not a number there.
    pub point: Option<Point>,
}

/// A boundary of a family and its monitors.
type FollowedOf<F> = Followed<<F as Family>::Label, <F as Family>::Margin>;

/// The nodes of a branch, and its end.
type WalkOf<F> = (Vec<Node>, End<<F as Family>::Margin>);

/// Follows the boundary between two places with different labels in both directions, until it ends
/// at a vertex, leaves the window, or closes. `None` if the labels are the same, or if no margin
/// vanishes where the label changes.
///
/// Zeros of monitors are found where a monitor has different signs at successive nodes, which are
/// at most [`TraceOptions::max_step`] apart. They are solved for on the boundary itself. Their
/// error along it is the error of the monitor divided by its slope, or 1e-10 of the window's
/// shorter extent. Each node is a step for `watch`, and each value of a monitor at one.
///
/// ```
/// use stickslip_solver::{Direction, Dop853, Guard, HybridSystem, Options, Start, State};
/// use stickslip_tracer::{Point, TraceOptions, Watch, Window};
/// use stickslip_tracer::{hybrid::HybridFamily, tracing::follow};
///
/// /// A ball that keeps a fraction of its velocity at each bounce.
/// struct Ball(f64);
///
/// impl HybridSystem<2, 1> for Ball {
///     type Mode = ();
///     fn field(&self, (): (), _: f64, y: &State<2>) -> State<2> {
///         State::from([y[1], -1.0])
///     }
///     fn guards(&self, (): ()) -> [Guard; 1] {
///         [Guard::new(Direction::Below)]
///     }
///     fn guard_values(&self, (): (), _: f64, y: &State<2>) -> [f64; 1] {
///         [y[0]]
///     }
///     fn transition(&self, (): (), _: usize, _: f64, y: &State<2>) -> ((), State<2>) {
///         ((), State::from([0.0, -self.0 * y[1]]))
///     }
/// }
///
/// let problem = |point: &Point| {
///     (Ball(point.y), Start { mode: (), s: 0.0, state: State::from([point.x, 0.0]) })
/// };
/// let options = Options::with_tolerance(1e-14);
/// let family = HybridFamily { problem, method: Dop853, options, end: 2.4 };
/// let window = Window { low: Point::new(0.5, 0.5), high: Point::new(2.0, 0.8) };
///
/// // The second bounce is at the time √(2x)(1 + 2y) = 2.4, and the ball falls from its top,
/// // y²x, before. Where is that top at the height 0.2?
/// let top = |point: &Point| point.y * point.y * point.x - 0.2;
/// let places = [Point::new(0.6, 0.55), Point::new(1.9, 0.75)];
/// let trace = TraceOptions::default();
/// let found = follow(&family, &window, &trace, &places, &[&top], Watch::SILENT)?;
/// let found = found.ok_or("no boundary")?;
/// let [zero] = found.zeros[..] else { panic!("one zero") };
/// // y √(2x) = √0.4, so that √(2x) = 2.4 − 2√0.4.
/// let root: f64 = 2.4 - 2.0 * 0.4_f64.sqrt();
/// let exact = Point::new(0.5 * root * root, 0.4_f64.sqrt() / root);
/// assert!((zero.point.ok_or("not located")? - exact).norm() < 1e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// An option is out of its range, the window is not a rectangle, a run fails, a margin is not a
/// number, or the watch cancels.
pub fn follow<F: Family>(
    family: &F,
    window: &Window,
    options: &TraceOptions,
    between: &[Point; 2],
    monitors: &[Monitor<'_>],
    watch: Watch<'_>,
) -> Traced<Option<FollowedOf<F>>, F> {
    let runs = Runs::new(family, *window, *options)?.watched(watch);
    watch.report(Progress::Now { what: "following the boundary" });
    let Some(seed) = Seed::between(&runs, between)? else { return Ok(None) };
    let Some((mut nodes, end)) = walk(&runs, &seed, true)? else { return Ok(None) };
    let ends = if let End::Closed = end {
        None
    } else {
        let Some((backward, start)) = walk(&runs, &seed, false)? else { return Ok(None) };
        let turned = |node: &Node| Node { tangent: -node.tangent, ..*node };
        let before: Vec<Node> = backward[1..].iter().rev().map(turned).collect();
        nodes.splice(0..0, before);
        Some([start, end])
    };
    watch.report(Progress::Now { what: "looking at monitors" });
    watch.report(Progress::Begin { steps: monitors.len() * nodes.len() });
    let value = |monitor: &Monitor<'_>, node: &Node| {
        runs.go_on()?;
        let value = monitor(&node.point);
        watch.report(Progress::Advance { steps: 1 });
        Ok(value)
    };
    let values = monitors.iter().map(|monitor| nodes.iter().map(|node| value(monitor, node)));
    let values: Vec<Vec<f64>> = values.map(Iterator::collect).collect::<Traced<_, F>>()?;
    let (margin, sides) = (seed.margin, seed.labels);
    let curve = Curve { margin, sides, nodes, ends: None };
    let mut zeros = Vec::new();
    for (index, (monitor, values)) in monitors.iter().zip(&values).enumerate() {
        for node in 0..values.len() {
            let own = MonitorZero { monitor: index, node, point: None };
            let (value, next) = (values[node], values.get(node + 1));
            // The last node of a closed boundary is its first one.
            let repeats = next.is_none() && ends.is_none();
            if value == 0.0 && !repeats {
                zeros.push(MonitorZero { point: Some(curve.nodes[node].point), ..own });
            } else if next.is_some_and(|&next| next != 0.0 && opposite(value, next)) {
                let bracket = Bracket { first: node, nodes: curve.nodes[node..=node + 1].to_vec() };
                // A value that jumps over zero never becomes small.
                let least = 1e-6 * (value.abs() + next.map_or(0.0, |next| next.abs()));
                let at = |node: &Node| monitor(&node.point);
                let found = solve(&runs, &curve, &bracket, at, |here| here.abs() <= least)?;
                zeros.push(MonitorZero { point: found.map(|(_, point)| point), ..own });
            }
        }
    }
    let Curve { margin, sides, nodes, .. } = curve;
    Ok(Some(Followed { margin, sides, nodes, ends, values, zeros }))
}

/// Whether two numbers have different signs.
fn opposite(one: f64, other: f64) -> bool {
    one < 0.0 && other > 0.0 || one > 0.0 && other < 0.0
}

/// The nodes of a branch from a seed, beginning with the seed itself, and its end. `None` if no
/// branch starts there.
fn walk<F: Family>(
    runs: &Runs<'_, F>,
    seed: &SeedOf<F>,
    forward: bool,
) -> Traced<Option<WalkOf<F>>, F> {
    let Some(mut branch) = BoundaryWalk::new(runs, seed, forward, &[])? else { return Ok(None) };
    let reached = || {
        runs.watch.report(Progress::Begin { steps: 1 });
        runs.watch.report(Progress::Advance { steps: 1 });
    };
    let Some(rest) = branch.rest(reached)? else { return Ok(None) };
    let nodes = std::iter::once(branch.origin()).chain(rest).collect();
    let end = branch.end().cloned().unwrap_or(End::Limit);
    Ok(Some((nodes, end)))
}
