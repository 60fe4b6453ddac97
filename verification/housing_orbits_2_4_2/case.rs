//! Orbits of both races in housings A, B and C under the rotating load of 2.4.2.

use std::f64::consts::TAU;
use std::time::Instant;

use bearing_dynamics::ch2_housing::bearing::geometry::Material;
use bearing_dynamics::ch2_housing::bearing::inertia::hollow_cylinder;
use bearing_dynamics::equilibrium::quasi_static_limit::lowest_frequency;
use bearing_dynamics::kinematics::strain::von_mises;
use bearing_dynamics::members::body::RotatingLoad;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Curve, OrbitPlot, orbit};
use bearing_dynamics::reduction::component_modes::lowest_modes;
use bearing_dynamics::reduction::fixed_interface_modes::vibrating_housing;
use bearing_dynamics::solids::bore_equilibrium::BoreState;
use bearing_dynamics::solids::condensation::geometry_error;
use bearing_dynamics::solids::stress::nodal_stresses;

use crate::bearings::{Hertz, oracle};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::contact_picture::contact_picture;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housed::{OUTER, QuasiStaticSequence, history, moving};
use crate::housings::{
    BEARING, BORE_RADIUS, WIDTH, angles, assumptions, bearing, condensed, fit, mean, mesh, panel,
    radii, search, solid, sum_of_loads, touched_part,
};
use crate::motion::RPM;
use crate::oracles::statics::Known;
use crate::solids::{Vec3, largest, name_of};
use crate::surface_picture::{SurfacePicture, surface_picture};

