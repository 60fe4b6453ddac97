//! One element and small patches of them: the laws that any tetrahedron must keep, both printed
//! routes to its forces, and the orders of convergence.

use bearing_dynamics::elements::tet4::{Tet4, relative};
use bearing_dynamics::elements::tet10::Tet10;
use bearing_dynamics::kinematics::strain::{Sym3, right_cauchy_green, von_mises};
use bearing_dynamics::mesh::generate::{Ring, RingMesh, bar, ring};
use bearing_dynamics::mesh::measure::total_volume;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::stress::nodal_stresses;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::solids::{
    Material, STEEL, Vec3, body_force, constant_load, field_error, free_body, largest, mesh_of,
    name_of, prescribe, size_of,
};

mod oracle;

pub const CASE: Case = Case {
    id: "solid_elements",
    title: "Tetrahedra: patches, rigid motion, force routes, orders of convergence",
    section: "2.2.2 and 4.2.2, (2.2)–(2.6), (4.2)–(4.7)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const ORDERS: [Order; 2] = [Order::Linear, Order::Quadratic];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for order in ORDERS {
        patch(context, order)?;
        rigid_motion(context, order)?;
        free_fall(context, order)?;
        masses(context, order)?;
    }
    right_cauchy_green_tensor(context);
    single_elements(context)?;
    manufactured(context)?;
    Ok(())
}

/// A cube of 20 mm in 3 × 3 × 3 cells with its inner nodes shaken.
fn shaken_cube(order: Order) -> Result<TetMesh, CaseError> {
    let side = 0.02;
    let mut solid = bar([side; 3], [3, 3, 3])?;
    for (n, place) in solid.mesh.nodes.iter_mut().enumerate() {
        let inside = place[0] > 1e-9
            && place[0] < side - 1e-9
            && place[1..].iter().all(|x| x.abs() < 0.5 * side - 1e-9);
        if inside {
            for (i, x) in place.iter_mut().enumerate() {
                *x += 1.2e-3 * (7.3 * n as f64 + 2.9 * i as f64).sin();
            }
        }
    }
    Ok(mesh_of(&solid, order)?)
}

/// Uniform strain given on the outside of a shaken mesh must come out everywhere inside.
fn patch(context: &mut CaseContext, order: Order) -> Result<(), CaseError> {
    const GRADIENT: [Vec3; 3] = [[1e-3, 2e-4, -3e-4], [4e-4, -5e-4, 1e-4], [0.0, 3e-4, 2e-4]];
    let field = |x: Vec3| GRADIENT.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
    let mesh = shaken_cube(order)?;
    let (low, high) = mesh.bounding_box();
    let mut problem = free_body(&mesh, STEEL);
    prescribe(&mut problem, |x| {
        let outside = (0..3).any(|i| x[i] < low[i] + 1e-9 || x[i] > high[i] - 1e-9);
        if outside { field(x).map(Some) } else { [None; 3] }
    });
    let model = SolidModel::new(problem)?;
    let options = EquilibriumOptions { tolerance: 1e-13, ..Default::default() };
    let found = equilibrium(&model, 0.0, &options)?;
    let exact: Vec<Vec3> = mesh.nodes.iter().map(|x| field(*x)).collect();
    context.check(
        Check::new(
            &format!("patch_{}", name_of(order)),
            &format!("{}: largest error of a displacement over the largest one", name_of(order)),
            "1",
            largest_difference(&found.displacement, &exact),
        )
        .closed_form(0.0, "the uniform strain given on the outside")
        .absolute(2e-14, "rounding of a solve with 24 to 375 unknowns, 2e-15"),
    );
    Ok(())
}

/// Largest |a − b| of all components over the largest |b|.
fn largest_difference(a: &[Vec3], b: &[Vec3]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    largest(pairs.map(|(a, b)| (a - b).abs())) / largest(b.iter().flatten().map(|x| x.abs()))
}

