//! Housings from mesh files that have their own coordinates: where they are put, what says so, and packs of them.

use super::housed_bore_shape::{annulus, refused, with_mesh};
use crate::housed_command_common::*;

use bearing_dynamics::mesh::{Order, TetMesh};
use std::fs;

/// The ring with its axis along Z, centred on (40, 35, 10) mm.
fn elsewhere() -> TetMesh {
    let mut mesh = annulus(24, Order::Linear);
    for node in &mut mesh.nodes {
        let [x, y, z] = *node;
        *node = [40e-3 + y, 35e-3 + z, 10e-3 + x];
    }
    mesh
}

const PUT: &str = "axis = \"z\"\norigin = [\"40 mm\", \"35 mm\", \"10 mm\"]\n";

fn put(text: &str, how: &str) -> String {
    text.replace("order = 1", &format!("order = 1\n{how}"))
}

#[test]
fn where_a_mesh_is_put_is_told() {
    let place = Place::new();
    let text = put(&with_mesh(&place, &elsewhere(), 1, ""), PUT);
    let scene = place.scene("scene.toml", &text);
    let said = succeed(command("check", &scene, &[]));
    let words = "housing.msh in m: its (40, 35, 10) mm at the bearing's centre, its Z along X";
    assert!(said.contains(words), "{said}");
    let echo: serde_json::Value =
        serde_json::from_str(&succeed(command("check", &scene, &["--json"]))).unwrap();
    let mesh = &echo["scene"]["solid"]["mesh"];
    assert_eq!(mesh["axis"], "z");
    assert_eq!(mesh["origin"][0], 0.04);
    // And where it is not put.
    let message = refused(&place, &with_mesh(&place, &elsewhere(), 1, ""));
    for words in [
        "it is at X 4.4730 to 75.5270, Y -0.5270 to 70.5270, Z 0.0000 to 20.0000 mm",
        "solid.mesh.origin",
        "solid.mesh.axis",
    ] {
        assert!(message.contains(words), "{message}");
    }
    // Beyond its end face: most of the race hangs out of it.
    let text = put(&with_mesh(&place, &elsewhere(), 1, ""), &PUT.replace("\"10 mm\"", "\"-4 mm\""));
    let message = refused(&place, &text.replace("[housing]", "[housing]\nwidth = \"20 mm\""));
    for words in ["are beside the bore", "solid.mesh.origin"] {
        assert!(message.contains(words), "{message}");
    }
    // Its axis beside the race's.
    let text =
        put(&with_mesh(&place, &elsewhere(), 1, ""), &PUT.replace("\"40 mm\"", "\"40.1 mm\""));
    let said = succeed(command("check", &place.scene("scene.toml", &text), &[]));
    assert!(said.contains("is 100.0000 um off the race's centre, more than the fit"), "{said}");
}

/// What is packed can be solved where the mesh it was made of is gone; a mesh that is elsewhere cannot be packed.
#[test]
fn a_pack_has_the_mesh_of_its_housing() {
    let place = Place::new();
    let text = put(&with_mesh(&place, &elsewhere(), 1, ""), PUT);
    let [folder, out, pack] = ["case", "out", "pack"].map(|name| place.path(name));
    fs::create_dir_all(folder.join("meshes")).unwrap();
    let file = place.path("housing.msh");
    fs::copy(&file, folder.join("meshes/ring.msh")).unwrap();
    let own = text.replace("housing.msh", "meshes/ring.msh");
    let scene = folder.join("scene.toml");
    fs::write(&scene, &own).unwrap();
    succeed(into_folder("statics", &scene, &out, &[]));
    for _ in 0..2 {
        // Over itself, too.
        let said = succeed(into_folder("pack", &scene, &pack, &[]));
        assert!(said.starts_with("wrote 9 files"), "{said}");
    }
    let manifest = json(pack.join("manifest.json"));
    assert!(manifest["sha256"]["meshes/ring.msh"].is_string(), "{manifest}");
    fs::remove_dir_all(&folder).unwrap();
    let again = place.path("again");
    succeed(into_folder("statics", &pack.join("scene.toml"), &again, &[]));
    let mut compare = command("compare", &pack, &[]);
    compare.arg(&again);
    assert!(succeed(compare).starts_with("equal: "));
    fs::write(pack.join("meshes/ring.msh"), "another").unwrap();
    let output = command("compare", &pack, &[again.to_str().unwrap()]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("meshes/ring.msh: sha256"), "{}", stderr(&output));
    let absolute = text.replace("housing.msh", file.to_str().unwrap());
    let scene = place.scene("absolute.toml", &absolute);
    let output = into_folder("pack", &scene, &place.path("other"), &[]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("is outside the scene's folder"), "{}", stderr(&output));
}

/// Another program reads the mesh that is solved, with every set.
#[test]
fn a_pack_has_the_mesh_as_it_is_solved() {
    let place = Place::new();
    let (pack, out) = (place.path("pack"), place.path("out"));
    let cantilever = crate::solid_command_common::shipped("cantilever.toml");
    succeed(into_folder("pack", &cantilever, &pack, &["--of", "statics"]));
    let mut scene = json(pack.join("resolved.json"));
    scene["solid"]["mesh"] = serde_json::json!({ "file": "mesh.msh", "unit": "m" });
    assert!(scene["solid"].as_object_mut().unwrap().remove("set").is_some());
    let from_file = pack.join("from_file.json");
    fs::write(&from_file, scene.to_string()).unwrap();
    succeed(into_folder("statics", &from_file, &out, &[]));
    fs::remove_file(&from_file).unwrap();
    let mut compare = command("compare", &pack, &[]);
    compare.arg(&out);
    assert!(succeed(compare).starts_with("equal: "));
}
