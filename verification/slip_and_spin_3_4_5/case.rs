//! Load, slip and spin of balls around a bearing whose inner race is tilted: outer race fixed or in a bushing.

use std::f64::consts::TAU;

use bearing_dynamics::output::plots::{Curve, PolarPlot, polar};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use nalgebra::Complex;

use crate::bushings::{BEARING_ON_BUSHING, BULK_RATIO, MODULUS, shear_over_modulus};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::{RPM, changed_scene, ran};
use crate::oracles::bonded_bushing::{Motion, Section, stiffness};
use crate::oracles::hertz::{ball_on_race, hamrock_brewe};
use crate::oracles::misalignment::{STEEL_ON_STEEL, TABLE_3_5, fitted};
use crate::oracles::rolling::{RollingBall, RollingContact};
use crate::oracles::statics::{Known, OracleBall, OracleBearing};
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "slip_and_spin_3_4_5",
    title: "Slip and spin of balls under a tilt, outer race fixed or in a bushing",
    section: "3.4.5, Figs. 3.31 to 3.33",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Tilt of the inner race, degrees, a moment in its place, N·m, and the shaft's speed, rpm.
const TILT: f64 = 0.15;
const MOMENT: f64 = 5.0;
const SPEED: f64 = 1000.0;
/// Of the bushing, m.
const SECTION: Section = Section { inner: 35.5e-3, outer: 45.5e-3, length: 20e-3 };
/// Between rows and until the map begins, s. The ball then goes once around.
const SAMPLE: f64 = 0.5e-3;
const FROM: f64 = 40e-3;
/// The bushing takes at least this part of what the fixed race has: "significantly".
const SIGNIFICANT: f64 = 0.5;

/// What holds the outer race.
#[derive(Clone, Copy, PartialEq)]
enum Held {
    Fixed,
    /// Bushing of Table 3.1's rubber, C_R times a factor.
    Bushing(f64),
}

/// What tilts the inner race, as the scene has it.
fn driven(tilt: bool) -> String {
    if tilt {
        format!("tilt_y = {{ tilt = \"{TILT} deg\" }}")
    } else {
        format!("tilt_y = {{ moment = \"{MOMENT} N m\" }}")
    }
}

fn scene(held: Held, tilt: bool) -> Result<AssemblyScene, CaseError> {
    let about_y = driven(tilt);
    let end = format!("end = \"{} s\"", FROM + period() + SAMPLE);
    let rubber = match held {
        Held::Bushing(factor) => {
            format!("table = \"3.1\"\nrubber_modulus = \"{} MPa\"", 1e-6 * factor * MODULUS)
        }
        Held::Fixed => "table = \"3.1\"".into(),
    };
    let mut text = BEARING_ON_BUSHING.to_string();
    if held == Held::Fixed {
        let cut = text.find("[spring.mount]").zip(text.find("[traction]"));
        let (from, to) = cut.ok_or_else(|| CaseError::message("no bushing in the scene"))?;
        text.replace_range(from..to, "");
        text = text.replace("motion = \"5-dof\"\nspeed = \"0 rpm\"", "motion = \"fixed\"");
    }
    let mut changes = vec![
        (
            "{ half_sine = \"-500 N\", base = \"0 N\", start = \"20 ms\", duration = \"0.5 ms\" }",
            "\"0 N\"",
        ),
        ("tilt_y = { tilt = \"0 deg\" }", about_y.as_str()),
        ("tilt_z = { tilt = \"0 deg\" }", "tilt_z = { moment = \"0 N m\" }"),
        ("end = \"120 ms\"", end.as_str()),
        ("output_interval = \"0.1 ms\"", "output_interval = \"0.5 ms\""),
        (
            "plots = [\"series\", \"orbit\"]",
            "plots = [\"series\"]\nchannels = [\"races\", \"orbits\", \"loads\", \"slip\"]",
        ),
    ];
    if held != Held::Fixed {
        changes.push(("table = \"3.1\"", rubber.as_str()));
    }
    changed_scene(&text, &changes)
}