/// A large turn and shift leave no stress and no force.
fn rigid_motion(context: &mut CaseContext, order: Order) -> Result<(), CaseError> {
    let mesh = shaken_cube(order)?;
    let model = SolidModel::new(free_body(&mesh, STEEL))?;
    let turn = nalgebra::Rotation3::from_euler_angles(0.7, -1.1, 2.3);
    let moved: Vec<Vec3> = mesh
        .nodes
        .iter()
        .map(|x| {
            let x = nalgebra::Vector3::from(*x);
            (turn * x - x + nalgebra::Vector3::new(0.02, -0.01, 0.03)).into()
        })
        .collect();
    let stress = nodal_stresses(&model, &moved);
    let name = name_of(order);
    context.check(
        Check::new(
            &format!("rigid_stress_{name}"),
            &format!("{name}: largest von Mises stress after a rigid motion, over E"),
            "1",
            largest(stress.iter().map(von_mises)) / STEEL.young,
        )
        .closed_form(0.0, "no strain, no stress")
        .absolute(5e-14, "rounding of displacement gradients of up to 2, 7e-15"),
    );
    let padded: Vec<_> = moved.iter().map(|u| [u[0], u[1], u[2], 0.0]).collect();
    let mut forces = vec![[0.0; 4]; padded.len()];
    model.add_internal_forces(&padded, &mut forces);
    let cell = 0.02 / 3.0;
    context.check(
        Check::new(
            &format!("rigid_force_{name}"),
            &format!("{name}: largest nodal force after a rigid motion, over E and a cell's side"),
            "1",
            largest(forces.iter().flatten().map(|f| f.abs())) / (STEEL.young * cell * cell),
        )
        .closed_form(0.0, "no strain, no force")
        .absolute(5e-14, "rounding of displacement gradients of up to 2, 4e-15"),
    );
    Ok(())
}

fn free_fall(context: &mut CaseContext, order: Order) -> Result<(), CaseError> {
    const GRAVITY: Vec3 = [0.3, -2.0, -9.81];
    for (method, key, steps) in [
        (ExplicitMethod::CentralDifferences, "central", 100),
        (ExplicitMethod::RungeKutta, "rk4", 100),
    ] {
        let mesh = shaken_cube(order)?;
        let still = vec![[0.0; 3]; mesh.nodes.len()];
        let mut problem = free_body(&mesh, STEEL);
        problem.gravity = GRAVITY;
        let model = SolidModel::new(problem)?;
        let stepping = SolidStepping::FractionOfLimit(0.5);
        let mut solid = ExplicitSolid::new(model, method, stepping, still.clone(), still)?;
        for _ in 0..steps {
            solid.step(|_, _, _| {})?;
        }
        let t = solid.time;
        let ratios = solid
            .displacement
            .iter()
            .flat_map(|u| [0, 1, 2].map(|i: usize| u[i] / (0.5 * GRAVITY[i] * t * t)));
        let off = largest(ratios.map(|ratio| (ratio - 1.0).abs()));
        let name = name_of(order);
        context.check(
            Check::new(
                &format!("free_fall_{name}_{key}"),
                &format!("{name}, {key}: largest |a/g − 1| of a node after {steps} steps"),
                "1",
                off,
            )
            .closed_form(0.0, "free fall, u = ½ g t²")
            .absolute(2e-13, "rounding of a sum of 100 steps, 3e-14"),
        );
    }
    Ok(())
}

fn masses(context: &mut CaseContext, order: Order) -> Result<(), CaseError> {
    let name = name_of(order);
    let cube = SolidModel::new(free_body(&shaken_cube(order)?, STEEL))?;
    context.check(
        Check::new(
            &format!("mass_cube_{name}"),
            &format!("{name}: sum of lumped masses of a shaken cube over ρV"),
            "1",
            cube.mass.iter().sum::<f64>() / (STEEL.density * 8e-6),
        )
        .closed_form(1.0, "ρV of a cube of 20 mm")
        .absolute(1e-14, "rounding of 162 volumes, an ulp or two"),
    );
    let body = Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.01 };
    let cells = RingMesh { around: 24, radial: 2, axial: 1, radial_growth: 1.0 };
    let mesh = mesh_of(&ring(&body, &cells)?, order)?;
    let model = SolidModel::new(free_body(&mesh, STEEL))?;
    context.check(
        Check::new(
            &format!("mass_ring_{name}"),
            &format!("{name}: sum of lumped masses of a meshed ring over ρV of the mesh"),
            "1",
            model.mass.iter().sum::<f64>() / (STEEL.density * total_volume(&mesh)),
        )
        .consistency(
            1.0,
            "lumped masses of the solid against our own measure of its mesh, by another quadrature",
        )
        .absolute(1e-14, "both integrate polynomials exactly; rounding, 2e-15"),
    );
    Ok(())
}

