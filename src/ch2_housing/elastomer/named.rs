//! Rubbers of the dissertation, by table.

use super::Elastomer;
use super::eight_chain::{ChainPull, EightChain};
use super::maxwell::Maxwell;

/// γ and τ (s) of Table 3.1.
pub const TABLE_3_1_MAXWELL: [[f64; 2]; 14] = [
    [0.492, 10.0],
    [0.687, 2.42],
    [1.153, 0.59],
    [1.286, 0.14],
    [1.804, 3.46e-2],
    [1.944, 8.40e-3],
    [2.116, 2.00e-3],
    [2.304, 4.92e-4],
    [2.485, 1.19e-4],
    [2.764, 2.89e-5],
    [2.798, 7.02e-6],
    [3.704, 1.70e-6],
    [1.912, 4.12e-7],
    [8.226, 1.00e-7],
];

fn rubber(modulus: f64) -> Elastomer {
    // Both tables have the same locking number and bulk modulus.
    let (locking, bulk) = (8.0, 100.0 * modulus);
    let network = EightChain { modulus, locking, bulk, pull: ChainPull::FiveTerms };
    let maxwell = TABLE_3_1_MAXWELL.map(|[gamma, tau]| Maxwell { gamma, tau }).to_vec();
    Elastomer { network, maxwell }
}

/// Chloroprene rubber of 2.3.1 and Table 2.3. The dissertation adjusted its Maxwell constants but does not print them;
/// those of Table 3.1 are used.
pub fn table_2_3() -> Elastomer {
    rubber(0.324e6)
}

/// The elastomer of Table 3.1.
pub fn table_3_1() -> Elastomer {
    rubber(0.647e6)
}
