//! A flexible shaft as a beam of stations.
pub mod beam;
