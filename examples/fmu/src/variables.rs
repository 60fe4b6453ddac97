//! Variables of the FMU: names, units and value references.

/// A variable. Value references count from 1: inputs, then outputs; 0 is the time.
pub struct Variable {
    pub name: String,
    pub unit: &'static str,
}

/// Number of inputs of a race: position and tilts, their rates, speed about the axis.
pub const OF_RACE: usize = 11;
pub const INPUTS: usize = 2 * OF_RACE;
/// Force and moment on each race.
pub const OUTPUTS: usize = 12;

const INPUT: [(&str, &str); OF_RACE] = [
    ("position.x", "m"),
    ("position.y", "m"),
    ("position.z", "m"),
    ("tilt.y", "rad"),
    ("tilt.z", "rad"),
    ("velocity.x", "m/s"),
    ("velocity.y", "m/s"),
    ("velocity.z", "m/s"),
    ("tilt_rate.y", "rad/s"),
    ("tilt_rate.z", "rad/s"),
    ("speed", "rad/s"),
];

const OUTPUT: [(&str, &str); OUTPUTS / 2] = [
    ("force.x", "N"),
    ("force.y", "N"),
    ("force.z", "N"),
    ("moment.x", "N.m"),
    ("moment.y", "N.m"),
    ("moment.z", "N.m"),
];

fn of_both(list: &[(&str, &'static str)]) -> Vec<Variable> {
    let race = |race: &'static str| {
        list.iter().map(move |(name, unit)| Variable { name: format!("{race}.{name}"), unit })
    };
    race("inner").chain(race("outer")).collect()
}

pub fn inputs() -> Vec<Variable> {
    of_both(&INPUT)
}

pub fn outputs() -> Vec<Variable> {
    of_both(&OUTPUT)
}
