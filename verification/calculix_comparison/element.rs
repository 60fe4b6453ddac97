//! Stiffness and mass of single elements, entry by entry.

use bearing_dynamics::mesh::{Elements, Order, TetMesh};
use bearing_dynamics::numeric::sparse::SymmetricMatrix;
use bearing_dynamics::solids::tangent::{MassMatrix, Unknowns, mass, pattern, stiffness};
use nalgebra::DMatrix;

use super::program::Output;
use super::{DENSITY, Kind, largest, model, oracle};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;

/// All entries of a sparse matrix in the order of the nodes instead of that of elimination.
fn dense(matrix: &SymmetricMatrix, unknowns: &Unknowns) -> DMatrix<f64> {
    let size = matrix.size();
    let mut all = DMatrix::zeros(size, size);
    let places = unknowns.of.as_flattened();
    for (column, place) in places.iter().enumerate() {
        let mut unit = vec![0.0; size];
        unit[*place] = 1.0;
        let mut image = vec![0.0; size];
        matrix.multiply(&unit, &mut image);
        for (row, place) in places.iter().enumerate() {
            all[(row, column)] = image[*place];
        }
    }
    all
}

/// Nodes of a ten-node element with curved edges, mm; the first four are those of a four-node one.
const NODES: [[f64; 3]; 10] = [
    [0.0, 0.0, 0.0],
    [7.0, 1.0, 0.5],
    [1.5, 6.0, -0.5],
    [1.0, 2.0, 8.0],
    [3.6, 0.2, 0.4],
    [4.5, 3.9, -0.1],
    [0.5, 3.1, -0.3],
    [0.3, 1.1, 4.2],
    [4.1, 1.3, 4.4],
    [1.4, 4.2, 3.6],
];

/// One element.
pub fn mesh(kind: &Kind) -> Result<TetMesh, CaseError> {
    let (count, elements) = match kind.order {
        Order::Linear => (4, Elements::Linear(vec![[0, 1, 2, 3]])),
        Order::Quadratic => (10, Elements::Quadratic(vec![[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]])),
    };
    let nodes = NODES[..count].iter().map(|place| place.map(|x| 1e-3 * x)).collect();
    Ok(TetMesh::new(nodes, elements)?)
}

/// Compares stiffness and mass of one element.
pub fn matrices(context: &mut CaseContext, kind: &Kind, theirs: &Output) -> Result<(), CaseError> {
    let Kind { tag, name, .. } = kind;
    let TetMesh { nodes, elements, .. } = mesh(kind)?;
    let element: Vec<usize> = (0..nodes.len()).collect();
    let few = oracle::few_point_mass(&nodes, &element, DENSITY);
    let model = model(nodes, elements, Vec::new(), Vec::new())?;
    let unknowns = Unknowns::new(&model);
    let mut sparse = pattern(&model.problem, &unknowns);
    stiffness(&model, &unknowns, &vec![[0.0; 3]; model.mass.len()], &mut sparse);
    let our_stiffness = dense(&sparse, &unknowns);
    mass(&model, &unknowns, MassMatrix::Consistent, &mut sparse);
    let our_mass = dense(&sparse, &unknowns);
    let (their_stiffness, their_mass) = (theirs.stiffness(), theirs.mass());
    let apart = |ours: &DMatrix<f64>, theirs: &DMatrix<f64>| {
        largest((ours - theirs).iter().map(|x| x.abs())) / largest(theirs.iter().map(|x| x.abs()))
    };
    let digits = "printed to 14 digits; sums of few terms";
    context.check(
        Check::new(
            &format!("{tag}_element_stiffness"),
            &format!("{name}: stiffness matrix of one element, over its largest entry"),
            "1",
            apart(&our_stiffness, &their_stiffness),
        )
        .independent(0.0, "CalculiX, MATRIXSTORAGE")
        .absolute(1e-13, digits),
    );
    // The same along each axis, no coupling between axes.
    let few = few.kronecker(&DMatrix::identity(3, 3));
    context.check(
        Check::new(
            &format!("{tag}_element_mass"),
            &format!(
                "{name}: the oracle's mass matrix of one element by {}, over its largest entry",
                kind.points
            ),
            "1",
            apart(&few, &their_mass),
        )
        .consistency(
            0.0,
            "the oracle of this case against CalculiX: shows how CalculiX integrates masses",
        )
        .absolute(2e-13, digits),
    );
    let total = |mass: &DMatrix<f64>| mass.sum() / 3.0;
    context.check(
        Check::new(
            &format!("{tag}_element_total_mass"),
            &format!("{name}: mass of one element"),
            "kg",
            total(&our_mass),
        )
        .independent(total(&their_mass), "CalculiX, MATRIXSTORAGE")
        .relative(kind.total_mass.0, kind.total_mass.1),
    );
    if *tag == "c3d4" {
        context.check(
            Check::new(
                "c3d4_element_mass_ours",
                "C3D4: our mass matrix of one element against CalculiX', over its largest entry",
                "1",
                apart(&our_mass, &their_mass),
            )
            .closed_form(0.6, "ρV/10 on the diagonal instead of ρV/16")
            .absolute(1e-12, digits),
        );
    }
    Ok(())
}
