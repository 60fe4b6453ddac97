//! Summary of a housing: fit, equilibrium, inertia and coupling steps.

use super::{Part, solid::limit_section};
use crate::equilibrium::quasi_static_sequence::EquilibriumAt;
use crate::kinematics::vec3::Vec3;
use crate::motion::coupling::CoupledMotion;
use crate::output::recorder::seat::{SeatRow, prefix};
use crate::output::results::quantity;
use crate::output::session::Motion;
use crate::reduction::component_modes::CutOff;
use crate::scene::build::excitations::Excitation;
use crate::scene::build::housing::HousingSetup;
use crate::solids::bore_equilibrium::{BoreState, POSE_NAMES};
use crate::solids::condensation::{CondensedBore, geometry_error};
use serde_json::{Map, Value, json};

/// Note on the largest pressure of bore nodes. It differed by 24 % between two meshes of housings of 2.4.2 whose
/// displacements differ by 0.7 %.
pub const PEAK_PRESSURE: &str = "from a single node; it can differ by tens of per cent between meshes whose displacements differ by 1 %";

/// Fit, width and mesh, the shape of the bore, and a caution if the shape affects results.
///
/// # Errors
/// A value that is not finite.
pub fn seat_section(setup: &HousingSetup) -> Part {
    let mut section = json!({
        "bore_radius": quantity("bore radius", setup.bore_radius, "m")?,
        "bore_out_of_round": quantity("out-of-roundness", setup.out_of_round, "m")?,
        "bore_off_centre": quantity("distance of the axes", setup.off_centre, "m")?,
        "interference": quantity("interference", setup.interference, "m")?,
        "width": quantity("width", setup.width, "m")?,
        "bore_nodes": setup.nodes.len(),
        "peak_pressure_note": PEAK_PRESSURE,
    });
    if let Some(caution) = &setup.caution {
        section["caution"] = json!(caution);
    }
    Ok(section)
}

/// Modes of a reduced housing, and the errors of truncation.
///
/// # Errors
/// A value that is not finite.
pub fn reduced_section(cut_off: &CutOff, excitations: &[Excitation]) -> Part {
    let mut section = json!({
        "natural_modes": cut_off.natural,
        "static_correction_modes": cut_off.patterns,
        "weight_and_loads": cut_off.own,
        "bore_nodes": cut_off.nodes,
        "masses": "lumped",
        "modes_to": quantity("frequency", cut_off.modes_to, "Hz")?,
        "lowest_frequency": quantity("frequency", cut_off.lowest, "Hz")?,
        "highest_frequency": quantity("frequency", cut_off.highest, "Hz")?,
        "compliance_left_out": quantity("part", cut_off.static_left_out, "1")?,
        "compliance_without_natural_shape": quantity("part", cut_off.by_patterns, "1")?,
    });
    if cut_off.first_left_out.is_finite() {
        section["first_frequency_left_out"] = quantity("frequency", cut_off.first_left_out, "Hz")?;
        let mut driven = Map::new();
        for excitation in excitations {
            let error = cut_off.dynamic_error(excitation.frequency);
            driven.insert(
                excitation.what.clone(),
                json!({
                    "frequency": quantity("frequency", excitation.frequency, "Hz")?,
                    "error_at_most": quantity("error", error, "1")?,
                }),
            );
        }
        section["excitation_errors"] = driven.into();
    }
    Ok(section)
}

/// Equilibrium of a condensed housing.
///
/// # Errors
/// A value that is not finite.
pub fn equilibrium_section(
    setup: &HousingSetup,
    bore: &CondensedBore,
    state: &BoreState,
    displacement: &[Vec3],
) -> Part {
    let sizes = bore.sizes;
    let seat = SeatRow::of_equilibrium(bore, state);
    let names = ["x", "y", "z", "tilt_y", "tilt_z"];
    let mut outer = Map::new();
    for (i, (name, value)) in names.iter().zip(bore.race(&state.pose)).enumerate() {
        let (value, unit) = if i < 3 { (value, "m") } else { (value.to_degrees(), "deg") };
        outer.insert((*name).into(), quantity(name, value, unit)?);
    }
    let mut stiffness = Map::new();
    for (i, row) in POSE_NAMES.iter().enumerate() {
        let mut entries = Map::new();
        for (j, column) in POSE_NAMES.iter().enumerate() {
            let unit = match (i < 2, j < 2) {
                (true, true) => "N/m",
                (true, false) => "N/rad",
                (false, true) => "N m/m",
                (false, false) => "N m/rad",
            };
            let value = state.stiffness[(i, j)];
            entries.insert((*column).into(), quantity("stiffness", value, unit)?);
        }
        stiffness.insert((*row).into(), Value::Object(entries));
    }
    let vector = |of: Vec3, unit: &str| -> Part {
        let part = |i: usize| quantity("component", of[i], unit);
        Ok(json!({ "x": part(0)?, "y": part(1)?, "z": part(2)? }))
    };
    let geometry = geometry_error(bore, displacement, &state.pose);
    Ok(json!({
        "seat": seat_section(setup)?,
        "outer_race": outer,
        "force_on_outer": vector(seat.force, "N")?,
        "moment_on_outer": vector(seat.moment, "N m")?,
        "support_stiffness": stiffness,
        "nodes_touching": seat.touching,
        "deepest_penetration": quantity("penetration", seat.deepest, "m")?,
        "peak_pressure": quantity("pressure", seat.peak_pressure, "Pa")?,
        "energy": {
            "housing": quantity("energy", state.elastic_energy, "J")?,
            "seat": quantity("energy", state.contact_energy, "J")?,
        },
        "condensed": {
            "unknowns": sizes.unknowns,
            "bore_nodes": sizes.bore,
            "kept": sizes.kept,
            "beyond_race_width": sizes.beside,
            "outside_contact_range": sizes.outside_range,
            "asymmetry": quantity("asymmetry", bore.asymmetry, "1")?,
            "error_of_fixed_normals": quantity("geometry error", geometry, "m")?,
        },
    }))
}

