//! The rotor in explicit steps of all its elements against the same elements reduced to sections.

use bearing_dynamics::output::series::Series;
use bearing_dynamics::output::session::{HousedParts, Motion, Parts, Session};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::shaft::take_shafts;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housed_shaft::Shaft;
use crate::motion::{
    ROTOR_IN_ELEMENTS, ROTOR_IN_PILLOW_BLOCKS, changed_scene, column, done, request,
};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "rotor_in_elements_4_2",
    title: "The rotor in explicit steps of all its elements, against the same elements reduced",
    section: "4.2.2, 4.2.3",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

type Change<'c> = (&'c str, &'c str);

const FOUR: &str = "order = 1, method = \"explicit\", longest_layer = \"5 mm\"";
const LOAD: &str = "load = [{ at = \"0 mm\", y = { half_sine = \"200 N\", duration = \"3 ms\" }, z = { smooth_ramp = [\"0 N\", \"-600 N\"], duration = \"2 ms\" } }]";
const DISCS: &str = "disc = [{ at = \"-200 mm\", mass = \"60 g\", axial = \"1.8e-5 kg m^2\", transverse = \"1e-5 kg m^2\" }, { at = \"200 mm\", mass = \"60 g\", axial = \"1.8e-5 kg m^2\", transverse = \"1e-5 kg m^2\" }]";
const EXPLICIT: Change = (", method = \"explicit\"", "");

/// A run: the middle's way, and what the energies of all parts leave unaccounted for.
struct Way {
    y: Vec<f64>,
    z: Vec<f64>,
    /// Over what the loads have done at most; `None` of a reduced run.
    residual: Option<f64>,
    elements: u64,
    steps: u64,
}

impl Way {
    fn of(series: &Series, session: &Session) -> Result<Way, CaseError> {
        let work = series.column("shaft_work_loads").map(|_| -> Result<f64, CaseError> {
            let parts = ["shaft_work_loads", "shaft_work_unbalance"];
            let parts = parts.map(|name| column(series, name));
            let [loads, unbalance] = parts;
            let both: Vec<f64> =
                loads?.iter().zip(unbalance?).map(|(a, b)| (a + b).abs()).collect();
            let left =
                largest(column(series, "energy_coupled_residual")?.into_iter().map(f64::abs));
            Ok(left / largest(both))
        });
        let (mut elements, mut steps) = (0, 0);
        if let Motion::Housed(housed) = &session.motion {
            for part in housed.solids.iter().filter(|part| part.shaft.is_some()) {
                elements += part.solid.work.elements;
                steps += part.solid.steps;
            }
        }
        let [y, z] = ["y", "z"].map(|axis| column(series, &format!("shaft_mid_{axis}")));
        Ok(Way { y: y?, z: z?, residual: work.transpose()?, elements, steps })
    }

    fn size(&self) -> f64 {
        largest(self.y.iter().zip(&self.z).map(|(y, z)| y.hypot(*z)))
    }

    /// Largest distance from another way at the same time, over its size.
    fn off(&self, other: &Way) -> f64 {
        let here = self.y.iter().zip(&self.z);
        let there = other.y.iter().zip(&other.z);
        let apart = here.zip(there).map(|((y, z), (a, b))| (y - a).hypot(z - b));
        if self.y.len() == other.y.len() { largest(apart) / other.size() } else { f64::NAN }
    }
}

/// With fixed outer races.
fn alone(scene: &AssemblyScene) -> Result<Way, CaseError> {
    let (request, mut assembly) = (request(scene)?, scene.assembly()?);
    let shafts = take_shafts(scene, &mut assembly)?;
    let session = if shafts.is_empty() {
        done(assembly, &request)?
    } else {
        let shafts = shafts.into_iter().map(|shaft| shaft.part).collect();
        let parts = HousedParts::without_housings(assembly, shafts, Vec::new(), &request.options);
        done(Parts::Housed(Box::new(parts)), &request)?
    };
    Way::of(&session.series()?, &session)
}

