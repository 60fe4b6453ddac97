//! Materials of an input deck compared with that of the scene.

use crate::mesh::read::{DeckMaterial, LengthUnit};
use crate::numeric::clock::to_digits;
use crate::scene::build::about::SetupError;
use crate::scene::build::solid_mesh::BuiltMesh;
use crate::scene::resolve::solid_scene::{MeshSource, SolidScene};

/// Compares materials of a deck with that of the scene: notes for differences, an error if the scene has only defaults
/// for values of the deck.
pub(crate) fn deck_materials(
    scene: &SolidScene,
    elastic: [f64; 2],
    built: &BuiltMesh,
) -> Result<Vec<String>, SetupError> {
    let defaulted = |key: &str| {
        scene.defaults_used.iter().any(|used| used.key == format!("solid.material.{key}"))
    };
    let [no_young, no_poisson, no_density] =
        ["youngs_modulus", "poisson_ratio", "density"].map(defaulted);
    // Within the digits of usual moduli.
    let differ = |a: f64, b: f64| (a - b).abs() > 1e-3 * b.abs();
    let known =
        |m: &&DeckMaterial| m.elastic.is_some() || m.density.is_some() || m.unread.is_some();
    let given: Vec<&DeckMaterial> = built.materials.iter().filter(known).collect();
    let mut notes = Vec::new();
    for material in &given {
        if let Some(law) = unread(material) {
            let names = [(no_young, "youngs_modulus"), (no_poisson, "poisson_ratio")];
            let density = (no_density && law.starts_with("*DENSITY"), "density");
            let missing: Vec<_> =
                names.into_iter().chain([density]).filter(|(no, _)| *no).collect();
            let name = &material.name;
            if !missing.is_empty() {
                let missing: Vec<&str> = missing.into_iter().map(|(_, name)| name).collect();
                let text = format!(
                    "the mesh file has a material \"{name}\" with {law}, which this program does not read. The scene gives \
                     no {}, so that steel would be used in its place. Hint: write the values you want in [solid]: material = \
                     {{ youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850 kg/m^3\" }} is steel",
                    missing.join(" and no ")
                );
                return Err(SetupError::key("solid.material", text));
            }
            notes.push(format!("the scene's material is used, not the deck's \"{name}\" ({law})"));
            continue;
        }
        let [young, poisson] = material.elastic.unwrap_or(elastic);
        let density = material.density.unwrap_or(scene.density);
        // Values of the deck and of the scene; whether the scene has only steel's; name and text.
        let parts = [
            (young, elastic[0], no_young, "youngs_modulus", gigapascals as fn(f64) -> String),
            (poisson, elastic[1], no_poisson, "poisson_ratio", |value| value.to_string()),
            (density, scene.density, no_density, "density", kilograms),
        ];
        let differing = parts.iter().filter(|(deck, scene, ..)| differ(*deck, *scene));
        let missing: Vec<_> = differing.clone().filter(|(_, _, no, ..)| *no).collect();
        let other = other_unit(scene, material);
        let units = match &other {
            Some((unit, value)) => {
                format!("with unit = \"{unit}\" the {value}: check solid.mesh.unit")
            }
            None => "if its units fit solid.mesh.unit".to_string(),
        };
        let deck = format!(
            "\"{}\": Young's modulus {}, Poisson's ratio {poisson}, density {}, {units}",
            material.name,
            gigapascals(young),
            kilograms(density)
        );
        if !missing.is_empty() {
            // A value that a scene may not have, or that a wrong unit made, is not proposed.
            let proposed = |value: f64, range: Range, text: String| {
                let fits = other.is_none() && range.contains(&value);
                if fits { text } else { "…".to_string() }
            };
            let mut write = format!(
                "write the values you want in [solid]: material = {{ youngs_modulus = {}, poisson_ratio = {}, density = {} }}",
                proposed(young, 1e3..=1e13, format!("\"{}\"", gigapascals(young))),
                proposed(poisson, -0.999..=0.499, poisson.to_string()),
                proposed(density, 1.0..=3e4, format!("\"{}\"", kilograms(density))),
            );
            if let Some((unit, _)) = &other {
                write = format!("correct solid.mesh.unit to \"{unit}\", or {write}");
            }
            let steel: Vec<_> = missing
                .iter()
                .map(|(_, of, _, name, text)| format!("{name} {}", text(*of)))
                .collect();
            let missing: Vec<&str> = missing.iter().map(|(_, _, _, name, _)| *name).collect();
            let text = format!(
                "the mesh file has a material ({deck}), which this program does not read. The scene gives no {}, so that \
                 steel would be used in {} place: {}. Hint: {write}",
                missing.join(" and no "),
                if missing.len() == 1 { "its" } else { "their" },
                steel.join(", ")
            );
            return Err(SetupError::key("solid.material", text));
        }
        let differing: Vec<_> = differing
            .map(|(of_deck, of, _, name, text)| {
                format!("{name} {} is used, not {}", text(*of), text(*of_deck))
            })
            .collect();
        if !differing.is_empty() {
            notes.push(format!(
                "the scene's material is used, not the deck's: {}; the deck has {deck}",
                differing.join("; ")
            ));
        }
    }
    if given.len() > 1 {
        notes.push(format!(
            "the deck has {} materials: the scene's is used for the whole body",
            given.len()
        ));
    }
    Ok(notes)
}

/// Constants of a material that are not read, if they determine what the scene does not give.
fn unread(material: &DeckMaterial) -> Option<&str> {
    let law = material.unread.as_deref()?;
    (material.elastic.is_none() || law.starts_with("*DENSITY")).then_some(law)
}

/// The other unit of length, and a constant with it, if that is usual for a solid and the one with the scene's unit is not.
fn other_unit(scene: &SolidScene, material: &DeckMaterial) -> Option<(&'static str, String)> {
    let MeshSource::File { unit, .. } = &scene.mesh.source else { return None };
    let (other, factor) = match unit {
        LengthUnit::Millimetre => ("m", 1e-6),
        LengthUnit::Metre => ("mm", 1e6),
    };
    // Rubber and foam are possible, but not the reason to suspect the unit.
    let mistaken = |value: f64, usual: Range, possible: Range, factor: f64| {
        (usual.contains(&(factor * value)) && !possible.contains(&value)).then_some(factor * value)
    };
    let modulus =
        material.elastic.and_then(|[young, _]| mistaken(young, 1e9..=1.3e12, 1e6..=1.3e12, factor));
    let density =
        material.density.and_then(|of| mistaken(of, 10.0..=3e4, 1.0..=3e4, factor * factor));
    match (modulus, density) {
        (Some(young), _) => Some((other, format!("modulus is {}", gigapascals(young)))),
        (None, Some(density)) => Some((other, format!("density is {}", kilograms(density)))),
        (None, None) => None,
    }
}

type Range = std::ops::RangeInclusive<f64>;

fn gigapascals(value: f64) -> String {
    format!("{} GPa", to_digits(1e-9 * value, 6))
}

fn kilograms(value: f64) -> String {
    format!("{} kg/m^3", to_digits(value, 6))
}
