//! Where lines end: at other lines, on which their margins cease to exist.

use crate::curve::{Vertex, VertexKind};
use crate::family::Family;
use crate::tracing::corrector::crossing;
use crate::tracing::margins::line::{Line, Place, Reach};
use crate::tracing::margins::{Lines, Located, Solved};
use crate::tracing::runs::Traced;
use crate::window::Point;

impl<F: Family> Lines<'_, F> {
    /// The ends of lines inside the window, each a line and 0 or 1. Those that lie on other lines
    /// come first: where these end, lines end that were lost farther away.
    pub(super) fn open_ends(&self) -> Vec<[usize; 2]> {
        let mut open = Vec::new();
        for (index, line) in self.all.iter().enumerate() {
            for end in 0..2 {
                if line.ends.is_some_and(|ends| ends[end] != Reach::Edge) {
                    let beside = self.nearest(index, &line.tip(end));
                    let distance = beside.map_or(f64::INFINITY, |(_, _, distance)| distance);
                    open.push((distance, [index, end]));
                }
            }
        }
        open.sort_by(|one, other| one.0.total_cmp(&other.0));
        open.into_iter().map(|(_, end)| end).collect()
    }

    /// The index of the vertex at which a line ends that was lost, among `vertices` or new.
    pub(super) fn end_vertex(
        &self,
        index: usize,
        end: usize,
        vertices: &mut Vec<Located<F::Margin>>,
    ) -> Traced<usize, F> {
        let lengths = self.runs.lengths;
        let tip = self.all[index].tip(end);
        let beside = self.nearest(index, &tip);
        let [x, y] = [tip.x, tip.y].map(f64::to_bits);
        let mut own = self.once([x, y, end as u64, 0, 1], || self.cusp(index, end))?;
        // Where a margin is singular, a smooth one of a run without the phases of length zero is
        // equal to it: the two meet where that line crosses.
        if own.is_none()
            && let Some(ahead) = self.touched_ahead(index, end, vertices, [0.9, 1.1])
        {
            return Ok(ahead);
        }
        let mut solved = own;
        if solved.is_none()
            && let Some((other, place, distance)) = beside
        {
            let reach = (100.0 * distance).max(lengths.touch).min(lengths.close);
            let foot = self.all[other].at(place);
            let foot = [foot.x, foot.y].map(f64::to_bits);
            solved = self.once([x, y, foot[0], foot[1], 2 + end as u64], || {
                Ok(match self.root_end(index, end, (other, place))? {
                    Some(found) => Some(found),
                    None => self.common_zero(index, end, other, place, reach)?,
                })
            })?;
        }
        if solved.is_none() {
            own = self.once([x, y, end as u64, 1, 1], || self.flat(index, end))?;
            solved = own;
        }
        if solved.is_none()
            && let Some(ahead) = self.touched_ahead(index, end, vertices, [0.5, 2.0])
        {
            return Ok(ahead);
        }
        let aim = solved.map_or(tip, |(place, _)| place);
        let away = |it: &Located<F::Margin>| (it.vertex.point - aim).norm();
        let known = vertices.iter().enumerate().map(|(vertex, it)| (vertex, away(it)));
        let known = known.min_by(|one, other| one.1.total_cmp(&other.1));
        let snaps = match (solved, beside) {
            (Some((_, error)), _) if own.is_some() => error + lengths.same,
            // Along a line on which it begins, its end is known worse than where others cross it.
            (Some((_, error)), _) => 10.0 * error + lengths.piece,
            // The error of a place that was lost is like its distance from the other line.
            (None, Some((_, _, distance))) => 10.0 * distance + lengths.piece,
            (None, None) => lengths.close,
        };
        if let Some((vertex, distance)) = known
            && distance <= snaps.min(lengths.close)
        {
            return Ok(vertex);
        }
        let margins = vec![self.all[index].margin.clone()];
        let foot = beside.map(|(other, place, _)| self.all[other].at(place));
        let (point, error) = solved.unwrap_or((foot.unwrap_or(tip), lengths.same));
        let vertex = Vertex { point, kind: VertexKind::Degenerate, margins };
        vertices.push(Located { vertex, error: error.max(lengths.same) });
        Ok(vertices.len() - 1)
    }

    /// The line that passes closest by the tip of another.
    pub(super) fn nearest(&self, index: usize, tip: &Point) -> Option<(usize, Place, f64)> {
        let reach = self.runs.lengths.close;
        let others = self.all.iter().enumerate().filter(|(other, _)| *other != index);
        let near = others.filter_map(|(other, line)| {
            line.near(tip, reach).map(|(place, distance)| (other, place, distance))
        });
        near.min_by(|one, other| one.2.total_cmp(&other.2))
    }

    /// The place where the margin of a line that ends vanishes together with that of another line
    /// that passes by, which is a smooth margin.
    fn common_zero(
        &self,
        index: usize,
        end: usize,
        other: usize,
        place: Place,
        reach: f64,
    ) -> Traced<Option<Solved>, F> {
        let (line, passing) = (&self.all[index], &self.all[other]);
        let own = line.name(end);
        let names = [own, &passing.names[place.piece]];
        if names[0] == names[1] {
            return Ok(None);
        }
        let (tip, along) = (line.tip(end), passing.tangent(place));
        let found = crossing(&self.runs, names, &tip, &along, self.runs.lengths.beyond, reach)?;
        let on = |point: &Point| passing.distance(point, 2.0 * self.runs.lengths.same).is_some();
        Ok(found.filter(|(point, error)| *error <= self.runs.lengths.same && on(point)))
    }

    /// The vertex ahead of a line that was lost because it touches another one: among those whose
    /// distance is so many times the one that is expected, the nearest to it.
    fn touched_ahead(
        &self,
        index: usize,
        end: usize,
        vertices: &[Located<F::Margin>],
        [least, most]: [f64; 2],
    ) -> Option<usize> {
        let lengths = self.runs.lengths;
        let last = self.all[index].last(end);
        for (other, passing) in self.all.iter().enumerate() {
            if other == index {
                continue;
            }
            let Some(left) = self.way_left(index, end, passing) else { continue };
            // A line that does not touch it is lost right before it.
            let close = passing.distance(&last.point, lengths.half).unwrap_or(0.0);
            let away = |it: &Located<F::Margin>| (it.vertex.point - last.point).norm();
            if vertices.iter().any(|it| away(it) < 10.0 * close) {
                continue;
            }
            let ahead = vertices.iter().enumerate().filter_map(|(vertex, it)| {
                let step = it.vertex.point - last.point;
                let away = step.norm();
                let alike = away > least * left && away < most * left;
                let on = passing.distance(&it.vertex.point, lengths.touch);
                (alike && step.dot(&last.tangent) > 0.0 && on.is_some())
                    .then(|| (vertex, (away - left).abs()))
            });
            let best = ahead.min_by(|one, other| one.1.total_cmp(&other.1));
            if let Some((vertex, _)) = best {
                return Some(vertex);
            }
        }
        None
    }

    /// How far ahead of its tip a line touches another one that passes by; `None` if it does not
    /// come close to it. The square root of their distance falls evenly up to there; the parabola
    /// through three places knows how evenly.
    pub(super) fn way_left(
        &self,
        index: usize,
        end: usize,
        passing: &Line<F::Margin>,
    ) -> Option<f64> {
        let lengths = self.runs.lengths;
        let (line, tip) = (&self.all[index], self.all[index].tip(end));
        let apart = |point: &Point| passing.distance(point, 10.0 * lengths.close);
        let close = apart(&tip)?;
        if close >= lengths.half || close <= lengths.least {
            return None;
        }
        let last = line.pieces();
        let mut inwards = (0..=last).map(|step| if end == 0 { step } else { last - step });
        let mut farther = |least: f64| {
            inwards.by_ref().map(|node| line.nodes[node].point).find_map(|point| {
                let distance = apart(&point).filter(|distance| *distance > least)?;
                Some(((point - tip).norm(), distance.sqrt()))
            })
        };
        let (way, root) = farther(4.0 * close)?;
        let rise = (root - close.sqrt()) / way;
        let even = close.sqrt() / rise;
        let Some((far, higher)) = farther(16.0 * close) else { return Some(even) };
        // √d = √close + rise x + bend x (x − way), at x below 0.
        let bend = ((higher - close.sqrt()) / far - rise) / (far - way);
        let slope = rise - bend * way;
        let square = slope * slope - 4.0 * bend * close.sqrt();
        let left = 2.0 * close.sqrt() / (slope + square.max(0.0).sqrt());
        Some(if left > 0.0 && left.is_finite() { left } else { even })
    }
}
