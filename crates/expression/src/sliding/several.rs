//! Modes that slide along several surfaces at once.
//!
//! A mode with k surfaces becomes 5ᵏ modes, one for each choice of the parts of each surface, and
//! one more, in which a solution that does not go on stops. Slopes and guards of all of them are
//! formulas: with the field f below all surfaces that are slid along and fᵢ above one of them each,
//! the solution slides with f + Σ sᵢ (fᵢ − f), whose shares s solve as many linear equations as
//! there are such surfaces. Which mode follows an event is the solution of a complementarity
//! problem, and no formula: [`Continuation`](crate::continuation::Continuation) solves it.

use stickslip_solver::Direction;

use super::{ABOVE, ABOVE_RELEASED, NotSliding, PARTS, SLIDING, Targets};
use crate::graph::{Binary, Formula, Graph, Unary};
use crate::system::{Mode, Next, Rule, Slide, System, Trigger};

/// The part of each surface in the mode at this place among those of a slide.
pub(crate) fn parts(place: usize, surfaces: usize) -> impl Iterator<Item = usize> {
    (0..surfaces).scan(place, |rest, _| {
        let part = *rest % PARTS.len();
        *rest /= PARTS.len();
        Some(part)
    })
}

/// The place of the mode with these parts.
pub(crate) fn place_of(parts: impl DoubleEndedIterator<Item = usize>) -> usize {
    parts.rev().fold(0, |place, part| place * PARTS.len() + part)
}

/// The number of modes that take the place of one.
pub(crate) fn count(surfaces: usize) -> usize {
    PARTS.len().pow(surfaces.try_into().unwrap_or(u32::MAX)) + 1
}

/// The fields beside surfaces.
struct Beside<'a> {
    surfaces: &'a [Formula],
    /// The slopes of all components for each choice of sides: above surfaces whose bits are 1.
    corners: &'a [Vec<Formula>],
    /// The rates of the surfaces' functions with these slopes.
    rates: Vec<Vec<Formula>>,
}

/// How a mode moves along some of the surfaces.
struct Along {
    slopes: Vec<Formula>,
    /// The share of the field above each surface, if it is slid along.
    shares: Vec<Option<Formula>>,
}

impl System {
    /// Adds the modes that take the place of one with several surfaces. If there are `names`, each
    /// surface has two rules in every mode, which are called by its name.
    pub(super) fn slide_along(
        &mut self,
        targets: &Targets,
        place: usize,
        mode: &Mode,
        surfaces: &[Formula],
        names: Option<&[String]>,
    ) -> Result<(), NotSliding> {
        let corner = |corner: usize, graph: &mut Graph| -> Vec<Formula> {
            let on_sides = |&slope: &Formula| {
                let sides = surfaces.iter().enumerate();
                sides.fold(slope, |it, (i, &surface)| graph.on_side(it, surface, is_in(corner, i)))
            };
            mode.slopes.iter().map(on_sides).collect()
        };
        let graph = &mut self.graph;
        let corners: Vec<_> = (0..1 << surfaces.len()).map(|it| corner(it, graph)).collect();
        if corners.iter().all(|it| *it == corners[0]) {
            return Err(NotSliding::NothingJumps(mode.name.clone()));
        }
        let rates_of = |slopes: &Vec<Formula>| -> Vec<Formula> {
            surfaces.iter().map(|&surface| graph.rate(surface, slopes)).collect()
        };
        let rates: Vec<_> = corners.iter().map(rates_of).collect();
        if (0..surfaces.len()).any(|i| rates.iter().all(|it| it[i] == rates[0][i])) {
            return Err(NotSliding::NothingSlides(mode.name.clone()));
        }
        let beside = Beside { surfaces, corners: &corners, rates };
        let first = self.modes.len();
        let slide = self.slides.len();
        for choice in 0..count(surfaces.len()) - 1 {
            let chosen: Vec<usize> = parts(choice, surfaces.len()).collect();
            let along = beside.along(&mut self.graph, &chosen);
            let mut rules = beside.rules(&mut self.graph, &chosen, &along, slide, names);
            let own: Vec<Rule> = mode
                .rules
                .iter()
                .map(|rule| self.mapped(rule, |graph, it| beside.seen(graph, it, &chosen, &along)))
                .collect();
            let mut own = self.redirected(targets, place, mode, &own)?;
            // A rule that stays is no longer where a surface was left.
            let settled = chosen
                .iter()
                .map(|&part| if part > SLIDING { part - ABOVE_RELEASED } else { part });
            let settled = first + place_of(settled);
            let stays = own.iter_mut().filter(|rule| rule.next == Next::Stay);
            if settled != first + choice {
                stays.for_each(|rule| rule.next = Next::Mode(settled));
            }
            rules.extend(own);
            let parts = chosen.iter().map(|&part| PARTS[part]);
            let name = format!("{}_{}", mode.name, parts.collect::<Vec<_>>().join("_"));
            self.modes.push(Mode { name, slopes: along.slopes, rules });
        }
        // Where the solution does not go on, nothing has a slope.
        let (nowhere, never) = (self.graph.constant(f64::NAN), Rule::new(Trigger::At(Vec::new())));
        let rules = match names {
            None => Vec::new(),
            Some(_) => vec![never; 2 * surfaces.len() + mode.rules.len()],
        };
        let name = format!("{}_undecided", mode.name);
        let slopes = vec![nowhere; self.components.len()];
        self.modes.push(Mode { name, slopes, rules });
        self.slides.push(Slide { surfaces: surfaces.to_vec(), corners, first });
        Ok(())
    }
}