fn both(changes: &[Change]) -> Result<[Way; 2], CaseError> {
    let explicit = changed_scene(ROTOR_IN_ELEMENTS, changes)?;
    // A reduced shaft is one of revolution: counterweights would put it out of balance.
    let own = changes.iter().filter(|(from, _)| *from != WEIGHTS).copied();
    let is_stiff = changes.iter().any(|(_, to)| to.contains(STIFF));
    let soft = is_stiff.then_some((STIFF, ""));
    let own: Vec<Change> = own.chain([EXPLICIT]).chain(soft).collect();
    Ok([alone(&explicit)?, alone(&changed_scene(ROTOR_IN_ELEMENTS, &own)?)?])
}

/// Springs of which a reduced shaft has none.
const STIFF: &str = ", race_stiffness = \"4e10 N/m\"";
const WEIGHTS: &str = "probe =";

/// Unbalances along a shaft of such a mesh that balance the masses of its cells.
fn counterweights(mesh: &str) -> Result<String, CaseError> {
    let scene = changed_scene(ROTOR_IN_ELEMENTS, &[(FOUR, mesh)])?;
    let shafts = take_shafts(&scene, &mut scene.assembly()?)?;
    let [[y, z], _] = shafts[0].imbalance();
    let (size, angle) = (y.hypot(z) / 4.0, (-z).atan2(-y).to_degrees());
    let weight = |at: i32| {
        format!("{{ at = \"{at} mm\", size = \"{size:e} kg m\", angle = \"{angle} deg\" }}")
    };
    let weights = [-150, -50, 50, 150].map(weight).join(", ");
    Ok(format!("unbalance = [{weights}]\nprobe ="))
}

const SHARED: &str = "the same elements condensed onto sections: consistent masses, gyroscopic terms, no spring under the race";

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "race_damping",
        "The damping between race and section is \"small\" and has no figure.",
        "200 N s/m",
    );
    context.assumption(
        "race_turns",
        "The source gives a race the section's orientation; here rotational springs, with the printed stiffness on an arm of the shaft's diameter, prescribe it.",
        "1.8e6 N m/rad",
    );
    let ten = |layer: &str, around: &str| {
        format!("order = 2, method = \"explicit\", longest_layer = \"{layer}\", around = {around}")
    };
    let coarse = ten("13 mm", "8");
    let balanced = counterweights(&coarse)?;
    let stiff = format!("{coarse}{STIFF}");
    let unbalanced = "unbalance = [{ at = \"0 mm\", size = \"1e-3 kg m\", angle = \"30 deg\" }]";
    let rising = "speed = { smooth_ramp = [\"0 rpm\", \"10000 rpm\"], duration = \"4 ms\" }";
    let ways = [
        ("four_nodes", "four-node elements, 6000 rpm, load", vec![]),
        ("ten_nodes", "ten-node elements, 13 mm, 8 around", vec![(FOUR, coarse.as_str())]),
        (
            "ten_nodes_balanced",
            "the same, their masses balanced by unbalances",
            vec![(FOUR, coarse.as_str()), (WEIGHTS, balanced.as_str())],
        ),
        (
            "ten_nodes_stiff",
            "the same on springs of 4e10 N/m",
            vec![(FOUR, stiff.as_str()), (WEIGHTS, balanced.as_str())],
        ),
        (
            "unbalance",
            "four-node elements, an unbalance, 0 to 10 000 rpm in 4 ms",
            vec![(LOAD, unbalanced), ("speed = \"6000 rpm\"", rising)],
        ),
    ];
    let mut rows = Vec::new();
    let mut errors = Vec::new();
    for (key, what, changes) in &ways {
        let [explicit, reduced] = both(changes)?;
        rows.push(row(what, &explicit, &reduced));
        errors.push(explicit.off(&reduced));
        judge(context, key, what, &explicit, &reduced);
    }
    // The reduced shaft is one of revolution: of the balanced run it is the same without the counterweights.
    context.check(
        Check::new(
            "mesh_is_out_of_balance",
            "ten-node elements balanced: that difference over the one of cells out of balance",
            "1",
            errors[2] / errors[1],
        )
        .consistency(1.0, "masses of the cells, 1.06e-5 kg m off the axis")
        .at_most(0.3, "0.4 % of the orbit are left, at rest as at speed"),
    );
    context.check(
        Check::new(
            "spring_gives_way",
            "that of balanced elements on springs of 4e10 N/m over the one on the printed 2e9 N/m",
            "1",
            errors[3] / errors[2],
        )
        .consistency(1.0, "the reduced shaft has its races on its sections without a spring")
        .at_most(0.4, "the couple of the cells and their lumped masses are left"),
    );
    let [explicit, reduced] = housed()?;
    let what = "four-node elements of shaft and both pillow blocks, 6000 rpm, load";
    rows.push(row(what, &explicit, &reduced));
    judge(context, "housed", what, &explicit, &reduced);
    context.table(
        "ways",
        "Explicit steps of all elements against the same elements reduced, over 5 ms",
        &["run", "orbit, µm", "apart", "residual over work", "steps", "elements evaluated"],
        rows,
    );
    Ok(())
}

