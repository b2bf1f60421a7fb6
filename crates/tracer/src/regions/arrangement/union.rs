//! Disjoint sets.

/// Disjoint sets of the numbers 0, 1, …, each represented by its least member.
#[derive(Clone, Debug)]
pub(crate) struct DisjointSets {
    parents: Vec<usize>,
}

impl DisjointSets {
    /// The sets with one member each.
    pub(crate) fn new(count: usize) -> Self {
        Self { parents: (0..count).collect() }
    }

    /// The least member of the set of `member`.
    pub(crate) fn least(&mut self, mut member: usize) -> usize {
        while self.parents[member] != member {
            self.parents[member] = self.parents[self.parents[member]];
            member = self.parents[member];
        }
        member
    }

    /// Whether `a` and `b` are in one set.
    pub(crate) fn are_united(&mut self, a: usize, b: usize) -> bool {
        self.least(a) == self.least(b)
    }

    /// Unites the sets of `a` and `b`.
    pub(crate) fn unite(&mut self, a: usize, b: usize) {
        let (a, b) = (self.least(a), self.least(b));
        self.parents[a.max(b)] = a.min(b);
    }
}
