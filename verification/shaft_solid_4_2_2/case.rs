//! The source's shaft of tetrahedra: whole against beam theory, reduced to stations against whole.

mod full;

use crate::single_shaft::{Fixed, SingleShaft};
use bearing_dynamics::members::beam::{Beam, BeamDisc, BeamSegment};
use bearing_dynamics::members::condensed_shaft::matrices;
use bearing_dynamics::members::meshed_shaft::ShaftMesh;
use bearing_dynamics::members::shaft_modes::{AttachedStation, BendingPlane, ShaftShapes};
use bearing_dynamics::mesh::generate::shaft;
use bearing_dynamics::mesh::{Order, TetMesh};
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::whirling_shaft::{End, Length, Part, left, root};
use crate::solids::{STEEL, free_body, mesh_of, name_of, size_of};

pub const CASE: Case = Case {
    id: "shaft_solid_4_2_2",
    title: "A flexible shaft of tetrahedra: full, reduced and as a beam",
    section: "2.2.2, 4.2.2, 4.2.3, Table 4.1",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const LENGTH: f64 = 0.4;
const DIAMETER: f64 = 0.03;
/// kg, kg·m² about the axis and a diameter: as in `shaft_beam`.
const DISC: [f64; 3] = [5.0, 0.025, 0.0135];
const SPIN: f64 = 2000.0;
/// Stations along the shaft and one more.
const INTERVALS: usize = 32;

/// Cells around, along the radius outside the core, and along the shaft.
#[derive(Clone, Copy)]
struct Cells {
    order: Order,
    around: usize,
    radial: usize,
    along: usize,
}

/// Ten-node elements as scenes have them unless told otherwise.
const USUAL: Cells = Cells { order: Order::Quadratic, around: 16, radial: 1, along: INTERVALS };
/// 3.33 mm along the axis, six cells (2.5 mm) along the radius.
const SOURCE: Cells = Cells { order: Order::Linear, around: 32, radial: 2, along: 120 };

impl Cells {
    fn mesh(&self) -> Result<TetMesh, CaseError> {
        let longest = LENGTH / self.along as f64 * 1.000_001;
        let stations = [0.0, 0.5 * LENGTH, LENGTH];
        let solid = shaft(0.5 * DIAMETER, &stations, longest, self.around, self.radial)?;
        Ok(mesh_of(&solid, self.order)?)
    }

    fn finer(&self, times: usize) -> Cells {
        let Cells { order, around, radial, along } = *self;
        Cells { order, around: around * times, radial: radial * times, along: along * times }
    }
}

/// Beam theory with the shear coefficient that fits three-dimensional vibrations (Hutchinson 2001).
fn length() -> Length {
    let area = FRAC_PI_4 * DIAMETER * DIAMETER;
    let moment = area * DIAMETER * DIAMETER / 16.0;
    let shear = STEEL.young / (2.0 + 2.0 * STEEL.poisson);
    Length {
        length: LENGTH,
        bending: STEEL.young * moment,
        shear: kappa() * shear * area,
        line_mass: STEEL.density * area,
        line_inertia: STEEL.density * moment,
    }
}

fn kappa() -> f64 {
    let nu = STEEL.poisson;
    6.0 * (1.0 + nu) * (1.0 + nu) / (7.0 + 12.0 * nu + 4.0 * nu * nu)
}

/// Timoshenko's sag of a beam on two supports under 1 N in the middle, m.
fn sag_of_theory() -> f64 {
    let Length { length, bending, shear, .. } = length();
    length.powi(3) / (48.0 * bending) + length / (4.0 * shear)
}

/// The oracle's frequency (rad/s) nearest to one of ours.
fn theory(parts: &[Part], ends: [End; 2], spin: f64, near: f64) -> f64 {
    root(|omega| left(parts, ends, spin, omega), near)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let whole = free(context)?;
    bending(context)?;
    reduced(context, &whole)?;
    spinning(context)
}

fn percent(value: f64) -> String {
    format!("{:+.4}", 100.0 * value)
}

/// Frequencies of the free shaft, whole, Hz.
fn free(context: &mut CaseContext) -> Result<Vec<f64>, CaseError> {
    let mesh = USUAL.mesh()?;
    let (found, apart) = full::free_bending(&mesh, 3)?;
    let mut row = vec![name_of(USUAL.order).into(), size_of(&mesh)];
    for (index, ours) in found.iter().enumerate() {
        let parts = [Part::Length(length())];
        let theirs = theory(&parts, [End::Free; 2], 0.0, TAU * ours) / TAU;
        row.push(format!("{ours:.2} ({} %)", percent(ours / theirs - 1.0)));
        let what = format!("free shaft, tet10, {}: bending mode {}", size_of(&mesh), index + 1);
        context.check(
            Check::new(&format!("free_{}", index + 1), &what, "Hz", *ours)
                .independent(theirs, "transfer matrices of Timoshenko's equations")
                .relative(
                    3e-3,
                    "asked for; beam equations leave the fourth order of diameter over wave length",
                )
                .golden(GoldenTolerance::MIXED),
        );
    }
    row.push(format!("{apart:.1e}"));
    let pairs =
        Check::new("pairs", "free shaft, tet10: largest distance within a pair", "1", apart);
    context.check(
        pairs
            .closed_form(0.0, "a body of revolution")
            .absolute(1e-4, "tetrahedra do not lie around the axis as the body does"),
    );
    let columns = ["element", "mesh", "mode 1, Hz", "mode 2, Hz", "mode 3, Hz", "pairs apart"];
    context.table(
        "free",
        "Free shaft, whole solid; in brackets off beam theory",
        &columns,
        vec![row],
    );
    Ok(found)
}

/// Sag of the whole solid between two supports, and how it converges.
fn bending(context: &mut CaseContext) -> Result<(), CaseError> {
    let exact = sag_of_theory();
    let mut rows = Vec::new();
    for (order, coarse, wanted, room) in [
        (Order::Quadratic, Cells { around: 8, along: 10, ..USUAL }, 4.0, 1.0),
        (Order::Linear, Cells { order: Order::Linear, around: 8, radial: 1, along: 20 }, 2.0, 0.4),
    ] {
        let mut sags = Vec::new();
        for times in 1..=3 {
            let mesh = coarse.finer(times).mesh()?;
            let sag = full::sag(&mesh)?;
            let stiff = exact / sag - 1.0;
            rows.push(vec![
                name_of(order).into(),
                size_of(&mesh),
                format!("{:.6e}", sag),
                percent(stiff),
            ]);
            sags.push(sag);
        }
        // (k₁ − k₂)/(k₂ − k₃) of stiffnesses with an error C hᵖ and cells of 1, 1/2 and 1/3.
        let [k1, k2, k3] = [0, 1, 2].map(|i: usize| 1.0 / sags[i]);
        let ratio = (k1 - k2) / (k2 - k3);
        let of = |p: f64| (1.0 - 0.5f64.powf(p)) / (0.5f64.powf(p) - (1.0 / 3.0f64).powf(p));
        let (mut low, mut high) = (0.1, 12.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if of(middle) < ratio { low = middle } else { high = middle }
        }
        let order_found = if ratio.is_finite() { 0.5 * (low + high) } else { f64::NAN };
        let name = name_of(order);
        context.check(
            Check::new(
                &format!("order_{name}"),
                &format!("order of the stiffness's error, {name}"),
                "1",
                order_found,
            )
            .closed_form(
                wanted,
                "twice the degree of the shape functions: work of the load converges as energy does",
            )
            .absolute(room, "three meshes; curved edges converge as well as the interpolation"),
        );
        if order == Order::Quadratic {
            context.check(
                Check::new("sag_tet10", "sag of the finest tet10 mesh under 1 N", "m", sags[2])
                    .closed_form(exact, "Timoshenko's beam with Hutchinson's shear coefficient")
                    .relative(3e-3, "required; loads spread evenly over sections differ from beam theory by 1e-4")
                    .golden(GoldenTolerance::MIXED),
            );
        }
    }
    let mesh = SOURCE.mesh()?;
    let sag = full::sag(&mesh)?;
    let stiff = exact / sag - 1.0;
    rows.push(vec![
        "tet4, 3.3 × 2.5 mm".into(),
        size_of(&mesh),
        format!("{sag:.6e}"),
        percent(stiff),
    ]);
    context.check(
        Check::new("tet4_as_the_source", "tet4, 3.33 mm along the axis × 2.5 mm along the radius: stiffness over beam theory, less 1", "1", stiff)
            .closed_form(0.05, "the source's rotor, by its bearings' moments (shaft some 5 % too stiff)")
            .absolute(0.01, "asked for: 4 to 6 %")
            .golden(GoldenTolerance::MIXED),
    );
    let columns = ["element", "mesh", "sag, m/N", "stiffness off theory, %"];
    context.table("sag", "Whole solid on two supports, load in the middle", &columns, rows);
    Ok(())
}

/// Frequencies (Hz) of shapes of a free shaft between pins at both ends.
fn between_pins(shapes: &ShaftShapes, plane: &BendingPlane) -> Vec<f64> {
    let rigid = plane.rigid_part();
    let (count, size) = (shapes.count(), shapes.count() + 2);
    let ends = [0, shapes.stations.len() - 1];
    let hold = DMatrix::from_fn(2, size, |end, k| match k {
        0 => 1.0,
        1 => shapes.stations[ends[end]],
        _ => shapes.deflection[ends[end] * count + k - 2],
    });
    let root_mass =
        |k: usize| [rigid.mass.sqrt(), rigid.transverse.sqrt()].get(k).copied().unwrap_or(1.0);
    // Coordinates of unit mass; what the pins leave of them.
    let hold = DMatrix::from_fn(2, size, |end, k| hold[(end, k)] / root_mass(k));
    let gram = (&hold * hold.transpose()).try_inverse().unwrap_or_else(|| DMatrix::zeros(2, 2));
    let free = DMatrix::identity(size, size) - hold.transpose() * gram * &hold;
    let springs = DMatrix::from_fn(size, size, |i, j| match i {
        _ if i != j || i < 2 => 0.0,
        _ => shapes.frequencies[i - 2] * shapes.frequencies[i - 2],
    });
    let left = &free * springs * &free;
    let eigen = SymmetricEigen::new((&left + left.transpose()) * 0.5);
    let mut all: Vec<f64> = eigen.eigenvalues.iter().map(|w2| w2.max(0.0).sqrt() / TAU).collect();
    all.sort_by(f64::total_cmp);
    // Two of them are the pins themselves.
    all.split_off(2)
}

/// Reduced against whole up to 2 kHz: free, and between pins by ever more natural shapes.
fn reduced(context: &mut CaseContext, whole: &[f64]) -> Result<(), CaseError> {
    let mesh = USUAL.mesh()?;
    let over = |intervals: usize| -> Result<BendingPlane, CaseError> {
        let at = |i: usize| LENGTH * i as f64 / intervals as f64;
        let stations = (0..=intervals).map(at).collect();
        Ok(BendingPlane::from(&matrices(&mesh, &free_body(&mesh, STEEL), stations)?))
    };
    let plane = over(INTERVALS)?;

    let found = plane.shapes(f64::INFINITY, usize::MAX, &[])?.hertz();
    for (index, (ours, theirs)) in found.iter().zip(whole).take(2).enumerate() {
        let what = format!("free shaft over {INTERVALS} intervals: bending mode {}", index + 1);
        context.check(
            Check::new(&format!("reduced_free_{}", index + 1), &what, "Hz", *ours)
                .consistency(*theirs, "the full solid by Lanczos' method")
                .relative(1e-3, "asked for up to 2 kHz")
                .golden(GoldenTolerance::MIXED),
        );
    }

    let whole = full::pinned(&mesh, 2000.0)?;
    context.check(
        Check::new(
            "pinned_count",
            "modes of the full solid between pins below 2 kHz, both directions",
            "1",
            whole.len() as f64,
        )
        .closed_form(4.0, "n² × 383 Hz of the pinned beam, less shear, either way")
        .absolute(0.0, "a count"),
    );
    let whole: Vec<f64> = whole.chunks_exact(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let worst = |plane: &BendingPlane, natural: usize, held: bool| -> Result<f64, CaseError> {
        let pins =
            [0, plane.stations.len() - 1].map(|station| AttachedStation { station, turns: false });
        let holds: &[AttachedStation] = if held { &pins } else { &[] };
        let shapes = plane.shapes(f64::INFINITY, natural, holds)?;
        let found = between_pins(&shapes, plane);
        let off = whole.iter().enumerate().map(|(i, f)| match found.get(i) {
            Some(ours) => (ours / f - 1.0).abs(),
            None => f64::INFINITY,
        });
        Ok(crate::solids::largest(off))
    };
    let mut rows = Vec::new();
    let (mut with, mut without) = (Vec::new(), Vec::new());
    for natural in [0, 2, 4, 6, 8, 12] {
        with.push(worst(&plane, natural, true)?);
        without.push(worst(&plane, natural, false)?);
        let [with, without] = [&with, &without].map(|of| format!("{:.1e}", of[of.len() - 1]));
        rows.push(vec![natural.to_string(), with, without]);
    }
    let columns = ["natural shapes", "largest error, with static answers", "without"];
    let title = format!(
        "Shaft between pins, modes below 2 kHz ({}), against the whole solid",
        whole.iter().map(|f| format!("{f:.2} Hz")).collect::<Vec<_>>().join(", ")
    );
    context.table("pinned", &title, &columns, rows);
    context.check(
        Check::new(
            "reduced_pinned",
            "between pins, component modes to 5 kHz (3) and static correction modes: largest error below 2 kHz",
            "1",
            worst(&plane, 3, true)?,
        )
        .consistency(0.0, "the full solid by subspace iteration, the same sections fixed")
        .absolute(1e-3, "asked for up to 2 kHz"),
    );
    let falls = |of: &[f64]| of.windows(2).map(|pair| pair[1] / pair[0]).fold(0.0, f64::max);
    context.check(
        Check::new(
            "falls_with_shapes",
            "between pins, without static correction modes: largest ratio of errors of 4, 6, 8 and 12 component modes to the previous ones",
            "1",
            falls(&without[1..]),
        )
        .consistency(1.0, "errors that fall")
        .at_most(0.3, "truncation error falls as a power of the number of terms, by two more of n modes"),
    );
    context.check(
        Check::new(
            "falls_with_static_answers",
            "between pins, with static correction modes: error of two component modes over that of none",
            "1",
            with[1] / with[0],
        )
        .consistency(1.0, "an error that falls")
        .at_most(0.9, "static answers leave the square of a frequency over the first one left out"),
    );

    let mut rows = Vec::new();
    let mut errors = Vec::new();
    for intervals in [8, 16, INTERVALS] {
        let error = worst(&over(intervals)?, usize::MAX, false)?;
        rows.push(vec![intervals.to_string(), format!("{error:.1e}")]);
        errors.push(error);
    }
    let order = (errors[1] / errors[2]).log2();
    context.check(
        Check::new("order_stations", "order of that error, 16 to 32 intervals", "1", order)
            .closed_form(
                2.0,
                "modes of least strain energy have a constant shear force from station to station",
            )
            .absolute(0.3, "the mesh of one layer to an interval moves little with the stations"),
    );
    let columns = ["intervals", "largest error of all shapes"];
    context.table("stations", "Condensation alone: as many stations", &columns, rows);
    context.check(
        Check::new(
            "stations_suffice",
            "between pins, all modes over 16 intervals: largest error below 2 kHz",
            "1",
            errors[1],
        )
        .consistency(0.0, "the full solid")
        .absolute(1e-3, "asked for up to 2 kHz; scenes have 32 intervals or more"),
    );
    Ok(())
}

/// Gyroscopic splitting of an overhung disc, tetrahedra against transfer matrices.
fn spinning(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut beam = Beam::new(vec![BeamSegment {
        length: LENGTH,
        outer_diameter: DIAMETER,
        inner_diameter: 0.0,
        density: STEEL.density,
        youngs_modulus: STEEL.young,
        poisson_ratio: STEEL.poisson,
    }]);
    let Cells { order, around, radial, .. } = USUAL;
    beam.mesh = Some(ShaftMesh { order, longest_layer: f64::INFINITY, around, radial });
    let [mass, axial, transverse] = DISC;
    beam.discs = vec![BeamDisc { at: LENGTH, mass, axial, transverse }];
    let mut rotor = SingleShaft::new(beam);
    rotor.fixed.push(Fixed::clamp(0.0));
    let model = rotor.model()?;
    let parts = [Part::Length(length()), Part::Disc { mass, axial, transverse }];
    let mut rows = Vec::new();
    let mut first = Vec::new();
    for spin in [0.0, SPIN] {
        for (index, whirl) in model.whirls(spin, 4)?.iter().enumerate() {
            let sign = if spin == 0.0 { 1.0 } else { whirl.direction.signum() };
            let ours = whirl.frequency();
            let theirs = sign * theory(&parts, [End::Clamped, End::Free], spin, sign * ours);
            rows.push(vec![
                format!("{spin:.0}"),
                if sign > 0.0 { "forward" } else { "backward" }.into(),
                format!("{:.3}", ours / TAU),
                format!("{:.3}", theirs / TAU),
                percent(ours / theirs - 1.0),
            ]);
            if index < 2 && spin > 0.0 {
                first.push([ours, theirs]);
            }
            let id = format!("overhung_{spin:.0}_{}", index + 1);
            let what = format!(
                "overhung disc at {spin:.0} rad/s: frequency {} of the clamped tet10 shaft",
                index + 1
            );
            context.check(
                Check::new(&id, &what, "rad/s", ours)
                    .independent(theirs, "transfer matrices of Timoshenko's equations")
                    .relative(3e-3, "asked for against the beam")
                    .golden(GoldenTolerance::MIXED),
            );
        }
    }
    let columns = ["spin, rad/s", "whirl", "tet10, Hz", "theory, Hz", "off, %"];
    context.table("overhung", "Clamped shaft with a disc at its end", &columns, rows);
    let split = |i: usize| (first[1][i] - first[0][i]).abs();
    context.check(
        Check::new(
            "splitting",
            "distance of the lowest two frequencies at 2000 rad/s",
            "rad/s",
            split(0),
        )
        .independent(split(1), "transfer matrices of Timoshenko's equations")
        .relative(3e-3, "asked for against the beam"),
    );
    // Of the shaft alone: what its own gyroscopic terms split, without a disc.
    let mut alone = rotor.clone();
    alone.beam.discs.clear();
    let model = alone.model()?;
    let [one, other] = [0, 1].map(|i| model.whirls(2.0 * SPIN, 2).map(|all| all[i].frequency()));
    let (one, other) = (one?, other?);
    let own = [Part::Length(length())];
    let ends = [End::Clamped, End::Free];
    let middle = 0.5 * (one + other);
    let theirs = theory(&own, ends, 2.0 * SPIN, one.max(other))
        + theory(&own, ends, 2.0 * SPIN, -one.min(other));
    context.check(
        Check::new(
            "own_splitting",
            "clamped shaft alone at 4000 rad/s: distance of its lowest two frequencies",
            "rad/s",
            (one - other).abs(),
        )
        .independent(theirs.abs(), "transfer matrices of Timoshenko's equations")
        .relative(
            5e-3,
            "a difference of two of its hundred-fold: rotary inertia of sections that warp",
        )
        .golden(GoldenTolerance::MIXED),
    );
    context.finding(
        "own_splitting_size",
        format!("The shaft's own gyroscopic terms part its first frequency ({:.1} Hz) by {:.3} Hz at 4000 rad/s; rotary inertia is all that does, I_p of {:.2e} kg·m².", middle / TAU, (one - other).abs() / TAU, STEEL.density * LENGTH * PI / 32.0 * DIAMETER.powi(4)),
    );
    Ok(())
}
