//! Section 2.2.1 (also 3.2.2, 4.2.1 and 5.3.1): the ball bearing.
//!
//! Axes: X axial, Z up, Y lateral. Ball azimuth is measured from +Y towards +Z, so that 90°
//! is on +Z and 270° on −Z (the convention of Fig. 3.31).
pub mod ball_contact;
pub mod cage;
pub mod contact;
pub mod elliptic;
pub mod frequencies;
pub mod geometry;
pub mod hertz;
pub mod inertia;
pub mod rating;
pub mod slices;
pub mod traction;
