//! Sixty random scenes, as a user writes them: each comes to its end with a closed ledger and
//! nothing inside anything, or ends with an error that says what has happened.

use crate::dynamics::Noise;
use bearing_dynamics::kinematics::vec3::{norm, sub};
use bearing_dynamics::members::ball_set::neighbours;
use bearing_dynamics::members::bearing::HERTZ_SCALE;
use bearing_dynamics::members::state::POSITION;
use bearing_dynamics::motion::simulation::{Simulation, SimulationError};
use bearing_dynamics::output::session::{RunRequest, Session, SessionError, Status};
use bearing_dynamics::plan::channels::ChannelGroup;
use bearing_dynamics::scene;
use bearing_dynamics::scene::Format;
use bearing_dynamics::scene::build::motion::{dynamic_problem, run_options};

/// Numbers of one scene.
struct Draw(Noise);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * 0.5 * (self.0.next() + 1.0)
    }

    /// Evenly over the logarithm.
    fn scaled(&mut self, low: f64, high: f64) -> f64 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn chance(&mut self, part: f64) -> bool {
        self.between(0.0, 1.0) < part
    }

    fn pick<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[(self.between(0.0, of.len() as f64) as usize).min(of.len() - 1)]
    }
}

/// A bearing of any size, fill, load and speed; `turns` of the inner race at most.
pub fn scene_text(seed: u64, turns: f64) -> String {
    let mut draw = Draw(Noise(0x6265_6172 ^ (seed << 20)));
    let ball = draw.scaled(0.5, 10.0);
    let full = draw.chance(0.35);
    // A full complement of fewer leaves no shaft.
    let balls = draw.between(if full { 7.0 } else { 3.0 }, 20.0) as usize;
    let fill = if full { draw.scaled(1.000_001, 1.001) } else { draw.between(1.2, 2.0) };
    // mm; a shaft is left where few balls stand on a small circle.
    let pitch = (ball * fill / (std::f64::consts::PI / balls as f64).sin()).max(if full {
        0.0
    } else {
        2.2 * ball
    });
    let clearance = ball * draw.between(-5e-4, 3e-3);
    let angular = draw.chance(0.25);
    let kind = if angular {
        let angle = draw.between(15.0, 40.0);
        format!(
            "kind = \"angular-contact\"\ncontact_angle = \"{angle} deg\"\nclearance = {{ radial = \"0 um\" }}"
        )
    } else {
        format!("kind = \"deep-groove\"\nclearance = {{ radial = \"{clearance} mm\" }}")
    };
    let conformity = [0; 2].map(|_| draw.between(0.508, 0.54));
    let mut text = format!(
        "[bearing]\n{kind}\nballs = {balls}\npitch_radius = \"{pitch} mm\"\nball_phase = \"{} deg\"\n\
         inner_race.conformity = {}\nouter_race.conformity = {}\nball.radius = \"{ball} mm\"\n",
        draw.between(0.0, 90.0),
        conformity[0],
        conformity[1],
    );
    let caged = !full && draw.chance(0.6);
    if caged {
        let (inner, outer) = (pitch - 0.4 * ball, pitch + 0.4 * ball);
        // g, of a steel ring 2.2 balls' radii long, half of it pockets.
        let mass = 7.85e-3 * std::f64::consts::PI * (outer * outer - inner * inner) * 1.1 * ball;
        let (pocket, clearance) = (draw.between(1.01, 1.06), draw.between(0.01, 0.05));
        let guidance = draw.pick(&["outer-race", "inner-race", "balls"]);
        text += &format!(
            "[bearing.cage]\npocket_radius = \"{} mm\"\ninner_radius = \"{inner} mm\"\n\
             outer_radius = \"{outer} mm\"\nmass = \"{mass} g\"\nlength = \"{} mm\"\n\
             guidance = \"{guidance}\"\npocket = \"{}\"\n",
            ball * pocket,
            2.2 * ball,
            draw.pick(&["cylindrical", "spherical"]),
        );
        if guidance != "balls" {
            text += &format!("race_clearance = \"{} mm\"\n", ball * clearance);
        }
    }
    // N: C0 = 12.3 Z D² with D in mm, as catalogues have it.
    let rating = 12.3 * balls as f64 * 4.0 * ball * ball;
    let radial = rating * draw.scaled(1e-4, 0.3);
    let axial =
        if angular { rating * draw.scaled(1e-3, 0.2) } else { rating * draw.scaled(1e-5, 0.05) };
    let rpm = draw.scaled(100.0, 30_000.0);
    // Contacts swing the faster the smaller they are.
    let end = (turns / (rpm / 60.0)).min(5e-4 * ball);
    let speed = if draw.chance(0.3) {
        format!("{{ ramp = [\"0 rpm\", \"{rpm} rpm\"], duration = \"{} s\" }}", 0.5 * end)
    } else {
        format!("\"{rpm} rpm\"")
    };
    text += &format!(
        "[inner_race]\nx = {{ load = \"{axial} N\" }}\nz = {{ load = \"{} N\" }}\nspeed = {speed}\n",
        -radial
    );
    if draw.chance(0.2) {
        text += "[ball_forces]\ngravity = [\"0 m/s^2\", \"0 m/s^2\", \"-9.81 m/s^2\"]\n";
    }
    text += &match draw.pick(&["none", "constant", "slide-to-roll", "slip-speed"]) {
        "constant" => format!(
            "[traction]\nlaw = \"constant\"\ncoefficient = {}\nregularisation_speed = \"{} m/s\"\n",
            draw.between(0.01, 0.15),
            draw.scaled(1e-3, 0.1)
        ),
        "slip-speed" => "[traction]\nlaw = \"slip-speed\"\nb = \"0.5 s/m\"\nc = \"8 s/m\"\n\
            d = 0.1\n"
            .into(),
        law => format!("[traction]\nlaw = \"{law}\"\n"),
    };
    if !text.ends_with("\"none\"\n") {
        text += "slices = 5\n";
    }
    if draw.chance(0.3) {
        let damping = draw.pick(&[
            "law = \"hunt-crossley\"\nalpha = \"0.2 s/m\"\n",
            "law = \"hunt-crossley\"\nalpha = \"2 s/m\"\n",
        ]);
        text += &format!("[contact_damping]\n{damping}");
    }
    let start = draw.pick(&["equilibrium", "nominal"]);
    text + &format!(
        "[numerics]\nend = \"{end} s\"\noutput_interval = \"{} s\"\nintegrator = \"rosenbrock\"\n\
         accuracy = 1e-3\nstart = \"{start}\"\n",
        end / 20.0
    )
}

