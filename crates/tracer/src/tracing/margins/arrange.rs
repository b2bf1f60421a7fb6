//! The arrangement of lines: vertices, and the parts of lines between them.

use crate::curve::{Vertex, VertexKind};
use crate::family::Family;
use crate::lengths::angle;
use crate::tracing::corrector::{crossing, stationary};
use crate::tracing::margins::line::{Cut, Line, Place, Reach};
use crate::tracing::margins::meet::{Crossing, crossings, nearnesses};
use crate::tracing::margins::parts::Part;
use crate::tracing::margins::{Arranged, Lines, Located, Solved};
use crate::tracing::network::Unresolved;
use crate::tracing::runs::Traced;

impl<F: Family> Lines<'_, F> {
    /// The greatest number of lines. Many are not seen by runs.
    pub(super) fn most(&self) -> usize {
        self.runs.options.max_curves.saturating_mul(2)
    }

    /// The lines that could not be followed to their end, or not at all.
    pub(super) fn unfollowed(&self) -> Vec<Unresolved<F::Label>> {
        let limit = |line: &Line<F::Margin>| {
            let ends = line.ends?;
            let end = ends.iter().position(|end| *end == Reach::Limit)?;
            Some(Unresolved::TooManyNodes { point: line.tip(end) })
        };
        let mut open: Vec<_> = self.all.iter().filter_map(limit).collect();
        if let Some(last) = self.all.get(self.most() - 1) {
            open.push(Unresolved::TooManyCurves { point: last.tip(0) });
        }
        open
    }

    /// Divides the lines where they meet, and asks for the labels beside their parts.
    pub(super) fn arranged(&mut self) -> Traced<Arranged<F>, F> {
        self.drop_fragments();
        let mut vertices = Vec::new();
        let mut cuts: Vec<Vec<Cut>> = vec![Vec::new(); self.all.len()];
        for (line, own) in self.all.iter().zip(&mut cuts) {
            for end in 0..2 {
                if line.ends.is_some_and(|ends| ends[end] == Reach::Edge) {
                    let vertex = self.edge_vertex(line, end, &mut vertices);
                    own.push(Cut { place: line.end(end), vertex });
                }
            }
        }
        let (lengths, window) = (self.runs.lengths, self.runs.window);
        let mut touches: Vec<Crossing> = Vec::new();
        for near in nearnesses(&self.all, &window, lengths.touch) {
            let known = |it: &Crossing| {
                it.lines == near.lines && (it.point - near.point).norm() < lengths.close
            };
            if !touches.iter().any(known)
                && let Some(touch) = self.touch(&near)?
            {
                let margins = touch.lines.map(|line| self.all[line].margin.clone()).to_vec();
                let (point, kind) = (self.inside(&touch.point), VertexKind::Crossing);
                let vertex = Vertex { point, kind, margins };
                keep(Located { vertex, error: lengths.same }, &mut vertices);
                touches.push(touch);
            }
        }
        for meeting in crossings(&self.all, &window, &lengths) {
            // Cubics of lines that touch may cross beside that place, by their errors.
            let touches = touches.iter().any(|touch| {
                let apart = (touch.point - meeting.point).norm();
                touch.lines == meeting.lines && apart < 10.0 * lengths.close
            });
            if !touches && let Some(vertex) = self.crossing_vertex(&meeting)? {
                keep(vertex, &mut vertices);
            }
        }
        for [index, end] in self.open_ends() {
            let vertex = self.end_vertex(index, end, &mut vertices)?;
            cuts[index].push(Cut { place: self.all[index].end(end), vertex });
        }
        for (vertex, it) in vertices.iter().enumerate() {
            self.runs.go_on()?;
            let reach = it.error + 3.0 * self.runs.options.interpolation;
            for (line, own) in self.all.iter().zip(&mut cuts) {
                let known = own.iter().any(|cut| cut.vertex == vertex);
                if let Some((place, _)) = line.near(&it.vertex.point, reach).filter(|_| !known) {
                    own.push(Cut { place, vertex });
                }
            }
        }
        let parts = self.divided(cuts);
        self.seen(&parts, vertices.into_iter().map(|it| it.vertex).collect())
    }

    /// Drops lines that cannot be told from others along their whole length: fragments of margins
    /// that are singular there.
    fn drop_fragments(&mut self) {
        /// A line with more nodes was followed because it is one.
        const MOST: usize = 12;
        let reach = 0.5 * self.runs.lengths.half;
        let is_fragment = |(index, line): (usize, &Line<F::Margin>)| {
            let hides = |other: &Line<F::Margin>| {
                line.nodes.iter().all(|node| other.near(&node.point, reach).is_some())
            };
            let mut others = self.all.iter().enumerate().filter(|(other, _)| *other != index);
            line.ends == Some([Reach::Lost; 2])
                && line.nodes.len() <= MOST
                && others.any(|(_, other)| hides(other))
        };
        let fragments: Vec<bool> = self.all.iter().enumerate().map(is_fragment).collect();
        let mut fragments = fragments.into_iter();
        self.all.retain(|_| fragments.next() == Some(false));
    }

    /// The index of the vertex where a line leaves the window.
    fn edge_vertex(
        &self,
        line: &Line<F::Margin>,
        end: usize,
        vertices: &mut Vec<Located<F::Margin>>,
    ) -> usize {
        let (window, tip) = (self.runs.window, line.tip(end));
        let point = window.onto_boundary(&tip, self.runs.lengths.same).unwrap_or(tip);
        let corner = window.corners().contains(&point);
        let kind = if corner { VertexKind::WindowCorner } else { VertexKind::WindowEdge };
        let vertex = Vertex { point, kind, margins: vec![line.margin.clone()] };
        keep(Located { vertex, error: self.runs.lengths.solved }, vertices)
    }

    /// A place that is solved for once, from these numbers.
    pub(super) fn once(
        &self,
        from: [u64; 5],
        solve: impl FnOnce() -> Traced<Option<Solved>, F>,
    ) -> Traced<Option<Solved>, F> {
        if let Some(known) = self.solved.borrow().get(&from) {
            return Ok(*known);
        }
        let found = solve()?;
        self.solved.borrow_mut().insert(from, found);
        Ok(found)
    }

    /// The vertex where the cubics of two lines cross, solved for with their margins; `None` if the
    /// lines only seem to cross.
    fn crossing_vertex(&self, meeting: &Crossing) -> Traced<Option<Located<F::Margin>>, F> {
        let lengths = self.runs.lengths;
        let Crossing { lines: [one, other], places: [here, there], point } = meeting;
        let (one, other) = (&self.all[*one], &self.all[*other]);
        let names = [&one.names[here.piece], &other.names[there.piece]];
        let (along, across) = (one.tangent(*here), other.tangent(*there));
        let sine = along.perp(&across).abs().max(lengths.same / lengths.scale);
        let itself = names[0] == names[1];
        let [x, y] = [point.x, point.y].map(f64::to_bits);
        let solved = self.once([x, y, along.x.to_bits(), across.x.to_bits(), 0], || {
            if itself {
                // The gradient of one margin vanishes where its zero set crosses itself.
                let reach = lengths.close;
                let found = stationary(&self.runs, names[0], point, reach, reach)?;
                return Ok(found.map(|place| (place, lengths.solved)));
            }
            let reach = 10.0 * lengths.close;
            crossing(&self.runs, names, point, &along, lengths.beyond, reach)
        })?;
        let open = (lengths.same / sine).max(lengths.touch);
        let solved = solved.filter(|(place, _)| (place - point).norm() < open);
        // Lines that touch cross by their errors.
        if solved.is_none() && sine < 100.0 * angle::DEPENDENT {
            return Ok(None);
        }
        let margins = vec![one.margin.clone(), other.margin.clone()];
        let (point, error) = solved.unwrap_or((*point, lengths.same));
        let kind = if itself { VertexKind::Degenerate } else { VertexKind::Crossing };
        let vertex = Vertex { point: self.inside(&point), kind, margins };
        Ok(Some(Located { vertex, error: error.max(lengths.solved) }))
    }

    /// The parts between the cuts, line after line.
    fn divided(&self, cuts: Vec<Vec<Cut>>) -> Vec<Part> {
        let mut parts = Vec::new();
        for (index, (line, mut own)) in self.all.iter().zip(cuts).enumerate() {
            own.sort_by(|one, other| {
                let order = |cut: &Cut| cut.place.piece as f64 + cut.place.theta;
                order(one).total_cmp(&order(other))
            });
            if line.ends.is_none() {
                let Some(&first) = own.first() else {
                    parts.push(Part { line: index, cuts: None });
                    continue;
                };
                let piece = first.place.piece + line.pieces();
                own.push(Cut { place: Place { piece, ..first.place }, ..first });
            }
            for pair in own.windows(2) {
                let part = Part { line: index, cuts: Some([pair[0], pair[1]]) };
                let is_loop = pair[0].vertex == pair[1].vertex;
                if !is_loop || part.length(line) > self.runs.lengths.piece {
                    parts.push(part);
                }
            }
        }
        parts
    }
}

/// The index of a vertex, which may be a known one.
fn keep<M>(new: Located<M>, vertices: &mut Vec<Located<M>>) -> usize {
    let near = |it: &Located<M>| (it.vertex.point - new.vertex.point).norm() < it.error + new.error;
    let known = vertices.iter().position(near);
    known.unwrap_or_else(|| {
        vertices.push(new);
        vertices.len() - 1
    })
}
