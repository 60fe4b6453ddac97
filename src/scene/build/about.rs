//! Part of a scene for an error that is found with the mesh, when positions in the file are no longer known: the
//! document looks them up.

/// Part of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum About {
    /// A key or a table, dotted.
    Key(String),
    /// A key of one entry of a list of tables; entries are counted from 0.
    Item { table: &'static str, index: usize, key: &'static str },
}

impl About {
    pub fn key(path: impl Into<String>) -> About {
        About::Key(path.into())
    }
}
