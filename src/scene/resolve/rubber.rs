//! From the given keys to the material of a solid: linear elastic, or rubber with its consequences.

use crate::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use crate::ch2_housing::elastomer::maxwell::Maxwell;
use crate::ch2_housing::elastomer::{Elastomer, ElastomerError, named};
use crate::scene::error::SceneError;
use crate::scene::resolve::bearing::{Reader, text};
use crate::scene::resolve::solid_scene::{Harmonic, Law, MeshSource, RubberScene, RunSteps};
use crate::scene::resolve::unused::refuse_unused;
use crate::scene::tables::keys;
use crate::scene::tables::solid::LAW;
use crate::scene::text::document::Document;
use crate::scene::text::units::plain;
use crate::scene::text::value::Checked;
use crate::solids::rubber::steps::Stepping;

/// Default of B over C_R: that of Tables 2.3 and 3.1.
const BULK_RATIO: f64 = 100.0;
/// As the range of `bulk_ratio`.
const MOST_BULK_RATIO: f64 = 1e6;
/// N of both tables.
const CHAIN: f64 = 8.0;
/// Densities, kg/m³.
const STEEL: f64 = 7850.0;
const RUBBER: f64 = 1100.0;
/// Estimated error of the stress in a step, over the largest so far.
const ACCURACY: f64 = 1e-3;

/// Whether the scene's solid is of rubber.
pub(crate) fn is_rubber(document: &Document) -> bool {
    matches!(document.value(LAW), Some(Checked::Choice("elastomer")))
}

/// Refuses a housing of rubber.
pub(crate) fn refuse_rubber(document: &Document) -> Result<(), SceneError> {
    if !is_rubber(document) {
        return Ok(());
    }
    let reason = "a housing of rubber is not built. Hint: leave `law` out, or take the solid by itself: without [bearing] and [housing]";
    Err(document.refused(LAW, reason))
}

/// The law of the material, and its density (kg/m³).
pub(crate) fn material(reader: &mut Reader) -> Result<(Law, f64), SceneError> {
    refuse_unused(reader.document, &["solid"])?;
    if !is_rubber(reader.document) {
        let law = Law::LinearElastic {
            youngs_modulus: reader.number("solid.material.youngs_modulus"),
            poisson_ratio: reader.number("solid.material.poisson_ratio"),
        };
        return Ok((law, density(reader, STEEL, "bearing steel")));
    }
    let table = reader.choice_if_given("solid.material.table");
    let pull = match reader.choice("solid.material.chain_force") {
        "inverse-langevin" => ChainPull::Exact,
        _ => ChainPull::FiveTerms,
    };
    let because = " with `law = \"elastomer\"` and no `table`";
    let material = rubber(reader, "solid.material", table, pull, because)?;
    let density = density(reader, RUBBER, "usual for filled rubber; the source states none");
    let harmonic = harmonic(reader)?;
    Ok((Law::Elastomer(Box::new(RubberScene { material, table, harmonic })), density))
}

/// The given density, else a usual one.
fn density(reader: &mut Reader, usual: f64, reason: &str) -> f64 {
    const KEY: &str = "solid.material.density";
    reader.number_or(KEY, usual, &format!("{} kg/m^3", plain(usual)), reason)
}

