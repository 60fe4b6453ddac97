//! The text of a scene: files, parsing, units, `base` and named tables.

pub mod base;
pub mod document;
pub mod input_file;
pub mod items;
pub mod reading;
pub mod scopes;
pub mod source;
pub mod sweep;
pub mod table;
pub mod tree;
pub mod units;
pub mod value;
pub mod written_out;
