//! Stiffness and mass of single elements, entry by entry.

use bearing_dynamics::mesh::Elements;
use bearing_dynamics::numeric::sparse::SymmetricMatrix;
use bearing_dynamics::solids::tangent::{MassMatrix, Unknowns, mass, pattern, stiffness};
use nalgebra::DMatrix;

use super::{
    DENSITY_PER_MM3, Kind, MM, N_PER_MM, TONNE, files, kept, largest, model, not_understood, oracle,
};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;

/// All entries of a sparse matrix, node by node; its own order is that of elimination.
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

/// Stiffness and mass of one element; the ten-node one is curved.
pub fn matrices(context: &mut CaseContext, kind: &Kind) -> Result<(), CaseError> {
    let Kind { tag, name, .. } = kind;
    let deck = kept(&format!("{tag}_element.inp"), oracle::deck)?;
    let [element] = deck.elements.as_slice() else { return Err(not_understood("one element")) };
    let nodes = deck.nodes.iter().map(|place| place.map(|x| x * MM)).collect();
    let indices: Vec<u32> = element.iter().map(|node| *node as u32).collect();
    let unfit = |_| not_understood("an element of neither 4 nor 10 nodes");
    let elements = match indices.len() {
        4 => Elements::Linear(vec![indices.try_into().map_err(unfit)?]),
        _ => Elements::Quadratic(vec![indices.try_into().map_err(unfit)?]),
    };
    let model = model(nodes, elements, Vec::new(), Vec::new())?;
    let unknowns = Unknowns::new(&model);
    let mut sparse = pattern(&model.problem, &unknowns);
    stiffness(&model, &unknowns, &vec![[0.0; 3]; model.mass.len()], &mut sparse);
    let our_stiffness = dense(&sparse, &unknowns) / N_PER_MM;
    mass(&model, &unknowns, MassMatrix::Consistent, &mut sparse);
    let our_mass = dense(&sparse, &unknowns) / TONNE;
    let dof = files::text(&format!("kept/{tag}_element.dof"))?;
    let of =
        |end: &str| kept(&format!("kept/{tag}_element.{end}"), |text| oracle::matrix(text, dof));
    let (their_stiffness, their_mass) = (of("sti")?, of("mas")?);
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
    // The same masses along each axis, none between axes.
    let few = oracle::few_point_mass(&deck.nodes, element, DENSITY_PER_MM3 / TONNE);
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
            "an oracle of this case against CalculiX: that is how CalculiX integrates masses",
        )
        .absolute(2e-13, digits),
    );
    let total = |mass: &DMatrix<f64>| mass.sum() / 3.0;
    context.check(
        Check::new(
            &format!("{tag}_element_total_mass"),
            &format!("{name}: mass of one element"),
            "t",
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
            .closed_form(0.6, "ρV/10 on the diagonal in place of ρV/16")
            .absolute(1e-12, digits),
        );
    }
    Ok(())
}