impl Beside<'_> {
    /// The slopes in a mode, and the shares of the fields above the surfaces that it slides along.
    fn along(&self, graph: &mut Graph, chosen: &[usize]) -> Along {
        let sliding: Vec<usize> = (0..chosen.len()).filter(|&i| chosen[i] == SLIDING).collect();
        let is_above = |i: &usize| matches!(chosen[*i], ABOVE | ABOVE_RELEASED);
        // The corner on the sides of the surfaces that are not slid along.
        let beside: usize = (0..chosen.len()).filter(is_above).map(|i| 1 << i).sum();
        let above = |i: usize| beside | 1 << i;
        let mut shares = vec![None; chosen.len()];
        let mut slopes = self.corners[beside].clone();
        if sliding.is_empty() {
            return Along { slopes, shares };
        }
        let base = &self.rates[beside];
        let matrix: Vec<Vec<Formula>> = sliding
            .iter()
            .map(|&i| {
                sliding.iter().map(|&j| less(graph, self.rates[above(j)][i], base[i])).collect()
            })
            .collect();
        let right: Vec<Formula> =
            sliding.iter().map(|&i| graph.unary(Unary::Neg, base[i])).collect();
        let all: Vec<usize> = (0..sliding.len()).collect();
        let whole = determinant(graph, &matrix, &all, &all);
        for (column, &i) in sliding.iter().enumerate() {
            let mut replaced = matrix.clone();
            replaced.iter_mut().zip(&right).for_each(|(row, &value)| row[column] = value);
            let part = determinant(graph, &replaced, &all, &all);
            shares[i] = Some(graph.binary(Binary::Div, part, whole));
        }
        let attracts = attraction(graph, &matrix);
        let nowhere = graph.constant(f64::NAN);
        for (component, slope) in slopes.iter_mut().enumerate() {
            let field = |corner: usize| self.corners[corner][component];
            // What a surface consists of stays where it is, bit for bit.
            let is_surface = |i: usize| {
                let same = |corner: usize| self.rates[corner][i] == field(corner);
                same(beside) && sliding.iter().all(|&j| same(above(j)))
            };
            let here = field(beside);
            *slope = if sliding.iter().any(|&i| is_surface(i)) {
                graph.constant(0.0)
            } else {
                let jumps = sliding.iter().filter(|&&i| field(above(i)) != here);
                jumps.fold(here, |sum, &i| {
                    let jump = less(graph, field(above(i)), here);
                    let share = shares[i].unwrap_or(here);
                    let part = graph.binary(Binary::Mul, share, jump);
                    graph.binary(Binary::Add, sum, part)
                })
            };
            if let Some(attracts) = attracts {
                *slope = graph.select(attracts, *slope, nowhere);
            }
        }
        Along { slopes, shares }
    }

    /// The rules of the surfaces, two for each: where it is reached, or left upwards, and where it
    /// is left downwards. Without names, those that never act are left out.
    fn rules(
        &self,
        graph: &mut Graph,
        chosen: &[usize],
        along: &Along,
        slide: usize,
        names: Option<&[String]>,
    ) -> Vec<Rule> {
        let mut rules = Vec::new();
        let one = graph.constant(1.0);
        for (i, (&part, &surface)) in chosen.iter().zip(self.surfaces).enumerate() {
            let [first, second] = match along.shares[i] {
                Some(share) => [Some(graph.binary(Binary::Sub, one, share)), Some(share)],
                None if matches!(part, ABOVE | ABOVE_RELEASED) => [Some(surface), None],
                None => [Some(graph.unary(Unary::Neg, surface)), None],
            };
            for (guard, formula) in [first, second].into_iter().enumerate() {
                let does = if part == SLIDING { "leaves" } else { "arrives" };
                let label = match names {
                    Some(names) => names[i].clone(),
                    None => format!("{does} {}", i + 1),
                };
                let trigger = match formula {
                    Some(formula) => Trigger::When(formula, Direction::Below),
                    None if names.is_none() => continue,
                    None => Trigger::At(Vec::new()),
                };
                rules.push(Rule {
                    label: Some(label),
                    from_zero: if part > SLIDING { 2 } else { 0 },
                    next: Next::Slide { slide, guard: Some(2 * i + guard) },
                    ..Rule::new(trigger)
                });
            }
        }
        rules
    }

    /// A formula of the mode itself, as it is with these parts.
    fn seen(&self, graph: &mut Graph, it: Formula, chosen: &[usize], along: &Along) -> Formula {
        let [one, two] = [1.0, 2.0].map(|x| graph.constant(x));
        let mut seen = it;
        for (i, &surface) in self.surfaces.iter().enumerate() {
            seen = if let Some(share) = along.shares[i] {
                let double = graph.binary(Binary::Mul, two, share);
                let sign = graph.binary(Binary::Sub, double, one);
                graph.with_sign(seen, surface, sign)
            } else {
                let above = matches!(chosen[i], ABOVE | ABOVE_RELEASED);
                graph.on_side(seen, surface, above)
            };
        }
        seen
    }
}

