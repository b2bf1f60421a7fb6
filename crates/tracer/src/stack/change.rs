//! What a change of the structure does to the regions.

use crate::family::Family;
use crate::regions::locate::Location;
use crate::stack::meeting::StackMeeting;
use crate::stack::structure::Sample;

/// A change of the structure of atlases with the third parameter.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Change<Label> {
    /// The two values at which the atlases differ.
    pub between: [f64; 2],
    /// The codimension-2 points that meet between these values; `None` if no conditions could be
    /// solved that explain the change.
    pub meeting: Option<StackMeeting>,
    /// Whether there may be several changes: atlases between the two values are in doubt, or have
    /// other structures at values that are too close to each other.
    pub doubtful: bool,
    /// What becomes of the regions as the third parameter grows. If there is nothing, only
    /// neighbours change.
    pub effects: Vec<Effect<Label>>,
}

/// What becomes of a region as the third parameter grows.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Effect<Label> {
    /// A region with this label is born.
    Born(Label),
    /// A region with this label dies.
    Dies(Label),
    /// Regions with this label merge.
    Merge(Label),
    /// A region with this label splits.
    Splits(Label),
}

impl<Label> Effect<Label> {
    /// The same effect with another label.
    #[must_use]
    pub fn map<L>(&self, label: impl Fn(&Label) -> L) -> Effect<L> {
        match self {
            Self::Born(own) => Effect::Born(label(own)),
            Self::Dies(own) => Effect::Dies(label(own)),
            Self::Merge(own) => Effect::Merge(label(own)),
            Self::Splits(own) => Effect::Splits(label(own)),
        }
    }

    /// `born`, `dies`, `merge` or `splits`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Born(_) => "born",
            Self::Dies(_) => "dies",
            Self::Merge(_) => "merge",
            Self::Splits(_) => "splits",
        }
    }

    /// The label of the region.
    #[must_use]
    pub const fn label(&self) -> &Label {
        match self {
            Self::Born(label) | Self::Dies(label) | Self::Merge(label) | Self::Splits(label) => {
                label
            }
        }
    }
}

impl<Label> Change<Label> {
    /// Whether there may be several changes, or nothing could be solved for.
    #[must_use]
    pub fn is_doubtful(&self) -> bool {
        self.doubtful || self.meeting.is_none()
    }

    /// What is in doubt, in one sentence; `over` is what the atlases differ in, in the plural.
    #[must_use]
    pub fn objection(&self, over: &str) -> Option<String> {
        let [low, high] = self.between;
        let what = if self.meeting.is_some() {
            "several changes may lie between the"
        } else {
            "nothing is known of what changes between the"
        };
        self.is_doubtful().then(|| format!("{what} {over} {low:?} and {high:?}"))
    }

    /// The same change with other labels.
    #[must_use]
    pub fn map<L>(&self, label: impl Fn(&Label) -> L) -> Change<L> {
        let Self { between, meeting, doubtful, effects } = self;
        let effects = effects.iter().map(|effect| effect.map(&label)).collect();
        Change { between: *between, meeting: *meeting, doubtful: *doubtful, effects }
    }
}

impl<Label: Clone + Ord> Change<Label> {
    pub(super) fn new<F: Family<Label = Label>>(
        samples: [&Sample<F>; 2],
        meeting: Option<StackMeeting>,
        doubtful: bool,
    ) -> Self {
        let between = samples.map(|sample| sample.value);
        Self { between, meeting, doubtful, effects: effects(samples) }
    }

    /// Adds a later change to this one, as one that is in doubt. A region that is born and dies
    /// again between the two values is not mentioned.
    pub(super) fn join(&mut self, later: Self) {
        let [low, high] = later.between;
        self.between = [self.between[0].min(low), self.between[1].max(high)];
        self.meeting = self.meeting.or(later.meeting);
        self.doubtful = true;
        for effect in later.effects {
            let undone = match &effect {
                Effect::Dies(label) => Effect::Born(label.clone()),
                Effect::Born(label) => Effect::Dies(label.clone()),
                Effect::Merge(label) => Effect::Splits(label.clone()),
                Effect::Splits(label) => Effect::Merge(label.clone()),
            };
            match self.effects.iter().position(|own| *own == undone) {
                Some(own) => drop(self.effects.remove(own)),
                None => self.effects.push(effect),
            }
        }
        self.effects.sort();
    }
}

/// What becomes of the regions between two atlases.
///
/// A region of one atlas corresponds to a region of the other atlas if both have the same label,
/// and if the sample point of one lies in the other.
fn effects<F: Family>(samples: [&Sample<F>; 2]) -> Vec<Effect<F::Label>> {
    let planes = samples.map(|sample| &sample.atlas.plane);
    let counts = planes.map(|plane| plane.regions().len());
    let label = |which: usize, region: usize| samples[which].structure.label(region);
    let mut related = vec![vec![false; counts[1]]; counts[0]];
    for (from, to) in [(0, 1), (1, 0)] {
        for (index, region) in planes[from].regions().iter().enumerate() {
            let Location::Region(found) = planes[to].locate(&region.sample) else { continue };
            if label(from, index) == label(to, found) {
                let [one, other] = if from == 0 { [index, found] } else { [found, index] };
                related[one][other] = true;
            }
        }
    }
    let partners = [
        related.iter().map(|row| row.iter().filter(|&&yes| yes).count()).collect::<Vec<_>>(),
        (0..counts[1]).map(|column| related.iter().filter(|row| row[column]).count()).collect(),
    ];
    let with = |which: usize, accepted: fn(usize) -> bool| -> Vec<F::Label> {
        let regions = (0..counts[which]).filter(|&region| accepted(partners[which][region]));
        regions.map(|region| label(which, region).clone()).collect()
    };
    let (mut dying, mut born) = (with(0, |count| count == 0), with(1, |count| count == 0));
    // A narrow region that has moved away is neither born nor dying.
    dying.retain(|label| match born.iter().position(|other| other == label) {
        Some(moved) => {
            born.remove(moved);
            false
        }
        None => true,
    });
    let mut effects: Vec<_> = born.into_iter().map(Effect::Born).collect();
    effects.extend(dying.into_iter().map(Effect::Dies));
    effects.extend(with(1, |count| count > 1).into_iter().map(Effect::Merge));
    effects.extend(with(0, |count| count > 1).into_iter().map(Effect::Splits));
    effects.sort();
    effects
}