/// One orbit of a ball by pure rolling, s.
fn period() -> f64 {
    let pitch = TABLE_3_5.inner[0] + TABLE_3_5.ball_radius;
    let ratio = 0.5 * (1.0 - TABLE_3_5.ball_radius / pitch);
    TAU / (ratio * SPEED * RPM)
}

/// What a ball meets at the outer race around the bearing.
struct Map {
    /// rad, N, m/s, rad/s.
    azimuth: Vec<f64>,
    load: Vec<f64>,
    slip: Vec<f64>,
    spin: Vec<f64>,
    /// Tilt of the inner race against the outer one about Z, its mean, rad.
    turned: f64,
}

impl Map {
    fn of(scene: &AssemblyScene) -> Result<Map, CaseError> {
        let names = [
            "time",
            "ball_1_angle",
            "ball_1_outer_load",
            "ball_1_outer_slip_rolling",
            "ball_1_outer_slip_transverse",
            "ball_1_outer_spin",
            "inner_tilt_z",
        ];
        let of_outer = scene.bearings[0].scene.dynamics.outer.is_some();
        let names: Vec<&str> =
            names.into_iter().chain(of_outer.then_some("outer_tilt_z")).collect();
        let columns = ran(scene, &names)?;
        let from = columns[0].iter().position(|t| *t >= FROM).unwrap_or(0);
        let rows = from..columns[0].len();
        let [_, angle, load, along, across, spin, inner, outer @ ..] = &columns[..] else {
            return Err(CaseError::message("seven columns"));
        };
        let mean = |of: &Vec<f64>| of[rows.clone()].iter().sum::<f64>() / rows.len() as f64;
        let outer: f64 = outer.iter().map(mean).sum();
        let pick = |of: &Vec<f64>| of[rows.clone()].to_vec();
        Ok(Map {
            // The unit of angles in results.
            azimuth: pick(angle).iter().map(|a| a.to_radians().rem_euclid(TAU)).collect(),
            load: pick(load),
            slip: rows.clone().map(|row| along[row].hypot(across[row])).collect(),
            spin: pick(spin).iter().map(|x| x.abs()).collect(),
            turned: (mean(inner) - outer).to_radians(),
        })
    }

    /// Each quantity with its name, as the figures have it.
    fn all(&self) -> [(&'static str, &Vec<f64>); 3] {
        [("load", &self.load), ("slip", &self.slip), ("spin", &self.spin)]
    }

    /// Mean over the samples within 15° of these azimuths, degrees.
    fn near(&self, of: &[f64], places: [f64; 2]) -> f64 {
        let close = |azimuth: f64| {
            let off = |place: f64| {
                let off = (azimuth.to_degrees() - place).rem_euclid(360.0);
                off.min(360.0 - off)
            };
            places.iter().any(|place| off(*place) <= 15.0)
        };
        let rows: Vec<f64> =
            self.azimuth.iter().zip(of).filter(|(a, _)| close(**a)).map(|(_, x)| *x).collect();
        rows.iter().sum::<f64>() / rows.len() as f64
    }
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|x| x * x).sum::<f64>() / values.len() as f64).sqrt()
}

/// Part of each quantity that the bushing takes: of the load what is above a bearing that is not tilted.
fn taken(fixed: &Map, bushing: &Map) -> [f64; 3] {
    let untilted = untilted();
    let over = |map: &Map| rms(&map.load.iter().map(|load| load - untilted).collect::<Vec<_>>());
    let part = |with: f64, without: f64| 1.0 - with / without;
    [
        part(over(bushing), over(fixed)),
        part(rms(&bushing.slip), rms(&fixed.slip)),
        part(rms(&bushing.spin), rms(&fixed.spin)),
    ]
}

