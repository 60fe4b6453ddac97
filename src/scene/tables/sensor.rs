//! Rows of the key table: sensors.

use crate::scene::tables::assembly::{PLACE, PLACE_HINT};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, open, table};
use crate::scene::text::units::Dimension::{Angle, Capacitance, Frequency, Length, Resistance};
use Need::{Default, Depends, Optional, Required};

pub(crate) const SENSORS: &[&str] = &["accelerometer", "telemeter"];
pub(crate) const DIRECTIONS: &[&str] = &["radial", "tangential", "axial", "fixed"];

const AZIMUTH: Kind = Kind::Quantity(Angle, closed(-360.0, 360.0, "deg"));
const RATE: Kind = Kind::Quantity(Frequency, closed(1e-3, 1e9, "Hz"));
const ECCENTRICITY: Kind = Kind::Quantity(Length, closed(0.0, 100.0, "mm"));
const RADIUS: Kind = Kind::Quantity(Length, closed(0.0, 10.0, "m"));
const LOOP: Kind = Kind::Quantity(Length, closed(1.0, 1000.0, "mm"));
const CENTRED: Need = Default { value: "0 mm", reason: "centred" };
const FROM_Y: Need = Default { value: "0 deg", reason: "towards +Y" };

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("sensor.kind", Kind::Choice(SENSORS), Required, "`accelerometer` on a body, `telemeter` on a bearing's cage."),
    Key::new("sensor.on", Kind::Text, Depends("required for an accelerometer"), "Body on which the accelerometer is mounted: `shaft` for `[body.shaft]`, a moving race that is a body of its own (`inner_race`), or `cage`; or `housing` with `method = \"reduced\"`; with named bearings `left.outer_race`, `left.housing`. The sensor moves and rotates with the body; on a flexible shaft with its section, on a housing with the nearest node.").only("sensor.kind", &["accelerometer"]),
    Key::new("sensor.at", PLACE, Default { value: "0 mm", reason: "at the centre of the body" }, "Axial position of an accelerometer, measured from the body's centre; on a flexible shaft in the coordinate of its `probe`, on a housing from the centre of its bearing.").hint(PLACE_HINT).example_of("30 mm").only("sensor.kind", &["accelerometer"]),
    Key::new("sensor.radius", RADIUS, Default { value: "0 mm", reason: "on the axis" }, "Radial position of an accelerometer, measured from the axis of the body, on a housing from that of its bearing.").hint("a distance; check the unit").example_of("45 mm").only("sensor.kind", &["accelerometer"]),
    Key::new("sensor.angle", AZIMUTH, FROM_Y, "Azimuth of an accelerometer at t = 0, from the scene's +Y towards +Z, also on the cage of a reversed bearing.").example_of("90 deg").only("sensor.kind", &["accelerometer"]),
    Key::new("sensor.direction", Kind::Choice(DIRECTIONS), Default { value: "radial", reason: "outwards, along `angle`" }, "Measured direction of an accelerometer. It rotates with the body: radially outwards along `angle`, tangential from +Y towards +Z, or axial. `fixed` is a direction in the scene's axes that does not rotate, given by `azimuth` and `elevation`.").only("sensor.kind", &["accelerometer"]),
    Key::new("sensor.azimuth", AZIMUTH, Depends("0 deg; only with `direction = \"fixed\"`"), "Azimuth of a fixed direction, from the scene's +Y towards +Z.").example_of("45 deg").only("sensor.direction", &["fixed"]),
    Key::new("sensor.elevation", Kind::Quantity(Angle, closed(-90.0, 90.0, "deg")), Depends("0 deg; only with `direction = \"fixed\"`"), "Angle between a fixed direction and the Y-Z plane, positive towards +X.").example_of("0 deg").only("sensor.direction", &["fixed"]),
    Key::new("sensor.bearing", Kind::Text, Depends("the only bearing; required with several"), "Bearing on whose cage a telemeter is mounted.").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.distance", Kind::Quantity(Length, above(0.0, 100.0, "mm")), Default { value: "3 mm", reason: "5.2.1 of the source" }, "Axial distance between the loop on the cage and the transceiver's loop. The transceiver is on the bearing's own +X side and moves with the outer race, but does not rotate about its axis.").hint("the source's tests have 1.78 to 5 mm").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.offset", ECCENTRICITY, CENTRED, "Distance of the transceiver's centre from the outer race's axis. Without an offset the signal depends on the cage's radial displacement only to second order.").hint("the source's tests have 0 to 20 mm").example_of("1.27 mm").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.offset_angle", AZIMUTH, FROM_Y, "Direction of `offset`, from +Y towards +Z.").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.runout", ECCENTRICITY, CENTRED, "Eccentricity of the loop on the cage. Together with `offset` it makes the cage's rotation visible in the signal.").hint("mounting error of the loop; some tenths of a millimetre").example_of("0.1 mm").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.runout_angle", AZIMUTH, FROM_Y, "Direction of `runout` at t = 0, from +Y towards +Z; it rotates with the cage.").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.loop_radius", LOOP, Depends("the cage's mean radius"), "Radius of the loop on the cage.").hint("about the cage's radius").example_of("31.25 mm").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.transceiver_radius", LOOP, Depends("`loop_radius`"), "Radius of the transceiver's loop.").hint("about the cage's radius").example_of("31.25 mm").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.wire_radius", Kind::Quantity(Length, closed(1.0, 1000.0, "um")), Default { value: "0.15 mm", reason: "the source states none" }, "Radius of the wire of both loops.").hint("a thin wire: 0.05 to 0.5 mm").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.capacitance", Kind::Quantity(Capacitance, open(0.0, 1e6, "nF")), Default { value: "100 pF", reason: "the source states none" }, "Capacitance of the circuit on the cage.").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.resistance", Kind::Quantity(Resistance, open(0.0, 1e6, "ohm")), Depends("that of copper wire: at the skin depth or for direct current, whichever is larger"), "Resistance of the loop on the cage. The transceiver's loop has that of copper wire.").hint("a loop of copper wire has some tenths of an ohm").example_of("0.3 ohm").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.frequency", Kind::Quantity(Frequency, closed(1e3, 1e10, "Hz")), Depends("the resonator's natural frequency"), "Frequency at which the reflection is measured.").hint("near the natural frequency, which `bearing check` prints").example_of("34 MHz").only("sensor.kind", &["telemeter"]),
    Key::new("sensor.sampling", RATE, Depends("every output row"), "Sampling rate of the sensor's spectra, at most one sample per output row. The interval is rounded to a whole number of rows; the actual rate is in the summary. Without `low_pass`, content above half the rate is aliased, as in a converter without a filter.").hint("at most 1/`numerics.output_interval`").example_of("20 kHz"),
    Key::new("sensor.low_pass", RATE, Optional, "Cut-off frequency (-3 dB) of a Butterworth filter of order 2, applied to the rows before sampling. The recorded column is not filtered.").hint("below half the rate of the output rows").example_of("5 kHz"),
    Key::new("sensor.envelope_band", Kind::Quantities(Frequency, closed(0.0, 1e9, "Hz")), Optional, "Lower and upper frequency of the band of the sensor's envelope spectrum; without it there is none. Choose a band around a resonance that the defect excites.").hint("both below half the sampling rate"),
];

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("sensor", "Sensors of a run, `[sensor.NAME]`, any number. Each adds a column of results over time and a spectrum; `sampling`, `low_pass` and `envelope_band` act on the spectra alone.",
        "[sensor.top]\nkind = \"accelerometer\"\non = \"outer_race\"\nradius = \"45 mm\"\nangle = \"90 deg\""),
];