/// C of (2.2) as the library makes it, by way of the strain, against FᵀF by plain products.
fn right_cauchy_green_tensor(context: &mut CaseContext) {
    let mut seed = 11;
    let mut gaps = Vec::new();
    for _ in 0..100 {
        let h = [[0.0; 3]; 3].map(|row: Vec3| row.map(|_| 0.5 * scatter(&mut seed)));
        let f = nalgebra::Matrix3::from(h).transpose() + nalgebra::Matrix3::identity();
        let c = f.transpose() * f;
        let plain = [c.m11, c.m22, c.m33, c.m12, c.m23, c.m13];
        gaps.extend(right_cauchy_green(&h).iter().zip(plain).map(|(a, b)| (a - b).abs()));
    }
    context.check(
        Check::new("right_cauchy_green", "largest difference of C from FᵀF", "1", largest(gaps))
            .closed_form(0.0, "FᵀF by plain products")
            .absolute(1e-14, "rounding of sums of up to 4"),
    );
}

/// Numbers without pattern in (−1, 1).
fn scatter(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

const CORNERS: [Vec3; 4] = [[0.0; 3], [1.1, 0.1, -0.1], [0.2, 0.9, 0.1], [0.1, 0.3, 1.2]];
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// Forces of single elements under large random displacements: the two printed routes, the direct
/// formula, and the derivative of the energy.
fn single_elements(context: &mut CaseContext) -> Result<(), CaseError> {
    let model = free_body(&shaken_cube(Order::Linear)?, STEEL).material;
    let law = |strain: &Sym3| model.second_piola_kirchhoff(strain);
    let lame = lame(STEEL);
    let mut seed = 7;
    let mut gaps: [Vec<f64>; 4] = Default::default();
    for _ in 0..50 {
        let shake = |places: &[Vec3], by: f64, seed: &mut u64| -> Vec<Vec3> {
            places.iter().map(|x| x.map(|x| x + by * scatter(seed))).collect()
        };
        let places = shake(&CORNERS, 0.1, &mut seed);
        let moves = shake(&[[0.0; 3]; 4], 0.15, &mut seed);
        let corners: [Vec3; 4] = std::array::from_fn(|i| places[i]);
        let moved: [Vec3; 4] = std::array::from_fn(|i| moves[i]);
        let tet = Tet4::new(&corners)?;
        let [a, b, c] = tet.nodal_forces(&relative(&moved), law);
        let direct = [a, b, c, [0, 1, 2].map(|i: usize| -(a[i] + b[i] + c[i]))];
        gaps[0].push(largest_difference(&tet.face_forces_deformed(&corners, &moved, law), &direct));
        gaps[1]
            .push(largest_difference(&tet.face_forces_undeformed(&corners, &moved, law), &direct));
        gaps[2].push(largest_difference(
            &direct,
            &minus_slope(&oracle::energy::<12>(&corners, &moved, lame).gradient),
        ));

        // Ten nodes, edges curved a little.
        let straight: Vec<Vec3> = (0..10)
            .map(|n| match n {
                0..4 => corners[n],
                _ => {
                    let [a, b] = EDGES[n - 4];
                    [0, 1, 2].map(|i: usize| 0.5 * (corners[a][i] + corners[b][i]))
                }
            })
            .collect();
        let places = shake(&straight, 0.03, &mut seed);
        let moves = shake(&[[0.0; 3]; 10], 0.06, &mut seed);
        let nodes: [Vec3; 10] = std::array::from_fn(|i| places[i]);
        let moved: [Vec3; 10] = std::array::from_fn(|i| moves[i]);
        let forces = Tet10::new(&nodes)?.nodal_forces(&moved, law);
        gaps[3].push(largest_difference(
            &forces,
            &minus_slope(&oracle::energy::<30>(&nodes, &moved, lame).gradient),
        ));
    }
    let worst = gaps.map(largest);
    let rounding = "rounding of some hundred products, strains of up to 0.4: 7e-15";
    let states = [
        ("route_deformed", "Cauchy traction on deformed faces (2.5)–(2.6) against −V P ∇N"),
        (
            "route_undeformed",
            "pushed-forward traction on undeformed faces (4.6)–(4.7) against −V P ∇N",
        ),
    ];
    for (at, (id, text)) in states.into_iter().enumerate() {
        context.check(
            Check::new(id, &format!("tet4: {text}, largest difference"), "1", worst[at])
                .consistency(0.0, "the printed route against our direct formula for the same force")
                .absolute(5e-14, rounding),
        );
    }
    for (at, name) in [(2, "tet4"), (3, "tet10")] {
        context.check(
            Check::new(
                &format!("energy_slope_{name}"),
                &format!(
                    "{name}: forces against minus the derivative of the energy, largest difference"
                ),
                "1",
                worst[at],
            )
            .independent(0.0, "exact derivative of the energy written in C = FᵀF")
            .absolute(5e-14, rounding),
        );
    }
    context.finding(
        "sign_of_face_forces",
        "Both printed routes give the element's force on its node only with the opposite sign: a third \
         of each face's traction, summed as printed in (2.6) and (4.6)–(4.7), is what the surroundings \
         must apply, plus the derivative of the energy.",
    );
    Ok(())
}

fn lame(material: Material) -> oracle::Lame {
    let Material { young, poisson, .. } = material;
    oracle::Lame {
        lambda: young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)),
        mu: 0.5 * young / (1.0 + poisson),
    }
}

