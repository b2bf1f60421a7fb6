//! Modes that slide along a surface, as modes without.
//!
//! On a surface h = 0 the equations of a mode jump: they contain the sign of h, its absolute value,
//! or a choice by it. With the derivatives f₁ above the surface and f₂ below, and the rates a₁ and
//! a₂ of h along them, the solution crosses where a₁ and a₂ have one sign, and slides along the
//! surface where a₁ < 0 < a₂, with (a₂ f₁ − a₁ f₂)/(a₂ − a₁), until a₁ or a₂ vanishes (Filippov,
//! *Differential Equations with Discontinuous Righthand Sides*, 1988, §4).
//!
//! All of these are formulas. Therefore whatever works on systems as data works on sliding:
//! printing, derivatives, atlases. On several surfaces the next mode is the solution of a small
//! complementarity problem, which is not a formula; see `several`.
//!
//! A mode that slides along one surface becomes five ordinary ones:
//!
//! | mode | until | then |
//! |---|---|---|
//! | `above` | h falls to 0 | a₂ ≥ 0: `sliding`, else `below` |
//! | `below` | h rises to 0 | a₁ ≤ 0: `sliding`, else `above` |
//! | `sliding` | a₁ rises to 0; a₂ falls to 0 | `above_released`; `below_released` |
//! | `above_released`, `below_released` | as `above` and `below` | as those |
//!
//! The last two start from a zero of h and of its rate, which rounding would hide. So the state is
//! moved onto the surface where they are entered, along f₁ − f₂.

pub(crate) mod several;

use stickslip_solver::Direction;
use thiserror::Error;

use crate::graph::{Binary, Formula, Unary, Variable};
use crate::system::{Mode, Next, Rule, System, Trigger};

/// The places of the modes that take the place of one that slides, from the first.
pub(crate) const ABOVE: usize = 0;
pub(crate) const BELOW: usize = 1;
pub(crate) const SLIDING: usize = 2;
pub(crate) const ABOVE_RELEASED: usize = 3;
pub(crate) const BELOW_RELEASED: usize = 4;
const PARTS: [&str; 5] = ["above", "below", "sliding", "above_released", "below_released"];

/// Why a mode cannot slide.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum NotSliding {
    /// Nothing depends on the side.
    #[error(
        "no equation of mode `{0}` changes across the surface; expected sign(…), abs(…) or `if …` \
         of the difference of both sides in one"
    )]
    NothingJumps(String),
    /// The rate of the surface's function is the same on both sides.
    #[error(
        "in mode `{0}`, the surface moves no differently on its two sides; expected an equation \
         that jumps for what the surface is made of"
    )]
    NothingSlides(String),
    /// A rule chooses between modes of which one slides.
    #[error("a rule of mode `{0}` chooses by `if`; expected modes that do not slide behind it")]
    Branch(String),
    /// There are more surfaces than can be decided.
    #[error(
        "mode `{0}` slides along too many surfaces; expected 4 at most, or fewer in many modes"
    )]
    TooMany(String),
    /// Events accumulate, and the mode that follows slides.
    #[error("a rule of mode `{0}` comes to rest in a mode that slides; expected another mode")]
    Rest(String),
}

/// The largest number of surfaces of a mode.
const MOST: usize = 4;

/// Several surfaces make many modes, of which so many are enough.
const MOST_MODES: usize = 20_000;

/// The formulas of one side of a surface.
struct Side {
    slopes: Vec<Formula>,
    rate: Formula,
}

impl System {
    /// The system with each mode that has a surface, where this formula is zero, replaced by modes
    /// that arrive at it, slide along it, and leave it.
    ///
    /// ```
    /// use stickslip_expression::System;
    /// use stickslip_solver::{EmbeddedPair, Options};
    ///
    /// // A block on a belt, with dry friction: it is carried until the spring is stretched by 1.
    /// let belt = System::parse(
    ///     "state x = 0, v = 0.5\nmode move\n  sliding on v = 0.5\n  x' = v\n\
    ///      v' = -x - sign(v - 0.5)\nend = 3",
    /// )?;
    /// let found = belt.with(&[])?.record(EmbeddedPair::Dop853, 3.0, &Options::default())?;
    /// assert_eq!(belt.modes[found.events[0].to].name, "move_sliding");
    /// assert!((found.events[1].s - 2.0).abs() < 1e-12);
    /// assert_eq!(belt.modes[found.events[1].to].name, "move_below_released");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`NotSliding`].
    pub fn sliding(self, surfaces: &[Vec<Formula>]) -> Result<Self, NotSliding> {
        self.slid(surfaces, None)
    }

