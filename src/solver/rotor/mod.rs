//! A flexible shaft over stations, a beam or tetrahedra, and its linear vibrations.
//!
//! [`beam`] makes matrices of a shaft, by beam theory or of a mesh ([`meshed`]) that [`solid`] condenses onto the stations; [`model`] puts it on supports and keeps its lowest natural motions; [`whirl`] has its
//! motions at a speed and over speeds, [`critical`] the speeds that an unbalance excites, [`unbalance`] the orbits that it forces.
pub mod beam;
pub mod critical;
pub mod meshed;
pub mod model;
pub mod relaxing;
mod round;
pub mod solid;
pub mod unbalance;
pub mod whirl;
