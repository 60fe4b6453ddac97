//! Runs of housed bearings begin at rest.

use crate::solid_command_common::{Place, column, into_folder, shipped, succeed};

/// A race that is loose by 40 µm goes that far across to where it is carried, where nodes are 11 nm beside where normals that stay
/// have them. Balls and bore push it as hard at the start, whatever method takes the steps; off by the force with which balls are held
/// in their orbit.
#[test]
fn a_loose_race_starts_in_equilibrium() {
    let place = Place::new();
    let scene = shipped("housing_c_tet10.toml");
    for (method, start) in
        [("reduced", "numerics.start=equilibrium"), ("explicit", "housing.start=equilibrium")]
    {
        let out = place.path(method);
        let sets = [
            &format!("housing.method={method}"),
            "housing.fit.radial=-40 um",
            "numerics.end=20 us",
            "numerics.output_interval=10 us",
            start,
        ];
        let sets: Vec<&str> = sets.into_iter().flat_map(|set| ["--set", set]).collect();
        succeed(into_folder("run", &scene, &out, &sets));
        let first = |name: &str| column(&out, name)[0];
        for (axis, carried) in [("y", 0.0), ("z", 250.0)] {
            let balls = first(&format!("contact_force_on_outer_{axis}"));
            let bore = first(&format!("housing_force_on_outer_{axis}"));
            assert!((balls - carried).abs() <= 0.1, "{method} {axis}: {balls}");
            assert!((balls + bore).abs() <= 0.1, "{method} {axis}: {balls} {bore}");
        }
    }
}
