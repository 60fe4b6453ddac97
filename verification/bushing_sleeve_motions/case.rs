//! Bushings against four motions of the inner sleeve: across, along and about the axis, and tilting.

use std::f64::consts::{PI, TAU};

use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::mesh::generate::{Bushing, Part};
use bearing_dynamics::solids::rubber::sleeve::{SleeveMotion, sleeve_stiffness};

use crate::bushings::{
    BEARING_ON_BUSHING, BULK_RATIO, BUSHING, BUSHING_3_3, MODULUS, complex_shear, quarter, rubber,
    section, shear_over_modulus,
};
use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::changed_scene;
use crate::oracles::bonded_bushing::{Motion, stiffness};

pub const CASE: Case = Case {
    id: "bushing_sleeve_motions",
    title: "Bushings against four motions of a sleeve",
    section: "3.3.1, 3.4.1 and 3.4.5, (3.13), (3.14)",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

const FREQUENCY: f64 = 10.0;
const DEGREE: usize = 5;

const MOTIONS: [(SleeveMotion, Motion, &str, &str); 4] = [
    (SleeveMotion::Radial, Motion::Radial, "radial", "N/m"),
    (SleeveMotion::Axial, Motion::Axial, "axial", "N/m"),
    (SleeveMotion::Torsional, Motion::Torsional, "torsional", "N·m/rad"),
    (SleeveMotion::Conical, Motion::Conical, "conical", "N·m/rad"),
];

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let bodies = [("3_4_1", BUSHING, [16, 6, 4], 2.0), ("3_3", BUSHING_3_3, [16, 6, 5], 1.8)];
    let mut rows = Vec::new();
    for (key, body, cells, grading) in bodies {
        let mesh = quarter(&body, cells, grading)?;
        let material = rubber(MODULUS, 1.0, ChainPull::FiveTerms)?;
        for (motion, of, name, unit) in MOTIONS {
            let pulsations = [0.0, TAU * FREQUENCY];
            let found = sleeve_stiffness(
                &mesh,
                Part::Quarter,
                material.clone(),
                motion,
                &pulsations,
                1e-6,
            )?;
            let exact = [(0.0, 0.0), (1.0, FREQUENCY)].map(|(gammas, frequency)| {
                let shear = complex_shear(gammas, frequency);
                stiffness(section(&body), of, shear, BULK_RATIO * MODULUS, DEGREE, 3)
            });
            let gap = |k: usize| {
                let (a, b) = (found[k].storage - exact[k].re, found[k].loss - exact[k].im);
                (a * a + b * b).sqrt() / exact[k].norm()
            };
            rows.push(vec![
                key.replace('_', "."),
                format!("{name}, {unit}"),
                format!("{:.5e}", found[0].storage),
                format!("{:.5e}", exact[0].re),
                format!("{:.2}", 100.0 * gap(0)),
                format!("{:.2}", 100.0 * gap(1)),
            ]);
            context.check(
                Check::new(
                    &format!("{name}_{key}"),
                    &format!("relaxed {name} stiffness, bushing of {}", key.replace('_', ".")),
                    unit,
                    found[0].storage,
                )
                .independent(exact[0].re, "one Fourier component, polynomials of degree 5")
                .relative(5e-3, "what these meshes leave, up to 0.4 %")
                .golden(GoldenTolerance::MIXED),
            );
            context.check(
                Check::new(&format!("{name}_{key}_10"), &format!("{name} stiffness at 10 Hz, distance in the complex plane over its magnitude, bushing of {}", key.replace('_', ".")), "1", gap(1))
                    .independent(0.0, "one Fourier component, polynomials of degree 5, a complex modulus")
                    .absolute(0.013, "what these meshes leave: 1.2 % of the long bushing that tilts, half a per cent of the others"),
            );
            if motion == SleeveMotion::Torsional {
                twisted(context, key, &body, found[0].storage);
            }
        }
    }
    context.table(
        "motions",
        "Relaxed stiffness, and how far it and that at 10 Hz are from the oracle's",
        &["bushing", "motion", "ours", "oracle", "relaxed, %", "10 Hz, %"],
        rows,
    );
    usual_meshes(context)?;
    long(context)
}

/// Diameters and lengths of bushings in mm, from a sleeve thin as a sheet to a flat disc.
const PROPORTIONS: [[f64; 3]; 6] = [
    [30.0, 34.0, 60.0],
    [60.0, 70.0, 80.0],
    [30.0, 38.0, 40.0],
    [20.0, 60.0, 20.0],
    [20.0, 60.0, 10.0],
    [20.0, 100.0, 10.0],
];