/// How a scene ended.
pub struct Outcome {
    pub error: Option<SimulationError>,
    pub steps: u64,
    /// Of balls in each other and of anything in anything, in ball radii.
    pub deepest_balls: f64,
    pub deepest: f64,
    /// Largest residual, as a part of the energy turned over then.
    pub residual: f64,
    pub meetings: u64,
}

/// Depths at the present state, found here and not by the program's own watch.
fn depths(simulation: &Simulation) -> (f64, f64) {
    let system = &simulation.system;
    let layout = system.sets[0].layout;
    let radius = system.assembly.bearings[0].geometry.ball_radius;
    let place = |ball| layout.ball_vector(&simulation.state, POSITION, ball);
    let apart = |one: usize| norm(sub(place(one), place((one + 1) % layout.balls)));
    let balls = (0..neighbours(layout.balls)).map(|one| 2.0 * radius - apart(one));
    let balls = balls.fold(0.0, f64::max);
    let races =
        system.sets[0].table.active.iter().map(|&pair| system.sets[0].table.contact[pair].overlap);
    let cage = system.sets[0]
        .pockets
        .iter()
        .chain(&system.sets[0].guides)
        .map(|contact| contact.penetration);
    (balls / radius, races.chain(cage).fold(balls, f64::max) / radius)
}

/// # Panics
/// Where the scene cannot be read.
pub fn run_scene(text: &str) -> Outcome {
    let scene = scene::read_str(text, Format::Toml, "scene.toml")
        .unwrap_or_else(|error| panic!("{error}\n{text}"));
    let settings = run_options(&scene).unwrap();
    let request = RunRequest {
        options: settings.options,
        end: settings.end,
        output_interval: settings.output_interval,
        fields_interval: None,
        channels: vec![ChannelGroup::Energy],
    };
    let mut outcome = Outcome {
        error: None,
        steps: 0,
        deepest_balls: 0.0,
        deepest: 0.0,
        residual: 0.0,
        meetings: 0,
    };
    let mut session = match Session::start(dynamic_problem(&scene).unwrap(), &request) {
        Ok(session) => session,
        Err(SessionError::Simulation(error)) => return Outcome { error: Some(error), ..outcome },
        Err(other) => panic!("{other}\n{text}"),
    };
    let (mut rows, mut contact) = (0, 0.0f64);
    loop {
        let advanced = session.advance(1);
        let simulation = session.motion.bearing().expect("a bearing moves");
        outcome.steps = simulation.steps;
        let status = match advanced {
            Ok(status) => status,
            Err(SessionError::Simulation(error)) => {
                return Outcome { error: Some(error), ..outcome };
            }
            Err(other) => panic!("{other}\n{text}"),
        };
        let (balls, all) = depths(simulation);
        outcome.deepest_balls = outcome.deepest_balls.max(balls);
        outcome.deepest = outcome.deepest.max(all);
        let met = simulation.system.sets[0].meetings.iter().filter(|m| m.normal_load > 0.0).count();
        outcome.meetings += met as u64;
        if session.recorder.rows() > rows {
            rows = session.recorder.rows();
            let simulation = session.motion.bearing_mut().expect("a bearing moves");
            let snapshot = simulation.snapshot();
            contact = contact.max(snapshot.energy.contact + snapshot.energy.ball_contact);
            let turned = contact
                + snapshot.energy.kinetic
                + snapshot.ledger.iter().map(|entry| entry.abs()).sum::<f64>();
            outcome.residual = outcome.residual.max(snapshot.residual.abs() / turned);
        }
        if status == Status::Complete {
            return outcome;
        }
    }
}

#[test]
fn sixty_random_scenes_end_sound_or_say_why() {
    let mut ended = Vec::new();
    let (mut complete, mut met, mut worst, mut deepest, mut steps) = (0, 0, 0.0f64, 0.0f64, 0);
    for seed in 0..60 {
        let text = scene_text(seed, 0.25);
        let outcome = run_scene(&text);
        steps += outcome.steps;
        assert!(outcome.deepest <= HERTZ_SCALE, "{seed}: {} radii\n{text}", outcome.deepest);
        deepest = deepest.max(outcome.deepest);
        met += usize::from(outcome.meetings > 0);
        if let Some(error) = outcome.error {
            println!("{seed}: {error}");
            ended.push((seed, error));
            continue;
        }
        complete += 1;
        worst = worst.max(outcome.residual);
        // Measured: 9e-4 at worst, where light parts rattle, which the method damps.
        assert!(outcome.residual <= 5e-3, "{seed}: {}\n{text}", outcome.residual);
    }
    println!(
        "{complete} complete, {met} with balls that met, worst residual {worst:e}, deepest {deepest:e}, {steps} steps"
    );
    assert!(complete >= 56, "{complete}");
    assert!(met >= 7, "{met}");
}
