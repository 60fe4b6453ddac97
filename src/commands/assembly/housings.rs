//! Flexible housings of several bearings: meshes, bores, shapes, and what they add to the lists.

use super::Fallible;
use crate::commands::housed::{self, reduced::reduction};
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::output::session::{HousedParts, Motion};
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::housing::{HousedScene, HousingMethod};
use bearing_dynamics::solver::dynamics::assembly::{Assembly, Body};
use bearing_dynamics::solver::dynamics::model::Drive;
use bearing_dynamics::solver::dynamics::run::Start;
use bearing_dynamics::solver::housing::bore_equilibrium::Fit;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::housing::exchange::SolidPart;
use bearing_dynamics::solver::housing::reduce::Reduction;
use bearing_dynamics::solver::housing::reduced_start::{self, add_housing, put_in_equilibrium};
use bearing_dynamics::solver::plan::tally::Tally;
use bearing_dynamics::solver::plan::{Item, motion};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::static_assembly::StaticAssembly;
use std::error::Error;
use std::time::Instant;

/// A housing and the bearing that it holds.
pub struct Housing {
    /// Index of the bearing.
    pub bearing: usize,
    /// Of the bearing; `None` for the only one.
    pub name: Option<String>,
    /// Both alone, where they stand.
    pub scene: HousedScene,
    pub mesh: housed::Prepared,
}

impl Housing {
    /// An error of this housing, under its name.
    fn named(&self, error: &dyn std::fmt::Display) -> Box<dyn Error> {
        match &self.name {
            Some(name) => format!("housing {name}: {error}").into(),
            None => error.to_string().into(),
        }
    }

    /// "housing left".
    pub fn of(&self) -> String {
        let of = self.name.as_ref().map_or(String::new(), |name| format!(" {name}"));
        format!("housing{of}")
    }

    /// Mesh and seat, a line.
    pub fn text(&self) -> String {
        format!(
            "  {:<22} {}; {}; bore {}\n",
            self.of(),
            housed::mesh_text(&self.mesh.built),
            housed::echo::method(&self.scene),
            housed::shape_text(&self.mesh.setup)
        )
    }
}

/// Reads or makes the meshes.
pub fn prepare(document: &Document, scene: &AssemblyScene) -> Fallible<Vec<Housing>> {
    let mut housings = Vec::new();
    for (bearing, placed) in scene.bearings.iter().enumerate() {
        let Some(own) = placed.housed() else { continue };
        let mesh = match &placed.name {
            Some(name) => housed::prepare(&document.scoped(name), &own)
                .map_err(|error| format!("{error} (housing {name})"))?,
            None => housed::prepare(document, &own)?,
        };
        if own.housing.method != HousingMethod::Explicit {
            housed::refuse_moved_supports(document, &own)?;
        }
        let housing = Housing { bearing, name: placed.name.clone(), scene: own, mesh };
        if housing.scene.housing.method != HousingMethod::Explicit {
            housed::refuse_free(&housing.mesh).map_err(|error| housing.named(&error))?;
        }
        housings.push(housing);
    }
    Ok(housings)
}

/// Items of the housings of a run: what acts on them, how they move, and the races in explicit ones.
pub fn items(scene: &AssemblyScene, housings: &[Housing], assembly: &Assembly) -> Vec<Item> {
    let mut items = Vec::new();
    for (index, housing) in housings.iter().enumerate() {
        let bearing = &assembly.bearings[housing.bearing];
        let seat = (bearing.mounts[1].body, housing.name.as_deref());
        items.extend(housed::plan::solid_items(
            &housing.scene,
            &housing.mesh,
            index,
            &housing.of(),
        ));
        if scene.housing_method() == Some(HousingMethod::Explicit) {
            items.extend(motion::stepped_seat(assembly, index, seat));
        }
    }
    items
}

/// Each condensed onto its bore.
pub fn condensed(housings: &[Housing]) -> Fallible<Vec<CondensedBore>> {
    let each = housings.iter();
    each.map(|h| housed::condensed(&h.mesh).map_err(|error| h.named(&error))).collect()
}

/// What is in equilibrium at t = 0, races in their bores and grown into their fits.
pub fn statics<'b>(
    scene: &AssemblyScene,
    housings: &[Housing],
    bores: &'b [CondensedBore],
) -> Fallible<StaticAssembly<'b>> {
    let mut still: StaticAssembly<'b> = scene.statics()?;
    for (housing, bore) in housings.iter().zip(bores) {
        housed::add_seat(&mut still, housing.bearing, &housing.scene, &housing.mesh, bore);
    }
    Ok(still)
}

/// Housings reduced to shapes, and the assembly that they are part of.
pub struct Reduced {
    pub assembly: Assembly,
    /// One for each housing.
    pub reductions: Vec<Reduction>,
    /// Wall time that condensing, and finding shapes and start took, s.
    pub seconds: [f64; 2],
    /// How often each stage of condensing ran, one for each housing.
    pub ran: Vec<Tally>,
}

