//! Rubber and bonded bushings for cases: inputs as the source states them, quarter models, their oracle, loops.

use std::f64::consts::{FRAC_PI_2, TAU};

use bearing_dynamics::assembly::lists::{Assembly, OUTER};
use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::ch2_housing::elastomer::{Elastomer, ElastomerError};
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::ch3_bushing::hysteresis::{Hysteresis, of_complex_stiffness};
use bearing_dynamics::members::body::{Body, Mobility};
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::mesh::generate::{Bushing, BushingMesh, Part, bushing};
use bearing_dynamics::mesh::{Elements, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::{DampedMotion, Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::rubber::explicit::RubberBody;
use bearing_dynamics::solids::rubber::harmonic::ComplexStiffness;
use bearing_dynamics::solids::rubber::model::{RubberModel, RubberProblem, supports};
use bearing_dynamics::solids::rubber::sleeve::{SleeveMotion, sleeve_supports};
use bearing_dynamics::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};
use bearing_dynamics::solids::rubber::tet_forces::MeanStress;

use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::oracles::bonded_bushing::{Section, radial_stiffness};

/// γ and τ (s) of Table 3.1.
pub const MAXWELL: [[f64; 2]; 14] = [
    [0.492, 10.0],
    [0.687, 2.42],
    [1.153, 0.59],
    [1.286, 0.14],
    [1.804, 0.0346],
    [1.944, 0.0084],
    [2.116, 0.002],
    [2.304, 4.92e-4],
    [2.485, 1.19e-4],
    [2.764, 2.89e-5],
    [2.798, 7.02e-6],
    [3.704, 1.7e-6],
    [1.912, 4.12e-7],
    [8.226, 1e-7],
];

/// C_R of Table 3.1, Pa.
pub const MODULUS: f64 = 0.647e6;
/// The bushing of 3.4.1.
pub const BUSHING: Bushing = Bushing { inner_diameter: 0.04, thickness: 0.02, length: 0.04 };
/// The bushing of 3.3.
pub const BUSHING_3_3: Bushing =
    Bushing { inner_diameter: 0.0197, thickness: 0.00835, length: 0.06 };

/// The shipped scene of the bushing of 3.4.1.
pub const BUSHING_RADIAL: &str = include_str!("../../scenes/bushing_radial.toml");

/// The shipped scene of a bearing on a bushing, hit.
pub const BEARING_ON_BUSHING: &str = include_str!("../../scenes/bearing_on_bushing.toml");
/// The bearing that creeps on rubber (2.4.3).
pub const CREEP_ON_RUBBER: &str = include_str!("../../scenes/creep_on_rubber.toml");

/// The shipped scene of a bearing with a dent in its fixed outer race.
pub const DENTED_RACE: &str = include_str!("../../scenes/dented_race.toml");

/// Maxwell elements of Table 3.1 in words of a scene, every γ times a factor, for `[spring.mount.bushing]`.
pub fn diluted(gammas: f64) -> String {
    let element = |[gamma, tau]: &[f64; 2]| {
        let gamma = gammas * gamma;
        format!(
            "\n[[spring.mount.bushing.maxwell]]\ngamma = {gamma}\nrelaxation_time = \"{tau} s\"\n"
        )
    };
    MAXWELL.iter().map(element).collect()
}

/// N and B/C_R of Tables 2.3 and 3.1.
pub const LOCKING: f64 = 8.0;
pub const BULK_RATIO: f64 = 100.0;

/// kg/m³: the source states none.
pub const DENSITY: f64 = 1100.0;

/// With C_R in Pa, and every γ times a factor; 0 is the network alone.
pub fn rubber(modulus: f64, gammas: f64, pull: ChainPull) -> Result<Elastomer, ElastomerError> {
    let network = EightChain::new(modulus, LOCKING, BULK_RATIO * modulus, pull)?;
    let all = MAXWELL.iter().filter(|_| gammas > 0.0);
    let maxwell =
        all.map(|[gamma, tau]| Maxwell::new(gammas * gamma, *tau)).collect::<Result<_, _>>()?;
    Ok(Elastomer { network, maxwell })
}

/// The rubber that stands in for that of the bushing of 3.3.
pub fn rubber_of_3_3(context: &mut CaseContext) -> Result<Elastomer, ElastomerError> {
    context.assumption(
        "rubber",
        "The constants of this bushing's rubber are not printed; those of Table 3.1 are used",
        "Table 3.1",
    );
    rubber(MODULUS, 1.0, ChainPull::FiveTerms)
}

/// 1 + Σ γ iωτ/(1 + iωτ), written for oracles.
pub fn complex_factor(gammas: f64, frequency: f64) -> nalgebra::Complex<f64> {
    let one = nalgebra::Complex::new(1.0, 0.0);
    MAXWELL.iter().fold(one, |sum, [gamma, tau]| {
        let x = nalgebra::Complex::new(0.0, TAU * frequency * tau);
        sum + x / (one + x) * (gammas * gamma)
    })
}

/// Shear modulus over C_R at N = 8: the slope of (2.8) at rest, twice.
pub fn shear_over_modulus() -> f64 {
    let x = 3.0 / LOCKING;
    let sum: f64 = [1.0 / 2.0, 1.0 / 10.0, 33.0 / 1050.0, 76.0 / 7000.0, 2595.0 / 673_750.0]
        .iter()
        .enumerate()
        .map(|(k, c)| c * x.powi(k as i32))
        .sum();
    2.0 * sum
}

/// A quarter of a bushing in `cells` around, across the wall and along half of the length.
pub fn quarter(body: &Bushing, cells: [usize; 3], grading: f64) -> Result<TetMesh, CaseError> {
    let [around, radial, axial] = cells;
    let mesh = BushingMesh { around, radial, axial, grading, part: Part::Quarter };
    Ok(bushing(body, &mesh)?.quadratic()?.mesh)
}

/// The quarter with its outer face held and its inner one moved along Z; and the nodes of that one. Forces
/// on them count four times.
pub fn bonded(
    mesh: &TetMesh,
    material: Elastomer,
    moved: Profile,
) -> Result<(RubberModel, Vec<u32>), CaseError> {
    let prescribed = held(mesh, moved);
    let Elements::Quadratic(elements) = mesh.elements.clone() else {
        return Err(CaseError::message("elements of ten nodes are needed"));
    };
    let nodes = mesh.nodes.clone();
    let problem = RubberProblem { nodes, elements, material, prescribed, loads: Vec::new() };
    Ok((RubberModel::new(problem)?, mesh.node_sets["inner"].clone()))
}

/// What the stiffness of a quarter says of the whole.
pub fn of_quarter(answer: &ComplexStiffness) -> Hysteresis {
    of_complex_stiffness(4.0 * answer.storage, 4.0 * answer.loss)
}

/// μ of the rubber of Table 3.1 with every γ times a factor, Pa.
pub fn complex_shear(gammas: f64, frequency: f64) -> nalgebra::Complex<f64> {
    complex_factor(gammas, frequency) * (shear_over_modulus() * MODULUS)
}

pub fn section(body: &Bushing) -> Section {
    let inner = 0.5 * body.inner_diameter;
    Section { inner, outer: inner + body.thickness, length: body.length }
}

/// Steady cycles of small amplitude by the oracle, of the rubber of Table 3.1 with every γ times a factor, by
/// polynomials of this degree.
pub fn exact(body: &Bushing, gammas: f64, frequency: f64, degree: usize) -> Hysteresis {
    let shear = complex_shear(gammas, frequency);
    let k = radial_stiffness(section(body), shear, BULK_RATIO * MODULUS, degree, 3);
    Hysteresis { dynamic_stiffness: k.norm(), damping_ratio: k.im / k.norm() }
}

/// A quarter in motion, and the force on the whole sleeve, N.
pub struct Moved<'a> {
    pub solid: RubberSolid<'a>,
    inner: &'a [u32],
}

