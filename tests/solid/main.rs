//! Laws of flexible solids and of their contact with a cylinder.

#[path = "../solid_common/mod.rs"]
mod solid_common;

mod bore_contact;
mod cylinder_contact;
mod elastomer;
mod floating_frame;
mod material_laws;
mod rubber;
mod rubber_bodies;
mod rubber_bushings;
mod rubber_checkpoint;
mod rubber_energy;
mod rubber_explicit;
mod rubber_great_strain;
mod rubber_limits;
mod rubber_prony;
mod rubber_steps;
mod small_laws;
mod solid_explicit;
mod solid_factors;
mod solid_plan;
mod solid_statics;
mod solid_step_limit;
mod solid_stress;
mod solid_trust;
