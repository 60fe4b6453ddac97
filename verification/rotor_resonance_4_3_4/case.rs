//! The rotor of 4.3.4 run up through resonance on fixed outer races and in pillow blocks.

use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::series::Series;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::housed_shaft::Shaft;
use crate::motion::{
    ROTOR_IN_PILLOW_BLOCKS, ROTOR_RUN_UP, RPM, changed_scene, column, done, request,
};
use crate::rotor_run_up::{CAGE, DAMPED, RAMP_UNSTATED, SPEED};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "rotor_resonance_4_3_4",
    title: "Rotor through resonance, on fixed races and in pillow blocks",
    section: "4.3.4, Figs. 4.20-4.23",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

type Change<'c> = (&'c str, &'c str);

/// Beside the middle, mm from it.
const PROBES: [i32; 8] = [-190, -150, -100, -50, 50, 100, 150, 190];
const NO_CLEARANCE: &str = "clearance = { radial = \"0 um\" }";
/// Balls that carry nothing keep their places and do not rattle.
const CALM: [Change; 2] = [("[bearing.left]", CAGE), ("law = \"none\"\n", DAMPED)];
/// Where the rotor bends as far as this part of its largest deflection is resonance: some 165 rows, which the row of the largest alone
/// does not shift.
const RESONANCE: f64 = 0.9;

/// What a run-up did, row by row.
struct Done {
    /// rpm.
    speed: Vec<f64>,
    /// Of the inner race, µm.
    y: Vec<f64>,
    z: Vec<f64>,
    /// On the inner race, N and N·m.
    force: Vec<f64>,
    moment: Vec<f64>,
    /// Of the middle, µm.
    deflection: Vec<f64>,
    series: Series,
}

impl Done {
    fn of(series: Series) -> Result<Done, CaseError> {
        let scaled = |name: &str, by: f64| -> Result<Vec<f64>, CaseError> {
            Ok(column(&series, name)?.iter().map(|x| by * x).collect())
        };
        let size = |[a, b]: [Vec<f64>; 2]| a.iter().zip(&b).map(|(a, b)| a.hypot(*b)).collect();
        let force = |axis: &str| column(&series, &format!("left_contact_force_on_inner_{axis}"));
        let moment = |axis: &str| column(&series, &format!("left_contact_moment_on_inner_{axis}"));
        Ok(Done {
            speed: scaled("shaft_speed", 1.0 / RPM)?,
            y: scaled("left_inner_y", 1e6)?,
            z: scaled("left_inner_z", 1e6)?,
            force: size([force("y")?, force("z")?]),
            moment: size([moment("y")?, moment("z")?]),
            deflection: size([scaled("shaft_mid_y", 1e6)?, scaled("shaft_mid_z", 1e6)?]),
            series,
        })
    }

    /// Farthest towards −Y, +Y, −Z, +Z, µm.
    fn farthest(&self) -> [f64; 4] {
        let most = |of: &[f64], sign: f64| largest(of.iter().map(|x| sign * x));
        [most(&self.y, -1.0), most(&self.y, 1.0), most(&self.z, -1.0), most(&self.z, 1.0)]
    }

    /// Root of the mean square of `of` in the rows where `counts`.
    fn mean(of: &[f64], counts: impl Iterator<Item = bool>) -> f64 {
        let rows = of.iter().zip(counts).filter(|(_, counts)| *counts);
        let (count, sum) = rows.fold((0.0, 0.0), |(n, sum), (x, _)| (n + 1.0, sum + x * x));
        f64::sqrt(sum / count)
    }

    fn mean_between(&self, of: &[f64], [from, to]: [f64; 2]) -> f64 {
        Done::mean(of, self.speed.iter().map(|speed| (from..to).contains(speed)))
    }

    fn at_resonance(&self, of: &[f64]) -> f64 {
        let least = RESONANCE * largest(self.deflection.iter().copied());
        Done::mean(of, self.deflection.iter().map(|deflection| *deflection >= least))
    }

    /// Speed of the largest deflection, rpm.
    fn peak(&self) -> f64 {
        self.speed[Done::top(&self.deflection)]
    }

    /// Row of the largest of these.
    fn top(of: &[f64]) -> usize {
        (0..of.len()).max_by(|a, b| of[*a].total_cmp(&of[*b])).unwrap_or(0)
    }
}

fn clearance(radial: f64) -> String {
    format!("clearance = {{ radial = \"{radial} um\" }}")
}

