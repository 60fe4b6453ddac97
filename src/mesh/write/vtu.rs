//! Writer of `.vtu` (VTK's unstructured grid) with fields, and of `.pvd`, the list of such files over time.
//!
//! Numbers are raw little-endian bytes after the markup, which is exact and compact.

use crate::mesh::error::MeshError;
use crate::mesh::tet_mesh::{Order, TetMesh};
use crate::mesh::write::is_xml_character;

/// A field: `components` consecutive values for each node or element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Field<'a> {
    pub name: &'a str,
    pub components: usize,
    pub values: &'a [f64],
}

impl Field<'_> {
    fn check(&self, count: usize) -> Result<(), MeshError> {
        check_name(self.name)?;
        let expected = count * self.components;
        if self.values.len() != expected || self.components == 0 {
            let (field, found) = (self.name.to_string(), self.values.len());
            return Err(MeshError::FieldLength { field, found, expected });
        }
        match self.values.iter().position(|value| !value.is_finite()) {
            Some(index) => Err(MeshError::FieldNotFinite {
                field: self.name.to_string(),
                index,
                value: self.values[index],
            }),
            None => Ok(()),
        }
    }
}

/// Checks a name for the markup, where it is an attribute in quotes.
fn check_name(name: &str) -> Result<(), MeshError> {
    if !name.is_empty()
        && !name.contains(|c: char| c.is_control() || !is_xml_character(c) || "<>&\"'".contains(c))
    {
        return Ok(());
    }
    let why = "it must not be empty or contain <, >, &, quotes, control or non-characters";
    Err(MeshError::Name { name: name.to_string(), why })
}

/// Markup of arrays and the bytes they refer to.
#[derive(Default)]
struct Appended {
    bytes: Vec<u8>,
}

impl Appended {
    /// Adds an array preceded by its length; returns its XML element.
    fn array(&mut self, kind: &str, name: &str, components: usize, data: &[u8]) -> String {
        let offset = self.bytes.len();
        self.bytes.extend((data.len() as u64).to_le_bytes());
        self.bytes.extend(data);
        format!(
            "        <DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{offset}\"/>\n"
        )
    }

    fn doubles(&mut self, name: &str, components: usize, values: &[f64]) -> String {
        let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.array("Float64", name, components, &data)
    }
}

/// Writes a `.vtu` file: the mesh, `point_data` at its nodes, `cell_data` in its elements.
///
/// # Errors
/// [`MeshError::FieldLength`], [`MeshError::FieldNotFinite`], [`MeshError::Name`].
pub fn write_vtu(
    mesh: &TetMesh,
    point_data: &[Field],
    cell_data: &[Field],
) -> Result<Vec<u8>, MeshError> {
    let (points, cells) = (mesh.nodes.len(), mesh.elements.len());
    for (fields, count) in [(point_data, points), (cell_data, cells)] {
        for field in fields {
            field.check(count)?;
        }
    }
    // VTK_TETRA and VTK_QUADRATIC_TETRA, whose node order is this program's.
    let (cell_type, per_cell) = match mesh.order() {
        Order::Linear => (10u8, 4),
        Order::Quadratic => (24u8, 10),
    };
    let mut data = Appended::default();
    let mut body = String::new();
    for (tag, fields) in [("PointData", point_data), ("CellData", cell_data)] {
        body += &format!("      <{tag}>\n");
        for field in fields {
            body += &data.doubles(field.name, field.components, field.values);
        }
        body += &format!("      </{tag}>\n");
    }
    body += "      <Points>\n";
    body += &data.doubles("Points", 3, mesh.nodes.as_flattened());
    body += "      </Points>\n      <Cells>\n";
    let nodes = mesh.elements.all_nodes().iter().flat_map(|&node| i64::from(node).to_le_bytes());
    body += &data.array("Int64", "connectivity", 1, &nodes.collect::<Vec<u8>>());
    let ends = (1..=cells as i64).flat_map(|cell| (cell * per_cell).to_le_bytes());
    body += &data.array("Int64", "offsets", 1, &ends.collect::<Vec<u8>>());
    body += &data.array("UInt8", "types", 1, &vec![cell_type; cells]);
    body += "      </Cells>\n";

    let head = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n";
    let mut file = format!(
        "{head}    <Piece NumberOfPoints=\"{points}\" NumberOfCells=\"{cells}\">\n{body}    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_"
    )
    .into_bytes();
    file.extend(data.bytes);
    file.extend(b"\n  </AppendedData>\n</VTKFile>\n");
    Ok(file)
}

/// Writes a `.pvd` file: times in s with the names of their `.vtu` files, relative to it.
///
/// # Errors
/// [`MeshError::Name`] for a file name that the markup does not allow, [`MeshError::Dimension`] for a time
/// that is not finite.
pub fn write_pvd(steps: &[(f64, &str)]) -> Result<String, MeshError> {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n  <Collection>\n",
    );
    let mut part = 0;
    for (index, &(time, file)) in steps.iter().enumerate() {
        // Files with the same time are parts of one data set.
        part = if index > 0 && steps[index - 1].0 == time { part + 1 } else { 0 };
        check_name(file)?;
        if !time.is_finite() {
            let allowed = "finite numbers".to_string();
            return Err(MeshError::Dimension { what: "time", value: time, unit: "", allowed });
        }
        text += &format!("    <DataSet timestep=\"{time}\" part=\"{part}\" file=\"{file}\"/>\n");
    }
    text += "  </Collection>\n</VTKFile>\n";
    Ok(text)
}
