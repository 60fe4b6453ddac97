//! Source of a solid's mesh: a file, or a generator and its dimensions.

use crate::mesh::generate::{
    Bushing, BushingMesh, Cage, CageMesh, ContactBlock, Housing, HousingMesh, Part, PillowBlock,
    RailRelief, Ring, RingMesh,
};
use crate::mesh::read::LengthUnit;
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::Reader;
use crate::scene::resolve::solid_scene::MeshSource;
use crate::scene::text::value::Checked;
use std::path::Path;

/// Dimensions and cells of each generator; `?` marks optional ones.
const KEYS_OF: &[(&str, &[&str])] = &[
    ("bar", &["length", "width", "height", "cells.along", "cells.across", "cells.up"]),
    ("block", &["half_width", "cells.per_half_width", "cells.deep", "cells.growth?"]),
    (
        "ring",
        &[
            "inner_radius",
            "outer_radius",
            "width",
            "cells.around",
            "cells.radial",
            "cells.axial",
            "cells.growth?",
        ],
    ),
    ("shaft", &["radius", "length?", "stations?", "cells.along", "cells.around", "cells.radial"]),
    (
        "cage",
        &[
            "pockets",
            "pocket_radius",
            "inner_radius",
            "outer_radius",
            "width",
            "relief.depth?",
            "relief.belt_width?",
            "cells.quarter",
            "cells.bar",
            "cells.wall",
        ],
    ),
    ("housing-a", &["bore_radius", "side", "depth", AROUND, RADIAL, AXIAL, GROWTH]),
    ("housing-b", PILLOW_BLOCK),
    ("housing-c", PILLOW_BLOCK),
    ("housing-d", &["bore_radius", "outer_radius", "depth", AROUND, RADIAL, AXIAL, GROWTH]),
    (
        "bushing",
        &[
            "inner_diameter",
            "outer_diameter",
            "length",
            "part?",
            AROUND,
            RADIAL,
            AXIAL,
            "cells.grading?",
        ],
    ),
];
const AROUND: &str = "cells.around";
const RADIAL: &str = "cells.radial";
const AXIAL: &str = "cells.axial";
const GROWTH: &str = "cells.growth?";
const PILLOW_BLOCK: &[&str] = &[
    "bore_radius",
    "outer_radius?",
    "depth",
    "centre_height?",
    "base_width?",
    "base_height?",
    "neck_width?",
    "fillet_radius?",
    AROUND,
    RADIAL,
    AXIAL,
    GROWTH,
];
/// Keys of `[solid.mesh]` that are not dimensions.
const GENERAL: &[&str] = &[
    "file",
    "generate",
    "unit",
    "origin",
    "axis",
    "order",
    "renumber",
    "repair",
    "cavities",
    "largest_aspect",
];

/// Names of dimensions in errors of generators, and their keys below `solid.mesh`.
pub const KEY_OF_DIMENSION: &[(&str, &str)] = &[
    ("inner radius", "inner_radius"),
    ("outer radius", "outer_radius"),
    ("width", "width"),
    ("half contact width", "half_width"),
    ("radius of the shaft", "radius"),
    ("stations of the shaft", "stations"),
    ("distance of two stations", "stations"),
    ("longest layer", "cells.along"),
    ("layers between two stations", "cells.along"),
    ("pockets", "pockets"),
    ("pocket radius", "pocket_radius"),
    ("relief of the rails", "relief.depth"),
    ("width of the belt", "relief.belt_width"),
    ("bore radius", "bore_radius"),
    ("side of the housing", "side"),
    ("depth", "depth"),
    ("centre height", "centre_height"),
    ("base width", "base_width"),
    ("base height", "base_height"),
    ("neck width", "neck_width"),
    ("fillet radius", "fillet_radius"),
    ("cells around", "cells.around"),
    ("cells around the bore", "cells.around"),
    ("cells around the shaft", "cells.around"),
    ("radial cells", "cells.radial"),
    ("axial cells", "cells.axial"),
    ("cells along a quarter of a pocket", "cells.quarter"),
    ("cells across half a bar", "cells.bar"),
    ("cells through the wall", "cells.wall"),
    ("cells per half contact width", "cells.per_half_width"),
    ("number of first steps in the length", "cells.per_half_width"),
    ("cells along the depth", "cells.deep"),
    ("growth of radial steps", "cells.growth"),
    ("growth of steps", "cells.growth"),
    ("inner diameter", "inner_diameter"),
    ("thickness", "outer_diameter"),
    ("length", "length"),
    ("grading", "cells.grading"),
];

/// The key below `solid.mesh` of a dimension in an error of a generator; `None` if it depends on several.
pub fn key_of_dimension(what: &str) -> Option<&'static str> {
    KEY_OF_DIMENSION.iter().find(|(known, _)| *known == what).map(|(_, key)| *key)
}