/// Load of each ball by interference alone, N.
fn untilted() -> f64 {
    let bearing = TABLE_3_5.bearing(TABLE_3_5.stiffness(fitted), 0.0);
    bearing.evaluate(&[0.0; 5]).2[0].outer.load
}

/// Tilts between the races and of the outer race, rad, with its outer race on the oracle's relaxed bushing.
fn shared_tilt() -> f64 {
    let shear = Complex::new(shear_over_modulus() * MODULUS, 0.0);
    let k = stiffness(SECTION, Motion::Conical, shear, BULK_RATIO * MODULUS, 4, 2).re;
    let (mut low, mut high) = (0.0, TILT.to_radians());
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let moment = tilted(0.0, [Known::Value(middle), Known::Load(0.0)]).1;
        if moment < k * (TILT.to_radians() - middle) { low = middle } else { high = middle }
    }
    low
}

/// Balls of a bearing tilted so about Y and Z, at a ball phase, and the moment about Y that holds it.
fn tilted(phase: f64, [about_y, about_z]: [Known; 2]) -> (Vec<OracleBall>, f64) {
    let bearing: OracleBearing = TABLE_3_5.bearing(TABLE_3_5.stiffness(fitted), phase);
    let free = Known::Load(0.0);
    let found = bearing.solve(&[free, free, free, about_y, about_z], None);
    (bearing.evaluate(&found.coordinates).2, found.loads[3])
}

/// Every so many rows a bearing is solved with a ball there.
const EVERY: usize = 4;

/// The ball of a bearing tilted so at the azimuth of every fourth row.
fn around(map: &Map, tilts: [Known; 2]) -> Vec<OracleBall> {
    map.azimuth.iter().step_by(EVERY).map(|azimuth| tilted(*azimuth, tilts).0[0]).collect()
}

/// Spin against the outer race, rad/s, of a ball that rolls where its spin moments balance.
fn spin_of(ball: &OracleBall) -> f64 {
    let touching = |contact: &crate::oracles::statics::OracleContact, side: [f64; 2], sign: f64| {
        let radii = ball_on_race(TABLE_3_5.ball_radius, side[0], side[1], sign);
        RollingContact {
            arm: TABLE_3_5.ball_radius - 0.5 * contact.approach,
            angle: contact.angle,
            load: contact.load,
            semi_axis: hamrock_brewe(radii, contact.load, STEEL_ON_STEEL).semi_axis_transverse,
        }
    };
    let rolling = RollingBall {
        orbit_radius: ball.position[1],
        inner: touching(&ball.inner, TABLE_3_5.inner, 1.0),
        outer: touching(&ball.outer, TABLE_3_5.outer, -1.0),
    };
    let friction = |s: f64| (22.28 * s - 0.1) * (-181.46 * s).exp() + 0.1;
    (rolling.spins(rolling.balanced_roll(friction))[1] * SPEED * RPM).abs()
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for assumption in &scene(Held::Bushing(1.0), true)?.common().assumptions {
        if ["clearance", "friction", "cage", "length"].contains(&assumption.name.as_str()) {
            context.assumption(
                &assumption.name,
                &assumption.text,
                "scenes/bearing_on_bushing.toml",
            );
        }
    }
    context.assumption(
        "speed",
        "3.4.5 states no speed; that of 3.4.3. Slip and spin go with it.",
        "1000 rpm",
    );
    context.assumption(
        "relaxed",
        "3.4.5 states neither the bushing's thickness nor how long the tilt lasts: the first of Table 3.6, relaxed.",
        "H 10 mm, relaxed",
    );
    let map = |held, tilt| scene(held, tilt).and_then(|scene| Map::of(&scene));
    let (fixed, bushing) = (map(Held::Fixed, true)?, map(Held::Bushing(1.0), true)?);
    loads(context, &fixed, &bushing);
    falls(context, &fixed, &bushing, &map(Held::Bushing(1e4), true)?);
    places(context, &fixed, &bushing);
    same_moment(context, &map(Held::Fixed, false)?, &map(Held::Bushing(1.0), false)?);
    figures(context, &fixed, &bushing)
}