/// Condenses and reduces the housings, and finds the equilibrium that a run starts from.
pub fn reduced(scene: &AssemblyScene, housings: &[Housing]) -> Fallible<Reduced> {
    let mut assembly = scene.assembly()?;
    let force = largest_force(&assembly);
    let (mut reductions, mut bores) = (Vec::new(), Vec::new());
    let mut seconds = [0.0; 2];
    for housing in housings {
        let bearing = &assembly.bearings[housing.bearing];
        let found = reduction(&housing.scene, &housing.mesh, bearing, force)?;
        let body = bearing.mounts[1].body;
        let (setup, own) = (&housing.mesh.setup, &housing.scene);
        let penalty = own.housing.penalty;
        let of = &found.reduction;
        add_housing(&mut assembly, body, of, &found.bore, setup.radius(own), penalty);
        if let (Some(seat), Some(name)) = (assembly.seats.last_mut(), &housing.name) {
            seat.label = Some(name.clone());
            seat.name = format!("the bore of housing {name}");
        }
        seconds = [seconds[0] + found.seconds[0], seconds[1] + found.seconds[1]];
        reductions.push(found.reduction);
        bores.push(found.bore);
    }
    let start = Instant::now();
    if scene.run().is_none_or(|run| run.options.start != Start::Nominal) {
        let of = |((housing, reduction), bore): ((&Housing, _), _)| {
            let (setup, own) = (&housing.mesh.setup, &housing.scene);
            let radius = setup.radius(own).value(0.0);
            let fit = Fit { radius, ..setup.fit(own) };
            reduced_start::Housing { reduction, bore, fit, penalty: own.housing.penalty }
        };
        let mut parts: Vec<_> =
            housings.iter().zip(&reductions).zip(bores.iter_mut()).map(of).collect();
        put_in_equilibrium(&mut assembly, &mut parts)?;
    }
    seconds[1] += start.elapsed().as_secs_f64();
    let ran = bores.iter().map(|bore| bore.ran).collect();
    Ok(Reduced { assembly, reductions, seconds, ran })
}

/// Displacements (m) and velocities (m/s) of all nodes of a reduced housing now.
pub fn fields(reduced: &Reduced, motion: &Motion, index: usize) -> Option<[Vec<Vec3>; 2]> {
    let Motion::Bearing(simulation) = motion else { return None };
    let (gone, speeds) = simulation.system.shapes_of(&simulation.state, index);
    Some([gone, speeds].map(|of| reduced.reductions[index].displacement(of)))
}

/// Bodies, bearings, solids and seats for explicit steps.
pub fn explicit(
    scene: &AssemblyScene,
    housings: &[Housing],
    threads: usize,
) -> Fallible<HousedParts> {
    let mut assembly = scene.assembly()?;
    let run = scene.run().ok_or("a run needs `end` in [numerics]")?;
    let in_bores: Vec<_> = housings.iter().map(|h| (h.bearing, &h.scene, &h.mesh)).collect();
    let mut start = housed::start_of_steps(&mut assembly, &in_bores)?.into_iter();
    let first = housings.first().ok_or("no housing")?;
    let mut seats = Vec::with_capacity(housings.len());
    let mut solids = Vec::with_capacity(housings.len());
    for (index, housing) in housings.iter().enumerate() {
        let body = assembly.bearings[housing.bearing].mounts[1].body;
        let seat = housed::seat(&housing.scene, &housing.mesh.setup, body, index);
        seats.push(bearing_dynamics::solver::housing::seat::Seat {
            name: housing.name.clone(),
            ..seat
        });
        let model = housing.mesh.setup.model.clone();
        let name = housing.name.clone();
        solids.push(match start.next() {
            Some(displacement) => SolidPart { name, model, displacement },
            None => SolidPart::undeformed(name, model),
        });
    }
    let options = housed::exchange_options(&first.scene, run);
    Ok(HousedParts { assembly, solids, seats, options, threads })
}

/// Sum of what acts on all bodies across their axes, each at its largest, N.
fn largest_force(assembly: &Assembly) -> f64 {
    let of = |body: &Body| {
        let Some(race) = body.driven() else { return 0.0 };
        let load = |i: usize| match &race.drives[i] {
            Drive::Load(load) => largest(load),
            Drive::Motion(_) => 0.0,
        };
        let turning = body.rotating_load.as_ref().map_or(0.0, |load| largest(&load.force));
        let [_, g_y, g_z] = assembly.gravity;
        load(1).hypot(load(2)) + turning + race.inertia.mass * g_y.hypot(g_z)
    };
    assembly.bodies.iter().map(of).sum()
}

/// Largest size over all times.
fn largest(profile: &Profile) -> f64 {
    let corners = profile.corners();
    let times = corners.iter().copied().chain([0.0]);
    let most = times.map(|time| profile.value(time).abs()).fold(0.0, f64::max);
    match profile {
        Profile::Harmonic { mean, amplitude, .. } => mean.abs() + amplitude.abs(),
        Profile::HalfSine { base, peak, .. } => most.max((base + peak).abs()),
        _ => most,
    }
}
