//! `bearing statics` of several bearings: one equilibrium of all bodies.

use super::housings::{self, Housing};
use super::{defaults, echo, name_of, statics_items};
use crate::commands::earlier::{Writes, claimed, remove_earlier};
use crate::commands::echo::{frequencies, hertz};
use crate::commands::{CommandResult, Outcome, record, remarks, results_folder, say, table};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::output::assembly_results::{Solved, readable, write};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::bore::{BoreNodeState, bore_series, condensed_nodes};
use bearing_dynamics::output::fields::{Stresses, file_name, stresses, write_fields, write_list};
use bearing_dynamics::output::plots::{LoadZone, load_zone};
use bearing_dynamics::output::recorder::seat::{SeatRow, seat_columns};
use bearing_dynamics::output::remarks as of_solid;
use bearing_dynamics::output::results::{ResultsError, RunRecord, quantity};
use bearing_dynamics::output::summary::solid::field_sections;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::{Document, Plot};
use bearing_dynamics::solver::housing::bore_equilibrium::BoreState;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::static_assembly::StaticAssembly;
use bearing_dynamics::solver::statics::{AssemblySolution, StaticOptions, solve_assembly};
use serde_json::{Map, Value, json};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// An equilibrium and everything its results folder records.
pub struct Found<'s> {
    /// Of the bearings.
    pub names: Vec<&'s str>,
    pub assembly: StaticAssembly<'static>,
    /// As people read it.
    pub solution: AssemblySolution,
    pub remarks: Vec<String>,
    pub record: RunRecord,
    pub settled: Vec<Settled>,
}

/// Finds the equilibrium of a scene that took `read` s to read.
pub fn find_equilibrium<'s>(
    document: &Document,
    scene: &'s AssemblyScene,
    read: f64,
) -> Result<Found<'s>, Box<dyn Error>> {
    let start = Instant::now();
    let housings = housings::prepare(document, scene)?;
    let bores = housings::condensed(&housings)?;
    let condense = start.elapsed().as_secs_f64();
    let assembly = housings::statics(scene, &housings, &bores)?;
    let start = Instant::now();
    let solution = solve_assembly(&assembly, None, &StaticOptions::default())?;
    let mut seconds = vec![("read".into(), read), ("solve".into(), start.elapsed().as_secs_f64())];
    if !housings.is_empty() {
        seconds.insert(1, ("condense".into(), condense));
    }
    let mut remarks = remarks::of_assembly(scene, &assembly, &solution);
    let names: Vec<&str> = scene.bearings.iter().map(name_of).collect();
    let assumptions = &scene.common().assumptions;
    let plan = statics_items(scene, &housings)?;
    let mut record = record(echo(scene)?, plan, assumptions, &defaults(scene), seconds);
    record.ran.clone_from(&solution.ran);
    for (tally, bore) in record.ran.solids.iter_mut().zip(&bores) {
        tally.absorb(&bore.ran);
    }
    let mut settled = Vec::with_capacity(housings.len());
    let mut sections = Map::new();
    for ((housing, bore), state) in housings.into_iter().zip(&bores).zip(&solution.seats) {
        let name = names[housing.bearing];
        let of = Settled::new(name, housing, bore, state);
        let model = &of.housing.mesh.setup.model;
        let said = of_solid::of_equilibrium(model, &of.displacement, &of.stress);
        remarks.extend(said.into_iter().map(|remark| format!("housing {name}: {remark}")));
        sections.insert(name.into(), of.section()?);
        settled.push(of);
    }
    if !settled.is_empty() {
        record.sections.push(("housings".into(), Value::Object(sections)));
    }
    record.sections.push(("remarks".into(), json!(remarks)));
    let contacts = assembly.bearings.iter().map(|b| hertz([&b.inner_contact, &b.outer_contact]));
    let speeds = scene.bearings.iter().map(|placed| frequencies(&placed.scene));
    record.sections.push(("hertz".into(), by_name(scene, contacts)?));
    record.sections.push(("frequencies".into(), by_name(scene, speeds)?));
    let solution = readable(&scene.assembly()?, &assembly, &solution);
    let StaticAssembly { bodies, bearings, connections, .. } = assembly;
    // Bores are needed no longer.
    let assembly = StaticAssembly { bodies, bearings, connections, seats: Vec::new() };
    Ok(Found { names, assembly, solution, remarks, record, settled })
}