/// With this clearance, µm, in pillow blocks.
fn housed(radial: f64) -> Result<Done, CaseError> {
    let watch: Vec<String> = PROBES
        .iter()
        .enumerate()
        .map(|(i, at)| format!("{{ name = \"s{i}\", at = \"{at} mm\" }}"))
        .collect();
    let watch = format!("probe = [{{ name = \"mid\", at = \"0 mm\" }}, {}]", watch.join(", "));
    let clearance = clearance(radial);
    let mut changes: Vec<Change> = vec![
        ("speed = \"1000 rpm\"", SPEED),
        (
            "load = [{ at = \"0 mm\", z = \"-3000 N\" }]\n",
            "disc = [{ at = \"0 mm\", mass = \"20 kg\", axial = \"2.25e-3 kg m^2\", transverse = \"1.125e-3 kg m^2\" }]\nunbalance = [{ at = \"0 mm\", size = \"1e-3 kg m\" }]\n",
        ),
        (
            "fit = { radial = \"2.5 um\" }              # interference\n",
            "fit = { radial = \"0 um\" }\nmodes_to = \"20 kHz\"\n",
        ),
        ("end = \"2 ms\"", "end = \"0.2 s\"\naccuracy = 0.01"),
        ("output_interval = \"20 us\"", "output_interval = \"0.1 ms\""),
        ("plots = [\"series\", \"orbit\"]", "channels = [\"races\", \"forces\", \"moments\"]"),
        ("probe = [{ name = \"mid\", at = \"0 mm\" }]", &watch),
        (NO_CLEARANCE, &clearance),
    ];
    changes.extend(CALM);
    let shaft = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &changes)?;
    Done::of(done(shaft.reduced()?, &shaft.request()?)?.series()?)
}

/// The same on fixed outer races; `more` are further words of the scene.
fn fixed(radial: f64, more: &[Change]) -> Result<Done, CaseError> {
    let clearance = clearance(radial);
    let mut changes: Vec<Change> = vec![
        ("end = \"0.2 s\"", "end = \"0.2 s\"\naccuracy = 0.01"),
        ("channels = [\"races\", \"energy\"]", "channels = [\"races\", \"forces\", \"moments\"]"),
        (NO_CLEARANCE, &clearance),
    ];
    changes.extend(more);
    let scene = changed_scene(ROTOR_RUN_UP, &changes)?;
    Done::of(done(scene.assembly()?, &request(&scene)?)?.series()?)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let (name, text, default) = RAMP_UNSTATED;
    context.assumption(name, text, default);
    context.assumption(
        "housing_dimensions",
        "The sizes of Fig. 4.5's pillow block are not in the text.",
        "the generator's pillow block, as deep as the bearing",
    );
    context.assumption(
        "balls_kept",
        "How balls that carry nothing keep their places is not in 4.3.4. Without cage and damping those of a bearing with clearance rattle and climb, and the moment is theirs.",
        "a cage of 20 g with 0.05 mm about each ball, and damped contacts (1 s/m)",
    );
    let (in_blocks, on_fixed) = (housed(0.0)?, fixed(0.0, &CALM)?);
    ways(context, &in_blocks, &on_fixed)?;
    give(context, &in_blocks)?;
    moments(context, &in_blocks)?;
    quarter_turns(context, &in_blocks)
}

fn ways(context: &mut CaseContext, in_blocks: &Done, on_fixed: &Done) -> Result<(), CaseError> {
    let (housed, fixed) = (in_blocks.farthest(), on_fixed.farthest());
    let gain = |i: usize| housed[i] / fixed[i] - 1.0;
    for (id, along, i) in
        [("farther_minus_y", "−Y", 0), ("farther_plus_y", "+Y", 1), ("farther_plus_z", "+Z", 3)]
    {
        context.check(
            Check::new(
                id,
                &format!("additional displacement of inner race 1 along {along} in housings than with fixed races"),
                "1",
                gain(i),
            )
            .stated(0.0, "4.3.4", "the displacement is significantly larger along +Z, +Y and −Y")
            .at_least(0.05, "2.5 times the step error of single rows"),
        );
    }
    context.check(
        Check::new("same_minus_z", "the same along −Z", "1", gain(2))
            .stated(0.0, "4.3.4", "the displacement is nearly the same along −Z")
            .absolute(0.03, "step error of single rows, 2 %, and the compliance of the foot"),
    );
    for (id, axis, of) in
        [("race_z", "z", [&in_blocks.z, &on_fixed.z]), ("race_y", "y", [&in_blocks.y, &on_fixed.y])]
    {
        let curve = |name: &str, done: &Done, of: &[f64]| {
            let points = done.speed.iter().zip(of).map(|(x, y)| [*x, *y]);
            Curve::new(name, points.collect())
        };
        let svg = xy(&XyPlot {
            title: format!("Inner race 1 along {axis}, run up within 0.2 s"),
            x: Axis::linear("speed", "rpm"),
            y: Axis::linear(axis, "um"),
            style: Style::Lines,
            curves: vec![
                curve("in pillow blocks", in_blocks, of[0]),
                curve("fixed", on_fixed, of[1]),
            ],
        })?;
        context.figure(id, svg, "As in Figs. 4.20 and 4.21.");
    }
    Ok(())
}

