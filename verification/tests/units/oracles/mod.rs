//! The oracles themselves, against closed forms and tables.

mod bonded_bushing;
mod bonded_disc;
mod creep;
mod dense;
mod elastic;
mod elliptic;
mod hertz;
mod hyperdual;
mod misalignment;
mod ring;
mod rolling;
mod rubber_point;
mod statics;
mod statics_terms;
mod timoshenko;
mod trust_region;
mod uniform_load;
