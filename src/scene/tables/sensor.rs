//! Rows of the key table: sensors.

use crate::scene::tables::assembly::{PLACE, PLACE_HINT};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, open, table};
use crate::scene::text::units::Dimension::{Angle, Capacitance, Frequency, Length, Resistance};
use Need::{Default, Depends, Required};

pub(crate) const SENSORS: &[&str] = &["accelerometer", "telemeter"];
pub(crate) const DIRECTIONS: &[&str] = &["radial", "tangential", "axial"];

const TURN: Kind = Kind::Quantity(Angle, closed(-360.0, 360.0, "deg"));
const ASIDE: Kind = Kind::Quantity(Length, closed(0.0, 100.0, "mm"));
const OUTWARDS: Kind = Kind::Quantity(Length, closed(0.0, 10.0, "m"));
const LOOP: Kind = Kind::Quantity(Length, closed(1.0, 1000.0, "mm"));
const NONE: Need = Default { value: "0 mm", reason: "none is given" };
const FROM_Y: Need = Default { value: "0 deg", reason: "towards +Y" };

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("sensor.kind", Kind::Choice(SENSORS), Required, "`accelerometer` on a rigid body, `telemeter` on a bearing's cage."),
    Key::new("sensor.on", Kind::Text, Depends("required for an accelerometer"), "The body it sits on and turns with: `shaft` for `[body.shaft]`, a race that is a body of its own and moves, `inner_race`, or `cage`; `left.outer_race` where bearings have names."),
    Key::new("sensor.at", PLACE, Default { value: "0 mm", reason: "at the centre of the body" }, "Of an accelerometer: its distance along the body's axis from the body's centre.").hint(PLACE_HINT).example_of("30 mm"),
    Key::new("sensor.radius", OUTWARDS, Default { value: "0 mm", reason: "on the axis" }, "Of an accelerometer: its distance from the body's axis.").hint("a distance; check the unit").example_of("45 mm"),
    Key::new("sensor.angle", TURN, FROM_Y, "Of an accelerometer: the direction from the axis in which it sits at the start, from the scene's +Y towards +Z, on a cage of a reversed bearing too.").example_of("90 deg"),
    Key::new("sensor.direction", Kind::Choice(DIRECTIONS), Default { value: "radial", reason: "outwards, along `angle`" }, "What an accelerometer feels: accelerations outwards along `angle`, across that from +Y towards +Z, or along the axis."),
    Key::new("sensor.bearing", Kind::Text, Depends("the only bearing; required where there are several"), "Of a telemeter: the bearing whose cage it is on."),
    Key::new("sensor.distance", Kind::Quantity(Length, above(0.0, 100.0, "mm")), Default { value: "3 mm", reason: "5.2.1 of the source" }, "Between the loop on the cage and that of the transceiver, which is on the bearing's own +X side and goes where the outer race goes, but does not turn about the axis with it.").hint("the source's tests have 1.78 to 5 mm"),
    Key::new("sensor.offset", ASIDE, NONE, "Of the transceiver's centre from the outer race's axis. With none the signal hardly depends on where the cage is.").hint("the source's tests have 0 to 20 mm").example_of("1.27 mm"),
    Key::new("sensor.offset_angle", TURN, FROM_Y, "Direction of `offset`, from +Y towards +Z."),
    Key::new("sensor.runout", ASIDE, NONE, "Of the loop's centre from the cage's axis. With an offset of the transceiver it is what makes the cage's turning visible.").hint("how well the loop was glued; some tenths of a millimetre").example_of("0.1 mm"),
    Key::new("sensor.runout_angle", TURN, FROM_Y, "Direction of `runout` at the start, from +Y towards +Z; it turns with the cage."),
    Key::new("sensor.loop_radius", LOOP, Depends("half way between inner and outer radius of the cage unless given"), "Radius of the loop on the cage.").hint("about the cage's radius").example_of("31.25 mm"),
    Key::new("sensor.transceiver_radius", LOOP, Depends("`loop_radius` unless given"), "Radius of the transceiver's loop.").hint("about the cage's radius").example_of("31.25 mm"),
    Key::new("sensor.wire_radius", Kind::Quantity(Length, closed(1.0, 1000.0, "um")), Default { value: "0.15 mm", reason: "the source states none" }, "Radius of the wire of both loops.").hint("a thin wire: 0.05 to 0.5 mm"),
    Key::new("sensor.capacitance", Kind::Quantity(Capacitance, open(0.0, 1e6, "nF")), Default { value: "100 pF", reason: "the source states none" }, "The cage's capacitor."),
    Key::new("sensor.resistance", Kind::Quantity(Resistance, open(0.0, 1e6, "ohm")), Depends("that of copper at its skin depth, or for steady currents if that is more, unless given"), "Of the loop on the cage. The transceiver's is that of copper.").hint("a loop of copper wire has some tenths of an ohm").example_of("0.3 ohm"),
    Key::new("sensor.frequency", Kind::Quantity(Frequency, closed(1e3, 1e10, "Hz")), Depends("the resonator's natural frequency unless given"), "At which the reflection is watched.").hint("near the natural frequency, which `bearing check` tells").example_of("34 MHz"),
];

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("sensor", "What a run is watched with besides its channels, `[sensor.NAME]`, any number: a column each, over time and as a spectrum.",
        "[sensor.top]\nkind = \"accelerometer\"\non = \"outer_race\"\nradius = \"45 mm\"\nangle = \"90 deg\""),
];
