//! Moment over tilt of the bearing of 3.4.5 with its outer race in a bonded bushing, relaxed.

use bearing_dynamics::assembly::lists::{Assembly, OUTER};
use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::equilibrium::initial::at_start;
use bearing_dynamics::members::body::{Drive, Rotation};
use bearing_dynamics::members::connection::SpringDashpot;
use bearing_dynamics::members::prony::bushing_spring;
use bearing_dynamics::mesh::generate::{Bushing, Part};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::rubber::sleeve::SleeveMotion;
use std::f64::consts::PI;

use crate::bearings::{DEEP_GROOVE, Lengths};
use crate::bushings::{
    BULK_RATIO, MODULUS, complex_shear, four_nodes, quarter, rubber, section, shear_over_modulus,
    spring_to_ground,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{moving, race};
use crate::oracles::bonded_bushing::{Motion, stiffness};
use crate::oracles::misalignment::baseline;

pub const CASE: Case = Case {
    id: "misalignment_on_bushing_3_4_5",
    title: "Moment of a tilted inner race, outer race in a bushing",
    section: "3.4.5, Tables 3.1, 3.5, 3.6 and 3.7",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const INTERFERENCE: Lengths = Lengths { clearance: -5e-6, ..DEEP_GROOVE };
const PHASE: f64 = 11.25;
/// Outside diameter and length of Table 3.5, m.
const DIAMETER: f64 = 71e-3;
const LENGTH: f64 = 20e-3;
/// Of the bushing, m; those of Table 3.6.
const THICKNESSES: [f64; 3] = [10e-3, 20e-3, 30e-3];
const CELLS: [usize; 3] = [20, 6, 4];
/// Where two digits are enough.
const COARSE: [usize; 3] = [12, 4, 3];
const GRADING: f64 = 2.0;
/// Of four-node elements, m.
const SIZES: [f64; 4] = [5e-3, 3.5e-3, 2.5e-3, 1.7e-3];

fn body(thickness: f64) -> Bushing {
    Bushing { inner_diameter: DIAMETER, thickness, length: LENGTH }
}

/// Of a relaxed bushing.
fn spring(thickness: f64, cells: [usize; 3]) -> Result<SpringDashpot, CaseError> {
    let mesh = quarter(&body(thickness), cells, GRADING)?;
    let material = rubber(MODULUS, 0.0, ChainPull::FiveTerms)?;
    Ok(bushing_spring(&mesh, Part::Quarter, &material, 1.0)?.law)
}

/// The bearing with its outer race on a spring to the ground.
fn on_spring(law: SpringDashpot, about_y: Drive) -> Result<Assembly, CaseError> {
    let mut problem = moving(&INTERFERENCE, PHASE.to_radians(), [0.0; 5], 0.0)?;
    problem.inner.drives[3] = about_y;
    problem.outer = Some(race([0.0; 5], Rotation::Speed(Profile::ZERO)));
    let mut assembly = problem.assembly();
    spring_to_ground(&mut assembly, law);
    Ok(assembly)
}

/// Tilts of inner and outer race, degrees.
fn tilts(law: &SpringDashpot, moment: f64) -> Result<[f64; 2], CaseError> {
    let assembly = on_spring(law.clone(), Drive::Load(Profile::Constant(moment)))?;
    let found = at_start(&assembly)?;
    Ok([0, OUTER].map(|body| found.coordinates[body][3].to_degrees()))
}

/// That holds a tilt of the inner race, N·m.
fn moment_at(law: &SpringDashpot, tilt: f64) -> Result<f64, CaseError> {
    let motion = Drive::Motion(Profile::Constant(tilt.to_radians()));
    Ok(at_start(&on_spring(law.clone(), motion)?)?.loads[0][3])
}

/// Of four-node elements with sides of about `size` m: linear elastic, with the rubber's shear and bulk modulus.
fn locked(thickness: f64, size: f64) -> Result<f64, CaseError> {
    let cells = |length: f64| ((length / size).round() as usize).max(1);
    let mesh =
        [cells(0.5 * PI * (DIAMETER + thickness)), 2 * cells(0.5 * thickness), cells(0.5 * LENGTH)];
    four_nodes(&body(thickness), mesh, shear_over_modulus() * MODULUS, SleeveMotion::Conical)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "bushing_of_3_4_5",
        "3.4.5 states neither the bushing's thickness, nor its length, nor how long the moment acts. Its inner diameter \
         is the bearing's outside, its length the bearing's, its thickness the first of Table 3.6, its rubber that of \
         Table 3.1, relaxed.",
        "H 10 mm, L 20 mm, relaxed",
    );
    context.assumption(
        "ball_radius_of_5_um_interference",
        "As of the fixed bearing, where the moment at 0.15° decided between two stated inputs.",
        "ball radius 5.9555 mm, stated as 5 µm",
    );
    let law = spring(THICKNESSES[0], CELLS)?;
    let exact = stiffness(
        section(&body(THICKNESSES[0])),
        Motion::Conical,
        complex_shear(0.0, 0.0),
        BULK_RATIO * MODULUS,
        6,
        3,
    )
    .re;
    context.check(
        Check::new("conical", "conical stiffness, H 10 mm", "N·m/rad", law.stiffness[4])
            .independent(exact, "axisymmetric polynomials of degree 6")
            .relative(0.005, "0.33 % found; cells across the wall and along it set it")
            .golden(GoldenTolerance::MIXED),
    );
    let fixed = baseline(PHASE);
    for (row, alone) in ROWS.iter().zip(fixed.tilt_degrees) {
        tilted(context, &law, row, alone)?;
    }
    context.check(
        Check::new("moment_0p15", "moment at 0.15° tilt", "N·m", moment_at(&law, 0.15)?)
            .published("moment_0p15")
            .under("bushing_of_3_4_5")
            .absolute(0.001, "one unit of the last printed digit")
            .golden(GoldenTolerance::MIXED)
            .explained(Explanation::new(
                "As the tilts: the published bushing is stiffer. By 0.15° less the bearing's own tilt it has 444 N·m/rad here and \
                 414 to 423 in Table 3.7.",
                MOMENT_OFF,
                0.003,
                &["conical", "locked_coarse", "locked_fine"],
            )),
    );
    beside(context)?;
    figure(context, &law)
}

/// A row of Table 3.7, and how far ours is above its inner and outer tilt, degrees.
struct Row {
    label: &'static str,
    moment: f64,
    above: [f64; 2],
}

const ROWS: [Row; 3] = [
    Row { label: "2p5", moment: 2.5, above: [0.1501, 0.1500] },
    Row { label: "5", moment: 5.0, above: [0.2974, 0.2971] },
    Row { label: "10", moment: 10.0, above: [0.5756, 0.5711] },
];
/// By how much ours is below the published moment, N·m.
const MOMENT_OFF: f64 = -0.2283;

fn tilted(
    context: &mut CaseContext,
    law: &SpringDashpot,
    row: &Row,
    alone: f64,
) -> Result<(), CaseError> {
    let Row { label, moment, above } = row;
    let [inner, outer] = tilts(law, *moment)?;
    // A linear spring turns by its moment, which goes through both.
    let turned = (moment / law.stiffness[4]).to_degrees();
    context.check(
        Check::new(
            &format!("difference_{label}"),
            &format!("inner minus outer race's tilt at {moment} N·m"),
            "°",
            inner - outer,
        )
        .independent(alone, "independent solver of the bearing with a fixed outer race")
        .absolute(
            1e-5,
            "the bearing's moment acts about the outer race's axis, turned by 2° at most",
        ),
    );
    context.check(
        Check::new(
            &format!("series_{label}"),
            &format!("outer race's tilt at {moment} N·m"),
            "°",
            outer,
        )
        .closed_form(turned, "moment over conical stiffness")
        .relative(1e-9, "rounding: a moment about Y rotates about Y only"),
    );
    for ((which, ours), above) in [("inner", inner), ("outer", outer)].into_iter().zip(above) {
        let id = format!("{which}_{label}");
        context.check(
            Check::new(&id, &format!("{which} race's tilt at {moment} N·m"), "°", ours)
                .published(&id)
                .under("bushing_of_3_4_5")
                .absolute(0.001, "one unit of the last printed digit")
                .golden(GoldenTolerance::MIXED)
                .explained(Explanation::new(
                    "The published bushing resists 414 to 423 N·m/rad, converged relaxed rubber of Table 3.1 292, 1.44 times less. \
                     Two causes are possible, and the text decides for neither: linear tetrahedra lock, and those of some 2.5 mm resist as \
                     much (table `four_nodes`); and rubber that has not relaxed resists up to 34.7 times as much. Other thicknesses \
                     of Table 3.6 are softer still. Inner minus outer tilt, which no bushing changes, is as published.",
                    *above,
                    // Of the stiffness, 0.5 %.
                    0.005 * outer,
                    &["conical", "locked_coarse", "locked_fine", &format!("difference_{label}")],
                )),
        );
    }
    Ok(())
}

/// What the unstated thickness and the source's elements make of it.
fn beside(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    for thickness in THICKNESSES {
        let law = spring(thickness, COARSE)?;
        let moment = moment_at(&law, 0.15)?;
        let mut row = vec![
            format!("{:.0}", 1e3 * thickness),
            format!("{:.1}", law.stiffness[4]),
            format!("{moment:.4}"),
        ];
        for Row { moment, .. } in &ROWS {
            row.push(format!("{:.4}", tilts(&law, *moment)?[0]));
        }
        rows.push(row);
    }
    context.table(
        "thicknesses",
        "Sensitivity to the unstated thickness",
        &[
            "H, mm",
            "N·m/rad",
            "moment at 0.15°, N·m",
            "inner tilt at 2.5 N·m, °",
            "5 N·m",
            "10 N·m",
        ],
        rows,
    );
    let mut rows = Vec::new();
    let mut outer = Vec::new();
    for size in SIZES {
        let stiffness = locked(THICKNESSES[0], size)?;
        outer.push((5.0 / stiffness).to_degrees());
        rows.push(vec![format!("{:.1}", 1e3 * size), format!("{stiffness:.1}")]);
    }
    context.table(
        "four_nodes",
        "Conical stiffness of four-node elements, H 10 mm",
        &["side, mm", "N·m/rad"],
        rows,
    );
    let [coarse, .., fine] = outer[..] else { return Ok(()) };
    let of = |id: &str, size: f64, tilt: f64| {
        let what = format!("outer race's tilt at 5 N·m, four-node elements of {} mm", 1e3 * size);
        Check::new(id, &what, "°", tilt).published("outer_5")
    };
    context.check(of("locked_coarse", SIZES[0], coarse).at_most(
        0.001,
        "a printed digit; the published tilt is larger, so its elements were finer",
    ));
    context.check(of("locked_fine", SIZES[SIZES.len() - 1], fine).at_least(
        0.001,
        "a printed digit; the published tilt is smaller, so its elements were coarser",
    ));
    Ok(())
}

fn figure(context: &mut CaseContext, law: &SpringDashpot) -> Result<(), CaseError> {
    let rigid = SpringDashpot { stiffness: [1e13; 6], ..SpringDashpot::default() };
    let curve = |law: &SpringDashpot, most: f64| -> Result<Vec<[f64; 2]>, CaseError> {
        (0..=20)
            .map(|step| {
                let moment = most * f64::from(step) / 20.0;
                Ok([tilts(law, moment)?[0], moment])
            })
            .collect()
    };
    let svg = xy(&XyPlot {
        title: "Moment over tilt of the inner race".into(),
        x: Axis::linear("tilt about Y", "deg"),
        y: Axis::linear("moment about Y", "N m"),
        style: Style::LinesAndMarkers,
        curves: vec![
            Curve::new("fixed outer race", curve(&rigid, 10.0)?),
            Curve::new("in a bushing", curve(law, 10.0)?),
        ],
    })?;
    context.figure(
        "moment_over_tilt",
        svg,
        "As in Fig. 3.34: the bushing, not the bearing, gives way.",
    );
    Ok(())
}
