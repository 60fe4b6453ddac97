//! What equilibria and vibrations of a solid leave out of its scene.

use bearing_dynamics::scene::SolidScene;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::model::SolidProblem;

fn profiles(problem: &SolidProblem) -> impl Iterator<Item = &Profile> {
    let loads = problem.loads.iter().map(|load| &load.profile);
    loads.chain(problem.prescribed.iter().map(|held| &held.profile))
}

/// Of what a solid has at the start of a run.
pub fn of_motion(scene: &SolidScene) -> Option<String> {
    let [spins, moves] = [scene.spin != 0.0, scene.velocity != [0.0; 3]];
    let what = match (spins, moves) {
        (false, false) => return None,
        (true, false) => "solid.spin is",
        (false, true) => "solid.velocity is",
        (true, true) => "solid.spin and solid.velocity are",
    };
    Some(format!("{what} of the start of a run and left out here: nothing moves"))
}

/// Loads and displacements that are all zero at the time `t` (s) of an equilibrium, `when`, and not at others.
pub fn of_time(problem: &SolidProblem, t: f64, when: &str) -> Option<String> {
    let changes = |profile: &&Profile| !profile.is_zero();
    let mut changing = profiles(problem).filter(changes).peekable();
    changing.peek()?;
    let nothing = changing.all(|profile| profile.value(t) == 0.0);
    let weightless = problem.gravity == [0.0; 3];
    (nothing && weightless).then(|| {
        format!("all loads and displacements are zero {when}: this is the solid at rest; `bearing run` follows them")
    })
}
