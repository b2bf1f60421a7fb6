//! Statements on the number of switches and of reversals: 6, 7, 8, 21, 23, 24.

use stickslip_model::exact;
use stickslip_studies::paper::{MOST_SWITCHES, STIFFNESS, SWITCHES, ratio};
use stickslip_studies::search::change;

use super::line::{Line, Span};
use super::statement::{Evidence, StatementFinding, StatementVerdict, Stop};
use super::statement::{digits, each, random};
use super::subject::Subject;
use crate::error::ReproductionError;

/// 6: at κ = 18 up to eight switches.
pub fn eight(subject: &Subject) -> Result<StatementFinding, Stop> {
    let [printed, read] = subject.lines()?;
    let mut evidence = Evidence::default();
    for line in [printed, read] {
        evidence = evidence
            .count(format!("most switches at κ = {}", line.kappa), line.most())
            .text(format!("switches as ψ falls at κ = {}", line.kappa), line.falling());
        for (index, pair) in line.stretches.windows(2).enumerate() {
            let (below, above) = (&pair[0].itinerary, &pair[1].itinerary);
            let name =
                format!("ψ of boundary {} at κ = {}, {below} to {above}", index + 1, line.kappa);
            evidence = evidence.number(name, pair[0].high);
        }
    }
    let [at_printed, at_read] = [printed, read].map(Line::falling);
    let explanation = format!(
        "Every boundary at both stiffnesses was {}. As ψ falls, the counts are {at_printed} at κ = \
         {STIFFNESS} of (24), and {at_read} at {STIFFNESS}/α = {}. Those of the figures are \
         {SWITCHES}{}.",
        printed.method,
        read.kappa,
        if at_read == SWITCHES { ", as if ακ were plotted" } else { "" }
    );
    let holds = [printed, read].map(|line| line.most() == MOST_SWITCHES);
    Ok(StatementFinding::by_reading(holds, evidence, explanation))
}

/// 7: there are half as many reversals as switches.
pub fn reversals(subject: &Subject) -> Result<StatementFinding, Stop> {
    let lines = subject.lines()?;
    let differs = |span: &&Span| 2 * span.reversals != span.switch_count;
    let share = |line: &Line| {
        let below = |span: &Span| span.high.min(2.0) - span.low.min(2.0);
        line.spans().filter(differs).map(below).sum::<f64>() / 2.0
    };
    let intervals: Vec<_> = lines.iter().flat_map(|line| line.spans().filter(differs)).collect();
    let more = intervals.iter().filter(|span| 2 * span.reversals > span.switch_count).count();
    let shares = lines.map(share);
    let mut evidence = Evidence::default();
    for (line, share) in lines.into_iter().zip(shares) {
        let name = format!("share of ψ in (0, 2) where it is false at κ = {}", line.kappa);
        evidence = evidence.number(name, share);
        for Span { low, high, switch_count, reversals } in line.spans().filter(differs) {
            let name =
                format!("κ = {}, ψ from {} to {}", line.kappa, digits(*low, 6), digits(*high, 6));
            evidence =
                evidence.text(name, format!("{switch_count} switches, {reversals} reversals"));
        }
    }
    let [printed, read] = shares;
    let explanation = format!(
        "Reversals and switches were counted between all boundaries, which were {}: both numbers \
         change nowhere else. Half the number of switches is not the number of reversals in {} % \
         of ψ from 0 to 2 at κ = {STIFFNESS}, and in {} % at {STIFFNESS}/α = {}. In {more} of the \
         {} intervals in which this is so there are more reversals: a spring that sticks turns the \
         motion round and back without a switch.",
        lines[0].method,
        digits(100.0 * printed, 2),
        digits(100.0 * read, 2),
        lines[1].kappa,
        intervals.len()
    );
    Ok(StatementFinding::new(StatementVerdict::of(printed.max(read) == 0.0), evidence, explanation))
}