fn is_in(bits: usize, place: usize) -> bool {
    bits >> place & 1 == 1
}

/// A formula that is positive where the solution is attracted to all surfaces that it slides along:
/// the smallest principal minor of the matrix with the other sign; none for a single surface, which
/// is left before.
fn attraction(graph: &mut Graph, matrix: &[Vec<Formula>]) -> Option<Formula> {
    let mut least = None;
    if matrix.len() < 2 {
        return None;
    }
    for bits in 1..1_usize << matrix.len() {
        let rows: Vec<usize> = (0..matrix.len()).filter(|&i| is_in(bits, i)).collect();
        let minor = determinant(graph, matrix, &rows, &rows);
        let minor = if rows.len() % 2 == 1 { graph.unary(Unary::Neg, minor) } else { minor };
        if graph.value(minor).is_some_and(|it| it > 0.0) {
            continue;
        }
        least = Some(least.map_or(minor, |least| graph.binary(Binary::Min, least, minor)));
    }
    least
}

/// The determinant of these rows and columns, as many of each. Exact zeros are left out.
fn determinant(
    graph: &mut Graph,
    a: &[Vec<Formula>],
    rows: &[usize],
    columns: &[usize],
) -> Formula {
    let Some((&row, rows)) = rows.split_first() else { return graph.constant(1.0) };
    let mut sum: Option<Formula> = None;
    for (place, &column) in columns.iter().enumerate() {
        let entry = a[row][column];
        let others: Vec<usize> = columns.iter().copied().filter(|it| *it != column).collect();
        let minor = determinant(graph, a, rows, &others);
        if [entry, minor].iter().any(|&it| graph.value(it) == Some(0.0)) {
            continue;
        }
        let term = if rows.is_empty() { entry } else { graph.binary(Binary::Mul, entry, minor) };
        sum = Some(match sum {
            None if place % 2 == 0 => term,
            None => graph.unary(Unary::Neg, term),
            Some(sum) => {
                let with = if place % 2 == 0 { Binary::Add } else { Binary::Sub };
                graph.binary(with, sum, term)
            }
        });
    }
    sum.unwrap_or_else(|| graph.constant(0.0))
}

/// A difference, exactly 0 for a formula less itself.
fn less(graph: &mut Graph, a: Formula, b: Formula) -> Formula {
    if a == b { graph.constant(0.0) } else { graph.binary(Binary::Sub, a, b) }
}