/// What there is of each bearing under its name; that of the only one by itself.
fn by_name(
    scene: &AssemblyScene,
    each: impl Iterator<Item = Result<Value, ResultsError>>,
) -> Result<Value, ResultsError> {
    let mut named = Map::new();
    for (placed, section) in scene.bearings.iter().zip(each) {
        match &placed.name {
            None => return section,
            Some(name) => named.insert(name.clone(), section?),
        };
    }
    Ok(Value::Object(named))
}

/// A housing in equilibrium.
pub struct Settled {
    name: String,
    housing: Housing,
    seat: SeatRow,
    nodes: Vec<BoreNodeState>,
    displacement: Vec<Vec3>,
    stress: Stresses,
    /// y, z (m), tilts (rad) of the race from its place.
    pose: [f64; 4],
}

impl Settled {
    fn new(name: &str, housing: Housing, bore: &CondensedBore, state: &BoreState) -> Settled {
        let model = &housing.mesh.setup.model;
        let displacement = bore.displacement(&state.loads);
        Settled {
            name: name.into(),
            seat: SeatRow::of_equilibrium(bore, state),
            nodes: condensed_nodes(model, bore, state),
            stress: stresses(model, &displacement),
            pose: state.pose,
            displacement,
            housing,
        }
    }

    fn section(&self) -> Result<Value, Box<dyn Error>> {
        let mut section = Map::new();
        let columns = seat_columns("");
        for (column, value) in columns.iter().zip(self.seat.values()) {
            section.insert(column.name.clone(), quantity(&column.name, value, &column.unit)?);
        }
        let built = &self.housing.mesh.built;
        section.extend(field_sections(built, &self.displacement, &self.stress)?);
        Ok(Value::Object(section))
    }

    /// As a person reads it.
    fn text(&self) -> String {
        let [y, z, ..] = self.pose;
        let von_mises = self.stress.cell_von_mises.iter().copied().fold(0.0, f64::max);
        format!(
            "housing {}: outer race {:.6} um along y, {:.6} um along z, {} bore nodes touch, pressure up to \
             {:.4} MPa, von Mises stress up to {:.4} MPa\n",
            self.name,
            1e6 * y,
            1e6 * z,
            self.seat.touching,
            1e-6 * self.seat.peak_pressure,
            1e-6 * von_mises
        )
    }

    /// Fields and the table of the bore's nodes; the files written.
    fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
        let fields = folder.join(file_name(&self.name, 0));
        let mesh = &self.housing.mesh.built.mesh;
        write_fields(&fields, mesh, &self.displacement, None, &self.stress, Some(&self.nodes))?;
        let table = folder.join(format!("bore_{}.csv", self.name));
        bore_series(&self.nodes)?.write_csv(&table)?;
        Ok(vec![fields, table])
    }
}

/// Finds the equilibrium, says it, and writes it to a folder unless it is only to be said.
pub fn run(
    path: &Path,
    document: &Document,
    scene: &AssemblyScene,
    out: &Option<PathBuf>,
    dry: bool,
) -> CommandResult {
    let start = Instant::now();
    let folder = match dry {
        true => None,
        false => Some(claimed(&results_folder(path, out), Writes::Statics)?),
    };
    let found = find_equilibrium(document, scene, start.elapsed().as_secs_f64())?;
    let Found { names, assembly, solution, remarks, record, settled } = &found;
    let of_housings: String = settled.iter().map(Settled::text).collect();
    say(&table::render_assembly(assembly, names, solution, &of_housings, remarks))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    remove_earlier(&folder)?;
    let mut written = Vec::new();
    if scene.common().plots.contains(&Plot::LoadZone) {
        let title = scene.common().title.clone().unwrap_or_else(|| "Bearings".into());
        for ((placed, name), state) in scene.bearings.iter().zip(names).zip(&solution.bearings) {
            let path = folder.join(format!("load_zone_{name}.svg"));
            let (heading, geometry) = (format!("{title}: {name}"), &placed.scene.geometry);
            let zone = LoadZone::new(heading, geometry, &state.balls);
            write_atomic(&path, load_zone(&zone)?.as_bytes())?;
            written.push(path);
        }
    }
    for housing in settled {
        written.extend(housing.write(&folder)?);
    }
    if !settled.is_empty() {
        let files: Vec<_> = settled.iter().map(|of| (0.0, file_name(&of.name, 0))).collect();
        written.push(write_list(&folder, &files)?);
    }
    written.extend(write(&folder, &Solved { assembly, names, solution }, record)?);
    say(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}
