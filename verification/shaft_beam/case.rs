//! Frequencies and critical speeds of beams against transfer matrices.

use crate::single_shaft::{Fixed, SingleShaft, Support};
use bearing_dynamics::members::beam::{Beam, BeamDisc, BeamSegment};
use bearing_dynamics::output::plots;
use bearing_dynamics::vibrations::rotor::RotorModel;
use bearing_dynamics::vibrations::whirl::Whirl;
use nalgebra::Matrix4;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::whirling_shaft::{End, Length, Part, left, root};

pub const CASE: Case = Case {
    id: "shaft_beam",
    title: "A flexible shaft as a beam against transfer matrices",
    section: "4.2.2, Table 4.1",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

const TRANSFER: &str = "transfer matrices of Timoshenko's equations";
/// kg, kg·m² about the axis and a diameter: a thick disc of 0.2 m.
const DISC: [f64; 3] = [5.0, 0.025, 0.0135];
const SPIN: f64 = 2000.0;

/// Lengths and diameters; discs at places; springs at places.
struct Shaft {
    lengths: Vec<[f64; 2]>,
    discs: Vec<f64>,
    springs: Vec<(f64, f64)>,
    ends: [End; 2],
}

impl Shaft {
    fn plain(ends: [End; 2]) -> Shaft {
        Shaft { lengths: vec![[0.4, 0.03]], discs: Vec::new(), springs: Vec::new(), ends }
    }

    fn overhung() -> Shaft {
        Shaft { discs: vec![0.4], ..Shaft::plain([End::Clamped, End::Free]) }
    }

    fn stepped() -> Shaft {
        Shaft {
            lengths: vec![[0.1, 0.03], [0.2, 0.04], [0.2, 0.025]],
            discs: vec![0.2, 0.5],
            springs: vec![(0.05, 5e7), (0.4, 8e7)],
            ends: [End::Free, End::Free],
        }
    }

    /// With elements of at most `longest` m.
    fn model(&self, longest: f64) -> Result<RotorModel, CaseError> {
        let segments = self.lengths.iter().map(|&[length, outer_diameter]| BeamSegment {
            length,
            outer_diameter,
            inner_diameter: 0.0,
            density: 7850.0,
            youngs_modulus: 210e9,
            poisson_ratio: 0.3,
        });
        let mut beam = Beam::new(segments.collect());
        let [mass, axial, transverse] = DISC;
        beam.discs =
            self.discs.iter().map(|&at| BeamDisc { at, mass, axial, transverse }).collect();
        beam.longest_element = longest;
        let length = beam.length();
        let mut rotor = SingleShaft::new(beam);
        for (end, at) in self.ends.into_iter().zip([0.0, length]) {
            match end {
                End::Free => {}
                End::Pinned => rotor.fixed.push(Fixed::pin(at)),
                End::Clamped => rotor.fixed.push(Fixed::clamp(at)),
            }
        }
        let support = |&(at, stiffness): &(f64, f64)| Support {
            at,
            stiffness: Matrix4::from_diagonal(&[stiffness, stiffness, 0.0, 0.0].into()),
            damping: Matrix4::zeros(),
        };
        rotor.supports = self.springs.iter().map(support).collect();
        Ok(rotor.model()?)
    }

    /// The same as the oracle has it.
    fn parts(&self) -> Vec<Part> {
        let [mass, axial, transverse] = DISC;
        let mut stops: Vec<(f64, Option<Part>)> = Vec::new();
        stops.extend(
            self.discs.iter().map(|&at| (at, Some(Part::Disc { mass, axial, transverse }))),
        );
        stops.extend(self.springs.iter().map(|&(at, k)| (at, Some(Part::Spring(k)))));
        let mut end = 0.0;
        for [length, _] in &self.lengths {
            end += length;
            stops.push((end, None));
        }
        stops.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut parts, mut at) = (Vec::new(), 0.0);
        for (stop, part) in stops {
            // The section that is half way to the stop.
            let (middle, mut end) = (0.5 * (at + stop), 0.0);
            let own = self.lengths.iter().find(|[length, _]| {
                end += length;
                middle < end
            });
            if let (Some([_, diameter]), true) = (own, stop > at + 1e-12) {
                parts.push(Part::Length(Length::steel(stop - at, *diameter)));
                at = stop;
            }
            parts.extend(part);
        }
        parts
    }

    /// The oracle's frequency nearest to one of ours, rad/s.
    fn oracle(&self, spin: f64, whirl: &Whirl) -> f64 {
        let parts = self.parts();
        let sign = whirl.direction.signum();
        sign * root(|omega| left(&parts, self.ends, spin, omega), sign * whirl.frequency())
    }
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let reason = "errors of the elements, of the eighth order of their length; asked for is 1e-6";
    let shafts = [
        ("pinned", Shaft::plain([End::Pinned, End::Pinned])),
        ("free", Shaft::plain([End::Free, End::Free])),
        ("overhung", Shaft::overhung()),
        ("stepped", Shaft::stepped()),
    ];
    let mut rows = Vec::new();
    for (name, shaft) in &shafts {
        let model = shaft.model(0.4 / 15.9)?;
        for (spin, state) in [(0.0, "at rest"), (SPIN, "spinning at 2000 rad/s")] {
            let mut worst = 0.0f64;
            for whirl in model.whirls(spin, 4)? {
                let (ours, theirs) = (whirl.frequency(), shaft.oracle(spin, &whirl));
                let error = (ours / theirs - 1.0).abs();
                // NaN, where the oracle finds nothing near, must not be lost.
                worst = if error.is_nan() { error } else { worst.max(error) };
                let turns = if whirl.is_forward() { "forward" } else { "backward" };
                let number = |value: f64| format!("{value:.4}");
                rows.push(vec![
                    name.to_string(),
                    state.to_string(),
                    if spin == 0.0 { "–".into() } else { turns.to_string() },
                    number(ours),
                    number(theirs),
                    format!("{error:.1e}"),
                ]);
            }
            let id = format!("{name}_{}", if spin == 0.0 { "rest" } else { "spinning" });
            let what =
                format!("{name} shaft {state}: largest error of its four lowest frequencies");
            context.check(
                Check::new(&id, &what, "1", worst)
                    .independent(0.0, TRANSFER)
                    .absolute(1e-6, reason),
            );
        }
        if *name == "free" {
            continue;
        }
        let first = &model.critical_speeds()?;
        for critical in first.iter().take(3) {
            let parts = shaft.parts();
            let sign = critical.whirl.direction.signum();
            let of = |speed: f64| left(&parts, shaft.ends, speed, sign * speed);
            let theirs = root(of, critical.speed);
            let turns = if sign > 0.0 { "forward" } else { "backward" };
            let id = format!("{name}_critical_{turns}_{:.0}", critical.speed);
            let what = format!("{name} shaft: {turns} critical speed");
            context.check(
                Check::new(&id, &what, "rad/s", critical.speed)
                    .independent(theirs, TRANSFER)
                    .relative(1e-6, reason)
                    .golden(GoldenTolerance::REORDERED),
            );
        }
    }
    let columns = ["shaft", "", "whirl", "ours, rad/s", "oracle, rad/s", "error"];
    context.table("frequencies", "Lowest frequencies", &columns, rows);
    order(context)?;
    diagram(context)
}