impl<'a> Moved<'a> {
    pub fn new(
        model: &'a RubberModel,
        inner: &'a [u32],
        stepping: Stepping,
    ) -> Result<Moved<'a>, CaseError> {
        let options = StepOptions { stepping, ..Default::default() };
        Ok(Moved { solid: RubberSolid::new(model, options)?, inner })
    }

    pub fn force(&self) -> f64 {
        4.0 * self.solid.support_force(self.inner)[2]
    }

    /// Goes on and notes time (s) and force (N) of every step.
    pub fn advance(&mut self, until: f64, course: &mut Vec<[f64; 2]>) -> Result<f64, CaseError> {
        let inner = self.inner;
        self.solid.advance(until, |solid| {
            course.push([solid.time(), 4.0 * solid.support_force(inner)[2]]);
        })?;
        Ok(self.force())
    }
}

/// A steady loop of displacement (m) and force (N), and how many steps it took.
pub struct SteadyLoop {
    pub points: Vec<[f64; 2]>,
    pub steps: u64,
}

/// A sleeve that swings by `amplitude` (m) at `frequency` (Hz) in steps of which `per` make a cycle; the second
/// cycle is read. It begins with a jump to the amplitude: what an element then lacks of its steady cycle is
/// γ/(1 + ω²τ²), little of slow ones, and quick ones forget it.
pub fn steady_loop(
    mesh: &TetMesh,
    material: Elastomer,
    amplitude: f64,
    frequency: f64,
    per: usize,
) -> Result<SteadyLoop, CaseError> {
    let wave = Profile::Harmonic { mean: 0.0, amplitude, frequency, phase: FRAC_PI_2 };
    let (model, inner) = bonded(mesh, material, wave)?;
    let mut moved = Moved::new(&model, &inner, Stepping::Fixed(1.0 / (frequency * per as f64)))?;
    moved.advance(1.0 / frequency, &mut Vec::new())?;
    let mut course = Vec::new();
    moved.advance(2.0 / frequency, &mut course)?;
    let at = |t: f64| amplitude * (TAU * frequency * t).cos();
    let points = course.iter().map(|[t, force]| [at(*t), *force]).collect();
    Ok(SteadyLoop { points, steps: moved.solid.counts.accepted })
}

