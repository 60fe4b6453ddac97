//! Where the work on a solid of rubber goes: into the network, the springs of its Maxwell elements, their dashpots.

use super::rubber_bodies::{bonded, fixed, network, pulled_cube, rubber_of};
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::ch2_housing::elastomer::named;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::rubber::measures::RubberLedger;
use bearing_dynamics::solids::rubber::steps::RubberSolid;

fn ledger(solid: &RubberSolid) -> RubberLedger {
    RubberLedger::of(solid.model(), solid.state()).unwrap()
}

/// A bushing through a cycle and a quarter at 1 Hz, by 1 µm of 20 mm, in so many steps a cycle: the ledger at the end
/// and the largest residual on the way, J.
fn swung(per: u32) -> (RubberLedger, f64) {
    let wave = Profile::Harmonic { mean: 0.0, amplitude: 1e-6, frequency: 1.0, phase: 0.0 };
    let (model, _) = bonded(named::table_3_1(), [4, 2, 1], wave);
    let mut solid = RubberSolid::new(&model, fixed(1.0 / f64::from(per))).unwrap();
    let (mut most, mut taken) = (0.0f64, 0.0);
    solid
        .advance(1.25, |solid| {
            let ledger = ledger(solid);
            most = most.max(ledger.residual().abs());
            assert!(ledger.dissipated >= taken && ledger.springs >= 0.0);
            taken = ledger.dissipated;
        })
        .unwrap();
    (ledger(&solid), most)
}

#[test]
fn work_of_small_strain_is_held_or_lost() {
    let [(_, coarse), (ledger, fine)] = [128, 384].map(swung);
    // Three energies and none of them small.
    let RubberLedger { network, springs, dissipated, beyond, work } = ledger;
    assert!(network > 0.1 * work && springs > 0.1 * work && dissipated > 0.5 * work, "{ledger:?}");
    assert!(beyond.abs() <= 1e-3 * work, "{ledger:?}");
    // The trapezium rule of the work, of second order.
    assert!(fine <= 1e-4 * work, "{fine:e} of {work:e}");
    assert!(coarse > 6.0 * fine && coarse < 12.0 * fine, "{coarse:e} {fine:e}");
}

/// At finite strain H:H/(4 μ₀ γ) is no longer what the springs hold: an entry of its own says by how much, and the ledger
/// closes as at small strain. No closed cycle gives energy, from rest or steady.
#[test]
fn closed_cycles_of_finite_strain_take_work() {
    let elements = [Maxwell { gamma: 1.0, tau: 0.3 }, Maxwell { gamma: 2.0, tau: 0.03 }];
    let rubber = rubber_of(network(64.7e6), &elements);
    let mut before = 0.0;
    for strain in [0.01, 0.1, 0.5] {
        let to = |n: u32| if n % 2 == 1 { -strain * 0.012 } else { 0.0 };
        let points = (0..=6).map(|n| [0.5 * f64::from(n), to(n)]).collect();
        let model = pulled_cube(rubber.clone(), Profile::Table { points }, 2);
        let mut solid = RubberSolid::new(&model, fixed(0.025)).unwrap();
        let mut so_far = 0.0;
        for cycle in 1..=3 {
            solid.advance(f64::from(cycle), |_| {}).unwrap();
            let work = solid.state().work;
            assert!(work - so_far > 0.0, "{strain} {cycle}: {} J", work - so_far);
            so_far = work;
        }
        // 0.1, 14 and 86 % of what dashpots of small strain would have taken; the steps leave 1.4 %.
        let ledger = ledger(&solid);
        let [part, rest] = [-ledger.beyond, ledger.residual()].map(|of| of / ledger.dissipated);
        assert!(part > before && part < 1.0 + before, "{strain}: {part}");
        assert!(rest.abs() <= 0.02, "{strain}: {rest}");
        before = part;
    }
    assert!(before > 0.5, "{before}");
}