/// 8: as the ratio falls, the count falls after its maximum, with brief rises by two.
pub fn rises(subject: &Subject) -> Result<StatementFinding, Stop> {
    let lines = subject.lines()?;
    let mut evidence = Evidence::default();
    let mut true_at = [false; 2];
    for (line, holds) in lines.into_iter().zip(&mut true_at) {
        let Rises { number, by_two, share } = Rises::of(line);
        evidence = evidence
            .text(format!("switches as ψ falls at κ = {}", line.kappa), line.falling())
            .count(format!("rises after the maximum at κ = {}", line.kappa), number)
            .number(format!("part of ψ below the maximum on a rise, {}", line.kappa), share);
        *holds = number > 0 && by_two && share < 0.5;
    }
    let explanation = format!(
        "A stretch is on a rise if it has more switches than one at a larger ψ below the first \
         maximum. Rises are brief if they take less than half of ψ there. At {STIFFNESS} the sequence \
         is {}, and at {STIFFNESS}/α it is {}.",
        lines[0].falling(),
        lines[1].falling()
    );
    Ok(match true_at {
        [true, false] => {
            StatementFinding::under(format!("at κ = {STIFFNESS}"), evidence, explanation)
        }
        both => StatementFinding::by_reading(both, evidence, explanation),
    })
}

/// The rises of the count below its first maximum as ψ falls.
struct Rises {
    number: usize,
    by_two: bool,
    /// The part of ψ on a rise.
    share: f64,
}

impl Rises {
    fn of(line: &Line) -> Self {
        let most = line.most();
        let below: Vec<_> =
            line.stretches.iter().rev().skip_while(|s| s.switch_count < most).collect();
        let mut rises = Self { number: 0, by_two: true, share: 0.0 };
        let mut least = most;
        let mut risen = 0.0;
        for pair in below.windows(2) {
            let (before, now) = (pair[0].switch_count, pair[1].switch_count);
            if now > before {
                rises.number += 1;
                rises.by_two &= now == before + 2;
            }
            least = least.min(now);
            risen += if now > least { pair[1].high - pair[1].low } else { 0.0 };
        }
        rises.share = risen / below.first().map_or(1.0, |first| first.high);
        rises
    }
}

/// 21: at b, c, d all switches are in the decompression, at e the first one just before the largest
/// compression.
pub fn decompression(subject: &Subject) -> Result<StatementFinding, Stop> {
    let [_, read] = subject.lines()?;
    let kappa = read.kappa;
    let middle = 0.5 * exact::CONTACT_TIME;
    let first = |psi: f64| -> Result<f64, ReproductionError> {
        let collision = subject.collide(kappa, psi, 0.0)?;
        Ok(collision.switches.first().map_or(f64::INFINITY, |switch| switch.time))
    };
    let falling: Vec<_> = read.stretches.iter().rev().collect();
    let counts: Vec<_> = falling.iter().map(|stretch| stretch.switch_count).collect();
    let [_, b, c, d, e, ..] = falling[..] else {
        let reason = format!("at κ = {kappa} the counts are {counts:?}: there is no e");
        return Err(Stop::Open(reason));
    };
    if counts[1..5] != [2, 4, 6, 8] {
        let reason = format!("at κ = {kappa} the counts are {counts:?}, not those of the figure");
        return Err(Stop::Open(reason));
    }
    let before = |psi| Ok::<_, ReproductionError>(first(psi)? < middle);
    let (low, high) = (e.low * (1.0 + 1e-9), b.high * (1.0 - 1e-9));
    let passes = if before(low)? && !before(high)? { change(low, high, before)? } else { low };
    let samples: Vec<f64> =
        (0..1000).map(|i| d.low + (b.high - d.low) * (f64::from(i) + 0.5) / 1000.0).collect();
    let early = each(&samples, |&psi| before(psi))?.into_iter().filter(|&early| early).count();
    let late = passes <= d.low && early == 0;
    let early_part = ((passes - e.low) / (e.high - e.low)).clamp(0.0, 1.0);
    let earliest = first(low)?;
    let evidence = Evidence::default()
        .number("time of largest compression", middle)
        .number("ψ at which the first switch passes it", passes)
        .number("lower end of b (2 switches) in ψ", b.low)
        .number("lower end of c (4 switches) in ψ", c.low)
        .number("lower end of d (6 switches) in ψ", d.low)
        .number("lower end of e (8 switches) in ψ", e.low)
        .number("time of the first switch at the lower end of e", earliest)
        .count("of 1000 ψ in b, c, d, those with a first switch before", early)
        .number("part of e in which the first switch comes before", early_part);
    let explanation = format!(
        "At κ = {STIFFNESS}/α the first switch passes the largest compression, t = {}, at ψ = {}. The \
         regions with 2, 4 and 6 switches reach down to ψ = {}, {} that. In the region with 8, down to \
         ψ = {}, the first switch comes before in {} % of ψ, and at its lower end at t = {}.",
        digits(middle, 4),
        digits(passes, 9),
        digits(d.low, 6),
        if passes <= d.low { "above" } else { "below" },
        digits(e.low, 6),
        digits(100.0 * early_part, 1),
        digits(earliest, 4)
    );
    if !late || early_part == 0.0 {
        return Ok(StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation));
    }
    if early_part == 1.0 {
        return Ok(StatementFinding::new(StatementVerdict::Holds, evidence, explanation));
    }
    let places = [passes, ratio(passes)].map(|value| digits(value, 6));
    let condition =
        format!("if e lies below ψ = {}, g_t/g_n = {} in the figures", places[0], places[1]);
    Ok(StatementFinding::under(condition, evidence, explanation))
}

