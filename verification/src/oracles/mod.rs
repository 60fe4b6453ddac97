//! Reference solutions that share nothing with the laws they judge.
//!
//! Nothing here imports the library: plain arrays, its own quadrature, its own automatic
//! derivatives and its own linear solver. Where there is a choice the formulation differs from the
//! usual one on purpose, so that an error would have to be made twice in different ways.

pub mod bonded_bushing;
pub mod bonded_disc;
pub mod bore_friction;
pub mod creep;
pub mod dense;
pub mod elastic;
pub mod elliptic;
pub mod flexible_shaft;
pub mod half_space;
pub mod hertz;
pub mod hyperdual;
pub mod lame;
pub mod loops;
pub mod misalignment;
pub mod ring;
pub mod rolling;
pub mod rubber_point;
pub mod run_up;
pub mod seated;
pub mod seated_shaft;
pub mod shaft;
pub mod statics;
pub mod swing;
pub mod timoshenko;
pub mod trust_region;
pub mod uniform_load;
pub mod whirling_shaft;
