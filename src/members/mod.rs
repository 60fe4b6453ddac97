//! One file for each kind of member of an assembly: position, forces, Jacobian rows, energy, static answer.

pub mod ball_set;
pub mod beam;
pub mod body_rates;
pub mod connection;
pub mod contact_traction;
pub mod contacts;
pub mod dent_table;
pub mod flexible_shaft;
pub mod half_space;
pub mod housing_fit;
pub mod race_position;
pub mod raceway_profile;
pub mod reduced_solid;
pub mod rigid_body;
pub mod section_attachments;
pub mod sensor;
pub mod shaft_modes;
pub mod static_ball;
pub mod static_ball_on_race;
pub mod static_ball_start;
pub mod static_bearing;
pub mod static_connection;
pub mod static_housing_fit;
pub mod static_shaft;
pub mod unbalance;
