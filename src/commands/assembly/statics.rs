//! `bearing statics` of a scene of bearings: equilibrium at t = 0.

use super::housing::Housing;
use super::housings::{self, Equilibrium};
use super::inertia::FrequencyRatio;
use super::lists::Lists;
use super::{Fallible, defaults, name_of, plan};
use crate::commands::asked::Asked;
use crate::commands::earlier::{Writes, remove_earlier};
use crate::commands::echo::{frequencies, frequency_line, geometry, hertz, sections};
use crate::commands::life::Life;
use crate::commands::warnings::of_equilibrium;
use crate::commands::{CommandResult, Outcome, pictures, print, record, table};
use bearing_dynamics::equilibrium::lists::StaticAssembly;
use bearing_dynamics::equilibrium::quasi_static_sequence::EquilibriumAt;
use bearing_dynamics::equilibrium::statics::{StaticProblem, StaticSolution, stiffness_to_ground};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::output::assembly_results::{Solved, readable, write};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::bore::{BoreNodeState, bore_series, condensed_nodes};
use bearing_dynamics::output::fields::{Stresses, file_name, stresses, write_fields, write_list};
use bearing_dynamics::output::plots::{LoadZone, load_zone};
use bearing_dynamics::output::recorder::seat::{SeatRow, seat_columns};
use bearing_dynamics::output::results::{
    ResultsError, RunRecord, quantity, stiffness_section, write_static_results,
};
use bearing_dynamics::output::summary::housing::{
    PEAK_PRESSURE, equilibrium_section, solver_section,
};
use bearing_dynamics::output::summary::solid::field_sections;
use bearing_dynamics::output::warnings::{Warning, lines, solid as of_solid};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::{Document, Plot};
use bearing_dynamics::solids::bore_equilibrium::{Axial, BoreState, POSE_NAMES};
use bearing_dynamics::solids::condensation::CondensedBore;
use nalgebra::SMatrix;
use serde_json::{Map, Value, json};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

const ONE_BEARING: &str = "note: statics draws moment-tilt and polar only for one unnamed bearing at the origin with a fixed outer race, not `reversed`, without bodies, springs, foundation and housing; `bearing sweep` gives loads over positions\n";

/// An equilibrium and everything its results folder records.
pub struct Found<'s> {
    scene: &'s AssemblyScene,
    names: Vec<&'s str>,
    assembly: StaticAssembly<'static>,
    /// Equilibrium; with several bearings in the coordinates of the output.
    moment: EquilibriumAt,
    /// The same as the problem and solution of a single bearing; `None` with several.
    of_one: Option<(StaticProblem, StaticSolution)>,
    lives: Vec<Option<Life>>,
    warnings: Vec<Warning>,
    inertia: Option<FrequencyRatio>,
    settled: Vec<Settled>,
    /// Stiffness of the shaft against the ground; `None` for rigid housings and with several bearings.
    to_ground: Option<SMatrix<f64, 5, 5>>,
    pub record: RunRecord,
}

