//! Where a run took a bushing beyond what the springs that stand for it hold for, by the rows of its table.

use crate::assembly::lists::{Assembly, Mobility};
use crate::assembly::mount::Mount;
use crate::members::connection::Law;
use crate::output::recorder::Recorder;
use crate::scene::build::assembly::{AssemblyScene, BushingOfSpring};
use crate::scene::build::bushing_reach::unasked;
use crate::solids::rubber::sleeve::SleeveMotion;

/// The farthest that a sleeve went in one motion, where the springs no longer hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Beyond {
    /// Index of the spring in the scene.
    pub spring: usize,
    pub motion: SleeveMotion,
    /// m or rad, and when, s.
    pub reached: f64,
    pub time: f64,
    /// As far as they hold, m or rad.
    pub holds: f64,
}

/// Amplitudes of one spring across, along, about its axis and tilting, as [`SleeveMotion::ALL`], with their times, s.
type Farthest = [[f64; 2]; 4];

/// How far the sleeves of a spring have gone against each other in any row; `None` where the table lacks the places of its ends.
pub fn farthest(assembly: &Assembly, recorder: &Recorder, spring: &str) -> Option<Farthest> {
    let joint = assembly.connections.iter().find(|joint| joint.label.as_deref() == Some(spring))?;
    let law = match &joint.law {
        Law::SpringDashpot(law) => law,
        // Of twist alone: places say nothing of it.
        Law::Torsion(_) => return None,
    };
    let [first, second] = [
        columns(assembly, recorder, &joint.ends[0])?,
        columns(assembly, recorder, &joint.ends[1])?,
    ];
    let mut all = Farthest::default();
    for row in 0..recorder.rows() {
        let values = recorder.row(row);
        let [a, b] = [(first, &joint.ends[0]), (second, &joint.ends[1])]
            .map(|(columns, mount)| place(columns, mount, values));
        let by: [f64; 5] = std::array::from_fn(|i| b[i] - a[i]);
        let [x, y, z] = [0, 1, 2].map(|i| by[i] - law.rest[i]);
        let across = |a: f64, b: f64| (a * a + b * b).sqrt();
        let here = [across(y, z), x.abs(), 0.0, across(by[3], by[4])];
        for (most, here) in all.iter_mut().zip(here) {
            if here > most[0] {
                *most = [here, values[0]];
            }
        }
    }
    Some(all)
}

/// Columns of x, y, z (m) and both tilts (degrees) of the body of an end; none of one that is fixed.
fn columns(assembly: &Assembly, recorder: &Recorder, end: &Mount) -> Option<Option<[usize; 5]>> {
    let body = &assembly.bodies[end.body];
    if matches!(body.mobility, Mobility::Fixed) {
        return Some(None);
    }
    let race = assembly.bearings.iter().find_map(|bearing| {
        let side = bearing.mounts.iter().position(|mount| mount.body == end.body)?;
        Some(format!("{}{}", bearing.prefix(), ["inner", "outer"][side]))
    });
    let name = body.label.clone().or(race)?;
    let at = |what: &str| {
        let name = format!("{name}_{what}");
        recorder.columns().iter().position(|column| column.name == name)
    };
    let [x, y, z] = [at("x")?, at("y")?, at("z")?];
    Some(Some([x, y, z, at("tilt_y")?, at("tilt_z")?]))
}

/// Place (m) and small tilts (rad) of a mount, from a row of a table: `columns` are those of x, y, z (m) and both tilts (degrees) of
/// its body; without any the body stands still at the origin.
pub fn place(columns: Option<[usize; 5]>, mount: &Mount, values: &[f64]) -> [f64; 5] {
    let [x, y, z, tilt_y, tilt_z] = columns.map_or([0.0; 5], |at| at.map(|at| values[at]));
    let (tilt_y, tilt_z) = (tilt_y.to_radians(), tilt_z.to_radians());
    [x + mount.along, y + mount.along * tilt_z, z - mount.along * tilt_y, tilt_y, tilt_z]
}

/// Motions in which sleeves went farther than `reach` says of a spring with a bushing; asked of motions that went farther than
/// is taken for granted.
pub fn beyond(
    scene: &AssemblyScene,
    assembly: &Assembly,
    recorder: &Recorder,
    reach: impl Fn(&BushingOfSpring, SleeveMotion) -> Option<f64>,
) -> Vec<Beyond> {
    let mut all = Vec::new();
    for (index, spring) in scene.springs.iter().enumerate() {
        let Some(of) = &spring.bushing else { continue };
        let Some(farthest) = farthest(assembly, recorder, &spring.name) else { continue };
        for (motion, [reached, time]) in SleeveMotion::ALL.into_iter().zip(farthest) {
            if reached <= unasked(of, motion) {
                continue;
            }
            let Some(holds) = reach(of, motion) else { continue };
            if reached > holds {
                all.push(Beyond { spring: index, motion, reached, time, holds });
            }
        }
    }
    all
}