/// Way of outer race 1 over the force that the balls push the block with, mean of the rows at resonance in which it hardly pushes
/// aside, m/N, along −Y, +Y, −Z and +Z, and how many rows.
fn gives(in_blocks: &Done) -> Result<[(f64, usize); 4], CaseError> {
    let of = |name: &str| column(&in_blocks.series, &format!("left_{name}"));
    let way = [of("outer_y")?, of("outer_z")?];
    let force = [of("housing_force_on_outer_y")?, of("housing_force_on_outer_z")?];
    Ok([(0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0)].map(|(axis, sign): (usize, f64)| {
        let (mut sums, mut rows) = ([0.0; 2], 0);
        for row in 0..way[0].len() {
            let pushed = -sign * force[axis][row];
            if pushed >= 500.0 && force[1 - axis][row].abs() <= 0.1 * pushed {
                sums[0] += sign * way[axis][row];
                sums[1] += pushed;
                rows += 1;
            }
        }
        (sums[0] / sums[1], rows)
    }))
}

/// The block answers a turning force far below its own frequencies as at rest, and its foot is stiffer than its top and sides.
fn give(context: &mut CaseContext, in_blocks: &Done) -> Result<(), CaseError> {
    let [minus_y, plus_y, minus_z, plus_z] = gives(in_blocks)?;
    let changes: [Change; 2] = [
        ("z = \"-3000 N\"", "z = \"2000 N\""),
        ("fit = { radial = \"2.5 um\" }", "fit = { radial = \"0 um\" }"),
    ];
    let shaft = Shaft::new(ROTOR_IN_PILLOW_BLOCKS, &changes)?;
    let (still, found) = shaft.statics(&shaft.bores()?)?;
    let still = found.coordinates[still.bearings[0].mounts[1].body][2] / found.seats[0].load[1];
    context.check(
        Check::new(
            "give",
            &format!(
                "displacement of outer race 1 along +Z over the force on the top of the block, mean of {} rows at resonance",
                plus_z.1
            ),
            "µm/kN",
            1e9 * plus_z.0,
        )
        .consistency(1e9 * still, "an equilibrium under 1000 N upwards")
        .relative(0.05, "forces up to 6° aside, and the block's own vibrations, whose mean counts"),
    );
    for (id, along, (other, rows)) in
        [("plus_z", "+Z", plus_z), ("plus_y", "+Y", plus_y), ("minus_y", "−Y", minus_y)]
    {
        context.check(
            Check::new(
                &format!("softer_{id}"),
                &format!(
                    "give of housing 1 along {along} over that along −Z at resonance, means of {rows} and {} rows",
                    minus_z.1
                ),
                "1",
                other / minus_z.0,
            )
            .stated(1.0, "4.3.4", "the support stiffness is large along −Z, where the block rests on the ground, and reduced in the other directions")
            .at_least(1.0, "twice as soft; the block's shape decides how far above"),
        );
    }
    Ok(())
}

/// Moment of bearing 1 on fixed races at rest under this force on each bearing, N: mean over a ball's pitch.
fn moment_at_rest(radial: f64, force: f64) -> Result<f64, CaseError> {
    const PHASES: [f64; 4] = [0.0, 11.25, 22.5, 33.75];
    let (clearance, load) =
        (clearance(radial), format!("load = [{{ at = \"0 mm\", z = \"{} N\" }}]", -2.0 * force));
    let mut sum = 0.0;
    for phase in PHASES {
        let balls = format!("balls = 8\nball_phase = \"{phase} deg\"");
        let changes: [Change; 5] = [
            (SPEED, "speed = \"0 rpm\""),
            ("unbalance = [{ at = \"0 mm\", size = \"1e-3 kg m\" }]", &load),
            ("start = \"nominal\"", "start = \"equilibrium\""),
            ("balls = 8", &balls),
            (NO_CLEARANCE, &clearance),
        ];
        let scene = changed_scene(ROTOR_RUN_UP, &changes)?;
        let found = solve_assembly(&scene.statics()?, None, &StaticOptions::default())?;
        sum += found.bearings[0].moments[0].norm();
    }
    Ok(sum / PHASES.len() as f64)
}