/// Load and spin around against the independent statics with a ball at the azimuth of each row. Traction, which that leaves
/// out, tilts the race about Z too, by some 2.5° of the tilt about Y at any speed, and turns the map by as much: loads are held place by place
/// against a bearing with that tilt. The spin's root mean square is held: the ball's axis lags.
fn loads(context: &mut CaseContext, fixed: &Map, bushing: &Map) {
    let shared = shared_tilt();
    for (id, text, map, tilt) in [
        ("fixed", "outer race fixed", fixed, TILT.to_radians()),
        ("bushing", "in a bushing", bushing, shared),
    ] {
        let balls: Vec<OracleBall> = around(map, [Known::Value(tilt), Known::Load(0.0)]);
        let load: Vec<f64> = balls.iter().map(|ball| ball.outer.load).collect();
        context.check(
            Check::new(
                &format!("load_{id}"),
                &format!("load of a ball, rms around, {text}"),
                "N",
                rms(&map.load),
            )
            .independent(
                rms(&load),
                "independent statics; the tilt shared with the bushing of axisymmetric polynomials",
            )
            .relative(
                0.01,
                "half of a ball's centrifugal force of 1.9 N; the bushing's mesh; traction",
            )
            .golden(GoldenTolerance::MIXED),
        );
        let turned = around(map, [Known::Value(tilt), Known::Value(map.turned)]);
        let apart = map.load.iter().step_by(EVERY).zip(&turned);
        let apart = largest(apart.map(|(load, ball)| (load - ball.outer.load).abs()));
        context.check(
            Check::new(
                &format!("places_{id}"),
                &format!(
                    "largest difference of a ball's load at any place, over its largest, {text}"
                ),
                "1",
                apart / largest(map.load.iter().copied()),
            )
            .independent(0.0, "independent statics with the run's own tilt about Z")
            .absolute(0.01, "as the root mean square; the tilt about Z is a mean"),
        );
        let spin: Vec<f64> = balls.iter().map(spin_of).collect();
        context.check(
            Check::new(&format!("spin_{id}"), &format!("spin of a ball, rms around, {text}"), "rad/s", rms(&map.spin))
                .independent(rms(&spin), "tilt of the ball's axis at which the spin moments of both contacts balance, by quadrature, on the independent statics")
                .relative(0.1, "the ball's axis follows its contacts with a delay of some 10° of the orbit, and what it lags is spin")
                .golden(GoldenTolerance::MIXED.floor(1e-4)),
        );
    }
}

/// That the bushing takes most of all three; and that a bushing which cannot yield takes nothing.
fn falls(context: &mut CaseContext, fixed: &Map, bushing: &Map, hard: &Map) {
    let words = [
        "contact forces due to the misalignment are significantly larger with a fixed outer race",
        "slip is significantly reduced",
        "spin is significantly reduced",
    ];
    let swapped = taken(bushing, fixed);
    let not = taken(fixed, hard);
    for (k, (part, name)) in taken(fixed, bushing)
        .into_iter()
        .zip(["load over that without tilt", "slip", "spin"])
        .enumerate()
    {
        let id = ["load", "slip", "spin"][k];
        context.check(
            Check::new(
                &format!("taken_{id}"),
                &format!("part that the bushing takes of the ball's {name}, rms around"),
                "1",
                part,
            )
            .stated(SIGNIFICANT, "3.4.5", words[k])
            .at_least(0.0, "\"significantly\" read as at least half")
            .golden(GoldenTolerance::MIXED.floor(1e-3)),
        );
        context.check(
            Check::new(
                &format!("swapped_{id}"),
                &format!("the same of the {name} with the two runs exchanged"),
                "1",
                swapped[k],
            )
            .stated(SIGNIFICANT, "3.4.5", words[k])
            .at_most(SIGNIFICANT, "exchanged runs must not pass"),
        );
        context.check(
            Check::new(
                &format!("hard_{id}"),
                &format!("the same of the {name} with rubber ten thousand times stiffer"),
                "1",
                not[k],
            )
            .stated(SIGNIFICANT, "3.4.5", words[k])
            .at_most(SIGNIFICANT - 0.05, "a bushing that cannot yield must not pass"),
        );
    }
}

