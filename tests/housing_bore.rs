//! Laws of a condensed housing and of a rigid race in its bore.

mod housing_common;

use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::housing::{Housing, HousingMesh, PillowBlock};
use bearing_dynamics::solver::housing::bore_equilibrium::{
    Axial, BoreError, BoreSearch, Fit, RaceLoad,
};
use bearing_dynamics::solver::housing::condensed::{
    CondenseError, Reach, condense, geometry_error,
};
use housing_common::*;

fn fit(interference: f64) -> Fit {
    Fit { radius: BORE + interference, penalty: Penalty::default(), axial: Axial::Held }
}

fn load(y: f64, z: f64, about_y: f64, about_z: f64) -> RaceLoad {
    RaceLoad { force: [0.0, y, z], moment: [0.0, about_y, about_z] }
}

#[test]
fn first_look() {
    for order in [Order::Linear, Order::Quadratic] {
        let bore = condensed(&RING, &COARSE, order, YOUNG);
        println!("{:?} asym {}", bore.sizes, bore.asymmetry);
        for i in [-1e-6, 0.0, 1e-6, 5e-6, 1e-5] {
            let fit = fit(i);
            let mut search = BoreSearch::new(&bore, fit.penalty);
            let state = search.under_load(&fit, &load(100.0, -250.0, 0.3, 0.1)).unwrap();
            println!(
                "{i:e}: {:?} touching {} it {} fac {} load {:?} deepest {:e} p {:e}",
                state.pose,
                state.touching,
                state.iterations,
                state.factorisations,
                state.load,
                state.deepest(),
                state.pressure(&bore).iter().fold(0.0f64, |a, b| a.max(*b))
            );
            let u = bore.displacement(&state.loads);
            println!("   geometry {:e}", geometry_error(&bore, &u, &state.pose));
        }
    }
}