fn row(what: &str, explicit: &Way, reduced: &Way) -> Vec<String> {
    vec![
        what.into(),
        format!("{:.3}", 1e6 * reduced.size()),
        format!("{:.2e}", explicit.off(reduced)),
        format!("{:.1e}", explicit.residual.unwrap_or(f64::NAN)),
        explicit.steps.to_string(),
        format!("{:.2e}", explicit.elements as f64),
    ]
}

fn judge(context: &mut CaseContext, key: &str, what: &str, explicit: &Way, reduced: &Way) {
    context.check(
        Check::new(
            &format!("{key}_orbit"),
            &format!("{what}: size of the orbit"),
            "µm",
            1e6 * explicit.size(),
        )
        .consistency(1e6 * reduced.size(), SHARED)
        .relative(1e-2, "asked for")
        .golden(GoldenTolerance::REORDERED),
    );
    context.check(
        Check::new(
            &format!("{key}_apart"),
            &format!("{what}: largest distance from each other, over the orbit"),
            "1",
            explicit.off(reduced),
        )
        .consistency(0.0, SHARED)
        .absolute(1e-2, "asked for"),
    );
    context.check(
        Check::new(
            &format!("{key}_ledger"),
            &format!("{what}: energy unaccounted for, over the work of loads"),
            "1",
            explicit.residual.unwrap_or(f64::NAN),
        )
        .closed_form(0.0, "stored, dissipated and transferred energy add up")
        .absolute(
            3e-4,
            "1e-3 is asked for; windows and steps of second order leave 2e-6 to 1.2e-4",
        ),
    );
}

/// Shaft and housings both ways. Races touch their bores from the start, without interference.
fn housed() -> Result<[Way; 2], CaseError> {
    let mesh = format!("mesh = {{ order = 1, longest_layer = \"5 mm\" }}\n{DISCS}");
    let common: [Change; 7] = [
        ("speed = \"1000 rpm\"", "speed = \"6000 rpm\""),
        ("damping = \"100 1/s\"", &mesh),
        ("load = [{ at = \"0 mm\", z = \"-3000 N\" }]", LOAD),
        ("fit = { radial = \"2.5 um\" }", "fit = { radial = \"0 um\" }"),
        ("end = \"2 ms\"", "end = \"5 ms\""),
        ("order = 2", "order = 1"),
        (
            "cells = { around = 16, radial = 1, axial = 1,",
            "cells = { around = 32, radial = 2, axial = 2,",
        ),
    ];
    let steps: [Change; 2] = [
        ("method = \"reduced\"", "method = \"explicit\""),
        ("{ order = 1, longest", "{ order = 1, method = \"explicit\", longest"),
    ];
    let scene = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &[&common[..], &steps].concat())?;
    let session = done(Parts::Housed(Box::new(scene.undeformed(1)?)), &scene.request()?)?;
    let explicit = Way::of(&session.series()?, &session)?;
    let scene = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &common)?;
    let session = done(scene.reduced()?, &scene.request()?)?;
    Ok([explicit, Way::of(&session.series()?, &session)?])
}