/// Where the tilt about Y is felt.
fn places(context: &mut CaseContext, fixed: &Map, bushing: &Map) {
    for (id, map) in [("fixed", fixed), ("bushing", bushing)] {
        for (name, of) in map.all() {
            // Slip is largest where the contact runs across the groove, at ±Y; in the bushing little is left but interference.
            if name == "slip" || id == "bushing" && name != "load" {
                continue;
            }
            let ratio = map.near(of, [90.0, 270.0]) / map.near(of, [0.0, 180.0]);
            context.check(
                Check::new(
                    &format!("place_{name}_{id}"),
                    &format!("{name} of a ball near ±Z over that near ±Y, {id}"),
                    "1",
                    ratio,
                )
                .stated(
                    1.0,
                    "3.4.5",
                    "larger when the ball moves closer to the positive and negative Z axis",
                )
                .at_least(0.0, "an order"),
            );
        }
    }
}

/// Under the same moment the races tilt as far against each other whatever holds the outer one.
fn same_moment(context: &mut CaseContext, fixed: &Map, bushing: &Map) {
    for ((name, a), (_, b)) in fixed.all().into_iter().zip(bushing.all()) {
        context.check(
            Check::new(&format!("moment_{name}"), &format!("{name} of a ball at 5 N·m, rms around, bushing over fixed"), "1", rms(b) / rms(a))
                .stated(1.0, "3.4.5", "the angle between the races, which determines the moment, is exactly the same with and without a bushing")
                .absolute(0.02, "ringing of the start differs; the bushing gives way to the balls as they pass"),
        );
    }
}

fn figures(context: &mut CaseContext, fixed: &Map, bushing: &Map) -> Result<(), CaseError> {
    let figures = ["Fig. 3.31", "Fig. 3.32", "Fig. 3.33"];
    let names =
        ["Load of a ball on the outer race", "Slip at the outer race", "Spin at the outer race"];
    let mut rows = Vec::new();
    for (k, ((id, a), (_, b))) in fixed.all().into_iter().zip(bushing.all()).enumerate() {
        let (unit, scale) = [("N", 1.0), ("mm/s", 1e3), ("rad/s", 1.0)][k];
        let points = |map: &Map, of: &[f64]| -> Vec<[f64; 2]> {
            map.azimuth.iter().zip(of).map(|(a, x)| [*a, scale * x]).collect()
        };
        let svg = polar(&PolarPlot {
            title: names[k].into(),
            quantity: id.into(),
            unit: unit.into(),
            curves: vec![
                Curve::new("fixed outer race", points(fixed, a)),
                Curve::new("in a bushing", points(bushing, b)),
            ],
        })?;
        context.figure(
            &format!("map_{id}"),
            svg,
            &format!("As {}: around the bearing, inner race tilted by 0.15° about Y.", figures[k]),
        );
        let most = |of: &[f64]| format!("{:.4}", scale * largest(of.iter().copied()));
        let root = |of: &[f64]| format!("{:.4}", scale * rms(of));
        rows.push(vec![format!("{id}, {unit}"), most(a), most(b), root(a), root(b)]);
    }
    context.table(
        "maps",
        "A ball at the outer race, 0.15°, 1000 rpm",
        &["", "largest, fixed", "largest, bushing", "rms, fixed", "rms, bushing"],
        rows,
    );
    Ok(())
}
