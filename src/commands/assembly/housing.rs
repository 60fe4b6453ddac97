//! A flexible housing and the bearing in it: mesh, bore, fit, and notes on them.

use super::Fallible;
use crate::commands::memory::within;
use crate::commands::placed;
use crate::commands::solid::mesh_notes;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::ch4_rotor::bore_friction::BoreFriction;
use bearing_dynamics::equilibrium::quasi_static_sequence::QuasiStaticFit;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::read::LengthUnit;
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::numeric::clock::{rounded, to_digits};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::numeric::sparse::Memory;
use bearing_dynamics::plan::Item;
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::build::housing::{
    HousingSetup, check_constant, check_supports, setup,
};
use bearing_dynamics::scene::build::solid_mesh::{BuiltMesh, build_housing};
use bearing_dynamics::scene::resolve::housing_scene::{HousedScene, HousingMethod};
use bearing_dynamics::scene::resolve::solid_scene::{MeshPlace, MeshSource};
use bearing_dynamics::solids::bore_equilibrium::Axial;
use bearing_dynamics::solids::condensation::{CondensedBore, Sizes, condense_over, memory, sizes};
use bearing_dynamics::solids::plan as solid;
use bearing_dynamics::solids::plan::Method;
use bearing_dynamics::solids::support::free_motions;
use bearing_dynamics::solids::tangent::Unknowns;
use std::fmt::Write;
use std::time::Instant;

/// Distance from the race, as a part of its radius, beyond which bore nodes are not tested for contact until
/// race or bore has moved. Races move far less in their bores.
const TESTED_DISTANCE: f64 = 2e-3;

/// Alternative without matrix factors.
const INSTEAD: &str = ", explicit steps (method = \"explicit\" in [housing])";

pub struct Housing {
    pub bearing: usize,
    /// Name of the bearing; `None` for a single one.
    pub name: Option<String>,
    /// Scene of this housing and its bearing, at their positions.
    pub scene: HousedScene,
    pub built: BuiltMesh,
    pub setup: HousingSetup,
    pub mesh_seconds: f64,
}

pub fn method(method: HousingMethod) -> &'static str {
    match method {
        HousingMethod::QuasiStatic => "quasi-static",
        HousingMethod::Explicit => "explicit",
        HousingMethod::Reduced => "reduced",
    }
}

impl Housing {
    /// Reads or generates the mesh. The document locates errors in the scene.
    pub fn new(
        document: &Document,
        bearing: usize,
        name: Option<String>,
        scene: HousedScene,
    ) -> Fallible<Housing> {
        let start = Instant::now();
        let mut built =
            build_housing(&scene).map_err(|error| placed(document, error.about(), error))?;
        let setup =
            setup(&scene, &built).map_err(|error| placed(document, error.about(), error))?;
        built.notes.extend(setup.solid.notes.iter().chain(&setup.notes).cloned());
        let mesh_seconds = start.elapsed().as_secs_f64();
        Ok(Housing { bearing, name, scene, built, setup, mesh_seconds })
    }

    /// The document with keys relative to this bearing.
    fn document(&self, whole: &Document) -> Document {
        self.name.as_ref().map_or_else(|| whole.clone(), |name| whole.scoped(name))
    }

    /// Returns an error for variable loads or moving supports that the solution method does not allow.
    pub fn refuse(&self, whole: &Document) -> Fallible<()> {
        let scene = &self.scene;
        let checked = match scene.housing.method {
            HousingMethod::Explicit => Ok(()),
            HousingMethod::QuasiStatic => check_constant(scene),
            HousingMethod::Reduced => check_supports(scene),
        };
        checked.map_err(|error| placed(&self.document(whole), error.about(), error))
    }

    /// Returns an error for variable loads or moving supports, which a quasi-static sequence does not allow.
    pub fn constant(&self) -> Fallible<()> {
        Ok(check_constant(&self.scene)?)
    }

    /// Returns an error if the housing can move as a rigid body.
    pub fn refuse_free(&self) -> Fallible<()> {
        let problem = &self.setup.solid.problem;
        let free = free_motions(&problem.nodes, &problem.prescribed);
        if free.count == 0 {
            return Ok(());
        }
        Err(format!(
            "{}the housing is free to move {}, and an equilibrium needs supports; add [[solid.fixed]]",
            self.before(),
            free.names()
        )
        .into())
    }

    /// Sizes and memory of condensing the housing onto its bore nodes, from the structure of its matrix alone.
    pub fn condensing(&self) -> Fallible<(Unknowns, Sizes, Memory)> {
        self.refuse_free()?;
        let setup = &self.setup;
        let unknowns = Unknowns::new(&setup.model);
        let sizes = sizes(&setup.model, &unknowns, &setup.nodes, &setup.reach())?;
        let needed = memory(&unknowns, &sizes);
        Ok((unknowns, sizes, needed))
    }

    /// Housing condensed onto the bore nodes under the race.
    pub fn condensed(&self) -> Fallible<CondensedBore> {
        let setup = &self.setup;
        let (unknowns, _, needed) = self.condensing()?;
        let condense = || condense_over(&setup.model, unknowns, &setup.nodes, &setup.reach());
        let named = |error: &dyn std::fmt::Display| format!("{}{error}", self.before());
        let condensed = within(&needed, INSTEAD, condense).map_err(|e| named(&e))?;
        Ok(condensed.map_err(|error| named(&error))?)
    }

