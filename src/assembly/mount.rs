//! Where a connection takes hold of a rigid body.

/// A place along the axis of a body, and which way it faces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mount {
    /// Index of the body in its assembly.
    pub body: usize,
    /// Distance of the place from the body's centre along the body's axis, m.
    pub along: f64,
    /// Whether the axis of what sits there points along the body's −X: put in the other way round.
    pub reversed: bool,
}

impl Mount {
    pub fn at_centre(body: usize) -> Mount {
        Mount { body, ..Mount::default() }
    }

    /// Whether what sits there and the body share centre and axes.
    pub fn is_direct(&self) -> bool {
        self.along == 0.0 && !self.reversed
    }
}
