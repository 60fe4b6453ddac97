//! What peaks owe to cage and contact damping, which the source does not have: they keep balls where the oracle's are.

use super::{CALM, RAMPS, RATTLE, course, digits};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::motion::RPM;
use crate::oracles::run_up::Peak;
use crate::rotor_run_up::{CAGE, Way, rotor, run_up};

/// Peaks of calm runs, each with its ramp, s, and unbalance, kg·m.
pub type Peaks<'p> = [((f64, &'p str), Peak)];

/// What is changed, in the scene and for a reader, and the runs in which it shows most.
struct Choice {
    id: &'static str,
    what: &'static str,
    change: (&'static str, &'static str),
    of: &'static [(usize, &'static str)],
}

const HALF: (&str, &str) = ("alpha = \"1 s/m\"", "alpha = \"0.5 s/m\"");
const TWICE: (&str, &str) = ("alpha = \"1 s/m\"", "alpha = \"2 s/m\"");
/// The cheap ramp of 0.5 s, in which no ball leans on the cage; that of 5 s, slowest of all, in which balls rattle longest under the smallest
/// unbalance and lean on the cage, or would meet without one, under the largest.
const CHOICES: [Choice; 5] = [
    Choice {
        id: "damping_half",
        what: "contact damping of 0.5 s/m",
        change: HALF,
        of: &[(1, "1e-4"), (3, "1e-4")],
    },
    Choice {
        id: "damping_twice",
        what: "contact damping of 2 s/m",
        change: TWICE,
        of: &[(1, "1e-4"), (3, "1e-4")],
    },
    Choice {
        id: "cage_half",
        what: "a cage of 10 g",
        change: ("mass = \"20 g\"", "mass = \"10 g\""),
        of: &[(3, "1e-3")],
    },
    Choice {
        id: "cage_twice",
        what: "a cage of 40 g",
        change: ("mass = \"20 g\"", "mass = \"40 g\""),
        of: &[(3, "1e-3")],
    },
    Choice {
        id: "without_cage",
        what: "no cage",
        change: (CAGE, "[bearing.left]"),
        of: &[(1, "1e-4")],
    },
];
/// Of speeds and heights.
const TOLERANCE: f64 = 2e-3;
const REASON: &str = "strikes of balls that carry nothing come at other times, which moves heights by 1.2e-3 and speeds by 0.7e-3 at most; \
                      two fifths of the tolerance of speeds against the oracle, a fifth of that of heights";

/// Each choice halved and doubled.
pub fn of_choices(context: &mut CaseContext, peaks: &Peaks) -> Result<(), CaseError> {
    for Choice { id, what, change, of } in CHOICES {
        for (which, unbalance) in of {
            let ramp = RAMPS[*which].0;
            let known = peaks.iter().find(|(of, _)| *of == (ramp, *unbalance));
            let (_, before) = known.ok_or_else(|| CaseError::message("a run that was not made"))?;
            let changes = [CALM.changes, &[change]].concat();
            let way = Way { changes: &changes, ..CALM };
            let (course, end) = course(RAMPS[*which]);
            let done = run_up(rotor(&course, unbalance, &way)?, &way, end)?;
            let top = done.top()?;
            let id = format!("{id}_{}_{}", digits(&ramp.to_string()), digits(unbalance));
            let what = format!("ramp of {ramp} s, unbalance of {unbalance} kg·m, {what}");
            for (key, of, unit, ours, before) in [
                ("speed", "speed at the peak", "rpm", top.speed / RPM, before.speed / RPM),
                ("height", "its height", "µm", 1e6 * top.height, 1e6 * before.height),
            ] {
                context.check(
                    Check::new(&format!("{id}_{key}"), &format!("{what}: {of}"), unit, ours)
                        .consistency(before, "the same run with 1 s/m and a cage of 20 g")
                        .relative(TOLERANCE, REASON)
                        .golden(RATTLE),
                );
            }
            if id.starts_with("without") {
                stay_put(context, &id, done.astray);
            }
        }
    }
    Ok(())
}

/// What a cage is to do, where none is needed for it.
fn stay_put(context: &mut CaseContext, id: &str, astray: f64) {
    let what = "the farthest that two neighbouring balls come from an eighth of the turn";
    context.check(
        Check::new(&format!("{id}_astray"), what, "rad", astray)
            .closed_form(0.0, "balls that keep their places")
            .absolute(
                1e-3,
                "half the way that a cage would leave a ball, 0.05 mm on the pitch radius of 26 mm",
            ),
    );
}