/// Effort of the solver for an equilibrium.
///
/// # Errors
/// A value that is not finite.
pub fn solver_section(moment: &EquilibriumAt) -> Part {
    Ok(json!({
        "iterations": moment.solution.iterations,
        "contact_changes": moment.contact_changes,
        "residual": quantity("residual", moment.residual, "1")?,
    }))
}

/// Method by which a run models its housings; `None` without a housing.
pub(super) fn method(motion: &Motion) -> Option<&'static str> {
    match motion {
        Motion::Bearing(simulation) => {
            (!simulation.system.assembly.seats.is_empty()).then_some("reduced")
        }
        Motion::Solid(_) | Motion::Rubber(_) => None,
        Motion::Housed(housed) => housed.seats().next().map(|_| "explicit"),
        Motion::QuasiStaticSequence(_) => Some("quasi-static"),
    }
}

/// Time steps of a coupled run. Keys of a named solid or fit start with its name.
pub(super) fn step(housed: &CoupledMotion) -> Part {
    let bodies = &housed.simulation;
    let mut section = Map::new();
    section.insert("coupling_step".into(), quantity("coupling_step", housed.coupling_step, "s")?);
    for part in &housed.solids {
        let (of, solid) = (prefix(&part.name), &part.solid);
        let kind = part.kind();
        section.insert(format!("{of}{kind}"), quantity("step", solid.step_size, "s")?);
        section.insert(format!("{of}{kind}_steps_per_coupling_step"), json!(part.steps));
    }
    for bushing in &housed.bushings {
        let name = &bushing.name;
        section.insert(format!("{name}_bushing"), quantity("step", bushing.step, "s")?);
        section.insert(format!("{name}_bushing_steps_per_coupling_step"), json!(bushing.steps));
    }
    let most = bodies.step_size.min(housed.coupling_step);
    section.insert("bearing_at_most".into(), quantity("step", most, "s")?);
    for part in &housed.solids {
        let limit = limit_section(&part.solid.limit, &part.solid.model.labels)?;
        section.insert(format!("{}{}_limit", prefix(&part.name), part.kind()), limit);
    }
    Ok(section.into())
}

pub(super) fn work(housed: &CoupledMotion) -> Value {
    let mut section = Map::new();
    section.insert("windows".into(), json!(housed.exchanges));
    for part in &housed.solids {
        let of = prefix(&part.name);
        section.insert(format!("{of}{}_steps", part.kind()), json!(part.solid.steps));
    }
    for bushing in &housed.bushings {
        section.insert(format!("{}_bushing_steps", bushing.name), json!(bushing.steps_done()));
    }
    section.insert("bearing_steps".into(), json!(housed.simulation.steps));
    for part in &housed.solids {
        let elements = part.solid.work.elements;
        section.insert(format!("{}elements_evaluated", prefix(&part.name)), json!(elements));
    }
    let evaluations = housed.simulation.system.work.evaluations;
    section.insert("bearing_evaluations".into(), json!(evaluations));
    for seat in housed.seats() {
        let of = prefix(&seat.seat.name);
        let (tested, outside_range) = seat.counts();
        section.insert(format!("{of}bore_nodes_in_reach"), json!(tested));
        section.insert(format!("{of}bore_nodes_outside_contact_range"), json!(outside_range));
        section.insert(format!("{of}bore_node_tests"), json!(seat.tested));
        section.insert(format!("{of}sorts_by_reach"), json!(seat.sorts));
    }
    section.into()
}
