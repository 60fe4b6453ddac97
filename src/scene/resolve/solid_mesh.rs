//! Source of a solid's mesh: a file, or a generator and its dimensions.

use crate::mesh::generate::{
    Bushing, BushingMesh, Cage, CageMesh, ContactBlock, Housing, HousingMesh, Part, PillowBlock,
    RailRelief, Ring, RingMesh,
};
use crate::mesh::read::LengthUnit;
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::{Reader, text};
use crate::scene::resolve::dynamics::millimetres;
use crate::scene::resolve::solid_scene::MeshSource;
use crate::scene::resolve::unused::refuse_unused;
use crate::scene::tables::keys;
use crate::scene::tables::keys::{KEYS, Key};
use crate::scene::tables::solid::{GENERATE, GENERATORS};
use crate::scene::text::value::Checked;
use std::path::Path;

/// Names of dimensions in errors of generators that are not those of their keys, and these keys below `solid.mesh`.
pub const KEY_OF_DIMENSION: &[(&str, &str)] = &[
    ("half contact width", "half_width"),
    ("radius of the shaft", "radius"),
    ("stations of the shaft", "stations"),
    ("distance of two stations", "stations"),
    ("longest layer", "cells.along"),
    ("layers between two stations", "cells.along"),
    ("relief of the rails", "relief.depth"),
    ("width of the belt", "relief.belt_width"),
    ("side of the housing", "side"),
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
    ("thickness", "outer_diameter"),
    ("grading", "cells.grading"),
];

/// The key below `solid.mesh` of a dimension in an error of a generator; `None` if it depends on several.
pub fn key_of_dimension(what: &str) -> Option<&'static str> {
    let own = || keys::find(&format!("solid.mesh.{}", what.replace(' ', "_")));
    let other = KEY_OF_DIMENSION.iter().find(|(known, _)| *known == what);
    other.map(|(_, key)| *key).or_else(|| own().map(|(_, key)| key.name()))
}

/// The generators and the keys of each, for the reference.
pub(crate) fn generators() -> impl Iterator<Item = (&'static str, String)> {
    GENERATORS.iter().map(|generator| {
        let used = |key: &&Key| {
            key.only.is_some_and(|(choice, of)| choice == GENERATE && of.contains(generator))
        };
        let name = |key: &Key| format!("`{}`", key.path.trim_start_matches("solid.mesh."));
        let keys: Vec<String> = KEYS.iter().filter(used).map(name).collect();
        (*generator, keys.join(", "))
    })
}

pub(crate) fn source(reader: &mut Reader) -> Result<MeshSource, SceneError> {
    let file = text(reader.document, "solid.mesh.file");
    let generator = reader.choice_if_given(GENERATE);
    refuse_unused(reader.document, &["solid.mesh"])?;
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
                let reason = "the extension of the name states the format, and this one is unknown. Hint: name a Gmsh file .msh, an Abaqus or CalculiX input file .inp";
                return Err(reader.document.refused("solid.mesh.file", reason));
            }
            let (path, name) = reader.document.file("solid.mesh.file", &file);
            Ok(MeshSource::File { path, name, unit })
        }
        (None, Some(generator)) => {
            refuse_keys_of_files(reader)?;
            if !reader.is_given("solid.mesh.order") {
                let because = " with `generate`: 1 for four-node, 2 for ten-node tetrahedra";
                return Err(reader.missing("solid.mesh.order", because));
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

/// Refuses keys of a file beside a generator.
fn refuse_keys_of_files(reader: &Reader) -> Result<(), SceneError> {
    for key in ["unit", "repair", "cavities"].map(|key| format!("solid.mesh.{key}")) {
        if reader.is_given(&key) {
            return Err(reader.document.refused(&key, "only with `file`"));
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
    let growth = |reader: &mut Reader| reader.number("solid.mesh.cells.growth");
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
                let reason = "it is no larger than the inner diameter. Hint: give a larger one; both are those of the rubber";
                return Err(reader.document.refused("solid.mesh.outer_diameter", reason));
            }
            let part = match reader.choice_if_given("solid.mesh.part") {
                Some("quarter") => Part::Quarter,
                _ => Part::Whole,
            };
            let grading = reader.given_number("solid.mesh.cells.grading").unwrap_or(1.0);
            reader.follow("solid.mesh.cells.grading", grading);
            reader
                .follow("solid.mesh.part", if part == Part::Quarter { "quarter" } else { "whole" });
            let mesh = BushingMesh {
                around: cells(reader, "around")?,
                radial: cells(reader, "radial")?,
                axial: cells(reader, "axial")?,
                grading,
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
        let reason = "in proportion to the bore; the source's figure is lost";
        *size = reader.number_or(&key, *size, &millimetres(*size), reason);
    }
    block
}
