//! Materials of an input deck compared with that of the scene.

use crate::mesh::read::DeckMaterial;
use crate::numeric::clock::to_digits;
use crate::scene::build::solid::SolidSetupError;
use crate::scene::build::solid_mesh::BuiltMesh;
use crate::scene::resolve::solid_scene::SolidScene;

/// Compares materials of a deck with that of the scene: notes for differences, an error if the scene has only defaults
/// for values of the deck.
pub(crate) fn deck_materials(
    scene: &SolidScene,
    elastic: [f64; 2],
    built: &BuiltMesh,
) -> Result<Vec<String>, SolidSetupError> {
    let defaulted = |key: &str| {
        scene.defaults_used.iter().any(|used| used.key == format!("solid.material.{key}"))
    };
    let [no_young, no_poisson, no_density] =
        ["youngs_modulus", "poisson_ratio", "density"].map(defaulted);
    // Within the digits of usual moduli.
    let differ = |a: f64, b: f64| (a - b).abs() > 1e-3 * b.abs();
    let given: Vec<&DeckMaterial> =
        built.materials.iter().filter(|m| m.elastic.is_some() || m.density.is_some()).collect();
    let mut notes = Vec::new();
    for material in &given {
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
        let deck = format!(
            "\"{}\": Young's modulus {}, Poisson's ratio {poisson}, density {}, if its units fit solid.mesh.unit",
            material.name,
            gigapascals(young),
            kilograms(density)
        );
        if !missing.is_empty() {
            let write = format!(
                "material = {{ youngs_modulus = \"{}\", poisson_ratio = {poisson}, density = \"{}\" }}",
                gigapascals(young),
                kilograms(density)
            );
            let steel: Vec<_> = missing
                .iter()
                .map(|(_, of, _, name, text)| format!("{name} {}", text(*of)))
                .collect();
            let missing = missing.iter().map(|(_, _, _, name, _)| *name).collect();
            return Err(SolidSetupError::DeckMaterial {
                deck,
                missing,
                steel: steel.join(", "),
                write,
            });
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

fn gigapascals(value: f64) -> String {
    format!("{} GPa", to_digits(1e-9 * value, 6))
}

fn kilograms(value: f64) -> String {
    format!("{} kg/m^3", to_digits(value, 6))
}
