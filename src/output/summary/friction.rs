//! Power lost by friction in a transient run, and the friction torque of a bearing.

use crate::motion::simulation::Simulation;
use crate::output::results::{ResultsError, quantity};
use crate::output::table::RunTable;
use serde_json::{Map, Value};

/// Works of the ledger and the names of their parts.
const PARTS: [(&str, &str); 4] = [
    ("work_traction", "balls_on_races"),
    ("work_cage_friction", "cage"),
    ("work_ball_friction", "between_balls"),
    ("work_contact_damping", "contact_damping"),
];

/// Mean power over the window, W, by part; with one bearing also its friction torque, N·m: this power over the mean
/// relative speed of its races. `None` without energy columns or with fewer than two rows.
pub(super) fn friction(
    simulation: &Simulation,
    table: &RunTable,
) -> Result<Option<Value>, ResultsError> {
    let duration = table.interval * table.window.len().saturating_sub(1) as f64;
    if duration <= 0.0 {
        return Ok(None);
    }
    let mut section = Map::new();
    let mut total = 0.0;
    for (column, part) in PARTS {
        let Some(work) = table.windowed(column) else { continue };
        let (Some(first), Some(last)) = (work.first(), work.last()) else { continue };
        let power = (first - last) / duration;
        total += power;
        section.insert(part.into(), quantity(part, power, "W")?);
    }
    if section.is_empty() {
        return Ok(None);
    }
    section.insert("power_loss".into(), quantity("power", total, "W")?);
    if let [_] = &simulation.system.assembly.bearings[..]
        && let Some(relative) = table.defect_lines().first().map(|of| of.speeds[0] - of.speeds[1])
    {
        section.insert("torque".into(), quantity("torque", total / relative.abs(), "N m")?);
    }
    Ok(Some(Value::Object(section)))
}
