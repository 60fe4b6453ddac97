//! Attachment of a bearing or connection to a rigid body.

/// A position along the axis of a body, and a direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mount {
    /// Index of the body in its assembly.
    pub body: usize,
    /// Distance from the body's centre along its axis, m.
    pub along: f64,
    /// True if the attached axis is along the body's −X (mounted reversed).
    pub reversed: bool,
}

impl Mount {
    pub fn at_centre(body: usize) -> Mount {
        Mount { body, ..Mount::default() }
    }

    /// Returns whether attachment and body have the same centre and axes.
    pub fn is_direct(&self) -> bool {
        self.along == 0.0 && !self.reversed
    }
}