/// Finds the equilibrium of a scene that took `read` s to read.
pub fn find_equilibrium<'s>(
    document: &Document,
    scene: &'s AssemblyScene,
    read: f64,
) -> Fallible<Found<'s>> {
    scene.check_statics()?;
    let housings = housings::prepare(document, scene)?;
    let start = Instant::now();
    let bores = housings::condensed(&housings)?;
    let condense = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let lists = Lists::of(scene);
    let found = housings::equilibrium(&lists, housings::grown(&housings, &bores), None)?;
    let Equilibrium { still, moment, in_bores } = &found;
    let inertia = match in_bores {
        Some((problem, search)) => FrequencyRatio::of(scene, problem, &housings, search, moment)?,
        None => None,
    };
    let mut seconds = vec![("read".into(), read), ("solve".into(), start.elapsed().as_secs_f64())];
    if !housings.is_empty() {
        let mesh = housings.iter().map(|housing| housing.mesh_seconds).sum();
        seconds.extend([("mesh".into(), mesh), ("condense".into(), condense)]);
    }
    let of_one = match scene.one_still() {
        Some(one) => {
            let problem = plan::of_one(one, still)?;
            Some((problem, StaticSolution::from(moment.solution.clone())))
        }
        None => None,
    };
    let mut warnings = of_equilibrium(scene, still, &moment.solution)?;
    let defaults = match scene.only() {
        Some(alone) => alone.defaults_used.clone(),
        None => defaults(scene),
    };
    let planned = plan::of_statics(&lists, &housings)?;
    let assumptions = &scene.common().assumptions;
    let mut record = record(document, planned, assumptions, &defaults, seconds);
    record.ran.clone_from(&moment.solution.ran);
    for (tally, bore) in record.ran.solids.iter_mut().zip(&bores) {
        tally.absorb(&bore.ran);
    }
    match &of_one {
        Some((problem, _)) => record.sections = sections(scene.common(), problem)?,
        None => {
            let contacts = still.bearings.iter();
            let contacts = contacts.map(|b| hertz([&b.inner_contact, &b.outer_contact]));
            let speeds = scene.bearings.iter().map(|placed| frequencies(&placed.scene));
            record.sections.push(("hertz".into(), by_name(scene, contacts)?));
            record.sections.push(("frequencies".into(), by_name(scene, speeds)?));
        }
    }
    let sizes = by_name(scene, scene.bearings.iter().map(|placed| geometry(&placed.scene)))?;
    record.sections.push(("geometry".into(), sizes));
    let balls = moment.solution.bearings.iter().map(|bearing| &bearing.balls);
    let lives = scene.bearings.iter().zip(balls);
    let lives: Vec<_> = lives.map(|(placed, balls)| Life::of(&placed.scene, balls)).collect();
    let section = by_name(scene, lives.iter().map(Life::section))?;
    record.sections.push(("rating_life".into(), section));
    let mut settled = Vec::with_capacity(housings.len());
    for ((housing, bore), state) in housings.into_iter().zip(&bores).zip(&moment.solution.seats) {
        let own = Settled::new(housing, bore, state);
        let model = &own.housing.setup.model;
        let mut of_housing = of_solid::of_equilibrium(model, &own.displacement, &own.stress);
        of_housing.extend(of_solid::of_contact_nodes(state));
        warnings.extend(of_housing.into_iter().map(|of| of.named(&own.housing.before())));
        own.record(bore, moment, &mut record)?;
        settled.push(own);
    }
    let to_ground = match (&of_one, &settled[..]) {
        (Some(_), [one]) => {
            let slides = one.housing.scene.housing.axial == Axial::Free;
            stiffness_to_ground(still, &moment.solution, slides)
        }
        _ => None,
    };
    if let Some(matrix) = &to_ground {
        record.sections.push(("stiffness_to_ground".into(), stiffness_section(matrix)?));
    }
    record.sections.push(("warnings".into(), json!(warnings)));
    if let Some(ratio) = &inertia {
        record.sections.push(("inertia".into(), ratio.section()?));
    }
    let Equilibrium { still, mut moment, .. } = found;
    if of_one.is_none() {
        moment.solution = readable(lists.assembly()?, &still, &moment.solution);
    }
    let StaticAssembly { bodies, bearings, connections, shafts, .. } = still;
    let assembly = StaticAssembly { bodies, bearings, connections, shafts, seats: Vec::new() };
    let names = scene.bearings.iter().map(name_of).collect();
    Ok(Found {
        scene,
        names,
        assembly,
        moment,
        of_one,
        lives,
        warnings,
        inertia,
        settled,
        to_ground,
        record,
    })
}

/// Section of each bearing under its name; that of a single one without a name.
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

