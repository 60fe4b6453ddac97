//! The steady critical speed of 4.3.4's rotor, and what a run-up does to it.

use crate::single_shaft::{Fixed, SingleShaft, Unbalance, peak};
use bearing_dynamics::members::beam::{Beam, BeamDisc, BeamSegment};
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::vibrations::rotor::RotorModel;
use std::f64::consts::PI;

use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::whirling_shaft::{End, Length, Part, left, root, run_up};

pub const CASE: Case = Case {
    id: "critical_speed_4_3_4",
    title: "First critical speed of the rotor with a disk",
    section: "4.3.4, Table 4.1",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const LENGTH: f64 = 0.4;
const DIAMETER: f64 = 0.03;
/// kg, 4.3.4.
const DISC: f64 = 20.0;
/// 1/s, Table 4.1.
const DAMPING: f64 = 100.0;
/// kg·m, the largest of 4.3.4.
const UNBALANCE: f64 = 1e-3;
/// rad/s for one rpm.
const RPM: f64 = PI / 30.0;
/// rad/s, where 4.3.4 ends.
const END: f64 = 10_000.0 * RPM;
/// s, chosen to meet the published speed.
const RAMP: f64 = 0.169;

fn model(damping: f64) -> Result<RotorModel, CaseError> {
    let mut beam = Beam::new(vec![BeamSegment {
        length: LENGTH,
        outer_diameter: DIAMETER,
        inner_diameter: 0.0,
        density: 7850.0,
        youngs_modulus: 210e9,
        poisson_ratio: 0.3,
    }]);
    // A mass spread over a section has inertias too; the source gives the disk no dimensions.
    let at = 0.5 * LENGTH;
    beam.discs.push(BeamDisc { at, mass: DISC, axial: 0.0, transverse: 0.0 });
    let mut rotor = SingleShaft::new(beam);
    rotor.fixed = vec![Fixed::pin(0.0), Fixed::pin(LENGTH)];
    rotor.mass_damping = damping;
    Ok(rotor.model()?)
}

/// The oracle's critical speed with a disc of that mass, rad/s.
fn transfer(mass: f64, near: f64) -> f64 {
    let half = Part::Length(Length::steel(0.5 * LENGTH, DIAMETER));
    let parts = [half, Part::Disc { mass, axial: 0.0, transverse: 0.0 }, half];
    root(|speed| left(&parts, [End::Pinned; 2], speed, speed), near)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    context.assumption(
        "pins",
        "Bearings on pins: no displacement and no resistance to tilting at the rotor's ends.",
        "pinned at 0 and 400 mm",
    );
    context.assumption(
        "ramp_time",
        "The source does not say how long the run-up takes. This one was chosen to meet its 6457 rpm.",
        "0.169 s to 10 000 rpm",
    );
    let still = model(0.0)?;
    let criticals = still.critical_speeds()?;
    let forward = criticals.iter().find(|critical| critical.whirl.is_forward());
    let critical = forward.ok_or_else(|| CaseError::message("no forward critical speed"))?.speed;
    let oracle = transfer(DISC, critical);
    let ours = critical / RPM;
    context.check(
        Check::new("critical_independent", "first critical speed, pinned", "rpm", ours)
            .independent(oracle / RPM, "transfer matrices of Timoshenko's equations")
            .relative(1e-6, "errors of the elements, of the eighth order of their length")
            .golden(GoldenTolerance::REORDERED),
    );

    // The motion's modal mass from how its frequency answers to the disc's.
    let slope =
        (transfer(DISC + 0.01, oracle).powi(2) - transfer(DISC - 0.01, oracle).powi(2)) / 0.02;
    let modal_mass = -oracle * oracle / slope;
    let offset = UNBALANCE / modal_mass;
    let damped = model(DAMPING)?;
    let station = damped.station(0.5 * LENGTH).ok_or_else(|| CaseError::message("no station"))?;
    let unbalance = Unbalance { at: 0.5 * LENGTH, moment: UNBALANCE, angle: 0.0 };
    let [speed, height] = peak(&damped, &[unbalance], station, [0.8 * critical, 1.2 * critical]);
    // The peak of e Ω²/|ω² − Ω² + iαΩ|.
    let ratio = DAMPING / oracle;
    let peak = oracle / (1.0 - 0.5 * ratio * ratio).sqrt();
    context.check(
        Check::new(
            "steady_peak",
            "speed of the largest steady deflection, damping 100 1/s",
            "rpm",
            speed / RPM,
        )
        .independent(peak / RPM, "one motion of the transfer matrices")
        .relative(1e-4, "motions above the first are left out of the one"),
    );
    let largest = offset * peak * peak / (oracle * oracle - peak * peak).hypot(DAMPING * peak);
    context.check(
        Check::new("steady_height", "largest steady deflection, 1e-3 kg·m", "um", height * 1e6)
            .independent(largest * 1e6, "one motion of the transfer matrices")
            .relative(5e-3, "motions above the first are left out of the one"),
    );

    let mut rows = Vec::new();
    let mut curve = Vec::new();
    for time in [0.1, 0.15, RAMP, 0.2, 0.3, 0.5, 1.0, 2.0, 5.0] {
        let [at, height] = run_up(oracle, DAMPING, offset, END, time);
        rows.push(vec![
            format!("{time}"),
            format!("{:.1}", at / RPM),
            format!("{:.2}", height * 1e6),
        ]);
        curve.push([time, at / RPM]);
    }
    let columns =
        ["run-up to 10 000 rpm, s", "largest deflection at, rpm", "largest deflection, um"];
    context.table("run_up", "One motion run up, 1e-3 kg·m, by the oracle", &columns, rows);
    let [at, _] = run_up(oracle, DAMPING, offset, END, RAMP);
    context.check(
        Check::new(
            "run_up_peak",
            "speed of the largest deflection in a run-up of 0.169 s, by the oracle",
            "rpm",
            at / RPM,
        )
        .published("critical_speed")
        .under("ramp_time")
        .fit("the ramp time was chosen so that the run-up of one pinned motion meets this number")
        .relative(0.005, "one mode on pins represents the rotor on its bearings"),
    );
    context.check(
        Check::new("critical", "first critical speed, pinned", "rpm", ours)
            .published("critical_speed")
            .under("pins")
            .relative(0.005, "tolerance of an agreement")
            .explained(Explanation::new(
                "The speed at which the deflection is largest while the rotor is run up, not the steady critical speed, which an \
                 independent method puts where ours is. Run up to 10 000 rpm in 0.169 s, a time that the source does not state and that \
                 is chosen here, one motion of the stated rotor has its largest deflection at this speed; slower ones have it lower, down to \
                 the critical speed.",
                -0.1988,
                0.001,
                &["critical_independent", "run_up_peak", "run_up"],
            )),
    );
    let svg = xy(&XyPlot {
        title: "Where the deflection is largest, over the time of the run-up".into(),
        x: Axis::linear("run-up to 10 000 rpm", "s"),
        y: Axis::linear("speed of the largest deflection", "rpm"),
        style: Style::LinesAndMarkers,
        curves: vec![
            Curve::new("one motion on pins", curve),
            Curve::new("steady critical speed", vec![[0.1, ours], [5.0, ours]]),
        ],
    })?;
    context.figure(
        "run_up_over_time",
        svg,
        "The faster the run-up, the later the largest deflection.",
    );
    Ok(())
}