/// The rubber of the keys in the table `of`; given keys replace values of a table of the source.
pub(crate) fn rubber(
    reader: &mut Reader,
    of: &str,
    table: Option<&'static str>,
    pull: ChainPull,
    because: &str,
) -> Result<Elastomer, SceneError> {
    let document = reader.document;
    let path = |key: &str| format!("{of}.{key}");
    let base = match table {
        Some("2.3") => Some(named::table_2_3()),
        Some(_) => Some(named::table_3_1()),
        None => None,
    };
    // A bushing has fewer of these keys than a solid.
    let given = |key: &str| {
        let path = path(key);
        keys::find(&path).and_then(|_| reader.given_number(&path))
    };
    let [modulus, chain, ratio, bulk] =
        ["rubber_modulus", "chain", "bulk_ratio", "bulk_modulus"].map(given);
    let modulus = match modulus.or(base.as_ref().map(|base| base.network.modulus)) {
        Some(modulus) => modulus,
        None => {
            return Err(reader.missing(&path("rubber_modulus"), because));
        }
    };
    let locking = match (chain, table) {
        (None, None) => {
            let reason = "as in Tables 2.3 and 3.1";
            reader.number_or(&path("chain"), CHAIN, &plain(CHAIN), reason)
        }
        (chain, _) => chain.unwrap_or(CHAIN),
    };
    let bulk = match (bulk, ratio) {
        (Some(bulk), _) if bulk < modulus => {
            let reason = "rubber is nearly incompressible, and this is less than C_R of its network. Hint: give at least C_R, usually 100 times that and more";
            return Err(document.refused("solid.material.bulk_modulus", reason));
        }
        (Some(bulk), _) if bulk > MOST_BULK_RATIO * modulus => {
            let reason = "no rubber resists a change of volume as much, and rounding would dominate the result. Hint: give at most a million times C_R; many rubbers have 2000 MPa, a thousand times that";
            return Err(document.refused("solid.material.bulk_modulus", reason));
        }
        (Some(bulk), _) => bulk,
        (None, Some(ratio)) => ratio * modulus,
        (None, None) => {
            if table.is_none() {
                let reason = "100 C_R, as in Tables 2.3 and 3.1";
                let path = path("bulk_ratio");
                reader.note(&path, &plain(BULK_RATIO), reason).fill(&path, BULK_RATIO);
            }
            BULK_RATIO * modulus
        }
    };
    let network = EightChain::new(modulus, locking, bulk, pull).map_err(|error| {
        let key = match error {
            ElastomerError::Modulus(_) => "rubber_modulus",
            ElastomerError::Bulk(_) => "bulk_modulus",
            _ => "chain",
        };
        let reason = "with the inverse Langevin function the chains are straight in the undeformed rubber where it \
                      is 1 or less. Hint: take more than 1; the source has 8";
        document.refused(&path(key), reason)
    })?;
    let (mut maxwell, list) = (Vec::new(), path("maxwell"));
    for item in document.items(&list) {
        let (gamma, tau) = (item.required("gamma")?, item.required("relaxation_time")?);
        maxwell.push(Maxwell { gamma, tau });
    }
    reader.follow(&path("rubber_modulus"), modulus);
    reader.follow(&path("chain"), locking);
    reader.follow(&path("bulk_ratio"), ratio.unwrap_or(BULK_RATIO));
    if let Some(base) = base.filter(|_| maxwell.is_empty()) {
        maxwell = base.maxwell;
        for (element, number) in maxwell.iter().zip(1..) {
            reader.follow(&format!("{list}.{number}.gamma"), element.gamma);
            reader.follow(&format!("{list}.{number}.relaxation_time"), element.tau);
        }
        if table == Some("2.3") {
            let value = "those of Table 3.1";
            let reason = "Table 2.3 prints none; the source says that they were adjusted";
            reader.note(&path("maxwell"), value, reason);
        }
    }
    Ok(Elastomer { network, maxwell })
}

fn harmonic(reader: &Reader) -> Result<Option<Harmonic>, SceneError> {
    let document = reader.document;
    if document.first_below("solid.harmonic").is_none() {
        return Ok(None);
    }
    let frequencies = match document.value("solid.harmonic.frequencies") {
        Some(Checked::Quantities(frequencies)) => frequencies.clone(),
        _ => return Err(reader.missing("solid.harmonic.frequencies", "")),
    };
    let set = text(document, "solid.harmonic.set")
        .ok_or_else(|| reader.missing("solid.harmonic.set", ", the moved set"))?;
    let axis = reader.required_choice("solid.harmonic.axis", ", the direction of motion")?;
    let axis = ["x", "y", "z"].iter().position(|name| *name == axis).unwrap_or(0);
    Ok(Some(Harmonic { set, axis, frequencies }))
}

/// Implicit elements are those of ten nodes.
pub(crate) fn check_order(
    document: &Document,
    source: &MeshSource,
    order: Option<crate::mesh::Order>,
) -> Result<(), SceneError> {
    use crate::mesh::Order;
    let linear = match source {
        // The order of a file is known when the mesh is read.
        MeshSource::File { .. } => order == Some(Order::Linear),
        _ => order != Some(Order::Quadratic),
    };
    if !(linear && is_rubber(document)) {
        return Ok(());
    }
    let reason = format!("{FOUR_NODES_LOCK}. Hint: write `order = 2` in [solid.mesh]");
    Err(document.refused("solid.mesh.order", reason))
}

pub(crate) const FOUR_NODES_LOCK: &str = "four-node elements of nearly incompressible rubber lock";

/// Steps of a run.
pub(crate) fn steps(reader: &mut Reader) -> RunSteps {
    RunSteps::Implicit(match reader.given_number("numerics.step") {
        Some(step) => Stepping::Fixed(step),
        None => Stepping::Accuracy(reader.given_number("numerics.accuracy").unwrap_or_else(|| {
            let reason = "of the largest stress so far, in each step";
            reader.number_or("numerics.accuracy", ACCURACY, &plain(ACCURACY), reason)
        })),
    })
}