/// 23: ε_t is negative after an odd number of reversals and positive after an even one.
pub fn signs(subject: &Subject) -> Result<StatementFinding, Stop> {
    const TRIED: usize = 100_000;
    let wrong = |tried: Vec<[f64; 3]>| -> Result<usize, ReproductionError> {
        let wrong = each(&tried, |&[kappa, psi, damping]| {
            let collision = subject.collide(kappa, psi, damping)?;
            let negative = collision.reversals % 2 == 1;
            Ok(usize::from(negative != (collision.final_velocity < 0.0)))
        })?;
        Ok(wrong.into_iter().sum())
    };
    let undamped = wrong(random(TRIED, 23, false))?;
    let damped = wrong(random(TRIED / 5, 24, true))?;
    let evidence = Evidence::default()
        .count("random collisions without damping", TRIED)
        .count("of them with the other sign", undamped)
        .count("random collisions with damping", TRIED / 5)
        .count("of them with the other sign (damped)", damped);
    let explanation = format!(
        "{undamped} of {TRIED} random collisions without damping and {damped} of {} with a from 0.001 \
         to 1 have the other sign. Nothing else is possible where reversals are the changes of sign \
         of the velocity. They are counted phase by phase; the sign is that at the end.",
        TRIED / 5
    );
    Ok(StatementFinding::new(StatementVerdict::of(undamped + damped == 0), evidence, explanation))
}

/// 24: for a small enough ratio there are two switches.
pub fn small_ratio(subject: &Subject) -> Result<StatementFinding, Stop> {
    const PSI: f64 = 1e-7;
    const INTERVALS: u32 = 12;
    let count = |kappa: f64| -> Result<usize, ReproductionError> {
        Ok(subject.collide(kappa, PSI, 0.0)?.switches.len())
    };
    let mark = |n: u32| if n == 0 { 0.01 } else { exact::small_impact_boundary(n) };
    let mut evidence = Evidence::default();
    let mut counts = Vec::new();
    let (mut changes, mut farthest) = (0, 0.0_f64);
    for n in 0..INTERVALS {
        let middle = 0.5 * (mark(n) + mark(n + 1));
        let here = count(middle)?;
        counts.push(here);
        let [low, high] = [n, n + 1].map(|n| digits(mark(n), 6));
        let name = format!("switches for κ from {low} to {high}");
        evidence = evidence.count(name, here);
        let beyond = 0.5 * (mark(n + 1) + mark(n + 2));
        if count(beyond)? != here {
            let same = |kappa| Ok::<_, ReproductionError>(count(kappa)? == here);
            let place = change(middle, beyond, same)?;
            changes += 1;
            farthest = farthest.max((place / mark(n + 1) - 1.0).abs());
        }
    }
    let evidence = evidence
        .count("changes bisected", changes)
        .number("largest relative distance of a change from κ_n", farthest);
    let text = counts.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
    let explanation = format!(
        "At ψ = {PSI:e} the counts between κ = 0 and the first {INTERVALS} of κ_n = (nπ/(2t_c))² are \
         {text}. Their {changes} changes were bisected, and lie within {farthest:.1e} of κ_n."
    );
    let two: Vec<_> =
        (0..).zip(&counts).filter(|(_, count)| **count == 2).map(|(n, _)| n).collect();
    Ok(if two.len() == counts.len() {
        StatementFinding::new(StatementVerdict::Holds, evidence, explanation)
    } else if two.iter().copied().eq((0..INTERVALS).step_by(2)) {
        let condition = "for κ between κ_2m and κ_(2m+1), κ_n = (nπ/(2t_c))²";
        StatementFinding::under(condition.to_owned(), evidence, explanation)
    } else {
        StatementFinding::new(StatementVerdict::DoesNotHold, evidence, explanation)
    })
}