fn minus_slope(gradient: &[f64]) -> Vec<Vec3> {
    gradient.chunks(3).map(|c| [-c[0], -c[1], -c[2]]).collect()
}

/// A given smooth displacement, the body force that it needs, and how fast the error falls.
fn manufactured(context: &mut CaseContext) -> Result<(), CaseError> {
    const SOFT: Material = Material { young: 1e6, poisson: 0.3, density: 1000.0 };
    let mut rows = Vec::new();
    for (order, cells, expected, coarse) in
        [(Order::Linear, [3, 6, 12], 2.0, 0.02), (Order::Quadratic, [2, 4, 8], 3.0, 1e-3)]
    {
        let name = name_of(order);
        let mut errors = Vec::new();
        for n in cells {
            let mesh = mesh_of(&bar([1.0; 3], [n; 3])?, order)?;
            let (low, high) = mesh.bounding_box();
            let mut problem = free_body(&mesh, SOFT);
            prescribe(&mut problem, |x| {
                let outside = (0..3).any(|i| x[i] < low[i] + 1e-9 || x[i] > high[i] - 1e-9);
                if outside { oracle::displacement(x).map(Some) } else { [None; 3] }
            });
            let force = |x: Vec3| oracle::body_force(x, lame(SOFT));
            problem.loads.push(constant_load(body_force(&mesh, force)));
            let model = SolidModel::new(problem)?;
            let found = equilibrium(&model, 0.0, &EquilibriumOptions::default())?;
            let error = field_error(&mesh, &found.displacement, oracle::displacement);
            let observed = errors
                .last()
                .map_or("–".to_string(), |last: &f64| format!("{:.3}", (last / error).log2()));
            rows.push(vec![name.to_string(), size_of(&mesh), format!("{error:.3e}"), observed]);
            errors.push(error);
        }
        let order = (errors[1] / errors[2]).log2();
        context.check(
            Check::new(
                &format!("order_{name}"),
                &format!("{name}: observed order of the error in L2, last two meshes"),
                "1",
                order,
            )
            .closed_form(expected, "order of the interpolation, degree + 1")
            .absolute(0.1, "next term of the error on meshes this coarse")
            .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(
                &format!("error_{name}"),
                &format!("{name}: error in L2 on the finest mesh, over the field"),
                "1",
                errors[2],
            )
            .closed_form(0.0, "the given field")
            .absolute(coarse, "three to four times the error of this coarse mesh; guards against the right order of a wrong limit")
            .golden(GoldenTolerance::MIXED),
        );
    }
    context.table(
        "convergence",
        "Given displacement field on a cube, large strains, body force from exact derivatives",
        &["element", "mesh", "error in L2", "observed order"],
        rows,
    );
    Ok(())
}
