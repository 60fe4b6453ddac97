//! Benchmarks with independent oracles.

pub mod oracles;