    /// As [`Self::sliding`], for a system whose modes all have the same surfaces, with these names.
    /// In every mode, each surface has two rules with its name before those of the mode: where it
    /// is reached, or left upwards, and where it is left downwards. A run that starts on surfaces
    /// goes on from there without an event.
    ///
    /// # Errors
    /// [`NotSliding`].
    pub fn sliding_on(self, surfaces: &[Formula], names: &[String]) -> Result<Self, NotSliding> {
        let all = vec![surfaces.to_vec(); self.modes.len()];
        self.slid(&all, Some(names))
    }

    fn slid(
        mut self,
        surfaces: &[Vec<Formula>],
        names: Option<&[String]>,
    ) -> Result<Self, NotSliding> {
        let mut unslid = self.clone();
        unslid.surfaces = surfaces.to_vec();
        self.surfaces.clear();
        let old = std::mem::take(&mut self.modes);
        // Where each mode, or the first of its parts, is found.
        let (mut places, mut kinds) = (Vec::new(), Vec::new());
        let (mut count, mut slides) = (0, 0);
        for (place, mode) in old.iter().enumerate() {
            places.push(count);
            let (kind, parts) = match surfaces.get(place).map_or(&[][..], |it| it) {
                [] => (Kind::Plain, 1),
                &[surface] if names.is_none() => (Kind::One(surface), PARTS.len()),
                several if several.len() > MOST || count > MOST_MODES => {
                    return Err(NotSliding::TooMany(mode.name.clone()));
                }
                several => {
                    slides += 1;
                    (Kind::Several(slides - 1), several::count(several.len()))
                }
            };
            kinds.push(kind);
            count += parts;
        }
        let targets = Targets { kinds, places };
        for (place, mode) in old.iter().enumerate() {
            match targets.kinds[place] {
                Kind::Plain => {
                    let rules = self.redirected(&targets, place, mode, &mode.rules)?;
                    self.modes.push(Mode { rules, ..mode.clone() });
                }
                Kind::One(surface) => self.slide(&targets, place, mode, surface, &old)?,
                Kind::Several(_) => {
                    self.slide_along(&targets, place, mode, &surfaces[place], names)?;
                }
            }
        }
        let mut otherwise = Vec::new();
        for (formula, mode) in std::mem::take(&mut self.otherwise) {
            if let Kind::One(surface) = targets.kinds[mode] {
                let at_start = self.at_start(surface);
                let both = self.graph.binary(Binary::Max, formula, at_start);
                otherwise.push((both, targets.places[mode] + BELOW));
            }
            otherwise.push((formula, targets.places[mode]));
        }
        if let Some(&Kind::One(surface)) = targets.kinds.get(self.first) {
            otherwise.push((self.at_start(surface), targets.places[self.first] + BELOW));
        }
        self.unslid = Some(Box::new(unslid));
        self.otherwise = otherwise;
        self.first = targets.places.get(self.first).copied().unwrap_or(0);
        Ok(self)
    }

    /// A formula at the start, as one of parameters.
    fn at_start(&mut self, formula: Formula) -> Formula {
        let starts: Vec<_> = self.components.iter().map(|component| component.start).collect();
        let at_start = self.graph.substituted(formula, &starts);
        let start = self.start.unwrap_or_else(|| self.graph.constant(0.0));
        self.graph.at_time(at_start, start)
    }

