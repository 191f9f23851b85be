//! What is known of a solution whatever its parameters: a row in the solution's own file.

/// How fields change with time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Changes {
    /// Not at all.
    Still,
    /// As a motion prescribes.
    AsPrescribed,
    /// By waves.
    Waves,
    /// By the diffusion of pressure.
    Diffuses,
}

/// Along what fields are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The depth below the drained surface.
    OverDepth,
    /// The distance from the middle of a slab, whose settlement is a plate's across it.
    AlongSlab,
    /// Depth and distance in a plane.
    InPlane,
}

/// A solution whatever its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Name in study files and tables.
    pub name: &'static str,
    /// It in running text; empty where it is called by its name.
    pub words: &'static str,
    /// Sets of study keys that it reads.
    pub(crate) inputs: &'static [&'static [&'static str]],
    /// Whether it must be computed in advance for its output times, which is expensive.
    pub is_prepared: bool,
    /// Along what its fields are given.
    pub axis: Axis,
    /// How they change with time.
    pub changes: Changes,
    /// Whether a load in parts has the sum of what each part does.
    pub adds_up: bool,
}

impl Row {
    /// A column in which pressure diffuses, in closed form.
    pub(crate) const COLUMN: Self = Self {
        name: "",
        words: "",
        inputs: &[],
        is_prepared: false,
        axis: Axis::OverDepth,
        changes: Changes::Diffuses,
        adds_up: false,
    };
}
