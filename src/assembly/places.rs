//! Positions of all members in the state vector.

use crate::assembly::lists::Assembly;
use crate::members::connection::Connection;
use crate::members::flexible_shaft::ElasticShaft;
use crate::members::floating_solid::FloatingSolid;
use crate::members::reduced_solid::ReducedSolid;
use crate::members::state::{BODY, LANES, LEDGER, Layout, Ledger, ball_entries};

/// Positions of bodies, solids and ledger in the state vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Places {
    first_body: usize,
    bodies: usize,
    /// Entries of all reduced solids.
    of_solids: usize,
    /// Entries of all Maxwell elements of connections.
    of_connections: usize,
    /// Entries of all flexible shafts.
    of_shafts: usize,
    /// Entries of all floating solids.
    of_floating: usize,
}

/// Number of entries of a connection: six for each Maxwell element.
fn connection_entries(connection: &Connection) -> usize {
    6 * connection.maxwell().len()
}

impl Places {
    pub fn of(assembly: &Assembly) -> Places {
        let balls = assembly.bearings.iter().map(|bearing| bearing.geometry.ball_count);
        Places {
            first_body: balls.map(ball_entries).sum(),
            bodies: assembly.bodies.len(),
            of_solids: assembly.solids.iter().map(|solid| 2 * solid.count()).sum(),
            of_connections: assembly.connections.iter().map(connection_entries).sum(),
            of_shafts: assembly.shafts.iter().map(ElasticShaft::entries).sum(),
            of_floating: assembly.floating.iter().map(|solid| 2 * solid.count()).sum(),
        }
    }

    /// First entries of each reduced solid: modal coordinates (m), then as many rates (m/s).
    pub fn solids(&self, assembly: &Assembly) -> Vec<usize> {
        let mut next = self.body(self.bodies);
        let mut first = |solid: &ReducedSolid| {
            let at = next;
            next += 2 * solid.count();
            at
        };
        assembly.solids.iter().map(&mut first).collect()
    }

    /// First entries of each connection's Maxwell elements: six elongations (m, rad) each.
    pub fn connections(&self, assembly: &Assembly) -> Vec<usize> {
        let mut next = self.body(self.bodies) + self.of_solids;
        let mut first = |connection: &Connection| {
            let at = next;
            next += connection_entries(connection);
            at
        };
        assembly.connections.iter().map(&mut first).collect()
    }

    /// First entries of each flexible shaft, see [`ElasticShaft::entries`].
    pub fn shafts(&self, assembly: &Assembly) -> Vec<usize> {
        let mut next = self.body(self.bodies) + self.of_solids + self.of_connections;
        let mut first = |shaft: &ElasticShaft| {
            let at = next;
            next += shaft.entries();
            at
        };
        assembly.shafts.iter().map(&mut first).collect()
    }

    /// First entries of each floating solid: amplitudes (m), then as many rates (m/s).
    pub fn floating(&self, assembly: &Assembly) -> Vec<usize> {
        let mut next = self.ledger() - self.of_floating;
        let mut first = |solid: &FloatingSolid| {
            let at = next;
            next += 2 * solid.count();
            at
        };
        assembly.floating.iter().map(&mut first).collect()
    }

    /// First of the 13 entries of a body.
    pub fn body(&self, body: usize) -> usize {
        self.first_body + BODY * body
    }

    pub fn ledger(&self) -> usize {
        let rigid = self.body(self.bodies);
        rigid + self.of_solids + self.of_connections + self.of_shafts + self.of_floating
    }

    pub fn ledger_entry(&self, entry: Ledger) -> usize {
        self.ledger() + entry as usize
    }

    /// Number of entries of the state.
    pub fn state_len(&self) -> usize {
        self.ledger() + LEDGER
    }
}

impl Layout {
    /// Layouts of the bearings of an assembly.
    pub fn of(assembly: &Assembly) -> Vec<Layout> {
        let places = Places::of(assembly);
        let mut first = 0;
        let mut layouts = Vec::with_capacity(assembly.bearings.len());
        for bearing in &assembly.bearings {
            let balls = bearing.geometry.ball_count;
            let races = bearing.mounts.map(|mount| places.body(mount.body));
            layouts.push(Layout {
                balls,
                padded: balls.next_multiple_of(LANES),
                has_cage: bearing.cage.is_some(),
                first,
                races,
                cage: bearing.cage.as_ref().map_or(places.ledger(), |cage| places.body(cage.body)),
                ledger: places.ledger(),
            });
            first += ball_entries(balls);
        }
        layouts
    }
}