/// The generators and the keys of each, for the reference.
pub(crate) fn generators() -> impl Iterator<Item = (&'static str, String)> {
    KEYS_OF.iter().map(|(name, keys)| {
        let keys: Vec<String> = keys
            .iter()
            .map(|key| match key.strip_suffix('?') {
                Some(key) => format!("(`{key}`)"),
                None => format!("`{key}`"),
            })
            .collect();
        (*name, keys.join(", "))
    })
}

pub(crate) fn source(reader: &mut Reader) -> Result<MeshSource, SceneError> {
    let file = match reader.document.value("solid.mesh.file") {
        Some(Checked::Text(file)) => Some(file.clone()),
        _ => None,
    };
    let generator = reader.choice_if_given("solid.mesh.generate");
    refuse_without_effect_on(reader, generator)?;
    match (file, generator) {
        (Some(file), _) => {
            let unit = match reader.choice_if_given("solid.mesh.unit") {
                Some("mm") => LengthUnit::Millimetre,
                Some(_) => LengthUnit::Metre,
                None => {
                    let because =
                        ": a mesh file does not say in which unit its numbers are, \"mm\" or \"m\"";
                    return Err(reader.missing("solid.mesh.unit", because));
                }
            };
            if !["msh", "inp"].contains(&extension(&file).as_str()) {
                let reason = "the extension of the name states the format, and this one is unknown";
                let advice = "name a Gmsh file .msh, an Abaqus or CalculiX input file .inp";
                return Err(reader.document.refused("solid.mesh.file", reason, advice));
            }
            let (path, name) = reader.document.file("solid.mesh.file", &file);
            Ok(MeshSource::File { path, name, unit })
        }
        (None, Some(generator)) => {
            if !reader.is_given("solid.mesh.order") {
                let because = " with `generate`: 1 for four-node, 2 for ten-node tetrahedra";
                let example = "`order = 2` to [solid.mesh]".to_string();
                let problem = Problem::Missing { because: because.to_string(), example };
                return Err(reader.document.error("solid.mesh.order", problem));
            }
            generated(reader, generator)
        }
        (None, None) => {
            let because = ", and no `generate` either".to_string();
            let example =
                "`file = \"part.msh\"` or `generate = \"bar\"` to [solid.mesh]".to_string();
            let problem = Problem::Missing { because, example };
            Err(reader.document.error("solid.mesh.file", problem))
        }
    }
}

/// Extension of a file name in lower case.
pub(crate) fn extension(file: &str) -> String {
    let ending = Path::new(file).extension().and_then(|ending| ending.to_str());
    ending.unwrap_or_default().to_ascii_lowercase()
}

/// Refuses dimensions without effect on the chosen source.
fn refuse_without_effect_on(reader: &Reader, generator: Option<&str>) -> Result<(), SceneError> {
    let own = KEYS_OF.iter().find(|(name, _)| Some(*name) == generator).map(|(_, keys)| *keys);
    for key in reader.document.given_keys() {
        let Some(name) = key.path.strip_prefix("solid.mesh.") else { continue };
        let of_file = ["unit", "repair", "cavities"].contains(&name) && generator.is_some();
        let taken = own.is_some_and(|keys| keys.iter().any(|k| k.trim_end_matches('?') == name));
        if of_file || !(taken || GENERAL.contains(&name)) {
            let reason = match generator {
                Some(_) => "this generator does not use it",
                None => "a mesh from a file does not use it",
            };
            let advice = match own {
                Some(keys) => format!("it takes {}", keys.join(", ").replace('?', "")),
                None => "leave it out".to_string(),
            };
            return Err(reader.document.refused(key.path, reason, advice));
        }
    }
    Ok(())
}