/// What a scene that gives no cells computes with, from thin sleeves to flat discs.
fn usual_meshes(context: &mut CaseContext) -> Result<(), CaseError> {
    let (mut rows, mut worst) = (Vec::new(), 0.0f64);
    for [inner, outer, length] in PROPORTIONS {
        let sizes = format!(
            "inner_diameter = \"{inner} mm\"\nouter_diameter = \"{outer} mm\"\nlength = \"{length} mm\"\ntable"
        );
        let shipped =
            "inner_diameter = \"71 mm\"\nouter_diameter = \"91 mm\"\nlength = \"20 mm\"\ntable";
        // On a body of its own: inside the race of the shipped scene there is no room for these sleeves.
        let hub = "[body.hub]\nspeed = \"0 rpm\"\n\
                   inertia = { mass = \"1 kg\", axial = \"1e-3 kg m^2\", transverse = \"1e-3 kg m^2\" }\n\n[traction]";
        let kind = "kind = \"deep-groove\"";
        let own_race = format!("{kind}\ninner_on = \"inner_race\"");
        let on_hub = [
            (shipped, &sizes[..]),
            ("to = \"outer_race\"", "to = \"hub\""),
            ("[traction]", hub),
            (kind, &own_race[..]),
        ];
        let scene = changed_scene(BEARING_ON_BUSHING, &on_hub)?;
        let [spring] = &scene.springs[..] else { return Err(CaseError::message("one spring")) };
        let ours = [1, 0, 3, 4].map(|i| spring.stiffness[i]);
        let thickness = 0.5e-3 * (outer - inner);
        let body = Bushing { inner_diameter: 1e-3 * inner, thickness, length: 1e-3 * length };
        for (own, (_, of, name, unit)) in ours.into_iter().zip(MOTIONS) {
            let shear = complex_shear(0.0, 0.0);
            let exact = stiffness(section(&body), of, shear, BULK_RATIO * MODULUS, DEGREE, 3).re;
            let gap = (own / exact - 1.0).abs();
            worst = if gap <= worst || worst.is_nan() { worst } else { gap };
            rows.push(vec![
                format!("{inner}/{outer} × {length} mm"),
                format!("{name}, {unit}"),
                format!("{own:.4e}"),
                format!("{exact:.4e}"),
                format!("{:.2}", 100.0 * gap),
            ]);
        }
    }
    context.check(
        Check::new(
            "usual_meshes",
            "relaxed stiffnesses of scenes that give no cells, largest distance",
            "1",
            worst,
        )
        .independent(0.0, "one Fourier component, polynomials of degree 5")
        .absolute(0.015, "what some three hundred cells leave, from thin sleeves to flat discs"),
    );
    context.table(
        "usual_cells",
        "Relaxed stiffness of scenes that give no cells, from thin sleeves to flat discs",
        &["bushing", "motion", "ours", "oracle", "distance, %"],
        rows,
    );
    Ok(())
}

/// Torsion shears alone, so that its closed form holds at any length.
fn twisted(context: &mut CaseContext, key: &str, body: &Bushing, ours: f64) {
    let a = 0.5 * body.inner_diameter;
    let b = a + body.thickness;
    let mu = shear_over_modulus() * MODULUS;
    let exact = 4.0 * PI * mu * body.length / (1.0 / (a * a) - 1.0 / (b * b));
    context.check(
        Check::new(
            &format!("torsion_{key}"),
            &format!("relaxed torsional stiffness, bushing of {}", key.replace('_', ".")),
            "N·m/rad",
            ours,
        )
        .closed_form(exact, "4πμL/(1/a² − 1/b²)")
        .relative(1e-3, "what the mesh leaves of a shear that falls with r²"),
    );
}

/// Two long bushings, so that the ends drop out, nearly without change of volume.
fn long(context: &mut CaseContext) -> Result<(), CaseError> {
    let (a, b) = (0.02f64, 0.04f64);
    let mut material = rubber(MODULUS, 0.0, ChainPull::FiveTerms)?;
    material.network.bulk = 1e4 * MODULUS;
    let mu = shear_over_modulus() * MODULUS;
    let squares = a * a + b * b;
    let forms = [
        (SleeveMotion::Axial, "axial_long", "2πμ/ln(b/a)", 2.0 * PI / (b / a).ln()),
        (
            SleeveMotion::Radial,
            "radial_long",
            "plane strain, 4πμ(a² + b²)/[(a² + b²) ln(b/a) − (b² − a²)]",
            4.0 * PI * squares / (squares * (b / a).ln() - (b * b - a * a)),
        ),
    ];
    for (motion, id, origin, exact) in forms {
        let of = |length: f64| {
            let mesh = quarter(&Bushing { length, ..BUSHING }, [14, 6, 8], 1.6)?;
            let found =
                sleeve_stiffness(&mesh, Part::Quarter, material.clone(), motion, &[0.0], 1e-6)?;
            Ok::<f64, CaseError>(found[0].storage)
        };
        let per_length = (of(0.48)? - of(0.4)?) / 0.08;
        context.check(
            Check::new(id, "stiffness per length of long bushings over μ", "1", per_length / mu)
                .closed_form(exact, origin)
                .relative(5e-3, "one mesh stretched to both lengths"),
        );
    }
    Ok(())
}