/// Errors of two meshes.
fn order(context: &mut CaseContext) -> Result<(), CaseError> {
    let shaft = Shaft::plain([End::Pinned, End::Pinned]);
    let mut errors = Vec::new();
    for elements in [2.0, 4.0, 8.0] {
        let model = shaft.model(0.4 / elements * 1.000_001)?;
        let first = &model.whirls(0.0, 1)?[0];
        errors.push(first.frequency() / shaft.oracle(0.0, first) - 1.0);
    }
    let order = (errors[0] / errors[1]).log2();
    context.check(
        Check::new(
            "order",
            "order of the error of the first pinned frequency, 2 to 4 elements",
            "1",
            order,
        )
        .closed_form(8.0, "twice the degree of the shape functions")
        .absolute(1.0, "two elements a half wave are not yet all the way there"),
    );
    let rows = [2, 4, 8].iter().zip(&errors);
    let rows = rows.map(|(n, error)| vec![n.to_string(), format!("{error:.2e}")]).collect();
    context.table("refinement", "First pinned frequency", &["elements", "error"], rows);
    Ok(())
}

fn diagram(context: &mut CaseContext) -> Result<(), CaseError> {
    let model = Shaft::overhung().model(0.05)?;
    let speeds: Vec<f64> = (0..50).map(|n| 50.0 * f64::from(n)).collect();
    let lines = model.campbell(&speeds, 4)?;
    let svg = plots::campbell("Overhung disc", &lines, &[])?;
    context.figure(
        "campbell",
        svg,
        "Gyroscopic moments split each frequency of a clamped shaft with a disc at its end.",
    );
    Ok(())
}
