//! Natural frequencies of rotors on springs that a book and another program print.

use bearing_dynamics::ch4_rotor::disc::Inertia;
use bearing_dynamics::members::beam::{Beam, BeamDisc, BeamSegment};
use nalgebra::Matrix4;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::single_shaft::{SingleShaft, Support};
use std::f64::consts::{PI, TAU};

pub const CASE: Case = Case {
    id: "outside_rotors",
    title: "Rotors on springs of a book and another program",
    section: "outside: Friswell et al., RAPPID",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const STEEL: f64 = 7810.0;
const RPM: f64 = PI / 30.0;

fn shaft(density: f64) -> Beam {
    let (youngs_modulus, shear_modulus) = (211e9, 81.2e9);
    Beam::new(vec![BeamSegment {
        length: 1.5,
        outer_diameter: 0.05,
        inner_diameter: 0.0,
        density,
        youngs_modulus,
        poisson_ratio: 0.5 * youngs_modulus / shear_modulus - 1.0,
    }])
}

fn disc(at: f64, diameter: f64) -> BeamDisc {
    let Inertia { mass, axial, transverse } = Inertia::of_ring(diameter, 0.05, 0.07, STEEL);
    BeamDisc { at, mass, axial, transverse }
}

/// Springs along y and z, N/m, and the coupling of y and z.
fn spring(at: f64, [y, z]: [f64; 2], coupling: f64) -> Support {
    let mut stiffness = Matrix4::from_diagonal(&[y, z, 0.0, 0.0].into());
    stiffness[(0, 1)] = coupling;
    stiffness[(1, 0)] = coupling;
    Support { at, stiffness, damping: Matrix4::zeros() }
}

/// The lowest frequencies at a speed, rad/s.
fn frequencies(rotor: &SingleShaft, speed: f64, count: usize) -> Result<Vec<f64>, CaseError> {
    let whirls = rotor.model()?.whirls(speed, count)?;
    Ok(whirls.iter().map(|whirl| whirl.frequency()).collect())
}

struct Example {
    id: &'static str,
    discs: &'static [[f64; 2]],
    ends: [f64; 2],
    stiffness: [f64; 2],
    coupling: f64,
    /// Printed frequencies at rest and at 4000 rpm.
    printed: [usize; 2],
    /// The book prints one of two equal frequencies at rest.
    once: bool,
    in_hertz: bool,
    /// The speed follows from the printed numbers.
    fit: bool,
}

const TWO_DISCS: &[[f64; 2]] = &[[0.5, 0.28], [1.0, 0.35]];
const PLAIN: Example = Example {
    id: "5_9_1",
    discs: TWO_DISCS,
    ends: [0.0, 1.5],
    stiffness: [1e6, 1e6],
    coupling: 0.0,
    printed: [5, 5],
    once: false,
    in_hertz: false,
    fit: false,
};
const EXAMPLES: [Example; 4] = [
    PLAIN,
    Example { id: "5_9_2", stiffness: [1e6, 0.8e6], ..PLAIN },
    Example { id: "5_9_4", coupling: 0.5e6, printed: [6, 0], in_hertz: true, fit: true, ..PLAIN },
    Example {
        id: "5_9_9",
        discs: &[[1.5, 0.35]],
        ends: [0.0, 1.0],
        stiffness: [1e7, 1e7],
        printed: [3, 6],
        once: true,
        ..PLAIN
    },
];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    for example in &EXAMPLES {
        let mut beam = shaft(STEEL);
        beam.discs = example.discs.iter().map(|&[at, diameter]| disc(at, diameter)).collect();
        let mut rotor = SingleShaft::new(beam);
        rotor.supports =
            example.ends.map(|at| spring(at, example.stiffness, example.coupling)).to_vec();
        for ((state, speed), count) in
            [("rest", 0.0), ("spin", 4000.0 * RPM)].into_iter().zip(example.printed)
        {
            let every = if example.once && speed == 0.0 { 2 } else { 1 };
            let found = frequencies(&rotor, speed, every * count)?;
            let (unit, scale) = if example.in_hertz { ("Hz", 1.0 / TAU) } else { ("rad/s", 1.0) };
            for (number, value) in (1..=count).zip(found.iter().step_by(every)) {
                let id = format!("{}_{state}_{number}", example.id);
                let title = format!("natural frequency {number}, {id}");
                let check = Check::new(&id, &title, unit, scale * value)
                    .published(&id)
                    .relative(1e-3, "the book's six elements are too stiff in high modes");
                context.check(match example.fit {
                    true => check.fit("the speed: all six numbers are met at rest, none of the last four at 4000 rpm"),
                    false => check,
                });
            }
        }
    }
    lumped(context)
}

/// Seven discs on a shaft that has stiffness only.
fn lumped(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut beam = shaft(1e-3);
    let end = [1.916_97, 5.9905e-4, 0.010_284];
    let between = [3.833_95, 1.1981e-3, 0.020_568];
    let wheel = [36.4237, 0.330_76, 0.198_66];
    let stations = [end, between, wheel, between, wheel, between, end];
    beam.discs = (0..)
        .zip(stations)
        .map(|(n, [mass, axial, transverse])| BeamDisc {
            at: 0.25 * f64::from(n),
            mass,
            axial,
            transverse,
        })
        .collect();
    let mut rotor = SingleShaft::new(beam);
    rotor.supports = [0.0, 1.5].map(|at| spring(at, [1e6, 0.8e6], 0.0)).to_vec();
    for (number, value) in (1..).zip(frequencies(&rotor, 500.0 * RPM, 8)?) {
        let id = format!("rappid_{number}");
        let title = format!("natural frequency {number} of a lumped rotor, 500 rpm");
        context.check(
            Check::new(&id, &title, "Hz", value / TAU)
                .published(&id)
                .relative(1e-3, "the shear coefficient of the program is not stated"),
        );
    }
    Ok(())
}
