//! Disjoint sets.

/// Sets of 0, 1, …, each known by its least member.
#[derive(Clone, Debug)]
pub(crate) struct DisjointSets {
    parents: Vec<usize>,
}

impl DisjointSets {
    pub(crate) fn new(count: usize) -> Self {
        Self { parents: (0..count).collect() }
    }

    pub(crate) fn least(&mut self, mut member: usize) -> usize {
        while self.parents[member] != member {
            self.parents[member] = self.parents[self.parents[member]];
            member = self.parents[member];
        }
        member
    }

    pub(crate) fn are_united(&mut self, a: usize, b: usize) -> bool {
        self.least(a) == self.least(b)
    }

    pub(crate) fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.least(a), self.least(b));
        self.parents[a.max(b)] = a.min(b);
    }
}
