//! Runs of housed bearings begin at rest.

use crate::solid_command_common::{Place, column, command, into_folder, shipped, succeed};

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

/// `statics` and reduced runs say where nodes that touch are beside where normals have them by much of what the race is pressed in.
#[test]
fn distances_that_normals_leave_out_are_told() {
    let scene = shipped("housing_c_tet10.toml");
    let place = Place::new();
    let sets = |young: &str, fit: &str| {
        let sets = [
            format!("solid.material.youngs_modulus={young}"),
            format!("housing.fit.radial={fit}"),
            "inner_race.rotating_load.force=2500 N".into(),
            "solid.mesh.cells.around=24".into(),
        ];
        sets.into_iter().flat_map(|set| ["--set".into(), set]).collect::<Vec<String>>()
    };
    let words = "beside where normals that stay have them";
    for (young, fit, told) in
        [("70 GPa", "-40 um", true), ("70 GPa", "0 um", false), ("210 GPa", "5 um", false)]
    {
        let sets = sets(young, fit);
        let sets: Vec<&str> =
            ["--dry"].into_iter().chain(sets.iter().map(String::as_str)).collect();
        let said = succeed(command("statics", &scene, &sets));
        assert_eq!(said.contains(words), told, "{young} {fit}: {said}");
    }
    // Reduced (of four-node elements, for time), it moves along normals in steps, too: the loose race goes as far across.
    for (young, fit, told) in [("70 GPa", "-40 um", true), ("210 GPa", "5 um", false)] {
        let more = [
            "housing.method=reduced",
            "solid.mesh.order=1",
            "numerics.end=20 us",
            "numerics.output_interval=10 us",
        ];
        let mut sets = sets(young, fit);
        sets.extend(more.into_iter().flat_map(|set| ["--set".into(), set.into()]));
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let said = succeed(into_folder("run", &scene, &place.path(fit), &sets));
        assert_eq!(said.contains(words), told, "{young} {fit}: {said}");
    }
}
