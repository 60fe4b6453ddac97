//! `.vtu` files: their own bytes taken apart, and opened by VTK's reader where Python has it.
//! `PYTHON=…` chooses the interpreter; with `REQUIRE_VTK=1` a missing VTK fails the test, else it is
//! written down as skipped.

use crate::outside_common;

use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
use bearing_dynamics::mesh::measure::{total_volume, volume};
use bearing_dynamics::mesh::write::{Field, write_pvd, write_vtu};
use bearing_dynamics::mesh::{MeshError, TetMesh};
use outside_common::{python_with_vtk, skipped_file, write_down};
use std::fs;
use std::path::Path;
use std::process::Command;

fn meshes() -> [TetMesh; 2] {
    let solid = ring(
        &Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.015 },
        &RingMesh { around: 32, radial: 2, axial: 2, radial_growth: 1.0 },
    )
    .unwrap();
    let curved = solid.quadratic().unwrap().mesh;
    [solid.mesh, curved]
}

/// A file with the places of its nodes as a vector and the volumes of its elements as cell data.
fn file(mesh: &TetMesh) -> Vec<u8> {
    let volumes: Vec<f64> = (0..mesh.elements.len()).map(|i| volume(mesh, i)).collect();
    let x: Vec<f64> = mesh.nodes.iter().map(|p| p[0]).collect();
    let points = [
        Field { name: "displacement", components: 3, values: mesh.nodes.as_flattened() },
        Field { name: "x", components: 1, values: &x },
    ];
    write_vtu(mesh, &points, &[Field { name: "volume", components: 1, values: &volumes }]).unwrap()
}

/// The appended array called `name`, by the offset in the markup.
fn array<'f>(file: &'f [u8], name: &str) -> &'f [u8] {
    let data = file.windows(3).position(|w| w == b">\n_").unwrap() + 3;
    let markup = String::from_utf8_lossy(&file[..data]).into_owned();
    let tag = markup.lines().find(|line| line.contains(&format!("Name=\"{name}\""))).unwrap();
    let offset = tag.split("offset=\"").nth(1).unwrap().split('"').next().unwrap();
    let at = data + offset.parse::<usize>().unwrap();
    let length = u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
    &file[at + 8..at + 8 + length]
}

