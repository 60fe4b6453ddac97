//! Bearing and housing by explicit steps settle where both are in equilibrium.

use std::time::Instant;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::{INNER, OUTER};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::members::body::Drive;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::motion::coupling::{CoupledMotion, CouplingOptions, SolidPart};
use bearing_dynamics::motion::race_in_bore::Seat;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::condensation::CondensedBore;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::housed::HousedState;
use crate::housings::{self, BORE_RADIUS, WIDTH};
use crate::motion;
use crate::solids::name_of;

pub const CASE: Case = Case {
    id: "housing_settling",
    title: "Bearing and housing settle where both are in equilibrium",
    section: "2.2.4, 2.4.2",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Down and aside, N; the direction is none of symmetry.
const LOAD: [f64; 2] = [150.0, -200.0];
/// Part of it at the start.
const FIRST: f64 = 0.6;
/// s: the rest has come, all has died out.
const RISE: f64 = 0.3e-3;
const END: f64 = 2.5e-3;
/// 1/s and s/m: high, so that little time is enough.
const DAMPING: f64 = 4000.0;
const CONTACT_DAMPING: f64 = 3.0;
/// Coarse: the two roads share the mesh, and their difference does not depend on it.
const LINEAR: [usize; 3] = [24, 2, 2];
const QUADRATIC: [usize; 3] = [16, 1, 1];

/// Coordinates y, z of both races, m.
type Places = [[f64; 2]; 2];

struct Settled {
    still: Places,
    moving: Places,
    /// N, on the outer race.
    force: [f64; 2],
    residual: f64,
    coupling_steps: u64,
    elements: usize,
    seconds: [f64; 2],
}

fn loads(part: f64) -> [f64; 5] {
    [0.0, part * LOAD[0], part * LOAD[1], 0.0, 0.0]
}

fn equilibrium(bore: &CondensedBore, problem: &DynamicProblem) -> Result<HousedState, CaseError> {
    let held = DynamicProblem { outer: None, ..problem.clone() };
    let still = held.statics(0.0);
    Ok(housings::search(bore).solve(&still, &housings::fit(0.0), [0.0; 3])?)
}

fn places(state: &HousedState) -> Places {
    let (inner, outer) = (&state.bearing.coordinates, &state.bore.pose);
    [[inner[1], inner[2]], [outer[0], outer[1]]]
}

fn settle(letter: char, cells: [usize; 3], order: Order) -> Result<Settled, CaseError> {
    let mesh = housings::mesh(letter, order, cells)?;
    let mut model = housings::solid(&mesh)?;
    model.problem.damping = DAMPING;
    let clock = Instant::now();
    let bore = housings::condensed(&mesh, &model)?;
    let still = equilibrium(&bore, &housings::mounted(loads(1.0))?)?;
    let first = equilibrium(&bore, &housings::mounted(loads(FIRST))?)?;
    let statics = clock.elapsed().as_secs_f64();

    let mut problem = housings::mounted([0.0; 5])?;
    problem.damping = ContactDamping::HuntCrossley { alpha: CONTACT_DAMPING };
    for (axis, load) in [(1, LOAD[0]), (2, LOAD[1])] {
        let (from, to) = (FIRST * load, load);
        let rise = Profile::SmoothRamp { from, to, start: 0.0, duration: RISE };
        problem.inner.drives[axis] = Drive::Load(rise);
    }
    let [y, z, xi, lambda] = first.bore.pose;
    problem.outer_start = [0.0, y, z, xi, lambda];
    let seat = Seat {
        name: None,
        mount: Mount::at_centre(OUTER),
        solid: 0,
        radius: Profile::Constant(BORE_RADIUS),
        width: WIDTH,
        penalty: Penalty::default(),
        friction: None,
        nodes: housings::bore_nodes(&mesh)?,
        reach: f64::INFINITY,
    };
    let options =
        CouplingOptions { solid_fraction: 0.9, seat_phase: 0.5, bearing: motion::fixed_step(2e-6) };
    let displacement = bore.displacement(&first.bore.loads);
    let elements = model.problem.elements.len();
    let clock = Instant::now();
    let mut housed = CoupledMotion::new(
        problem,
        vec![SolidPart::displaced(None, model, displacement)],
        vec![seat],
        &options,
    )?;
    while housed.time() < END {
        housed.advance()?;
    }
    let snapshot = housed.snapshot()?;
    let force = snapshot.solids[0].seats[0].contact.force;
    let inner = housed.simulation.body(INNER).position;
    let outer = housed.simulation.body(OUTER).position;
    Ok(Settled {
        still: places(&still),
        moving: [[inner[1], inner[2]], [outer[1], outer[2]]],
        force: [force[1], force[2]],
        residual: snapshot.residual.abs() / snapshot.turned_over,
        coupling_steps: housed.exchanges,
        elements,
        seconds: [statics, clock.elapsed().as_secs_f64()],
    })
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let (name, text, default) = motion::RACE_INERTIA;
    context.assumption(name, text, default);
    housings::assumptions(context);
    context.assumption(
        "damping",
        "Damping of the housing and of the ball contacts is raised so that all motion dies out within 2 ms; it does not move \
         the place of rest.",
        "4000 1/s, Hunt–Crossley 3 s/m",
    );
    let mut rows = Vec::new();
    let length = LOAD[0].hypot(LOAD[1]);
    for letter in ['A', 'B', 'C'] {
        for (order, cells) in [(Order::Linear, LINEAR), (Order::Quadratic, QUADRATIC)] {
            let settled = settle(letter, cells, order)?;
            let tag = format!("{}_{}", letter.to_ascii_lowercase(), name_of(order));
            let off = |race: usize| {
                let [ours, theirs] = [settled.moving[race], settled.still[race]];
                (ours[0] - theirs[0]).hypot(ours[1] - theirs[1]) / theirs[0].hypot(theirs[1])
            };
            let races = ["inner", "outer"];
            for (race, name) in races.into_iter().enumerate() {
                context.check(
                    Check::new(
                        &format!("{name}_{tag}"),
                        &format!(
                            "{name} race off its place of rest, over its way, housing {letter}, {}",
                            name_of(order)
                        ),
                        "1",
                        off(race),
                    )
                    .consistency(0.0, "explicit steps, settled, against our own equilibrium of bearing and condensed housing")
                    .absolute(
                        if letter == 'C' && order == Order::Quadratic { 5e-3 } else { 1e-3 },
                        "residual motion after 2 ms: 1e-3 in ten-node housing C, the softest, 1e-4 in the others",
                    ),
                );
            }
            let force = (settled.force[0] + LOAD[0]).hypot(settled.force[1] + LOAD[1]) / length;
            context.check(
                Check::new(
                    &format!("force_{tag}"),
                    &format!(
                        "force of the bore less the load, over the load, housing {letter}, {}",
                        name_of(order)
                    ),
                    "1",
                    force,
                )
                .closed_form(0.0, "balance of the outer race")
                .absolute(1e-3, "residual motion after 2 ms, 1e-4 to 2e-4"),
            );
            context.check(
                Check::new(
                    &format!("energy_{tag}"),
                    &format!("energy unaccounted for, over all that was turned over, housing {letter}, {}", name_of(order)),
                    "1",
                    settled.residual,
                )
                .closed_form(0.0, "the ledger of both together closes")
                .absolute(5e-10, "of second order in the coupling_step, and damping took most of the work, so that it is 5e-11; ten times that"),
            );
            context.work(
                &format!("windows, housing {letter}, {}", name_of(order)),
                settled.coupling_steps,
            );
            rows.push(vec![
                letter.to_string(),
                name_of(order).into(),
                settled.elements.to_string(),
                format!("{:.2}", 1e9 * settled.still[1][0].hypot(settled.still[1][1])),
                format!("{:.1e}", off(1)),
                format!("{:.2}", 1e9 * settled.still[0][0].hypot(settled.still[0][1])),
                format!("{:.1e}", off(0)),
                format!("{force:.1e}"),
                format!("{:.1e}", settled.residual),
                format!("{:.2} / {:.2}", settled.seconds[0], settled.seconds[1]),
            ]);
        }
    }
    let columns = [
        "housing",
        "element",
        "elements",
        "outer race's way, nm",
        "off",
        "inner race's way, nm",
        "off",
        "force off",
        "energy off",
        "seconds, equilibrium / explicit",
    ];
    context.table("settled", "Where bearing and housing settle under 250 N", &columns, rows);
    Ok(())
}
