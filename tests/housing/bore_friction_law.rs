//! The spring between a bore's node and the outer race by itself (4.2.4.2): stick, slip, loops, and what its ledger books.

use bearing_dynamics::ch4_rotor::bore_friction::{BoreFriction, FrictionUpdate, Spring};
use bearing_dynamics::kinematics::vec3::{Vec3, add, add_scaled, dot, norm, scale, sub};

const LAW: BoreFriction = BoreFriction { coefficient: 0.6, stretch: 1e-7 };
/// Of the contact, N/m; load at which a spring that slips at 0.1 µm would be stiffer, N.
const STIFFNESS: f64 = 2.5e8;
const STIFFEST_AT: f64 = STIFFNESS * 1e-7 / 0.6;
const NORMAL: Vec3 = [0.0, 0.6, -0.8];
const HERE: Vec3 = [3e-3, 0.021, -0.028];
/// Square to the normal and to each other.
const ALONG: Vec3 = [1.0, 0.0, 0.0];
const ROUND: Vec3 = [0.0, 0.8, 0.6];

/// The spring of a node that goes to each place in turn (m along and round from where it touched first) under each load.
fn through(
    law: &BoreFriction,
    steps: impl IntoIterator<Item = ([f64; 2], f64)>,
) -> Vec<FrictionUpdate> {
    let mut spring = Spring::default();
    let pull = |([along, round], load): ([f64; 2], f64)| {
        let place = add_scaled(add_scaled(HERE, along, ALONG), round, ROUND);
        let pull = law.update(&spring, place, NORMAL, load, STIFFNESS);
        spring = pull.spring;
        pull
    };
    steps.into_iter().map(pull).collect()
}

fn force(pull: &FrictionUpdate) -> Vec3 {
    pull.spring.force()
}

#[test]
fn a_spring_sticks_in_proportion_to_its_stretch_and_slips_at_its_coefficient() {
    for load in [10.0, 40.0] {
        for way in [[1.0, 0.0], [0.0, -1.0], [0.6, 0.8]] {
            for part in [0.01, 0.5, 0.999, 1.001, 7.0] {
                let moved = way.map(|component| part * 1e-7 * component);
                let pulls = through(&LAW, [([0.0; 2], load), (moved, load)]);
                assert_eq!(force(&pulls[0]), [0.0; 3]);
                let should = 0.6 * load * f64::min(part, 1.0);
                let found = force(&pulls[1]);
                let wanted = add_scaled(scale(ALONG, should * way[0]), should * way[1], ROUND);
                // Places are 0.03 m from the race's centre: rounding of 1e-17 m, of a nanometre at least.
                assert!(norm(sub(found, wanted)) <= 1e-7 * should, "{found:?} {wanted:?}");
                assert_eq!(pulls[1].slips, part > 1.0);
            }
        }
    }
}

/// Where the load would make the spring stiffer than the contact it stays as stiff as that, and slips at the same load.
#[test]
fn no_spring_is_stiffer_than_its_contact() {
    for (times, short) in [(0.5, 1.0), (1.0, 1.0), (4.0, 1.0), (1.0, 1e-3)] {
        let load = times * STIFFEST_AT;
        let law = BoreFriction { stretch: short * LAW.stretch, ..LAW };
        let late = LAW.stretch * f64::max(short, times);
        let pulls = through(
            &law,
            [([0.0; 2], load), ([0.25 * late, 0.0], load), ([2.0 * late, 0.0], load)],
        );
        let stiffness = norm(force(&pulls[1])) / (0.25 * late);
        let should = f64::min(0.6 * load / law.stretch, STIFFNESS);
        assert!((stiffness / should - 1.0).abs() <= 1e-7, "{stiffness:e} {should:e}");
        assert!(stiffness <= STIFFNESS * (1.0 + 1e-7));
        assert!((norm(force(&pulls[2])) / (0.6 * load) - 1.0).abs() <= 1e-12);
    }
}

/// To and fro between ±`reach` (m) along, this many steps a quarter, `quarters` of them from the middle outwards.
fn to_and_fro(reach: f64, quarter: usize, quarters: usize) -> impl Iterator<Item = f64> {
    (0..=quarter * quarters).map(move |step| {
        let quarters = step as f64 / quarter as f64;
        reach * (1.0 - ((quarters + 1.0).rem_euclid(4.0) - 2.0).abs())
    })
}

