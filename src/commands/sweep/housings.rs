//! Housings of a point of a sweep, and what they add to its row.
//!
//! Condensing takes far longer than the equilibrium, so that the housings of the point before are taken
//! again where nothing of them has changed, with the same bits.

use crate::commands::assembly::housing::Housing;
use bearing_dynamics::output::Column;
use bearing_dynamics::output::fields::stresses;
use bearing_dynamics::output::recorder::seat::{SeatRow, prefix};
use bearing_dynamics::output::warnings::Warning;
use bearing_dynamics::output::warnings::solid::of_equilibrium;
use bearing_dynamics::scene::SolidScene;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::bore_shape::BorePlace;
use bearing_dynamics::scene::build::housing::setup;
use bearing_dynamics::scene::build::solid_mesh::build_housing;
use bearing_dynamics::scene::resolve::solid_scene::MeshSource;
use bearing_dynamics::scene::text::input_file;
use bearing_dynamics::scene::text::input_file::LARGEST_DATA;
use bearing_dynamics::solids::bore_equilibrium::BoreState;
use bearing_dynamics::solids::condensation::{CondensedBore, Reach};
use std::error::Error;

/// Housings of the point before, condensed.
#[derive(Default)]
pub struct Kept {
    housings: Vec<Housing>,
    bores: Vec<CondensedBore>,
}

/// Columns of each housing, of the race in it and what it holds.
const RESULTS: [(&str, &str); 12] = [
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

/// Columns beside those of the bearings.
pub fn columns(scene: &AssemblyScene) -> Vec<Column> {
    let housed = scene.bearings.iter().filter(|placed| placed.housing.is_some());
    let of = |prefix: String| {
        RESULTS.map(|(name, unit)| Column::new(format!("{prefix}{name}"), unit)).to_vec()
    };
    housed.flat_map(|placed| of(prefix(&placed.name))).collect()
}

impl Kept {
    /// The housings of a scene, made of those of the point before as far as these are the same.
    pub fn take(self, scene: &AssemblyScene) -> Result<Kept, Box<dyn Error>> {
        let mut earlier = self.housings.into_iter().zip(self.bores);
        let mut kept = Kept::default();
        for (bearing, placed) in scene.bearings.iter().enumerate() {
            let Some(own) = placed.housed() else { continue };
            // The bore's place counts: mid-side nodes may be put on its cylinder.
            let same = |(of, _): &(Housing, CondensedBore)| {
                of.scene.solid == own.solid && BorePlace::of(&of.scene) == BorePlace::of(&own)
            };
            let (built, earlier) = match earlier.next().filter(same) {
                Some((of, bore)) => (of.built, Some((of.scene.housing.bore, bore))),
                None => (build_housing(&own)?, None),
            };
            let setup = setup(&own, &built)?;
            let reach = setup.reach();
            let name = placed.name.clone();
            let of = Housing { bearing, name, scene: own, built, setup, mesh_seconds: 0.0 };
            kept.bores.push(match earlier {
                // Nothing is out of reach of such a race, so that its size only comes into rounding.
                Some((name, mut bore))
                    if name == of.scene.housing.bore
                        && Reach { radius: reach.radius, ..bore.reach } == reach =>
                {
                    bore.reach = reach;
                    bore
                }
                _ => of.condensed()?,
            });
            kept.housings.push(of);
        }
        Ok(kept)
    }

    pub fn parts(&self) -> (&[Housing], &[CondensedBore]) {
        (&self.housings, &self.bores)
    }

    /// What each adds to the row, in the order of [`columns`], and the warnings.
    pub fn row(&self, seats: &[BoreState]) -> (Vec<f64>, Vec<Warning>) {
        let (mut row, mut warnings) = (Vec::new(), Vec::new());
        for ((of, bore), state) in self.housings.iter().zip(&self.bores).zip(seats) {
            let seat = SeatRow::of_equilibrium(bore, state);
            let displacement = bore.displacement(&state.loads);
            let stress = stresses(&of.setup.model, &displacement);
            let said = of_equilibrium(&of.setup.model, &displacement, &stress);
            warnings.extend(said.into_iter().map(|said| said.named(&of.before())));
            let [x, y, z, tilt_y, tilt_z] = bore.race(&state.pose);
            row.extend([x, y, z].map(|place| 1e6 * place));
            row.extend([tilt_y, tilt_z].map(f64::to_degrees));
            row.extend([seat.force[1], seat.force[2]]);
            row.extend([0, 1].map(|i| state.stiffness[(i, i)]));
            row.push(seat.touching as f64);
            row.push(1e-6 * seat.peak_pressure);
            row.push(1e-6 * stress.cell_von_mises.iter().copied().fold(0.0, f64::max));
        }
        (row, warnings)
    }
}

/// Names, as the scene has them, and content.
pub type MeshFiles = Vec<(String, Vec<u8>)>;

/// The mesh files that a scene's housings are read from.
pub fn mesh_files(scene: &AssemblyScene) -> Result<MeshFiles, Box<dyn Error>> {
    let housings = scene.bearings.iter().filter_map(|placed| placed.housing.as_ref());
    solid_mesh_files(housings.map(|housing| &housing.solid))
}

pub fn solid_mesh_files<'s>(
    solids: impl Iterator<Item = &'s SolidScene>,
) -> Result<MeshFiles, Box<dyn Error>> {
    let mut all = MeshFiles::new();
    for solid in solids {
        let MeshSource::File { path, name, .. } = &solid.mesh.source else { continue };
        if all.iter().any(|(known, _)| known == name) {
            continue;
        }
        let content = input_file::read(path, LARGEST_DATA);
        let content =
            content.map_err(|error| format!("cannot read {}: {error}", path.display()))?;
        all.push((name.clone(), content));
    }
    Ok(all)
}