impl Found<'_> {
    fn text(&self, document: &Document) -> Fallible<String> {
        let mut of_housings: String = self.settled.iter().map(Settled::text).collect();
        if let Some(matrix) = &self.to_ground {
            of_housings += &table::ground_stiffness(matrix);
        }
        let solution = &self.moment.solution;
        let mut text = String::new();
        for note in self.settled.iter().flat_map(|settled| settled.housing.notes()) {
            text += &format!("note: {note}\n");
        }
        let lives = self.lives.iter().map(|life| life.as_ref().map_or(String::new(), Life::text));
        text += &match &self.of_one {
            Some((_, solution)) => {
                table::render(solution, &lives.collect::<String>(), &of_housings, &self.warnings)
            }
            None => {
                let bearings: Vec<_> = self.names.iter().copied().zip(lives).collect();
                table::render_assembly(
                    &self.assembly,
                    &bearings,
                    solution,
                    &of_housings,
                    &self.warnings,
                )
            }
        };
        if !self.settled.is_empty() {
            let EquilibriumAt { contact_changes, residual, .. } = self.moment;
            text += &format!(
                "{} iterations, {contact_changes} changes of contact, relative residual {residual:.1e}\n",
                solution.iterations
            );
        }
        for (placed, name) in self.scene.bearings.iter().zip(&self.names) {
            let of = placed.name.as_ref().map_or(String::new(), |_| format!("{name}: "));
            text += &format!("{of}{}\n", frequency_line(&placed.scene)?);
        }
        if let Some(ratio) = &self.inertia {
            text += &format!("note: inertia left out: {}\n", ratio.text());
        }
        if document.is_given("output.plots")
            && self.scene.common().plots.iter().any(|plot| *plot != Plot::LoadZone)
            && (self.of_one.is_none() || !self.settled.is_empty())
        {
            text += ONE_BEARING;
        }
        Ok(text)
    }

    /// Draws the pictures; returns their files, and a warning for each that could not be drawn.
    fn draw(&self, folder: &Path) -> Fallible<(Vec<PathBuf>, Vec<Warning>)> {
        let common = self.scene.common();
        if let Some((problem, solution)) = &self.of_one {
            let mut drawn = common.clone();
            // The other plots move the balls, and with them the outer race.
            drawn.plots.retain(|plot| self.settled.is_empty() || *plot == Plot::LoadZone);
            return pictures::write(folder, &drawn, problem, solution);
        }
        let mut written = Vec::new();
        if common.plots.contains(&Plot::LoadZone) {
            let title = common.title.clone().unwrap_or_else(|| "Bearings".into());
            let bearings = self.scene.bearings.iter().zip(&self.names);
            for ((placed, name), state) in bearings.zip(&self.moment.solution.bearings) {
                let path = folder.join(format!("load_zone_{name}.svg"));
                let (heading, geometry) = (format!("{title}: {name}"), &placed.scene.geometry);
                let zone = LoadZone::new(heading, geometry, &state.balls);
                write_atomic(&path, load_zone(&zone)?.as_bytes())?;
                written.push(path);
            }
        }
        Ok((written, Vec::new()))
    }

    /// Summary and tables.
    ///
    /// # Errors
    /// A value that is not finite, a file that cannot be written.
    pub fn write(&self, folder: &Path, record: &RunRecord) -> Result<Vec<PathBuf>, ResultsError> {
        match &self.of_one {
            Some((_, solution)) => write_static_results(folder, solution, record),
            None => {
                let Found { names, assembly, moment, .. } = self;
                write(folder, &Solved { assembly, names, solution: &moment.solution }, record)
            }
        }
    }
}

struct Settled {
    housing: Housing,
    seat: SeatRow,
    nodes: Vec<BoreNodeState>,
    displacement: Vec<Vec3>,
    stress: Stresses,
    state: BoreState,
    /// Position of the race in the global frame, m and rad.
    place: [f64; 5],
}

impl Settled {
    fn new(housing: Housing, bore: &CondensedBore, state: &BoreState) -> Settled {
        let model = &housing.setup.model;
        let displacement = bore.displacement(&state.loads);
        Settled {
            seat: SeatRow::of_equilibrium(bore, state),
            nodes: condensed_nodes(model, bore, state),
            stress: stresses(model, &displacement),
            state: state.clone(),
            place: bore.race(&state.pose),
            displacement,
            housing,
        }
    }