fn generated(reader: &mut Reader, generator: &str) -> Result<MeshSource, SceneError> {
    let because = format!(" with `generate = \"{generator}\"`");
    let size =
        |reader: &Reader, key: &str| reader.required_number(&format!("solid.mesh.{key}"), &because);
    let cells = |reader: &Reader, key: &str| {
        size(reader, &format!("cells.{key}")).map(|count| count as usize)
    };
    let growth = |reader: &mut Reader| reader.number("solid.mesh.cells.growth").unwrap_or(1.0);
    Ok(match generator {
        "bar" => MeshSource::Bar {
            size: [size(reader, "length")?, size(reader, "width")?, size(reader, "height")?],
            cells: [cells(reader, "along")?, cells(reader, "across")?, cells(reader, "up")?],
        },
        "block" => MeshSource::Block(ContactBlock {
            half_width: size(reader, "half_width")?,
            cells_per_half_width: cells(reader, "per_half_width")?,
            depth_cells: cells(reader, "deep")?,
            growth: growth(reader),
        }),
        "ring" => MeshSource::Ring(
            Ring {
                inner_radius: size(reader, "inner_radius")?,
                outer_radius: size(reader, "outer_radius")?,
                width: size(reader, "width")?,
            },
            RingMesh {
                around: cells(reader, "around")?,
                radial: cells(reader, "radial")?,
                axial: cells(reader, "axial")?,
                radial_growth: growth(reader),
            },
        ),
        "shaft" => {
            let stations = match reader.document.value("solid.mesh.stations") {
                Some(Checked::Quantities(_)) if reader.is_given("solid.mesh.length") => {
                    let problem = Problem::Exclusive {
                        rival: "solid.mesh.length".to_string(),
                        advice: "keep `length` or `stations`".to_string(),
                    };
                    return Err(reader.document.error("solid.mesh.stations", problem));
                }
                Some(Checked::Quantities(stations)) => stations.clone(),
                _ => vec![0.0, size(reader, "length")?],
            };
            let length = stations[stations.len() - 1] - stations[0];
            MeshSource::Shaft {
                radius: size(reader, "radius")?,
                // Half a millionth more, so that rounding adds no layer.
                longest_layer: length / cells(reader, "along")? as f64 * (1.0 + 5e-7),
                stations,
                around: cells(reader, "around")?,
                radial: cells(reader, "radial")?,
            }
        }
        "cage" => {
            let [depth, belt] = ["solid.mesh.relief.depth", "solid.mesh.relief.belt_width"];
            let relief = match reader.is_given(depth) || reader.is_given(belt) {
                true => Some(RailRelief {
                    depth: reader.required_number(depth, " with `relief`")?,
                    belt_width: reader.required_number(belt, " with `relief`")?,
                }),
                false => None,
            };
            let shape = Cage {
                pocket_count: size(reader, "pockets")? as usize,
                pocket_radius: size(reader, "pocket_radius")?,
                inner_radius: size(reader, "inner_radius")?,
                outer_radius: size(reader, "outer_radius")?,
                width: size(reader, "width")?,
                relief,
            };
            let mesh = CageMesh {
                quarter: cells(reader, "quarter")?,
                bar: cells(reader, "bar")?,
                wall: cells(reader, "wall")?,
            };
            MeshSource::Cage(shape, mesh)
        }
        "bushing" => {
            let [inner_diameter, outer_diameter] =
                [size(reader, "inner_diameter")?, size(reader, "outer_diameter")?];
            let thickness = 0.5 * (outer_diameter - inner_diameter);
            let thick = thickness > 0.0;
            if !thick {
                let reason = "it is no larger than the inner diameter";
                let advice = "give a larger one; both are those of the rubber";
                return Err(reader.document.refused("solid.mesh.outer_diameter", reason, advice));
            }
            let part = match reader.choice_if_given("solid.mesh.part") {
                Some("quarter") => Part::Quarter,
                _ => Part::Whole,
            };
            let mesh = BushingMesh {
                around: cells(reader, "around")?,
                radial: cells(reader, "radial")?,
                axial: cells(reader, "axial")?,
                grading: reader.given_number("solid.mesh.cells.grading").unwrap_or(1.0),
                part,
            };
            let length = size(reader, "length")?;
            MeshSource::Bushing(Bushing { inner_diameter, thickness, length }, mesh)
        }
        _ => {
            let (bore_radius, depth) = (size(reader, "bore_radius")?, size(reader, "depth")?);
            let housing = match generator {
                "housing-a" => Housing::Square { bore_radius, side: size(reader, "side")?, depth },
                "housing-d" => {
                    let outer_radius = size(reader, "outer_radius")?;
                    Housing::Annulus { bore_radius, outer_radius, depth }
                }
                _ => {
                    let block = pillow_block(reader, bore_radius, depth);
                    if generator == "housing-b" {
                        Housing::MirroredPillowBlock(block)
                    } else {
                        Housing::PillowBlock(block)
                    }
                }
            };
            let mesh = HousingMesh {
                around: cells(reader, "around")?,
                radial: cells(reader, "radial")?,
                axial: cells(reader, "axial")?,
                radial_growth: growth(reader),
            };
            MeshSource::Housing(housing, mesh)
        }
    })
}

/// Given sizes, else the assumed proportions.
fn pillow_block(reader: &mut Reader, bore_radius: f64, depth: f64) -> PillowBlock {
    let mut block = PillowBlock::proportioned(bore_radius, depth);
    let sizes = [
        ("outer_radius", &mut block.outer_radius),
        ("centre_height", &mut block.centre_height),
        ("base_width", &mut block.base_width),
        ("base_height", &mut block.base_height),
        ("neck_width", &mut block.neck_width),
        ("fillet_radius", &mut block.fillet_radius),
    ];
    for (name, size) in sizes {
        let key = format!("solid.mesh.{name}");
        match reader.given_number(&key) {
            Some(given) => *size = given,
            None => {
                let value = crate::scene::resolve::dynamics::millimetres(*size);
                reader.note(&key, &value, "in proportion to the bore; the source's figure is lost");
            }
        }
    }
    block
}
