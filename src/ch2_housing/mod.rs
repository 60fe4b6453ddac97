//! Chapter 2: the dynamic bearing model and the flexible housing.
pub mod bearing;
pub mod bore_contact;
pub mod elastomer;
pub mod linear_elastic;
