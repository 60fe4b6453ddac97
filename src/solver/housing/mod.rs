//! A bearing in a flexible housing (2.2.4).
//!
//! `exchange` runs both in explicit steps, each at its own rate.
pub mod exchange;