pub const CASE: Case = Case {
    id: "housing_orbits_2_4_2",
    title: "Orbits in housings A, B and C under a rotating load of 250 N",
    section: "2.4.2, Tables 2.2 and 2.3",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const LOAD: f64 = 250.0;
const LOAD_SPEED: f64 = 50.0 * RPM;
/// Points of one turn of the load; a multiple of eight, so that opposite directions are among them.
const POINTS: usize = 72;
const RIGHT: usize = 0;
const UP: usize = POINTS / 4;
const DOWN: usize = 3 * POINTS / 4;

/// Meshes, coarse to fine: cells around, radial and axial.
const LADDER: [(Order, [usize; 3]); 5] = [
    (Order::Linear, [32, 2, 2]),
    (Order::Linear, [48, 3, 3]),
    (Order::Linear, [64, 4, 4]),
    (Order::Quadratic, [24, 2, 2]),
    (Order::Quadratic, [32, 3, 2]),
];
/// What they are measured with.
const FINEST: (Order, [usize; 3]) = (Order::Quadratic, [48, 3, 3]);

/// One turn of the load, y and z in m.
struct Turn {
    outer: Vec<[f64; 2]>,
    inner: Vec<[f64; 2]>,
    /// Part of the bore that is touched, and largest pressure there, Pa.
    touched: Vec<f64>,
    pressure: Vec<f64>,
    /// Largest unbalanced load of the outer race, and of the nodal loads against the applied one, over the load.
    unbalanced: f64,
    sums: f64,
    /// Fixed normals against true distances, over the orbit's mean radius.
    geometry: f64,
    /// Lowest natural frequency of races and housing, Hz.
    lowest: f64,
    unknowns: usize,
    nodes: usize,
    seconds: f64,
    iterations: usize,
    changes: usize,
}

/// What a picture of a turn needs, for the four main directions.
struct Pictures {
    contact: String,
    stress: String,
}

fn turn(
    letter: char,
    (order, cells): (Order, [usize; 3]),
    pictures: Option<f64>,
) -> Result<(Turn, Option<Pictures>), CaseError> {
    let clock = Instant::now();
    let mesh = mesh(letter, order, cells)?;
    let solid = solid(&mesh)?;
    let bore = condensed(&mesh, &solid)?;
    let mut search = search(&bore);
    let course = QuasiStaticSequence {
        times: angles(POINTS).map(|angle| angle / LOAD_SPEED).collect(),
        conditions: [0; 5].map(|_| Profile::ZERO),
        rotating_load: Some(RotatingLoad {
            force: Profile::Constant(LOAD),
            speed: Profile::Constant(LOAD_SPEED),
            phase: 0.0,
        }),
        shaft_speed: Profile::ZERO,
        interference: Profile::ZERO,
        centrifugal: false,
    };
    let bearing = bearing()?;
    let moments = history(&mut search, &bearing, &fit(0.0), &course)?;
    let seconds = clock.elapsed().as_secs_f64();
    let states: Vec<&BoreState> = moments.iter().map(|moment| &moment.state.bore).collect();
    let outer: Vec<[f64; 2]> = states.iter().map(|state| [state.pose[0], state.pose[1]]).collect();
    let size = mean(&radii(&outer));
    let sums = angles(POINTS).zip(&states).map(|(angle, state)| {
        let [_, y, z] = sum_of_loads(&mesh, &bore, state);
        (y - LOAD * angle.cos()).hypot(z - LOAD * angle.sin()) / LOAD
    });
    let geometry = [RIGHT, UP, DOWN].map(|at| {
        let state = states[at];
        geometry_error(&bore, &bore.displacement(&state.loads), &state.pose) / size
    });
    let outer_race = hollow_cylinder(31.953e-3, BORE_RADIUS, WIDTH, Material::STEEL.density);
    let inner_race = hollow_cylinder(15e-3, 22e-3, 12e-3, Material::STEEL.density);
    let last = &moments[POINTS - 1].state;
    let (natural, _) = lowest_modes(&solid, &bore, 4)?;
    let housing = vibrating_housing(search.bore(), &solid, OUTER, &natural, 0.0);
    let bodies = moving([inner_race, outer_race], [true; 5]);
    let lowest = lowest_frequency(&last.stiffness, &bodies, &[housing]).unwrap_or(f64::NAN);
    let drawn = pictures.map(|magnification| {
        let names = ["+Y", "+Z", "−Y", "−Z"];
        let panels: Vec<_> = (0..4)
            .map(|quarter| {
                let title = format!("Housing {letter}, load along {}", names[quarter]);
                panel(title, &mesh, &bore, states[quarter * POINTS / 4], magnification)
            })
            .collect();
        let state = states[if letter == 'C' { UP } else { DOWN }];
        let u = bore.displacement(&state.loads);
        let stress: Vec<f64> =
            nodal_stresses(&solid, &u).iter().map(|t| 1e-6 * von_mises(t)).collect();
        let enlarged: Vec<Vec3> = u.iter().map(|u| u.map(|x| magnification * x)).collect();
        let stress = surface_picture(&SurfacePicture {
            mesh: &mesh,
            displacement: &enlarged,
            values: &stress,
            label: "von Mises stress, MPa",
            azimuth: 12.0,
            elevation: 10.0,
        });
        Pictures { contact: contact_picture(&panels, 2), stress }
    });
    let of = |read: &dyn Fn(&BoreState) -> f64| states.iter().map(|state| read(state)).collect();
    let turn = Turn {
        inner: moments
            .iter()
            .map(|moment| {
                let at = &moment.state.bearing.coordinates;
                [at[1], at[2]]
            })
            .collect(),
        touched: of(&|state| touched_part(&bore, state)),
        pressure: of(&|state| largest(state.pressure(&bore))),
        unbalanced: largest(moments.iter().map(|moment| moment.state.residual)),
        sums: largest(sums),
        geometry: largest(geometry),
        lowest,
        unknowns: bore.sizes.unknowns,
        nodes: bore.sizes.kept,
        seconds,
        iterations: moments.iter().map(|moment| moment.state.iterations).sum(),
        changes: moments.iter().map(|moment| moment.state.contact_changes).sum(),
        outer,
    };
    Ok((turn, drawn))
}

/// Largest over smallest radius.
fn roundness(orbit: &[[f64; 2]]) -> f64 {
    let radii = radii(orbit);
    let low = radii.iter().fold(f64::INFINITY, |low: f64, r| low.min(*r));
    largest(radii) / low
}

/// How far the orbit is from its own images in the Y and the Z axis, over its mean radius.
fn asymmetry(orbit: &[[f64; 2]]) -> f64 {
    let size = mean(&radii(orbit));
    let count = orbit.len();
    let gaps = (0..count).flat_map(|i| {
        let [y, z] = orbit[i];
        // Directions of the load mirrored in the Y axis and in the Z axis.
        let [[ya, za], [yb, zb]] = [orbit[(count - i) % count], orbit[(3 * count / 2 - i) % count]];
        [(y - ya).hypot(z + za) / size, (y + yb).hypot(z - zb) / size]
    });
    largest(gaps)
}

/// Half axes along Y and Z by the points under loads along them; off the ellipse they span, over
/// its own radius there.
fn off_ellipse(orbit: &[[f64; 2]]) -> f64 {
    let (a, b) = (orbit[RIGHT][0], orbit[UP][1]);
    largest(orbit.iter().map(|[y, z]| ((y / a).hypot(z / b) - 1.0).abs()))
}

fn axes_ratio(orbit: &[[f64; 2]]) -> f64 {
    let radii = radii(orbit);
    radii[RIGHT] / radii[UP]
}

/// Displacement under a load to the side, and upwards, over that downwards.
fn beside_down(orbit: &[[f64; 2]]) -> f64 {
    let radii = radii(orbit);
    radii[RIGHT].min(radii[POINTS / 2]) / radii[DOWN]
}

fn up_down(orbit: &[[f64; 2]]) -> f64 {
    let radii = radii(orbit);
    radii[UP] / radii[DOWN]
}

/// Largest difference of radii over the mean radius.
fn orbit_error(orbit: &[[f64; 2]], reference: &[[f64; 2]]) -> f64 {
    let (ours, theirs) = (radii(orbit), radii(reference));
    largest(ours.iter().zip(&theirs).map(|(r, s)| (r - s).abs())) / mean(&theirs)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    context.assumption(
        "quasi_static",
        "2.4.2 does not say whether the inner race turns while the load does. It is at rest here, balls at their initial positions, and every position is an equilibrium; the table estimates the effect of inertia.",
        "one equilibrium for each 5° of the load",
    );
    context.assumption(
        "race_masses",
        "No table states the races' masses; rings of steel, 15–22 mm and 12 mm wide (inner), 31.953–35.527 mm and 20 mm wide \
         (outer). Only the estimate of inertia uses them.",
        "0.077 kg and 0.119 kg",
    );
    let known =
        |angle: f64| [0.0, LOAD * angle.cos(), LOAD * angle.sin(), 0.0, 0.0].map(Known::Load);
    let fixed: Vec<[f64; 2]> = angles(POINTS)
        .map(|angle| {
            let at = oracle(&BEARING, Hertz::Fit, 0.0).solve(&known(angle), None).coordinates;
            [at[1], at[2]]
        })
        .collect();
    let mut turns = Vec::new();
    let mut rows = Vec::new();
    for (letter, magnification) in [('A', 6e4), ('B', 3e4), ('C', 1.5e4)] {
        let (finest, pictures) = turn(letter, FINEST, Some(magnification))?;
        for variant in LADDER.into_iter().chain([FINEST]) {
            let of_ladder =
                if variant == FINEST { None } else { Some(turn(letter, variant, None)?.0) };
            let turn = of_ladder.as_ref().unwrap_or(&finest);
            let (order, [around, radial, axial]) = variant;
            let error = orbit_error(&turn.outer, &finest.outer);
            rows.push(vec![
                format!("{letter}, {}, {around} × {radial} × {axial}", name_of(order)),
                turn.unknowns.to_string(),
                turn.nodes.to_string(),
                format!("{:.2}", 1e9 * mean(&radii(&turn.outer))),
                if variant == FINEST { "–".into() } else { format!("{:.2}", 100.0 * error) },
                format!("{:.2}", turn.seconds),
                turn.iterations.to_string(),
                turn.changes.to_string(),
            ]);
            if variant == LADDER[4] {
                mesh_check(context, letter, error);
            }
        }
        if let Some(pictures) = pictures {
            draw(context, letter, magnification, pictures);
        }
        balance_checks(context, letter, &finest);
        turns.push((letter, finest));
    }
    context.table(
        "meshes",
        "Cost and error of one turn of the load in 72 equilibria: error is the largest difference of the outer race's \
         orbit radius from the finest mesh, over its mean; seconds are those of the machine of the report, mesh and \
         condensation included",
        &["housing, element, cells", "unknowns", "bore nodes", "mean radius, nm", "error, %", "seconds", "bearings solved", "changes of contact"],
        rows,
    );
    statements(context, &turns, &fixed);
    orbit_table(context, &turns, &fixed);
    figures(context, &turns, &fixed)
}

fn mesh_check(context: &mut CaseContext, letter: char, error: f64) {
    context.check(
        Check::new(
            &format!("mesh_{letter}"),
            &format!("housing {letter}: error of ten-node elements, 32 × 3 × 2 cells, over the mean radius"),
            "1",
            error,
        )
        .consistency(0.0, "this mesh against ten-node elements of 48 × 3 × 3 cells, the finest mesh here, half as fine again")
        .absolute(0.01, "the cheapest mesh that is to be within 1 % of the finest"),
    );
}

fn balance_checks(context: &mut CaseContext, letter: char, turn: &Turn) {
    context.check(
        Check::new(
            &format!("balance_{letter}"),
            &format!(
                "housing {letter}: nodal loads summed over the bore against the load, over the load"
            ),
            "1",
            turn.sums,
        )
        .closed_form(0.0, "balance of the rigid outer race")
        .absolute(1e-10, "statics of the bearing leaves 1e-11 of its ball loads"),
    );
    context.check(
        Check::new(
            &format!("geometry_{letter}"),
            &format!("housing {letter}: distances with fixed normals against true ones, over the orbit's radius"),
            "1",
            turn.geometry,
        )
        .consistency(0.0, "our fixed normals against our own distances of displaced nodes from the displaced axis")
        .absolute(3e-5, "of the order of displacement over bore radius, 1e-5 in housing C, and the tilt's share"),
    );
    let size = 1e9 * mean(&radii(&turn.outer));
    context.golden(
        &format!("mean_radius_{letter}"),
        size,
        "nm",
        GoldenTolerance { relative: 1e-7, absolute: 0.0 },
    );
}

/// Each statement of the text as a number of one housing. Where another statement does not imply it, the same
/// number of a housing of which the text does not say so, which has to miss.
fn statements(context: &mut CaseContext, turns: &[(char, Turn)], fixed: &[[f64; 2]]) {
    let [a, b, c] = [0, 1, 2].map(|i: usize| &turns[i].1);
    let section = "2.4.2, Figs. 2.16 to 2.20";
    let size = |turn: &Turn| mean(&radii(&turn.outer));
    let ellipse = "B: the orbit is an ellipse";
    let arcs = "A: contact forces are distributed alike in all directions of the load";
    let sideways = "C: the annulus inclines under lateral loads, but not under loads downwards";
    let most = |id: &str, what: &str, ours: f64, limit: f64, sentence: &str, why: &str| {
        Check::new(id, what, "1", ours).stated(limit, section, sentence).at_most(0.0, why)
    };
    let least = |id: &str, what: &str, ours: f64, limit: f64, sentence: &str, why: &str| {
        Check::new(id, what, "1", ours).stated(limit, section, sentence).at_least(0.0, why)
    };
    let must_miss = "the statement must not hold of the wrong housing";
    let all = [
        most(
            "a_round",
            "A: largest over smallest radius of the orbit",
            roundness(&a.outer),
            1.05,
            "A: the orbit is nearly a circle",
            "5 % would be seen",
        ),
        most(
            "b_symmetric",
            "B: orbit against its mirror images, over its radius",
            asymmetry(&b.outer),
            0.02,
            "B: the motion is as symmetric as the housing",
            "2 % would not be seen; the mesh's own asymmetry is below 1 %",
        ),
        most(
            "b_ellipse",
            "B: largest distance from the ellipse through its apices",
            off_ellipse(&b.outer),
            0.05,
            ellipse,
            "5 % would be seen",
        ),
        least(
            "b_ellipse_swapped",
            "C: largest distance from the ellipse through its apices",
            off_ellipse(&c.outer),
            0.05,
            ellipse,
            must_miss,
        ),
        most(
            "a_smallest",
            "A: mean radius over B's",
            size(a) / size(b),
            0.8,
            "A: the orbit is the smallest",
            "a fifth would be seen",
        ),
        Check::new("b_below_c", "B: mean radius over C's", "1", size(b) / size(c))
            .consistency(
                0.8,
                "our own orbits in B and C, which the text does not order: by this and the check before, A's is the smallest of all three",
            )
            .at_most(0.0, "a fifth would be seen"),
        most(
            "a_like_arcs",
            "A: spread of the touched part of the bore over the turn, over its mean",
            spread(&a.touched),
            0.15,
            arcs,
            "one row of nodes more or less is 4 % of the touched ones, on both sides",
        ),
        least(
            "a_like_arcs_swapped",
            "C: spread of the touched part of the bore over the turn, over its mean",
            spread(&c.touched),
            0.15,
            arcs,
            must_miss,
        ),
        least(
            "b_along_y",
            "B: radius under loads along Y over that along Z",
            axes_ratio(&b.outer),
            1.5,
            "B: displacement under loads along Y is larger than in other directions",
            "one and a half times as much would fail",
        ),
        least(
            "c_soft_sideways",
            "C: radius under loads to the side over that downwards",
            beside_down(&c.outer),
            5.0,
            sideways,
            "the text prints no ratio: set between B, 2.9, which has its necks on both sides, and C, 12.8",
        ),
        most(
            "c_soft_sideways_swapped",
            "B: radius under loads to the side over that downwards",
            beside_down(&b.outer),
            5.0,
            sideways,
            must_miss,
        ),
        least(
            "c_soft_upwards",
            "C: radius under a load upwards over that downwards",
            up_down(&c.outer),
            2.0,
            "C: upwards the necks are pulled, downwards the base is compressed",
            "twice as far would be seen",
        ),
        least(
            "c_even_above",
            "C: touched part of the bore under a load upwards over that downwards",
            c.touched[UP] / c.touched[DOWN],
            1.2,
            "C: under a load upwards, on the annulus of even thickness, contact forces are more uniform",
            "a fifth would be seen",
        ),
    ];
    all.into_iter().for_each(|check| context.check(check));
    for (letter, turn) in turns {
        let ratio = mean(&radii(&turn.inner)) / mean(&radii(fixed));
        context.check(
            Check::new(
                &format!("inner_{letter}"),
                &format!("{letter}: mean radius of the inner race's orbit over that with a fixed outer race by independent statics"),
                "1",
                ratio,
            )
            .stated(1.0, "2.4.2, Fig. 2.20", "the inner race's orbit grows by the outer race's displacement")
            .at_least(1e-3, "statics agree to 1e-9; a growth of 1e-3 is no error of either"),
        );
        let carried = turn.inner.iter().zip(&turn.outer).zip(fixed);
        let apart = carried.map(|(([y, z], [v, w]), [a, b])| (y - v - a).hypot(z - w - b));
        context.check(
            Check::new(
                &format!("carried_{letter}"),
                &format!("{letter}: inner race relative to the outer one, largest difference from the case of a fixed outer race, over its mean radius"),
                "1",
                largest(apart) / mean(&radii(fixed)),
            )
            .independent(0.0, "independent statics with a fixed outer race: the housing moves the whole bearing")
            .absolute(1e-10, "statics leaves 1e-11 of the load; tilts of the outer race are too small to turn the bearing"),
        );
    }
    let most = |turn: &Turn| largest(radii(&turn.inner)) / mean(&radii(fixed)) - 1.0;
    context.finding(
        "inner_orbits",
        format!(
            "The inner race's orbit grows by at most {:.1} % in A, {:.1} % in B and {:.0} % in C: at 5 µm interference in the bearing \
             the Hertz contacts give way by 1.3 µm, more than housings A and B. \"Significantly\" holds of C in these \
             assumed dimensions.",
            100.0 * most(a),
            100.0 * most(b),
            100.0 * most(c)
        ),
    );
}

/// Largest less smallest value over the mean.
fn spread(values: &[f64]) -> f64 {
    let low = values.iter().fold(f64::INFINITY, |low: f64, x| low.min(*x));
    (largest(values.iter().copied()) - low) / mean(values)
}

fn orbit_table(context: &mut CaseContext, turns: &[(char, Turn)], fixed: &[[f64; 2]]) {
    let rows = turns
        .iter()
        .map(|(letter, turn)| {
            let radii = radii(&turn.outer);
            let nanometres = |i: usize| format!("{:.1}", 1e9 * radii[i]);
            vec![
                letter.to_string(),
                nanometres(RIGHT),
                nanometres(UP),
                nanometres(DOWN),
                format!("{:.1}", 1e9 * mean(&radii)),
                format!("{:.1}", 1e9 * mean(&self::radii(&turn.inner))),
                format!("{:.0} / {:.0}", 100.0 * turn.touched[UP], 100.0 * turn.touched[DOWN]),
                format!("{:.2} / {:.2}", 1e-6 * turn.pressure[UP], 1e-6 * turn.pressure[DOWN]),
                format!("{:.0}", turn.lowest),
                format!("{:.0e}", (LOAD_SPEED / TAU / turn.lowest).powi(2)),
                format!("{:.0e}", turn.unbalanced),
            ]
        })
        .collect();
    context.table(
        "orbits",
        &format!(
            "Radius of the outer race's orbit; inner race with a fixed outer race: {:.1} nm. Inertia: lowest natural frequency f of \
             races and housing, and (load's frequency / f)², the part of the displacement that quasi-static leaves out",
            1e9 * mean(&radii(fixed))
        ),
        &[
            "housing",
            "load +Y, nm",
            "load +Z, nm",
            "load −Z, nm",
            "mean, nm",
            "inner race, mean, nm",
            "bore touched +Z / −Z, %",
            "peak pressure +Z / −Z, MPa",
            "f, Hz",
            "inertia",
            "unbalanced",
        ],
        rows,
    );
}

fn draw(context: &mut CaseContext, letter: char, magnification: f64, pictures: Pictures) {
    context.figure(
        &format!("contact_{letter}"),
        pictures.contact,
        &format!(
            "As Fig. {}: contact forces on the bore of housing {letter} and its deformation, {magnification:.0} times enlarged \
             (grey: undeformed), every 90° of the load.",
            if letter == 'A' { "2.16" } else if letter == 'B' { "2.17" } else { "2.18" }
        ),
    );
    context.figure(
        &format!("stress_{letter}"),
        pictures.stress,
        &format!(
            "Von Mises stress in housing {letter}, load along {}, {magnification:.0} times enlarged.",
            if letter == 'C' { "+Z: tension in the necks" } else { "−Z" }
        ),
    );
}

fn figures(
    context: &mut CaseContext,
    turns: &[(char, Turn)],
    fixed: &[[f64; 2]],
) -> Result<(), CaseError> {
    let closed = |points: &[[f64; 2]]| -> Vec<[f64; 2]> {
        points.iter().chain(&points[..1]).map(|[y, z]| [1e9 * y, 1e9 * z]).collect()
    };
    let named = |letter: char| format!("Housing {letter}");
    let svg = orbit(&OrbitPlot {
        title: "Outer race under 250 N at 50 rpm".into(),
        unit: "nm".into(),
        curves: turns.iter().map(|(l, turn)| Curve::new(named(*l), closed(&turn.outer))).collect(),
    })?;
    context.figure("outer", svg, "As Fig. 2.19: orbits of the outer race in the three housings.");
    let mut curves = vec![Curve::new("fixed outer race", closed(fixed))];
    curves.extend(turns.iter().map(|(l, turn)| Curve::new(named(*l), closed(&turn.inner))));
    let svg = orbit(&OrbitPlot {
        title: "Inner race under 250 N at 50 rpm".into(),
        unit: "nm".into(),
        curves,
    })?;
    context.figure(
        "inner",
        svg,
        "As Fig. 2.20: orbits of the inner race in the housings and with a fixed outer race.",
    );
    Ok(())
}