    /// Adds the parts of a mode that slides.
    fn slide(
        &mut self,
        targets: &Targets,
        place: usize,
        mode: &Mode,
        surface: Formula,
        old: &[Mode],
    ) -> Result<(), NotSliding> {
        let above = self.side(mode, surface, true);
        let below = self.side(mode, surface, false);
        if above.slopes == below.slopes {
            return Err(NotSliding::NothingJumps(mode.name.clone()));
        }
        if above.rate == below.rate {
            return Err(NotSliding::NothingSlides(mode.name.clone()));
        }
        let (a1, a2) = (above.rate, below.rate);
        let difference = self.graph.binary(Binary::Sub, a2, a1);
        let mut sliding = Vec::new();
        for (&f1, &f2) in above.slopes.iter().zip(&below.slopes) {
            let first = self.graph.binary(Binary::Mul, a2, f1);
            let second = self.graph.binary(Binary::Mul, a1, f2);
            sliding.push(if f1 == f2 {
                f1
            } else if first == second {
                self.graph.constant(0.0)
            } else {
                let sum = self.graph.binary(Binary::Sub, first, second);
                self.graph.binary(Binary::Div, sum, difference)
            });
        }
        let onto_surface = self.onto_surface(surface, &above, &below, difference);
        // The sign that keeps the solution on the surface.
        let sum = self.graph.binary(Binary::Add, a1, a2);
        let multiplier = self.graph.binary(Binary::Div, sum, difference);
        let [falls, rises] = [surface, self.graph.unary(Unary::Neg, surface)];
        let minus_a1 = self.graph.unary(Unary::Neg, a1);
        let first = targets.places[place];
        let to = |part: usize| first + part;
        let rule = |guard: Formula, label: &str, next: Next, from_zero: u32| Rule {
            label: Some(label.to_owned()),
            from_zero,
            next,
            ..Rule::new(Trigger::When(guard, Direction::Below))
        };
        for (part, suffix) in PARTS.into_iter().enumerate() {
            let is_above = matches!(part, ABOVE | ABOVE_RELEASED);
            let slopes = match part {
                SLIDING => sliding.clone(),
                _ if is_above => above.slopes.clone(),
                _ => below.slopes.clone(),
            };
            let sided: Vec<Rule> = mode
                .rules
                .iter()
                .map(|rule| {
                    self.mapped(rule, |graph, formula| match part {
                        SLIDING => graph.with_sign(formula, surface, multiplier),
                        _ => graph.on_side(formula, surface, is_above),
                    })
                })
                .collect();
            let mut rules = self.redirected(targets, place, mode, &sided)?;
            let from_zero = if part > SLIDING { 2 } else { 0 };
            if part > SLIDING {
                // A rule that stays is no longer where the surface was left.
                let stays = rules.iter_mut().filter(|rule| rule.next == Next::Stay);
                stays.for_each(|rule| rule.next = Next::Mode(to(part - ABOVE_RELEASED)));
            }
            if part == SLIDING {
                for (guard, part) in [(minus_a1, ABOVE_RELEASED), (a2, BELOW_RELEASED)] {
                    let (changes, guard) = (onto_surface.clone(), self.as_condition(guard));
                    rules.push(Rule { changes, ..rule(guard, "leaves", Next::Mode(to(part)), 0) });
                }
            } else if is_above {
                let next = Next::Branch(a2, to(SLIDING), to(BELOW));
                rules.push(rule(falls, "arrives", next, from_zero));
            } else {
                let next = Next::Branch(minus_a1, to(SLIDING), to(ABOVE));
                rules.push(rule(rises, "arrives", next, from_zero));
            }
            let mut name = format!("{}_{suffix}", mode.name);
            while old.iter().any(|mode| mode.name == name) {
                name.push('_');
            }
            self.modes.push(Mode { name, slopes, rules });
        }
        Ok(())
    }

    /// The changes that move the state onto the surface, from which rounding has moved it away:
    /// along the difference of the fields.
    fn onto_surface(
        &mut self,
        surface: Formula,
        above: &Side,
        below: &Side,
        difference: Formula,
    ) -> Vec<(usize, Formula)> {
        let mut changes = Vec::new();
        let graph = &mut self.graph;
        let distance = graph.binary(Binary::Div, surface, difference);
        for (place, (&f1, &f2)) in above.slopes.iter().zip(&below.slopes).enumerate() {
            if f1 != f2 {
                let jump = graph.binary(Binary::Sub, f1, f2);
                let step = graph.binary(Binary::Mul, jump, distance);
                let here = graph.component_at(place);
                changes.push((place, graph.binary(Binary::Add, here, step)));
            }
        }
        changes
    }

