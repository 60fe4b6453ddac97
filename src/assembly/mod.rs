//! The lists of all members, their places in the state vector, and speeds and loads at a time.

pub mod bearing_alone;
pub mod ledger_watch;
pub mod lists;
pub mod places;
pub mod prescribed;
pub mod section_attachments;
