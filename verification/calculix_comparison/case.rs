//! One mesh solved by this program and by CalculiX: displacements, natural frequencies, and the matrices of
//! single elements.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::mesh::generate::bar;
use bearing_dynamics::mesh::measure::{Share, tributary_areas};
use bearing_dynamics::mesh::{Elements, Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::{DampedMotion, Load, Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::modes::{ModeOptions, Modes, modes};
use std::ops::Range;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::solids::{Vec3, mesh_of};

mod element;
mod oracle;
mod program;

use program::{Output, probes};

pub const CASE: Case = Case {
    id: "calculix_comparison",
    title: "Solids against CalculiX",
    section: "(2.2)–(2.7), (4.2)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Steel; SI units.
const YOUNG: f64 = 2.1e11;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 7800.0;
/// Force on the end face, N.
const FORCE: Vec3 = [1.5e-3, 3.5e-3, -2.5e-3];

/// Number of modes compared; a free body has six rigid ones.
const HELD_MODES: usize = 8;
const FREE_MODES: usize = 14;
const RIGID: usize = 6;
/// Modes of the Rayleigh–Ritz analysis with CalculiX' mass.
const SPAN: usize = 30;

struct Kind {
    tag: &'static str,
    name: &'static str,
    order: Order,
    cells: [usize; 3],
    /// CalculiX' quadrature of the mass.
    points: &'static str,
    /// Allowed relative difference of frequencies, and why.
    frequencies: (f64, &'static str),
    /// The same with CalculiX' mass.
    few_points: (f64, &'static str),
    /// Allowed relative difference of one element's whole mass, and why.
    total_mass: (f64, &'static str),
}

const KINDS: [Kind; 2] = [
    Kind {
        tag: "c3d4",
        name: "C3D4",
        order: Order::Linear,
        cells: [48, 6, 8],
        points: "one point",
        frequencies: (
            6e-3,
            "CalculiX integrates the mass with one point, which raises the frequency of torsion by 0.5 % on this mesh",
        ),
        few_points: (2e-6, "seven digits printed; Rayleigh–Ritz over the modes of the exact mass"),
        total_mass: (1e-12, "the volume times the density"),
    },
    Kind {
        tag: "c3d10",
        name: "C3D10",
        order: Order::Quadratic,
        cells: [24, 3, 4],
        points: "four points",
        frequencies: (6e-5, "CalculiX integrates the mass with four points, we with fifteen"),
        few_points: (5e-7, "seven digits printed; Rayleigh–Ritz over the modes of the exact mass"),
        total_mass: (1e-4, "four points miss 1e-5 of the volume of this curved element"),
    },
];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for (kind, theirs) in KINDS.iter().zip(program::kept(context)?) {
        let part = Part { kind, mesh: mesh(kind)?, theirs };
        part.statics(context)?;
        part.frequencies(context)?;
        element::matrices(context, kind, &part.theirs)?;
    }
    context.finding(
        "quadrature",
        "CalculiX integrates the mass with the quadrature points of the stiffness: one for C3D4, whose sixteen entries are then all \
         ρV/16 (the integral gives ρV/10 and ρV/20), four for C3D10. Products of shape functions need more points. The mass of motions that \
         vary within an element comes out too small and frequencies too high, most for torsion of C3D4. With CalculiX' mass our \
         frequencies agree with it to the digits that it prints.",
    );
    Ok(())
}

/// The largest of non-negative numbers; NaN stays.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, x| if most >= x { most } else { x })
}

fn not_understood(name: &str) -> CaseError {
    CaseError::message(format!("{name} is not understood"))
}

/// Largest difference of vectors over the largest component of `theirs`.
fn difference(ours: &[[f64; 3]], theirs: &[[f64; 3]]) -> f64 {
    if ours.len() != theirs.len() {
        return f64::NAN;
    }
    let pairs = ours.as_flattened().iter().zip(theirs.as_flattened());
    let scale = largest(theirs.as_flattened().iter().map(|x| x.abs()));
    largest(pairs.map(|(a, b)| (a - b).abs())) / scale
}

const LENGTH: f64 = 0.12;
/// Radius of the axis of the bent bar, m.
const BEND: f64 = 0.15;

/// A bar of 120 × 16 × 20 mm, tapered, twisted and bent: asymmetric, with curved elements between two plane
/// end faces `x_low` and `x_high`.
fn mesh(kind: &Kind) -> Result<TetMesh, CaseError> {
    let mut mesh = mesh_of(&bar([LENGTH, 0.016, 0.02], kind.cells)?, kind.order)?;
    for place in &mut mesh.nodes {
        let [x, y, z] = *place;
        let (taper, (sin, cos)) = (1.0 - 0.3 * x / LENGTH, (0.6 * x / LENGTH).sin_cos());
        let [y, z] = [taper * (cos * y - sin * z), taper * (sin * y + cos * z)];
        let (sin, cos) = (x / BEND).sin_cos();
        *place = [(BEND - z) * sin, y, BEND - (BEND - z) * cos];
    }
    Ok(mesh)
}

/// Forces on all nodes from the face `x_high`, N.
fn forces(mesh: &TetMesh) -> Result<Vec<Vec3>, CaseError> {
    let areas = tributary_areas(mesh, mesh.surface_set("x_high")?, Share::Consistent);
    let whole: f64 = areas.iter().sum();
    Ok(areas.iter().map(|area| FORCE.map(|force| force * area / whole)).collect())
}

/// The bar in elements of one kind, and CalculiX' results for it.
struct Part {
    kind: &'static Kind,
    mesh: TetMesh,
    theirs: Output,
}

impl Part {
    fn id(&self, what: &str) -> String {
        format!("{}_{what}", self.kind.tag)
    }

    /// Fixed at the face `x_low` or free, with the forces times `factor`.
    fn model(&self, held: bool, factor: f64) -> Result<SolidModel, CaseError> {
        let mut prescribed = Vec::new();
        if held {
            for &node in self.mesh.node_set("x_low")? {
                prescribed.extend((0..3).map(|axis| Prescribed {
                    node,
                    axis,
                    profile: Profile::ZERO,
                }));
            }
        }
        let forces =
            forces(&self.mesh)?.into_iter().enumerate().map(|(node, force)| (node as u32, force));
        let load = Load { forces: forces.collect(), profile: Profile::Constant(factor) };
        model(self.mesh.nodes.clone(), self.mesh.elements.clone(), prescribed, vec![load])
    }

    fn statics(&self, context: &mut CaseContext) -> Result<(), CaseError> {
        let name = self.kind.name;
        let options = EquilibriumOptions::default();
        let solved = |factor| -> Result<_, CaseError> {
            Ok(equilibrium(&self.model(true, factor)?, 0.0, &options)?.displacement)
        };
        let (whole, half) = (solved(1.0)?, solved(0.5)?);
        let probed: Vec<_> = probes(whole.len()).map(|node| whole[node]).collect();
        let doubled: Vec<_> = half.into_iter().map(|u| u.map(|x| 2.0 * x)).collect();
        context.check(
            Check::new(
                &self.id("nonlinearity"),
                &format!("{name}: displacements against twice those under half the load"),
                "1",
                difference(&doubled, &whole),
            )
            .consistency(
                0.0,
                "our own solutions under two loads: the response of a linear solid is proportional",
            )
            .absolute(1e-6, "the loads are small enough that our quadratic strain does not matter"),
        );
        context.check(
            Check::new(
                &self.id("displacement"),
                &format!("{name}: displacements of {} nodes, over the largest", probed.len()),
                "1",
                difference(&probed, &self.theirs.displacements),
            )
            .independent(0.0, "CalculiX, linear static")
            .absolute(
                2e-6,
                "same elements, nodes and forces; seven digits printed, 4e-7 of the largest",
            ),
        );
        let most = |axis: usize| largest(whole.iter().map(|u| u[axis].abs()));
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            context.check(
                Check::new(
                    &self.id(&format!("largest_u{letter}")),
                    &format!("{name}: largest displacement along {letter}"),
                    "m",
                    most(axis),
                )
                .independent(self.theirs.largest[axis], "CalculiX, linear static")
                .relative(5e-6, "as the displacements"),
            );
        }
        Ok(())
    }

    fn frequencies(&self, context: &mut CaseContext) -> Result<(), CaseError> {
        let held = modes(&self.model(true, 0.0)?, &ModeOptions::new(SPAN))?;
        self.compare_frequencies(context, "held", &held, 0..HELD_MODES)?;
        let free = modes(&self.model(false, 0.0)?, &ModeOptions::new(SPAN))?;
        self.compare_frequencies(context, "free", &free, RIGID..FREE_MODES)
    }

    fn compare_frequencies(
        &self,
        context: &mut CaseContext,
        support: &str,
        found: &Modes,
        elastic: Range<usize>,
    ) -> Result<(), CaseError> {
        let Kind { name, frequencies: (tolerance, why), few_points, .. } = self.kind;
        let (rigid, count) = (elastic.start, elastic.end);
        let first = count - rigid;
        let theirs = if rigid > 0 { &self.theirs.free } else { &self.theirs.held };
        if theirs.len() != count {
            return Err(CaseError::message(format!("{} modes of {count}", theirs.len())));
        }
        let ours: Vec<f64> = found.modes.iter().map(|mode| mode.frequency).collect();
        let apart = |ours: &[f64], modes: Range<usize>| {
            largest(modes.map(|i| (ours[i] / theirs[i] - 1.0).abs()))
        };
        context.check(
            Check::new(
                &self.id(&format!("{support}_frequencies")),
                &format!(
                    "{name}, {support}: first {first} frequencies, largest relative difference"
                ),
                "1",
                apart(&ours, rigid..rigid + first),
            )
            .independent(0.0, "CalculiX")
            .absolute(*tolerance, why),
        );
        if rigid > 0 {
            context.check(
                Check::new(&self.id("rigid"), &format!("{name}: largest of the six frequencies of rigid motion"), "Hz", ours[rigid - 1])
                    .closed_form(0.0, "a free body has six rigid motions")
                    .absolute(0.03,
"rounding: 1e-8 (the root of 1e-16) of an element's own frequency, about a megahertz"),
            );
        }
        let mut columns = vec!["mode", "ours, Hz", "CalculiX, Hz", "difference"];
        let mut rows: Vec<Vec<String>> = (rigid..count)
            .map(|i| {
                let difference = format!("{:.1e}", ours[i] / theirs[i] - 1.0);
                vec![
                    format!("{}", i + 1),
                    format!("{:.3}", ours[i]),
                    format!("{:.3}", theirs[i]),
                    difference,
                ]
            })
            .collect();
        let as_theirs = self.with_few_points(found)?;
        context.check(
            Check::new(
                &self.id(&format!("{support}_few_points")),
                &format!(
                    "{name}, {support}: all {} frequencies with masses by {}",
                    count - rigid,
                    self.kind.points
                ),
                "1",
                apart(&as_theirs, elastic.clone()),
            )
            .independent(0.0, "CalculiX")
            .absolute(few_points.0, few_points.1),
        );
        let fewer = format!("ours, mass by {}, Hz", self.kind.points);
        columns.extend([fewer.as_str(), "difference"]);
        for (row, i) in rows.iter_mut().zip(rigid..count) {
            row.push(format!("{:.3}", as_theirs[i]));
            row.push(format!("{:.1e}", as_theirs[i] / theirs[i] - 1.0));
        }
        context.table(
            &self.id(&format!("{support}_table")),
            &format!("{name}, {support}: natural frequencies"),
            &columns,
            rows,
        );
        Ok(())
    }

    /// Our frequencies with CalculiX' mass.
    fn with_few_points(&self, found: &Modes) -> Result<Vec<f64>, CaseError> {
        let frequencies: Vec<f64> = found.modes.iter().map(|mode| mode.frequency).collect();
        let shapes: Vec<_> = found.modes.iter().map(|mode| mode.shape.clone()).collect();
        let elements: Vec<Vec<usize>> = (0..self.mesh.elements.len())
            .map(|of| self.mesh.elements.nodes(of).iter().map(|node| *node as usize).collect())
            .collect();
        oracle::few_point_frequencies(&self.mesh.nodes, &elements, DENSITY, &frequencies, &shapes)
            .ok_or_else(|| CaseError::message("CalculiX' mass is not positive over the modes"))
    }
}

fn model(
    nodes: Vec<[f64; 3]>,
    elements: Elements,
    prescribed: Vec<Prescribed>,
    loads: Vec<Load>,
) -> Result<SolidModel, CaseError> {
    Ok(SolidModel::new(SolidProblem {
        nodes,
        elements,
        material: LinearElastic::new(YOUNG, POISSON)?,
        density: DENSITY,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed,
        loads,
        gravity: [0.0; 3],
    })?)
}