/// A cycle of ±A loses 4 μN (A − s), whose heat is that area: an error of the second order in the steps, from where
/// slip sets in within one.
#[test]
fn a_cycle_loses_its_loop() {
    let (load, reach) = (25.0, 4e-7);
    let area = 4.0 * 0.6 * load * (reach - LAW.stretch);
    let mut errors = Vec::new();
    // No step ends where slip begins.
    for quarter in [401, 1603] {
        let moves: Vec<f64> = to_and_fro(reach, quarter, 9).collect();
        let pulls = through(&LAW, moves.iter().map(|along| ([*along, 0.0], load)));
        // From the end of the first quarter on a cycle is steady.
        let steady = quarter..5 * quarter;
        let (mut looped, mut heat) = (0.0, 0.0);
        for step in steady {
            let mean = 0.5 * (force(&pulls[step])[0] + force(&pulls[step + 1])[0]);
            looped += mean * (moves[step + 1] - moves[step]);
            heat += pulls[step + 1].heat;
        }
        let stored = pulls[5 * quarter].spring.energy() - pulls[quarter].spring.energy();
        assert!(stored.abs() <= 1e-9 * area, "{stored:e}");
        assert!((heat - looped).abs() <= 1e-9 * area, "{heat:e} {looped:e}");
        assert!(pulls.iter().all(|pull| pull.heat >= 0.0 && pull.load_work == 0.0 || pull.spring.anchor == HERE));
        errors.push((heat / area - 1.0).abs());
    }
    println!("loop errors {errors:?}");
    let order = (errors[0] / errors[1]).log2() / 2.0;
    // Where in its step slip sets in differs between the two.
    assert!((order - 2.0).abs() <= 1.0, "{order}");
    assert!(errors[1] <= 1e-6, "{errors:?}");
}

/// Along any way under any loads, the force's work is what is stored and lost less what the load has put in.
#[test]
fn the_ledger_of_a_spring_closes() {
    let mut seed = 7u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let (mut at, mut load) = ([0.0; 2], 20.0);
    let mut steps = vec![(at, load)];
    for _ in 0..20_000 {
        at = [at[0] + 2e-8 * noise(), at[1] + 2e-8 * noise()];
        // Some beyond the load above which springs are as stiff as the contact.
        load = f64::clamp(load + 4.0 * noise(), 1.0, 3.0 * STIFFEST_AT);
        steps.push((at, load));
    }
    let pulls = through(&LAW, steps.iter().copied());
    let (mut work, mut heat, mut load_work, mut slips) = (0.0, 0.0, 0.0, 0);
    for (pair, ends) in pulls.windows(2).zip(steps.windows(2)) {
        let [from, to] = [ends[0].0, ends[1].0];
        let moved = add(scale(ALONG, to[0] - from[0]), scale(ROUND, to[1] - from[1]));
        work += 0.5 * dot(add(force(&pair[0]), force(&pair[1])), moved);
        heat += pair[1].heat;
        load_work += pair[1].load_work;
        slips += usize::from(pair[1].slips);
    }
    let stored = pulls[pulls.len() - 1].spring.energy();
    println!("work {work:e} heat {heat:e} load {load_work:e} stored {stored:e}, {slips} slips");
    assert!(slips > 1000 && heat > 0.1 * work && load_work.abs() > 1e-3 * heat);
    // Rounding of places, 1e-17 m, under loads of 60 N in 2e4 steps.
    assert!((work - stored - heat + load_work).abs() <= 1e-9 * work, "{work:e}");
}

/// A node that moves less than slip takes does not take its anchor along, however often.
#[test]
fn an_anchor_stays_where_it_is_while_nothing_slips() {
    let steps = (0..100_000).map(|step| {
        let turn = f64::from(step) * 0.1;
        ([4e-8 * libm::sin(turn), 4e-8 * libm::cos(1.7 * turn)], 30.0 + 5.0 * libm::sin(0.3 * turn))
    });
    let pulls = through(&LAW, steps);
    assert!(pulls.iter().all(|pull| pull.spring.anchor == pulls[0].spring.anchor && !pull.slips));
    assert!(pulls.iter().all(|pull| pull.heat == 0.0));
}

/// A way along the normal is none of the spring's.
#[test]
fn pressing_deeper_stretches_nothing() {
    let first = LAW.update(&Spring::default(), HERE, NORMAL, 10.0, STIFFNESS);
    let deeper = add_scaled(HERE, -3e-6, NORMAL);
    let second = LAW.update(&first.spring, deeper, NORMAL, 700.0, STIFFNESS);
    assert!(norm(second.spring.stretch) <= 1e-17, "{:?}", second.spring);
}