    /// A formula that can be a condition: one that never changes cannot, and reads the time.
    fn as_condition(&mut self, formula: Formula) -> Formula {
        let read = self.graph.reads(&[formula]);
        if read.iter().any(|it| !matches!(it, Variable::Parameter(_))) {
            return formula;
        }
        let (time, zero) = (self.graph.time(), self.graph.constant(0.0));
        let nothing = self.graph.binary(Binary::Mul, zero, time);
        self.graph.binary(Binary::Add, formula, nothing)
    }

    /// The equations of a mode on one side, and the rate of the surface's function there.
    fn side(&mut self, mode: &Mode, surface: Formula, above: bool) -> Side {
        let graph = &mut self.graph;
        let slopes: Vec<Formula> =
            mode.slopes.iter().map(|&slope| graph.on_side(slope, surface, above)).collect();
        let rate = graph.rate(surface, &slopes);
        Side { slopes, rate }
    }

    /// A rule with its moving formulas made anew.
    fn mapped(
        &mut self,
        rule: &Rule,
        mut of: impl FnMut(&mut crate::graph::Graph, Formula) -> Formula,
    ) -> Rule {
        let mut rule = rule.clone();
        if let Trigger::When(guard, _) = &mut rule.trigger {
            *guard = of(&mut self.graph, *guard);
        }
        let at_rest = rule.rest.iter_mut().flat_map(|rest| &mut rest.changes);
        for (_, formula) in rule.changes.iter_mut().chain(at_rest) {
            *formula = of(&mut self.graph, *formula);
        }
        if let Next::Branch(condition, ..) = &mut rule.next {
            *condition = of(&mut self.graph, *condition);
        }
        rule
    }

    /// Rules whose modes have other places now.
    fn redirected(
        &mut self,
        targets: &Targets,
        place: usize,
        mode: &Mode,
        rules: &[Rule],
    ) -> Result<Vec<Rule>, NotSliding> {
        let mut redirected = Vec::new();
        for rule in rules {
            let mut rule = rule.clone();
            let slides = |mode: usize| !matches!(targets.kinds[mode], Kind::Plain);
            rule.next = match rule.next {
                Next::Stay => match targets.kinds[place] {
                    Kind::One(surface) if self.moves(surface, &rule) => {
                        self.entering(targets, place, &rule)
                    }
                    Kind::Several(_) if !rule.changes.is_empty() => {
                        self.entering(targets, place, &rule)
                    }
                    _ => Next::Stay,
                },
                Next::Mode(next) => self.entering(targets, next, &rule),
                Next::Branch(condition, one, other) => {
                    if slides(one) || slides(other) {
                        return Err(NotSliding::Branch(mode.name.clone()));
                    }
                    Next::Branch(condition, targets.places[one], targets.places[other])
                }
                Next::Slide { .. } => return Err(NotSliding::Branch(mode.name.clone())),
            };
            if let Some(rest) = &mut rule.rest {
                if slides(rest.next) {
                    return Err(NotSliding::Rest(mode.name.clone()));
                }
                rest.next = targets.places[rest.next];
            }
            redirected.push(rule);
        }
        Ok(redirected)
    }

    /// How a mode is entered behind a rule's changes.
    fn entering(&mut self, targets: &Targets, next: usize, rule: &Rule) -> Next {
        let place = targets.places[next];
        match targets.kinds[next] {
            Kind::Plain => Next::Mode(place),
            Kind::One(surface) => {
                let behind = self.behind(surface, rule);
                Next::Branch(behind, place + ABOVE, place + BELOW)
            }
            Kind::Several(slide) => Next::Slide { slide, guard: None },
        }
    }

    /// Whether a rule changes what a surface's function is.
    fn moves(&mut self, surface: Formula, rule: &Rule) -> bool {
        self.behind(surface, rule) != surface
    }

    /// A formula of the state behind a rule's changes, as one of the state before.
    fn behind(&mut self, formula: Formula, rule: &Rule) -> Formula {
        let components = self.graph.state(self.components.len(), &rule.changes);
        self.graph.substituted(formula, &components)
    }
}

/// Along what a mode slides.
#[derive(Clone, Copy)]
enum Kind {
    Plain,
    /// This surface.
    One(Formula),
    /// The surfaces of the slide at this place.
    Several(usize),
}

/// Where the modes are, and along what they slide.
struct Targets {
    kinds: Vec<Kind>,
    places: Vec<usize>,
}
