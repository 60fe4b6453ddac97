//! A bearing in its housing in equilibrium, against a solution that shares the mesh and the nodes' shares of the bore.

use bearing_dynamics::ch2_housing::bore_contact::{Cylinder, Frame, contact_nodes, touch};
use bearing_dynamics::equilibrium::statics::StaticProblem;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::euler::quaternion;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solids::condensation::{CondensedBore, Reach, condense};
use nalgebra::{DMatrix, Rotation3, UnitQuaternion, Vector3};

use crate::bearings::{self, Hertz};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housings::{self, BEARING, BORE_RADIUS, WIDTH};
use crate::oracles::elastic::ElasticBody;
use crate::oracles::seated::{self, Distance, Seat, SeatNode, Seated};
use crate::solids::{STEEL, Vec3, largest, name_of};

mod two_housings;

pub const CASE: Case = Case {
    id: "housing_equilibrium",
    title: "A bearing in its housing, against a condensed solution of its own",
    section: "2.2.4, (2.16)–(2.19), 2.4",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// 2.2.4: 2.5e8 N/m, taken for 1 mm² of the bore, N/m³.
const STIFFNESS: f64 = 2.5e14;

struct Variant {
    id: &'static str,
    text: &'static str,
    housing: char,
    order: Order,
    cells: [usize; 3],
    /// m.
    interference: f64,
    conditions: [Condition; 5],
    /// Bore and bearing turned about all three axes and moved, as one.
    turned: bool,
    /// By how much turning normals may change the place, as a part of it, and why.
    exact_gap_iteration: (f64, &'static str),
}

const fn load(value: f64) -> Condition {
    Condition::Load(value)
}

const VARIANTS: [Variant; 4] = [
    Variant {
        id: "eccentric",
        text: "transition, load askew",
        housing: 'C',
        order: Order::Quadratic,
        cells: [16, 1, 1],
        interference: 0.0,
        conditions: [load(0.0), load(150.0), load(-200.0), load(0.0), load(0.0)],
        turned: false,
        exact_gap_iteration: (
            1e-5,
            "motion over twice the bore's radius, 1e-6; soft tilts multiply it",
        ),
    },
    Variant {
        id: "clearance",
        text: "1 µm of clearance, load askew and upwards",
        housing: 'C',
        order: Order::Linear,
        cells: [24, 2, 2],
        interference: -1e-6,
        conditions: [load(0.0), load(-180.0), load(120.0), load(0.0), load(0.0)],
        turned: false,
        exact_gap_iteration: (3e-5, "motion over twice the bore's radius, 2.6e-5"),
    },
    Variant {
        id: "tilted",
        text: "1 µm of interference, inner race tilted by 0.05° and −0.03°",
        housing: 'A',
        order: Order::Quadratic,
        cells: [16, 1, 2],
        interference: 1e-6,
        conditions: [
            load(0.0),
            load(100.0),
            load(-250.0),
            Condition::Displacement(0.05 * std::f64::consts::PI / 180.0),
            Condition::Displacement(-0.03 * std::f64::consts::PI / 180.0),
        ],
        turned: false,
        exact_gap_iteration: (
            5e-3,
            "the bore follows 1 µm of interference: that squared over twice its radius is 14 pm, of the 9.5 nm that the race moves 1.5e-3",
        ),
    },
    Variant {
        id: "turned",
        text: "transition, axial load and moments, rotated in space",
        housing: 'C',
        order: Order::Quadratic,
        cells: [16, 1, 2],
        interference: 0.0,
        conditions: [load(80.0), load(-150.0), load(-200.0), load(1.0), load(-0.6)],
        turned: true,
        exact_gap_iteration: (
            2e-4,
            "motion over twice the bore's radius, 2e-6; tilts of 5 µrad and an axial load multiply it",
        ),
    },
];

/// Where the race's axes are in the world.
struct Placed {
    turn: Rotation3<f64>,
    centre: Vector3<f64>,
}

impl Placed {
    fn at_home() -> Placed {
        Placed { turn: Rotation3::identity(), centre: Vector3::zeros() }
    }

    fn of(variant: &Variant) -> Placed {
        if variant.turned {
            let centre = Vector3::new(0.11, -0.07, 0.23);
            return Placed { turn: Rotation3::from_euler_angles(0.7, -1.1, 2.3), centre };
        }
        Placed::at_home()
    }

    fn world(&self, place: Vec3) -> Vec3 {
        (self.turn * Vector3::from(place) + self.centre).into()
    }

    fn pose(&self) -> Pose {
        let orientation = UnitQuaternion::from_rotation_matrix(&self.turn);
        Pose { position: self.centre, orientation }
    }
}

/// The program's answer.
struct Ours {
    outer: [f64; 4],
    inner: [f64; 5],
    loads: [f64; 5],
    /// On the bore's nodes, and their sum by way of the race's load, in the world, N.
    forces: Vec<Vec3>,
    sum: Vec3,
}

fn ours(variant: &Variant, placed: &Placed, bore: &CondensedBore) -> Result<Ours, CaseError> {
    let pose = placed.pose();
    let problem = bearings::problem(&BEARING, Hertz::Fit, 0.0, variant.conditions)?;
    let problem = StaticProblem { frame: pose, outer_pose: pose, ..problem };
    let state =
        housings::search(bore).solve(&problem, &housings::fit(variant.interference), [0.0; 3])?;
    let [y, z, _, _] = state.bore.load;
    Ok(Ours {
        outer: state.bore.pose,
        inner: state.bearing.coordinates.into(),
        loads: state.bearing.loads.into(),
        forces: bore.nodal_forces(&state.bore.loads).map(|(_, force)| force).collect(),
        sum: bore.to_world([0.0, y, z]),
    })
}

/// The oracle's answer: places of nodes seen from the race, elements, held nodes and the nodes' shares of
/// the bore are given to it.
fn theirs(
    variant: &Variant,
    shares: &[f64],
    places: &[Vec3],
    compliance: &DMatrix<f64>,
    distance: Distance,
) -> Seated {
    let nodes = places.iter().zip(shares);
    let nodes = nodes.map(|(&place, share)| SeatNode { place, stiffness: STIFFNESS * share });
    let radius = BORE_RADIUS + variant.interference;
    let seat = Seat { nodes: nodes.collect(), compliance, radius, distance };
    let bearing = bearings::oracle(&BEARING, Hertz::Fit, 0.0);
    // Along the load until it touches, and a little more.
    let along =
        |i: usize| if let Condition::Load(load) = variant.conditions[i] { load } else { 0.0 };
    let (y, z) = (along(1), along(2));
    let way = (1e-7 - variant.interference.min(0.0)) / y.hypot(z);
    let start = [way * y, way * z, 0.0, 0.0];
    seated::equilibrium(&seat, &bearing, &bearings::known(&variant.conditions), start)
}

fn body(mesh: &TetMesh, placed: &Placed) -> Result<ElasticBody, CaseError> {
    let back =
        |place: &Vec3| (placed.turn.inverse() * (Vector3::from(*place) - placed.centre)).into();
    let elements = (0..mesh.elements.len())
        .map(|e| mesh.elements.nodes(e).iter().map(|&n| n as usize).collect())
        .collect();
    let held = mesh.nodes_of_faces(mesh.surface_set("fixed")?);
    Ok(ElasticBody {
        nodes: mesh.nodes.iter().map(back).collect(),
        elements,
        held: held.into_iter().map(|n| n as usize).collect(),
        young: STEEL.young,
        poisson: STEEL.poisson,
    })
}

/// Largest difference over the largest of `theirs`.
fn apart(ours: &[f64], theirs: &[f64]) -> f64 {
    let size = largest(theirs.iter().map(|x| x.abs()));
    largest(ours.iter().zip(theirs).map(|(a, b)| (a - b).abs())) / size
}

fn compare(context: &mut CaseContext, variant: &Variant) -> Result<Vec<String>, CaseError> {
    let placed = Placed::of(variant);
    let mut mesh = housings::mesh(variant.housing, variant.order, variant.cells)?;
    for node in &mut mesh.nodes {
        *node = placed.world(*node);
    }
    let solid = housings::solid(&mesh)?;
    let nodes = contact_nodes(&mesh, mesh.surface_set("bore")?);
    let reach = Reach { nominal: placed.pose(), radius: BORE_RADIUS, width: WIDTH, travel: None };
    let bore = condense(&solid, &nodes, &reach)?;
    let ours = ours(variant, &placed, &bore)?;

    let body = body(&mesh, &placed)?;
    let of: Vec<usize> = bore.nodes.iter().map(|node| node.node as usize).collect();
    let places: Vec<Vec3> = of.iter().map(|&n| body.nodes[n]).collect();
    let shares: Vec<f64> = bore.nodes.iter().map(|node| node.area).collect();
    let compliance = body.compliance(&of);
    let first = theirs(variant, &shares, &places, &compliance, Distance::FirstOrder);
    let exact = theirs(variant, &shares, &places, &compliance, Distance::True);

    // Tilts as motion at the bore; the inner race's at its pitch circle.
    let metres =
        |outer: &[f64; 4]| [outer[0], outer[1], BORE_RADIUS * outer[2], BORE_RADIUS * outer[3]];
    let pitch = BEARING.pitch_radius;
    let inner = |c: &[f64; 5]| [c[0], c[1], c[2], pitch * c[3], pitch * c[4]];
    let held = |c: &[f64; 5]| [c[0], c[1], c[2], c[3] / pitch, c[4] / pitch];
    let world = |force: &Vec3| -> Vec3 { (placed.turn * Vector3::from(*force)).into() };
    let sum_of = |seated: &Seated| {
        let sum =
            seated.forces.iter().fold([0.0; 3], |s, f| [s[0] + f[0], s[1] + f[1], s[2] + f[2]]);
        world(&sum)
    };
    let flat = |forces: &[Vec3]| forces.iter().flatten().copied().collect::<Vec<f64>>();
    let turned: Vec<Vec3> = first.forces.iter().map(world).collect();
    let of_oracle = "own stiffness, factor, contact and Newton's method, to first order in displacements; mesh and nodes' shares of the bore are the program's";
    let why = "statics of the bearing is solved to 1e-11 of its loads; the race's soft tilts in its bore multiply that by up to a hundred";
    let (id, text) = (variant.id, variant.text);
    for (what, name, error, limit) in [
        (
            "outer",
            "outer race's displacement and tilts",
            apart(&metres(&ours.outer), &metres(&first.outer)),
            1e-9,
        ),
        (
            "inner",
            "inner race's displacement and tilts",
            apart(&inner(&ours.inner), &inner(&first.inner)),
            5e-11,
        ),
        ("loads", "loads on the inner race", apart(&held(&ours.loads), &held(&first.loads)), 2e-10),
        ("forces", "forces on the bore's nodes", apart(&flat(&ours.forces), &flat(&turned)), 1e-9),
        (
            "sum",
            "force of the race on the bore in the world",
            apart(&ours.sum, &sum_of(&first)),
            1e-10,
        ),
    ] {
        context.check(
            Check::new(
                &format!("{id}_{what}"),
                &format!("{text}: {name}, largest difference over the largest of them"),
                "1",
                error,
            )
            .independent(0.0, of_oracle)
            .absolute(limit, why),
        );
    }
    let distances = apart(&metres(&ours.outer), &metres(&exact.outer));
    context.check(
        Check::new(
            &format!("{id}_true_distances"),
            &format!(
                "{text}: outer race's displacement and tilts, largest difference over the largest of them"
            ),
            "1",
            distances,
        )
        .independent(
            0.0,
            "the same with (2.16)–(2.18) for displaced nodes and race: normals that turn",
        )
        .absolute(variant.exact_gap_iteration.0, variant.exact_gap_iteration.1),
    );
    context.golden(
        &format!("{id}_outer"),
        1e9 * ours.outer[0].hypot(ours.outer[1]),
        "nm",
        GoldenTolerance { relative: 1e-7, absolute: 0.0 },
    );
    Ok(vec![
        text.to_string(),
        format!(
            "{}, {}, {}",
            variant.housing,
            name_of(variant.order),
            variant.cells.map(|n| n.to_string()).join(" × ")
        ),
        mesh.nodes.len().to_string(),
        format!(
            "{} of {}",
            ours.forces.iter().filter(|f| largest(f.map(f64::abs)) > 0.0).count(),
            of.len()
        ),
        format!("{:.3}", 1e9 * ours.outer[0].hypot(ours.outer[1])),
        format!("{:.3}", 1e6 * ours.outer[2].hypot(ours.outer[3])),
        format!("{:.0e}", apart(&metres(&ours.outer), &metres(&first.outer))),
        format!("{distances:.0e}"),
        format!("{:.0e} / {:.0e}", first.unbalanced, exact.unbalanced),
        format!("{} / {}", first.iterations, exact.iterations),
    ])
}

/// (2.16) to (2.19) one by one, of a race displaced and tilted in axes that are turned, against plain products.
fn laws(context: &mut CaseContext) {
    let (eta, xi, lambda) = (0.7_f64, -1.1_f64, 2.3_f64);
    // Turns about one axis each, body to inertial; 1-2-3 about body-fixed axes is their product.
    let about = |axis: usize, angle: f64| -> [Vec3; 3] {
        let (sin, cos) = angle.sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut turn = [[0.0; 3]; 3];
        turn[axis][axis] = 1.0;
        (turn[i][i], turn[i][j], turn[j][i], turn[j][j]) = (cos, -sin, sin, cos);
        turn
    };
    let times = |a: [Vec3; 3], b: [Vec3; 3]| {
        [0, 1, 2].map(|i: usize| {
            [0, 1, 2].map(|j: usize| (0..3).map(|k| a[i][k] * b[k][j]).sum::<f64>())
        })
    };
    let turn = times(times(about(0, eta), about(1, xi)), about(2, lambda));
    let orientation = quaternion(eta, xi, lambda);
    let printed = Frame::new(&Pose { position: Vector3::zeros(), orientation }).to_body;
    let entries = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    context.check(
        Check::new(
            "law_2_16",
            "(2.16): largest difference of an entry, angles 0.7, −1.1, 2.3",
            "1",
            largest(entries.map(|(i, j)| (printed[i][j] - turn[j][i]).abs())),
        )
        .closed_form(0.0, "the product of three turns about one axis each, transposed")
        .absolute(2e-15, "rounding of sums of up to three products of numbers up to one"),
    );

    let centre = [0.11, -0.07, 0.23];
    let orientation = UnitQuaternion::from_matrix(&nalgebra::Matrix3::from_fn(|i, j| turn[i][j]));
    let frame = Frame::new(&Pose { position: Vector3::from(centre), orientation });
    let cylinder = Cylinder { radius: BORE_RADIUS, width: WIDTH };
    let (mut seen, mut apart, mut pushed) = (0.0f64, 0.0f64, 0.0f64);
    let (mut inside, mut wrong) = (0, 0);
    for n in 0..60 {
        // Places around the race, some inside of it and some not, some beside it.
        let angle = 0.37 * f64::from(n);
        let own = [
            0.6 * WIDTH * (1.3 * f64::from(n)).sin(),
            (BORE_RADIUS + 1e-6 * (2.1 * f64::from(n)).cos()) * angle.cos(),
            (BORE_RADIUS + 1e-6 * (2.1 * f64::from(n)).cos()) * angle.sin(),
        ];
        let world =
            [0, 1, 2].map(|i: usize| centre[i] + (0..3).map(|j| turn[i][j] * own[j]).sum::<f64>());
        let found = frame.seen(world);
        seen = largest([seen].into_iter().chain((0..3).map(|i| (found[i] - own[i]).abs())));
        let depth = BORE_RADIUS - own[1].hypot(own[2]);
        let expected = depth > 0.0 && own[0].abs() <= 0.5 * WIDTH;
        let touched = touch(&cylinder, &frame, world);
        wrong += usize::from(expected != touched.is_some());
        if let Some(touched) = touched {
            inside += 1;
            apart = largest([apart, (touched.penetration - depth).abs()]);
            // 1 N for each µm, outwards from the axis.
            let force = touched.force(1e6);
            let outward = [0, 1, 2]
                .map(|i: usize| (turn[i][1] * own[1] + turn[i][2] * own[2]) / own[1].hypot(own[2]));
            let gaps = (0..3).map(|i| (force[i] - 1e6 * depth * outward[i]).abs());
            pushed = largest([pushed].into_iter().chain(gaps));
        }
    }
    for (id, what, unit, error, limit, why) in [
        (
            "law_2_17",
            "(2.17): place of 60 points seen from a turned race, largest error",
            "m",
            seen,
            2e-16,
            "some ulps of 0.25 m, from the origin of the world",
        ),
        (
            "law_2_18",
            "(2.18): penetration of those that touch, largest error",
            "m",
            apart,
            2e-16,
            "as the places",
        ),
        (
            "law_2_19",
            "(2.19): force on them at 1e6 N/m, largest error of a component",
            "N",
            pushed,
            2e-10,
            "as the places",
        ),
        (
            "law_touching",
            "points wrongly found inside or outside the race",
            "1",
            wrong as f64,
            0.0,
            "a count",
        ),
    ] {
        context.check(
            Check::new(id, what, unit, error)
                .closed_form(
                    0.0,
                    "the place in the race's own axes, from which its place in the world was made",
                )
                .absolute(limit, why),
        );
    }
    context.work("points inside the race", inside);
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    housings::assumptions(context);
    laws(context);
    let mut rows = Vec::new();
    for variant in &VARIANTS {
        rows.push(compare(context, variant)?);
    }
    two_housings::compare(context)?;
    context.table(
        "variants",
        "Outer race in its bore, ours against the oracle's; both take the mesh and the nodes' shares of the bore as given",
        &[
            "what",
            "housing, element, cells",
            "nodes",
            "touching nodes",
            "outer race moves, nm",
            "tilts, µrad",
            "off",
            "off true distances",
            "oracle unbalanced, N, first order / true",
            "its iterations, first order / true",
        ],
        rows,
    );
    Ok(())
}