/// Stiffness against a motion of the sleeve of linear elastic elements of four nodes at a shear modulus (Pa) and the
/// bulk modulus of Table 3.1, N/m or N·m/rad.
pub fn four_nodes(
    body: &Bushing,
    cells: [usize; 3],
    shear: f64,
    motion: SleeveMotion,
) -> Result<f64, CaseError> {
    const BY: f64 = 1e-6;
    let [around, radial, axial] = cells;
    let mesh = BushingMesh { around, radial, axial, grading: 1.0, part: Part::Quarter };
    let mesh = bushing(body, &mesh)?.mesh;
    let mut prescribed = sleeve_supports(&mesh, Part::Quarter, motion);
    for of in &mut prescribed {
        of.profile = Profile::Constant(BY * of.profile.value(0.0));
    }
    let lambda = BULK_RATIO * MODULUS - 2.0 / 3.0 * shear;
    let problem = SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material: LinearElastic { lambda, shear_modulus: shear },
        density: DENSITY,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed,
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    let model = SolidModel::new(problem)?;
    let found = equilibrium(&model, 0.0, &EquilibriumOptions::default())?;
    let resists = mesh.node_sets["inner"].iter().map(|&node| {
        let (place, force) = (mesh.nodes[node as usize], found.reactions[node as usize]);
        match motion {
            SleeveMotion::Radial => force[2],
            SleeveMotion::Axial => force[0],
            SleeveMotion::Torsional => place[1] * force[2] - place[2] * force[1],
            SleeveMotion::Conical => place[2] * force[0] - place[0] * force[2],
        }
    });
    Ok(4.0 / BY * resists.sum::<f64>())
}

/// Puts the outer race of the only bearing on a spring to the ground.
pub fn spring_to_ground(assembly: &mut Assembly, law: SpringDashpot) {
    let ground = assembly.bodies.len();
    assembly.bodies.push(Body {
        name: "the ground".into(),
        label: None,
        mobility: Mobility::Fixed,
        rest: [0.0; 5],
        rotating_load: None,
        unbalance: 0.0,
    });
    assembly.connections.push(Connection {
        name: "the bushing".into(),
        label: None,
        ends: [ground, OUTER].map(Mount::at_centre),
        law: Law::SpringDashpot(law),
    });
}

/// Checks of an order that a sentence of the source states: `value` is at least zero.
pub fn order(
    context: &mut CaseContext,
    section: &str,
    sentence: &str,
    checks: &[(&str, &str, f64)],
) {
    for (id, text, value) in checks {
        context.check(
            Check::new(id, text, "1", *value)
                .stated(0.0, section, sentence)
                .at_least(0.0, "an order"),
        );
    }
}

/// The same quarter in four-node elements, for explicit steps of rubber of 1100 kg/m³; and the nodes that move.
pub fn bonded_tets(
    body: &Bushing,
    cells: [usize; 3],
    grading: f64,
    material: Elastomer,
    mean_stress: MeanStress,
    moved: Profile,
) -> Result<(RubberBody, Vec<u32>), CaseError> {
    let [around, radial, axial] = cells;
    let mesh = BushingMesh { around, radial, axial, grading, part: Part::Quarter };
    let mesh = bushing(body, &mesh)?.mesh;
    let Elements::Linear(elements) = mesh.elements.clone() else {
        return Err(CaseError::message("elements of four nodes are needed"));
    };
    let rubber = RubberBody {
        nodes: mesh.nodes.clone(),
        elements,
        material,
        density: DENSITY,
        mean_stress,
        mass_scale: 1.0,
        prescribed: held(&mesh, moved),
        loads: Vec::new(),
        gravity: [0.0; 3],
    };
    Ok((rubber, mesh.node_sets["inner"].clone()))
}

fn held(mesh: &TetMesh, moved: Profile) -> Vec<Prescribed> {
    const HELD: Option<Profile> = Some(Profile::ZERO);
    supports(
        mesh,
        &[
            ("outer", [HELD; 3]),
            ("inner", [HELD, HELD, Some(moved)]),
            ("x_low", [HELD, None, None]),
            ("y_low", [None, HELD, None]),
        ],
    )
}