fn moments(context: &mut CaseContext, in_blocks: &Done) -> Result<(), CaseError> {
    context.check(
        Check::new(
            "moment_peak",
            "speed at the largest moment of bearing 1 in housings",
            "rpm",
            in_blocks.speed[Done::top(&in_blocks.moment)],
        )
        .stated(
            in_blocks.peak(),
            "4.3.4",
            "the rotor deflection at resonance causes the reaction moment to increase",
        )
        .relative(0.08, "one row among those of a moment that ripples as balls pass; five turns about the peak, where the deflection is flat to 3 %"),
    );
    let moment = |done: &Done| done.at_resonance(&done.moment);
    context.check(
        Check::new(
            "moment_rises",
            "moment of bearing 1 in housings at resonance over that between 2500 and 3500 rpm",
            "1",
            moment(in_blocks) / in_blocks.mean_between(&in_blocks.moment, [2500.0, 3500.0]),
        )
        .stated(1.0, "4.3.4", "the reaction moment increases at resonance")
        .at_least(5.0, "far above one"),
    );
    let loose = [(5.0, housed(5.0)?), (10.0, housed(10.0)?), (20.0, housed(20.0)?)];
    let mut before = (0.0, in_blocks);
    for (radial, done) in &loose {
        context.check(
            Check::new(
                &format!("moment_falls_{radial}"),
                &format!("moment of bearing 1 in housings at resonance, with a clearance of {radial} µm over that with {} µm", before.0),
                "1",
                moment(done) / moment(before.1),
            )
            .stated(1.0, "4.3.4", "the moment is reduced with a positive bearing internal clearance")
            .at_most(0.01, "five times its step error (0.01 against 0.002: 0.2 %)"),
        );
        before = (*radial, done);
    }
    for (radial, done) in [(0.0, in_blocks), (5.0, &loose[0].1)] {
        let force = done.at_resonance(&done.force);
        context.check(
            Check::new(
                &format!("moment_at_{radial}"),
                &format!("moment of bearing 1 in housings at resonance, clearance of {radial} µm"),
                "N m",
                moment(done),
            )
            .consistency(
                moment_at_rest(radial, force)?,
                &format!(
                    "equilibria on fixed races under the mean force of those rows, {force:.0} N"
                ),
            )
            .relative(
                0.05,
                "housings tilt with their races, and rms values replace rows with a ripple",
            ),
        );
    }
    let (kept, free) = (fixed(5.0, &CALM)?, [fixed(0.0, &[])?, fixed(5.0, &[])?]);
    context.finding(
        "moment_without_cage",
        format!(
            "On fixed races the moment at resonance with +5 µm is {:.2} N·m. Without cage and damped contacts it is {:.2} N·m, and {:.2} N·m without clearance: balls that carry nothing climb \
             out of their grooves, and the rise is theirs. At the same force equilibria have 2 to 4 % more moment with +5 µm than without: what a clearance takes off is the rotor's deflection.",
            moment(&kept),
            moment(&free[1]),
            moment(&free[0]),
        ),
    );
    let curve = |name: String, done: &Done| {
        let points = done.speed.iter().zip(&done.moment).map(|(x, y)| [*x, *y]);
        Curve::new(name, points.collect())
    };
    let mut curves = vec![curve("no clearance".into(), in_blocks)];
    curves.extend([0, 2].map(|i: usize| curve(format!("+{} um", loose[i].0), &loose[i].1)));
    let svg = xy(&XyPlot {
        title: "Moment of bearing 1 in pillow blocks".into(),
        x: Axis::linear("speed", "rpm"),
        y: Axis::linear("moment", "N m"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("moment", svg, "As in Fig. 4.23.");
    Ok(())
}

/// The bent axis at the largest deflection and each quarter of a turn after.
fn quarter_turns(context: &mut CaseContext, in_blocks: &Done) -> Result<(), CaseError> {
    let series = &in_blocks.series;
    let first = Done::top(&in_blocks.deflection);
    let time = column(series, "time")?;
    let turn = 60.0 / in_blocks.speed[first];
    let names =
        ["left_inner_z", "s0", "s1", "s2", "s3", "mid", "s4", "s5", "s6", "s7", "right_inner_z"];
    let places = [-200, -190, -150, -100, -50, 0, 50, 100, 150, 190, 200];
    let mut curves = Vec::new();
    for quarter in 0..4 {
        let then = time[first] + 0.25 * f64::from(quarter) * turn;
        let row = time.iter().position(|t| *t >= then).unwrap_or(first);
        let mut points = Vec::new();
        for (name, x) in names.iter().zip(places) {
            let name =
                if name.ends_with("_z") { (*name).into() } else { format!("shaft_{name}_z") };
            points.push([f64::from(x), 1e6 * column(series, &name)?[row]]);
        }
        curves.push(Curve::new(format!("{} deg", 90 * quarter), points));
    }
    let svg = xy(&XyPlot {
        title: "The rotor's axis at resonance, each quarter of a turn".into(),
        x: Axis::linear("x", "mm"),
        y: Axis::linear("z", "um"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("quarter_turns", svg, "Seen from the side, in pillow blocks, as in Fig. 4.22.");
    Ok(())
}
