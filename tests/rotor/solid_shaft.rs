use bearing_dynamics::mesh::Order;
use bearing_dynamics::solver::rotor::beam::{Beam, BeamSegment};
use bearing_dynamics::solver::rotor::meshed::ShaftMesh;
use bearing_dynamics::solver::shaft_shapes::{Kept, free_shaft};
use bearing_dynamics::ch4_rotor::beam::ShearCoefficient;

fn source_shaft() -> Beam {
    Beam::new(vec![BeamSegment { length: 0.4, outer_diameter: 0.03, inner_diameter: 0.0, density: 7850.0, youngs_modulus: 210e9, poisson_ratio: 0.3 }])
}

#[test]
fn look() {
    for shear in [ShearCoefficient::Cowper, ShearCoefficient::Hutchinson] {
        let beam = Beam { shear_coefficient: shear, ..source_shaft() };
        let (rigid, shapes) = free_shaft(&beam, Kept::ALL, &[(0.0, true), (0.4, true), (0.2, false)], &[]).unwrap();
        println!("beam {shear:?} {rigid:?} {:?} {:?} g {:?}", &shapes.hertz()[..6], &shapes.stretch_frequencies.iter().take(3).map(|w| w/std::f64::consts::TAU).collect::<Vec<_>>(), &shapes.gyroscopic[..3]);
    }
    for (order, around, radial, layer) in [(Order::Quadratic, 8, 1, 0.0126), (Order::Quadratic, 16, 1, 0.0126), (Order::Quadratic, 16, 2, 0.0126), (Order::Quadratic, 24, 2, 0.0064), (Order::Linear, 24, 3, 0.0033), (Order::Linear, 24, 3, 0.0033)] {
        let t = std::time::Instant::now();
        let mut beam = Beam { mesh: Some(ShaftMesh { order, longest_layer: layer, around, radial }), ..source_shaft() };
        if order == Order::Linear { beam.longest_element = 0.04 * 1.000001; beam.mesh.as_mut().unwrap().longest_layer = 0.00334; }
        let (rigid, shapes) = free_shaft(&beam, Kept::ALL, &[(0.0, true), (0.4, true), (0.2, false)], &[]).unwrap();
        println!("{order:?} {around} {radial} {layer} {rigid:?} {:?} {:?} g {:?} {:?}", &shapes.hertz()[..6], &shapes.stretch_frequencies.iter().take(3).map(|w| w/std::f64::consts::TAU).collect::<Vec<_>>(), &shapes.gyroscopic[..3], t.elapsed());
    }
}
