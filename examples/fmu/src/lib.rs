//! A ball bearing between its races as an FMU for co-simulation (FMI 3.0).
#![allow(non_snake_case, reason = "names of the C interface")]

mod c_interface;
pub mod model;
pub mod variables;
