//! Which part of a scene an error is about that shows only with the mesh, when no position in the
//! file is known any more: the document says where it stands.

/// Part of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum About {
    /// A key or a table, dotted.
    Key(String),
    /// A key of one entry of a list of tables, entries counted from 0.
    Item { table: &'static str, index: usize, key: &'static str },
}

impl About {
    pub fn key(path: impl Into<String>) -> About {
        About::Key(path.into())
    }
}