    /// Adds its sections to the record: a single housing's at the top level, others under their names.
    fn record(
        &self,
        bore: &CondensedBore,
        moment: &EquilibriumAt,
        record: &mut RunRecord,
    ) -> Fallible<()> {
        let Settled { housing, displacement, .. } = self;
        let mut equilibrium = equilibrium_section(&housing.setup, bore, &self.state, displacement)?;
        let fields = field_sections(&housing.built, displacement, &self.stress)?;
        let Some(name) = &housing.name else {
            equilibrium["solver"] = solver_section(moment)?;
            record.sections.push(("housing".into(), equilibrium));
            record.sections.extend(fields);
            return Ok(());
        };
        let mut section = Map::new();
        for (column, value) in seat_columns("").iter().zip(self.seat.values()) {
            section.insert(column.name.clone(), quantity(&column.name, value, &column.unit)?);
        }
        section.insert("housing".into(), equilibrium);
        section.extend(fields);
        match record.sections.iter_mut().find(|(name, _)| name == "housings") {
            Some((_, of_all)) => of_all[name] = Value::Object(section),
            None => record.sections.push(("housings".into(), json!({ name: section }))),
        }
        Ok(())
    }

    fn text(&self) -> String {
        let Settled { housing, seat, place, state, .. } = self;
        let von_mises = self.stress.cell_von_mises.iter().copied().fold(0.0, f64::max);
        let of = housing.before();
        let mut text = format!("\n{of}outer race      displacement, tilt      housing load\n");
        let loads = [seat.force[1], seat.force[2], seat.moment[1], seat.moment[2]];
        for (i, name) in POSE_NAMES.iter().enumerate() {
            let (value, unit, load_unit) = if i < 2 {
                (1e6 * place[1 + i], "um ", "N")
            } else {
                (place[1 + i].to_degrees(), "deg", "N m")
            };
            let _ =
                writeln!(text, "  {name:<10} {value:>16.6} {unit} {:>18.6} {load_unit}", loads[i]);
        }
        let stiffness = |i: usize| 1e-6 * state.stiffness[(i, i)];
        let _ = writeln!(
            text,
            "housing stiffness {:.4} N/um along y, {:.4} N/um along z\n\
             {} of {} bore nodes in contact, penetration up to {:.6} um, pressure up to {:.4} MPa, von Mises \
             stress up to {:.4} MPa\n\
             this pressure is {PEAK_PRESSURE}",
            stiffness(0),
            stiffness(1),
            seat.touching,
            state.loads.len(),
            1e6 * seat.deepest,
            1e-6 * seat.peak_pressure,
            1e-6 * von_mises
        );
        text
    }

    /// Writes fields and the table of bore nodes; returns the files.
    fn write(&self, folder: &Path) -> Fallible<Vec<PathBuf>> {
        let fields = folder.join(self.fields_file());
        let mesh = &self.housing.built.mesh;
        write_fields(&fields, mesh, &self.displacement, None, &self.stress, Some(&self.nodes))?;
        let table = folder.join(self.housing.bore_file());
        bore_series(&self.nodes)?.write_csv(&table)?;
        Ok(vec![fields, table])
    }

    fn fields_file(&self) -> String {
        file_name(self.housing.name.as_deref().unwrap_or("fields"), 0)
    }
}

/// Finds the equilibrium, prints it, and writes it to a folder unless `--dry` is given.
pub fn run(asked: &Asked, scene: &AssemblyScene, read: f64) -> CommandResult {
    let folder = asked.folder(Writes::Statics)?;
    let found = find_equilibrium(asked.document, scene, read)?;
    // Printed first, so that an error in a file loses no result.
    print(&found.text(asked.document)?)?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    remove_earlier(&folder)?;
    let start = Instant::now();
    let mut written = found.write(&folder, &found.record)?;
    for housing in &found.settled {
        written.extend(housing.write(&folder)?);
    }
    if !found.settled.is_empty() {
        let files: Vec<_> = found.settled.iter().map(|of| (0.0, of.fields_file())).collect();
        written.push(write_list(&folder, &files)?);
    }
    let (pictures, warnings) = found.draw(&folder)?;
    written.extend(pictures);
    print(&lines(&warnings))?;
    let mut record = found.record.clone();
    record.seconds.push(("plots".into(), start.elapsed().as_secs_f64()));
    if let Some((_, all)) = record.sections.iter_mut().find(|(name, _)| name == "warnings") {
        *all = json!([&found.warnings[..], &warnings].concat());
    }
    found.write(&folder, &record)?;
    print(&format!("wrote {} files to {}\n", written.len(), folder.display()))?;
    Ok(Outcome::Done)
}
