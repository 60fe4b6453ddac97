//! A rigid race pressed into a rigid bore of springs that also drag (4.2.4.2): what holds it along the axis, by sums over
//! the nodes.
//!
//! While the race sinks straight down, the bore's nodes slide up along its sides by a part of the sinking, and what
//! drags them carries some of the load; once the race has slid far along its axis, all of the drag points there.

/// Nodes at rest on the race, all with the same spring.
pub struct Bore {
    /// Of each node, rad from the lateral axis towards the vertical one.
    pub azimuths: Vec<f64>,
    /// Against sinking in, N/m.
    pub stiffness: f64,
    /// Of slipping, and stretch from which on a node slips, m.
    pub coefficient: f64,
    pub stretch: f64,
}

impl Bore {
    /// Σ over nodes below a race that has sunk by `sink` (m) of a part of their normal load (N).
    fn over_loads(&self, sink: f64, part: impl Fn(f64, f64) -> f64) -> f64 {
        let below = self.azimuths.iter().map(|azimuth| (azimuth.cos(), -azimuth.sin()));
        let touching = below.filter(|(_, down)| *down > 0.0);
        touching.map(|(aside, down)| self.stiffness * sink * down * part(aside, down)).sum()
    }

    /// What lifts a race that has sunk straight down without slipping, N.
    fn lift(&self, sink: f64, drags: bool) -> f64 {
        self.over_loads(sink, |aside, down| {
            let drag = self.coefficient * sink * aside.abs() / self.stretch;
            if drags { down + drag * aside.abs() } else { down }
        })
    }

    /// How far the race sinks under a load (N), its springs dragging or turned along the axis, m.
    ///
    /// # Panics
    /// If a node slips while the race sinks.
    pub fn sinks(&self, load: f64, drags: bool) -> f64 {
        let (mut low, mut high) = (0.0, self.stretch);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if self.lift(middle, drags) < load { low = middle } else { high = middle }
        }
        assert!(self.lift(high, drags) >= load * (1.0 - 1e-12), "it slips while it sinks");
        low
    }

    /// Σ of the normal loads, N.
    pub fn normal_load(&self, sink: f64) -> f64 {
        self.over_loads(sink, |_, _| 1.0)
    }

    /// Along the axis as long as nothing slips, N/m.
    pub fn stick_stiffness(&self, sink: f64) -> f64 {
        self.coefficient * self.normal_load(sink) / self.stretch
    }

    /// Along the axis when all slips, N.
    pub fn slip_force(&self, sink: f64) -> f64 {
        self.coefficient * self.normal_load(sink)
    }

    /// Heat of a cycle of ±`reach` (m) along the axis, J.
    pub fn loop_area(&self, sink: f64, reach: f64) -> f64 {
        4.0 * self.slip_force(sink) * (reach - self.stretch)
    }
}