#[test]
fn bytes_are_where_the_markup_says() {
    for mesh in meshes() {
        let file = file(&mesh);
        let points: Vec<u8> =
            mesh.nodes.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        assert_eq!(array(&file, "Points"), points);
        assert_eq!(array(&file, "displacement"), points);
        let nodes = array(&file, "connectivity").chunks(8);
        let nodes = nodes.map(|c| i64::from_le_bytes(c.try_into().unwrap()) as u32);
        assert!(nodes.eq(mesh.elements.all_nodes().iter().copied()));
        let kind = if mesh.elements.nodes(0).len() == 4 { 10 } else { 24 };
        assert_eq!(array(&file, "types"), vec![kind; mesh.elements.len()]);
        assert!(file.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
    }
}

#[test]
fn fields_that_do_not_fit_are_refused() {
    let [mesh, _] = meshes();
    let write =
        |name, values: &[f64]| write_vtu(&mesh, &[Field { name, components: 1, values }], &[]);
    let mut values = vec![0.0; mesh.nodes.len()];
    assert!(write("t", &values).is_ok());
    assert!(matches!(write("t", &values[1..]), Err(MeshError::FieldLength { .. })));
    for name in ["a<b", "a\u{fffe}b", "\u{ffff}", "\u{1b}", "\u{0}", ""] {
        assert!(matches!(write(name, &values), Err(MeshError::Name { .. })), "{name:?}");
        assert!(matches!(write_pvd(&[(0.0, name)]), Err(MeshError::Name { .. })), "{name:?}");
    }
    values[7] = f64::NAN;
    assert!(matches!(write("t", &values), Err(MeshError::FieldNotFinite { index: 7, .. })));
    assert!(matches!(write_pvd(&[(f64::INFINITY, "a.vtu")]), Err(MeshError::Dimension { .. })));
    assert!(matches!(write_pvd(&[(0.0, "a\".vtu")]), Err(MeshError::Name { .. })));
    let text = write_pvd(&[(0.0, "a.vtu"), (1e-6, "b.vtu")]).unwrap();
    assert!(text.contains("timestep=\"0.000001\" part=\"0\" file=\"b.vtu\""), "{text}");
}

#[test]
fn vtk_reads_what_was_written() {
    let Some(python) = python_with_vtk("vtk_reads_what_was_written") else { return };
    let folder = tempfile::tempdir().unwrap();
    let meshes = meshes();
    let paths = [0, 1].map(|i| folder.path().join(format!("{i}.vtu")));
    for (mesh, path) in meshes.iter().zip(&paths) {
        fs::write(path, file(mesh)).unwrap();
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/read_vtu.py");
    let output = Command::new(&python).arg(script).args(&paths).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for (i, mesh) in meshes.iter().enumerate() {
        let found = &found[i];
        let number = |key: &str| found[key].as_f64().unwrap();
        assert_eq!(found["problems"].as_array().unwrap().len(), 0, "{said}");
        assert_eq!(number("points") as usize, mesh.nodes.len());
        assert_eq!(number("cells") as usize, mesh.elements.len());
        assert_eq!(number("type") as usize, [10, 24][i]);
        // VTK measures a curved cell by straight pieces: the chord of half an arc, 0.3 % here.
        let allowed = [1e-12, 3e-3][i];
        assert!((number("volume") / total_volume(mesh) - 1.0).abs() <= allowed, "{found}");
        // A bulge over a chord of 32 round the circle is 0.15 mm; another node order is off by mm.
        assert!(number("farthest_middle") <= 0.2e-3, "{found}");
        let (low, high) = mesh.bounding_box();
        for axis in 0..3 {
            let bound = |end: usize| found["bounds"][2 * axis + end].as_f64().unwrap();
            assert_eq!((bound(0), bound(1)), (low[axis], high[axis]));
        }
        let top = |data: &str, name: &str, c: usize| found[data][name][2][c].as_f64().unwrap();
        assert_eq!(top("point_data", "x", 0), high[0]);
        assert_eq!([0, 1, 2].map(|c| top("point_data", "displacement", c)), high);
        let largest = (0..mesh.elements.len()).map(|e| volume(mesh, e)).fold(0.0, f64::max);
        assert_eq!(top("cell_data", "volume", 0), largest);
    }
}

/// What is skipped stands in a file of the target folder, a line each, and `make test` prints that file
/// whatever the tests came to.
#[test]
fn a_skip_is_written_down_and_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("skipped.txt");
    ["SKIPPED a\n", "SKIPPED b\n"].into_iter().for_each(|line| write_down(&path, line));
    assert_eq!(fs::read_to_string(&path).unwrap(), "SKIPPED a\nSKIPPED b\n");
    assert_eq!(skipped_file().file_name().unwrap(), "skipped.txt");
    // The folder that this very test was built into, whoever made it.
    assert!(std::env::current_exe().unwrap().starts_with(skipped_file().parent().unwrap()));
    // The recipe of the Makefile, with a stand-in for cargo that skips and fails or not.
    let make = Path::new(env!("CARGO_MANIFEST_DIR")).join("Makefile");
    for code in [0, 3] {
        let cargo = folder.path().join("cargo");
        let script = format!("#!/bin/sh\necho SKIPPED it >> {}\nexit {code}\n", path.display());
        fs::write(&cargo, script).unwrap();
        let output = Command::new("make")
            .arg("--makefile")
            .arg(&make)
            // Under `make test` this is a make within a make, which would say where it is.
            .arg("--no-print-directory")
            .arg("test")
            .arg(format!("CARGO=sh {}", cargo.display()))
            .env("CARGO_TARGET_DIR", folder.path())
            .env_remove("MAKEFLAGS")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert_eq!(output.status.success(), code == 0, "{said}");
        // Of this run alone, and last.
        assert!(!said.contains("SKIPPED a"), "{said}");
        assert_eq!(said.lines().last(), Some("SKIPPED it"), "{said}");
    }
}
