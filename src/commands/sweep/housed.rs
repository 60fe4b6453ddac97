//! A point of a sweep over a bearing in its housing.
//!
//! Condensing takes far longer than the equilibrium, so that the housing of the point before is taken
//! again where nothing of it has changed, with the same bits.

use super::point::of_bearing;
use crate::commands::housed::{Prepared, condensed, equilibrium_at, search};
use bearing_dynamics::output::course::outer_place;
use bearing_dynamics::output::fields::stresses;
use bearing_dynamics::output::recorder::seat::SeatRow;
use bearing_dynamics::scene::Subject;
use bearing_dynamics::scene::bore_shape::BorePlace;
use bearing_dynamics::scene::housing::HousedScene;
use bearing_dynamics::scene::housing_problem::setup;
use bearing_dynamics::scene::input_file::{self, LARGEST_DATA};
use bearing_dynamics::scene::solid::MeshSource;
use bearing_dynamics::scene::solid_mesh::{BuiltMesh, build_housing};
use bearing_dynamics::solver::housing::condensed::{CondensedBore, Reach};
use std::error::Error;

/// The housing of the point before.
pub struct Kept {
    scene: HousedScene,
    built: BuiltMesh,
    bore: CondensedBore,
}

/// Columns beside those of the bearing.
pub const RESULTS: [(&str, &str); 12] = [
    ("outer_x", "um"),
    ("outer_y", "um"),
    ("outer_z", "um"),
    ("outer_tilt_y", "deg"),
    ("outer_tilt_z", "deg"),
    ("housing_force_on_outer_y", "N"),
    ("housing_force_on_outer_z", "N"),
    ("housing_stiffness_y", "N/m"),
    ("housing_stiffness_z", "N/m"),
    ("bore_nodes_touching", "1"),
    ("bore_peak_pressure", "MPa"),
    ("housing_von_mises", "MPa"),
];

/// Position and results of bearing and housing at t = 0, the race grown into its fit.
pub fn row(scene: &HousedScene, kept: &mut Option<Kept>) -> Result<Vec<f64>, Box<dyn Error>> {
    let (built, earlier) = match kept.take() {
        // The bore's place counts: mid-side nodes may be put on its cylinder.
        Some(kept)
            if kept.scene.solid == scene.solid
                && BorePlace::of(&kept.scene) == BorePlace::of(scene) =>
        {
            (kept.built, Some((kept.scene.housing.bore, kept.bore)))
        }
        _ => (build_housing(scene)?, None),
    };
    let setup = setup(scene, &built)?;
    let prepared = Prepared { built, setup, mesh_seconds: 0.0 };
    let reach = prepared.setup.reach();
    let bore = match earlier {
        // Nothing is out of reach of such a race, so that its size only comes into rounding.
        Some((name, mut bore))
            if name == scene.housing.bore
                && Reach { radius: reach.radius, ..bore.reach } == reach =>
        {
            bore.reach = reach;
            bore
        }
        _ => condensed(&prepared)?,
    };
    let mut search = search(scene, &bore);
    let (_, state) = equilibrium_at(scene, &prepared.setup, &mut search, 0.0)?;
    let seat = SeatRow::of_equilibrium(&bore, &state.bore);
    let displacement = bore.displacement(&state.bore.loads);
    let stress = stresses(&prepared.setup.model, &displacement);
    let [x, y, z, tilt_y, tilt_z] = outer_place(&bore, &state);
    let mut row = of_bearing(&state.bearing);
    row.extend([x, y, z].map(|place| 1e6 * place));
    row.extend([tilt_y, tilt_z].map(f64::to_degrees));
    row.extend([seat.force[1], seat.force[2]]);
    row.extend([0, 1].map(|i| state.bore.stiffness[(i, i)]));
    row.push(seat.touching as f64);
    row.push(1e-6 * seat.peak_pressure);
    row.push(1e-6 * stress.cell_von_mises.iter().copied().fold(0.0, f64::max));
    *kept = Some(Kept { scene: scene.clone(), built: prepared.built, bore });
    Ok(row)
}

/// Content of the mesh file that a scene's housing is read from; nothing where there is none.
pub fn mesh_file(subject: &Subject) -> Result<Vec<u8>, Box<dyn Error>> {
    let Subject::Housed(scene) = subject else { return Ok(Vec::new()) };
    let MeshSource::File { path, .. } = &scene.solid.mesh.source else { return Ok(Vec::new()) };
    Ok(input_file::read(path, LARGEST_DATA)
        .map_err(|error| format!("cannot read {}: {error}", path.display()))?)
}
