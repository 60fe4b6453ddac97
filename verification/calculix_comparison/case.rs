//! The same Gmsh meshes solved here and by CalculiX: displacements, natural frequencies, and the
//! matrices of single elements.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::mesh::measure::{Share, tributary_areas};
use bearing_dynamics::mesh::read::{LengthUnit, read_gmsh};
use bearing_dynamics::mesh::{Elements, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::{DampedMotion, Load, Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::modes::{ModeOptions, Modes, modes};
use std::ops::Range;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;

mod again;
mod element;
mod files;
mod oracle;

pub const CASE: Case = Case {
    id: "calculix_comparison",
    title: "Solids against CalculiX",
    section: "(2.2)–(2.7), (4.2)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Of `steel.inp`, SI units.
const YOUNG: f64 = 2.1e11;
const POISSON: f64 = 0.3;
const DENSITY: f64 = 7800.0;
/// Force on the loaded face, N; of `bracket.py`.
const FORCE: [f64; 3] = [1.5e-3, 3.5e-3, -2.5e-3];

/// kg/mm³, for masses over the decks' places.
const DENSITY_PER_MM3: f64 = DENSITY * MM * MM * MM;

/// Units of the decks (mm, N, t) in SI units.
const MM: f64 = 1e-3;
const N_PER_MM: f64 = 1e3;
const TONNE: f64 = 1e3;

/// Rounding times the condition of the stiffness, some 1e7.
const SOLVED: GoldenTolerance = GoldenTolerance { relative: 1e-8, absolute: 0.0 };

/// Modes that the decks ask for.
const HELD_MODES: usize = 8;
const FREE_MODES: usize = 14;
const RIGID: usize = 6;
/// Modes over which CalculiX' mass is put: what lies beyond hardly takes part.
const SPAN: usize = 30;

struct Kind {
    tag: &'static str,
    name: &'static str,
    nodes_per_element: usize,
    /// CalculiX' quadrature of the mass.
    points: &'static str,
    /// Allowed relative difference of frequencies, and why.
    frequencies: (f64, &'static str),
    /// How many elastic modes that holds for, held and free; CalculiX' mass serves for all.
    first: [usize; 2],
    /// The same with CalculiX' mass.
    few_points: (f64, &'static str),
    /// Allowed relative difference of one element's whole mass, and why.
    total_mass: (f64, &'static str),
}

const KINDS: [Kind; 2] = [
    Kind {
        tag: "c3d4",
        name: "C3D4",
        nodes_per_element: 4,
        points: "one point",
        frequencies: (
            1e-3,
            "modes whose waves are long against the elements: CalculiX integrates the mass with one point",
        ),
        first: [5, 2],
        few_points: (2e-6, "seven digits printed; Rayleigh–Ritz over the modes of the exact mass"),
        total_mass: (1e-12, "the volume times the density"),
    },
    Kind {
        tag: "c3d10",
        name: "C3D10",
        nodes_per_element: 10,
        points: "four points",
        frequencies: (
            3e-5,
            "CalculiX integrates the mass with four points, we with fifteen: 3e-6 held, 1e-5 free",
        ),
        first: [HELD_MODES, FREE_MODES - RIGID],
        few_points: (5e-7, "seven digits printed; Rayleigh–Ritz over the modes of the exact mass"),
        total_mass: (
            1e-4,
            "four points do not give the volume of this element, curved on purpose, exactly: 1e-5 are missing",
        ),
    },
];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let altered = files::altered();
    if !altered.is_empty() {
        let names = altered.join(", ");
        return Err(CaseError::message(format!("not as SHA256SUMS has them: {names}")));
    }
    for kind in &KINDS {
        let part = Part::read(kind)?;
        part.compare_meshes(context)?;
        part.statics(context)?;
        part.frequencies(context)?;
        element::matrices(context, kind)?;
    }
    context.finding(
        "quadrature",
        "CalculiX integrates masses with the quadrature points of its stiffness: one for C3D4, whose sixteen entries are then all \
         ρV/16 (the integral gives ρV/10 and ρV/20), four for C3D10. That is too few for products of shape functions: what varies \
         within a C3D4 weighs nothing, and what is not linear within a C3D10 weighs too little, so that frequencies come out \
         higher, torsion of C3D4 most (1 % on this mesh). With its masses our frequencies are CalculiX' own to the digits it prints.",
    );
    again::run(context)
}

/// The largest of non-negative numbers; NaN stays.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |most, x| if most >= x { most } else { x })
}

fn not_understood(name: &str) -> CaseError {
    CaseError::message(format!("{name} is not understood"))
}

fn kept<T>(name: &str, parse: impl Fn(&str) -> Option<T>) -> Result<T, CaseError> {
    parse(files::text(name)?).ok_or_else(|| not_understood(name))
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

/// The bracket as a `.msh` gives it to us, and as a deck gives it to CalculiX.
struct Part {
    kind: &'static Kind,
    mesh: TetMesh,
    deck: oracle::Deck,
}

impl Part {
    fn read(kind: &'static Kind) -> Result<Part, CaseError> {
        let name = format!("bracket_{}.msh", kind.tag);
        let mesh = read_gmsh(files::text(&name)?.as_bytes(), LengthUnit::Millimetre)?.mesh;
        let deck = kept(&format!("bracket_{}_mesh.inp", kind.tag), oracle::deck)?;
        Ok(Part { kind, mesh, deck })
    }

    fn id(&self, what: &str) -> String {
        format!("{}_{what}", self.kind.tag)
    }

    /// Forces on all nodes from the named face, N.
    fn forces(&self) -> Result<Vec<[f64; 3]>, CaseError> {
        let areas =
            tributary_areas(&self.mesh, self.mesh.surface_set("loaded")?, Share::Consistent);
        let whole: f64 = areas.iter().sum();
        Ok(areas.iter().map(|area| FORCE.map(|force| force * area / whole)).collect())
    }

    /// Held at the named face or free, with `factor` times the forces.
    fn model(&self, held: bool, factor: f64) -> Result<SolidModel, CaseError> {
        let mut prescribed = Vec::new();
        if held {
            for &node in self.mesh.node_set("held")? {
                prescribed.extend((0..3).map(|axis| Prescribed {
                    node,
                    axis,
                    profile: Profile::ZERO,
                }));
            }
        }
        let forces =
            self.forces()?.into_iter().enumerate().map(|(node, force)| (node as u32, force));
        let load = Load { forces: forces.collect(), profile: Profile::Constant(factor) };
        model(self.mesh.nodes.clone(), self.mesh.elements.clone(), prescribed, vec![load])
    }

    fn compare_meshes(&self, context: &mut CaseContext) -> Result<(), CaseError> {
        let Kind { name, nodes_per_element, .. } = self.kind;
        let theirs: Vec<_> = self.deck.nodes.iter().map(|place| place.map(|x| x * MM)).collect();
        context.check(
            Check::new(
                &self.id("nodes"),
                &format!("{name}: places of nodes, over the size of the part"),
                "1",
                difference(&self.mesh.nodes, &theirs),
            )
            .independent(0.0, "deck written through Gmsh's interface")
            .absolute(1e-15, "the same decimals, one rounding in the change of unit"),
        );
        let mut others = self.deck.elements.len().abs_diff(self.mesh.elements.len());
        for (index, nodes) in self.deck.elements.iter().enumerate().take(self.mesh.elements.len()) {
            let ours = self.mesh.elements.nodes(index);
            let same = nodes.len() == *nodes_per_element
                && ours.iter().map(|node| *node as usize).eq(nodes.iter().copied());
            others += usize::from(!same);
        }
        let held: Vec<usize> =
            self.mesh.node_set("held")?.iter().map(|node| *node as usize).collect();
        context.check(
            Check::new(
                &self.id("elements"),
                &format!("{name}: elements with other nodes than the deck's"),
                "1",
                others as f64,
            )
            .independent(0.0, "deck written through Gmsh's interface")
            .absolute(0.5, "a count"),
        );
        let strays = held.iter().filter(|node| !self.deck.held.contains(node)).count()
            + self.deck.held.iter().filter(|node| !held.contains(node)).count();
        context.check(
            Check::new(
                &self.id("held_set"),
                &format!("{name}: held nodes that only one program holds"),
                "1",
                strays as f64,
            )
            .independent(0.0, "nodes of the physical group, as Gmsh lists them")
            .absolute(0.5, "a count"),
        );
        let loads = kept(&format!("bracket_{}_loads.inp", self.kind.tag), |text| {
            oracle::loads(text, self.deck.nodes.len())
        })?;
        context.check(
            Check::new(
                &self.id("forces"),
                &format!("{name}: nodal forces, over the largest"),
                "1",
                difference(&self.forces()?, &loads),
            )
            .independent(
                0.0,
                "a third of each flat triangle's force to each of its nodes, by bracket.py",
            )
            .absolute(
                if self.kind.tag == "c3d4" { 1e-11 } else { 1e-7 },
                "places are rounded to 1e-7 mm, which bends the edges of quadratic triangles by 1e-8; flat ones are the same, 3e-13",
            ),
        );
        Ok(())
    }

    fn statics(&self, context: &mut CaseContext) -> Result<(), CaseError> {
        let name = self.kind.name;
        let options = EquilibriumOptions::default();
        let solved = |factor| -> Result<_, CaseError> {
            Ok(equilibrium(&self.model(true, factor)?, 0.0, &options)?.displacement)
        };
        let (whole, half) = (solved(1.0)?, solved(0.5)?);
        let theirs = kept(&format!("kept/{}_static.dat", self.kind.tag), oracle::displacements)?;
        let theirs: Vec<_> = theirs.into_iter().map(|u| u.map(|x| x * MM)).collect();
        let doubled: Vec<_> = half.into_iter().map(|u| u.map(|x| 2.0 * x)).collect();
        context.check(
            Check::new(&self.id("nonlinearity"), &format!("{name}: displacements against twice those of half the load"), "1", difference(&doubled, &whole))
                .consistency(0.0, "our own solutions under two loads: a linear solid answers in proportion")
                .absolute(1e-6, "so small are the loads that the quadratic strain cannot be what differs from CalculiX"),
        );
        context.check(
            Check::new(
                &self.id("displacement"),
                &format!("{name}: displacements of all {} nodes, over the largest", whole.len()),
                "1",
                difference(&whole, &theirs),
            )
            .independent(0.0, "CalculiX, linear static")
            .absolute(
                2e-6,
                "same elements, nodes and forces; seven digits printed, 4e-7 of the largest",
            ),
        );
        let most = |axis: usize| largest(whole.iter().map(|u| u[axis].abs()));
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            let of_theirs = largest(theirs.iter().map(|u| u[axis].abs()));
            context.check(
                Check::new(
                    &self.id(&format!("largest_u{letter}")),
                    &format!("{name}: largest displacement along {letter}"),
                    "m",
                    most(axis),
                )
                .independent(of_theirs, "CalculiX, linear static")
                .relative(5e-6, "as all displacements; the small ones across the load are printed to fewer of their digits")
                .golden(SOLVED),
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
        let Kind { tag, name, frequencies: (tolerance, why), few_points, .. } = self.kind;
        let (rigid, count) = (elastic.start, elastic.end);
        let first = self.kind.first[usize::from(rigid > 0)];
        let output = format!("kept/{tag}_{support}.dat");
        let theirs = kept(&output, oracle::frequencies)?;
        if theirs.len() != count {
            return Err(CaseError::message(format!(
                "{output} has {} modes of {count}",
                theirs.len()
            )));
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
        context.golden(&self.id(&format!("{support}_first_frequency")), ours[rigid], "Hz", SOLVED);
        if rigid > 0 {
            context.check(
                Check::new(&self.id("rigid"), &format!("{name}: largest of the six frequencies of rigid motion"), "Hz", ours[rigid - 1])
                    .closed_form(0.0, "a free body has six motions without stiffness")
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
        oracle::few_point_frequencies(&self.deck, DENSITY_PER_MM3, &frequencies, &shapes)
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