    /// Fit of the race in the condensed bore, with its radius over time, m.
    pub fn quasi_static_fit<'b>(
        &self,
        bore: &'b CondensedBore,
        radius: Profile,
    ) -> QuasiStaticFit<'b> {
        QuasiStaticFit {
            name: self.name.clone(),
            bearing: self.bearing,
            bore,
            penalty: self.scene.housing.penalty,
            axial: self.scene.housing.axial,
            radius,
            damping: self.setup.solid.problem.damping,
        }
    }

    /// Fit of the race `body` in the bore of the explicit solid `solid`.
    pub fn seat(&self, body: usize, solid: usize) -> Seat {
        Seat {
            name: self.name.clone(),
            mount: Mount::at_centre(body),
            solid,
            radius: self.setup.radius(&self.scene),
            width: self.setup.width,
            penalty: self.scene.housing.penalty,
            friction: self.scene.housing.friction,
            nodes: self.setup.nodes.clone(),
            reach: TESTED_DISTANCE * self.setup.bore_radius,
        }
    }

    /// "housing left".
    pub fn label(&self) -> String {
        self.name.as_ref().map_or("housing".into(), |name| format!("housing {name}"))
    }

    /// Prefix of messages, "housing left: "; empty for a single housing.
    pub fn before(&self) -> String {
        self.name.as_ref().map_or(String::new(), |name| format!("housing {name}: "))
    }

    /// File name of the table of bore nodes.
    pub fn bore_file(&self) -> String {
        self.name.as_ref().map_or("bore.csv".into(), |name| format!("bore_{name}.csv"))
    }

    pub fn mesh_text(&self) -> String {
        let mesh = &self.built.mesh;
        let nodes_each = if mesh.order() == Order::Linear { 4 } else { 10 };
        format!("{} nodes, {} elements of {nodes_each}", mesh.nodes.len(), mesh.elements.len())
    }

    /// Mesh file and placement; empty for a mesh generated in place.
    fn place_text(&self) -> String {
        let mesh = &self.scene.solid.mesh;
        let from = match &mesh.source {
            MeshSource::File { name, unit: LengthUnit::Millimetre, .. } => {
                format!(", {name} in mm")
            }
            MeshSource::File { name, .. } => format!(", {name} in m"),
            _ => String::new(),
        };
        let MeshPlace { origin, axis, .. } = mesh.place;
        let moved = origin != [0.0; 3] || axis != 0;
        let put = moved.then(|| {
            let [x, y, z] = origin.map(|at| to_digits(1e3 * at, 7));
            format!(
                ": its ({x}, {y}, {z}) mm at the bearing's centre, its {} along X",
                ["X", "Y", "Z"][axis]
            )
        });
        format!("{from}{}", put.unwrap_or_default())
    }

    /// Plan items of the housing, solid number `index`.
    pub fn items(&self, index: usize, method: &Method) -> Vec<Item> {
        let problem = &self.setup.solid.problem;
        solid::items(problem, index, Some(&self.label()), &self.mesh_text(), method)
    }

    /// Notes on mesh and bore, printed before the results.
    pub fn notes(&self) -> Vec<String> {
        let caution = self.setup.caution.iter().map(|caution| format!("caution: {caution}"));
        let notes = mesh_notes(&self.built).into_iter().chain(caution);
        notes.map(|note| format!("{}{note}", self.before())).collect()
    }

    pub fn lines(&self) -> Vec<(String, String)> {
        let Housing { scene: HousedScene { housing, .. }, setup, .. } = self;
        let text = format!("{}{}; {}", self.mesh_text(), self.place_text(), method(housing.method));
        let mut lines = vec![(self.label(), text)];
        let mut line = |label: &str, text: String| lines.push((label.into(), text));
        for note in mesh_notes(&self.built) {
            line("note", note);
        }
        let mass: f64 = setup.model.mass.iter().sum();
        let fixed = setup.solid.problem.prescribed.len();
        line("housing mass", format!("{mass:.6} kg; {fixed} components fixed"));
        let um = 1e6 * setup.interference;
        let kind = match um {
            um if um > 0.0 => "interference",
            um if um < 0.0 => "clearance",
            _ => "transition",
        };
        let mut fit = format!(
            "bore radius {:.4} mm, {} nodes, {:.4} mm wide; {kind} {um:+.4} um radial = {:+.4} um diametral",
            1e3 * setup.bore_radius,
            setup.nodes.len(),
            1e3 * setup.width,
            2.0 * um
        );
        let by_radius = setup.race_radius.map(|radius| 1e6 * (radius - setup.bore_radius));
        if let Some(other) = by_radius.filter(|other| (other - um).abs() > 0.1) {
            let _ = write!(
                fit,
                "; outer_race.outer_radius would make it {other:+.4} um and has no effect on the fit"
            );
        }
        line("housing fit", fit);
        line(
            "bore shape",
            format!(
                "{:.4} um out of round, axis {:.4} um from the race's centre",
                1e6 * setup.out_of_round,
                1e6 * setup.off_centre
            ),
        );
        if let Some(caution) = &setup.caution {
            line("caution", caution.clone());
        }
        let stiffness = match housing.penalty {
            Penalty::PerArea(stiffness) => format!("{stiffness:e} N/m^3, by area"),
            Penalty::PerNode(stiffness) => format!("{stiffness:e} N/m for each node"),
        };
        line("contact stiffness", stiffness);
        let axial = match housing.axial {
            Axial::Fixed => "fixed by a shoulder",
            Axial::Free => "free",
        };
        line("outer race, axially", axial.into());
        if let Some(BoreFriction { coefficient, stretch }) = housing.friction {
            let nm = rounded(1e9 * stretch);
            line(
                "friction in the bore",
                format!("coefficient {coefficient}, slips beyond {nm} nm"),
            );
        }
        lines
    }
}
