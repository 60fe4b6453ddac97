//! Contacts of the rigid cage: balls in pockets, ring on its guiding race.

use crate::kinematics::vec3::{Vec3, add_scaled, cross, dot, norm, scale, sub};

/// Force law of a cage contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CageForce {
    /// K Δ, N/m, equation (5.8); 5.3.2 takes K = 2e8 N/m.
    Penalty { stiffness: f64 },
    /// K Δ^{3/2}, N/m^1.5.
    Hertz { stiffness: f64 },
}

/// Force of a penetration (m), N; zero for a gap. With [`CageForce::Penalty`] this is (5.8).
pub fn cage_load(force: &CageForce, penetration: f64) -> f64 {
    if penetration <= 0.0 {
        return 0.0;
    }
    match force {
        CageForce::Penalty { stiffness } => stiffness * penetration,
        CageForce::Hertz { stiffness } => stiffness * penetration * penetration.sqrt(),
    }
}

/// Slope of the force of a penetration, N/m.
pub fn cage_stiffness(force: &CageForce, penetration: f64) -> f64 {
    if penetration <= 0.0 {
        return 0.0;
    }
    match force {
        CageForce::Penalty { stiffness } => *stiffness,
        CageForce::Hertz { stiffness } => 1.5 * stiffness * penetration.sqrt(),
    }
}

/// Energy stored at a penetration, J.
pub fn cage_energy(force: &CageForce, penetration: f64) -> f64 {
    if penetration <= 0.0 {
        return 0.0;
    }
    match force {
        CageForce::Penalty { stiffness } => 0.5 * stiffness * penetration * penetration,
        CageForce::Hertz { stiffness } => {
            0.4 * stiffness * penetration * penetration * penetration.sqrt()
        }
    }
}

/// Shape of a pocket.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pocket {
    /// Round hole with a radial axis: the ball touches its wall.
    Cylindrical,
    /// Sphere around the pocket's centre.
    Spherical,
}

/// Guidance of the cage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Guidance {
    OuterRace,
    InnerRace,
    Balls,
}

impl Guidance {
    /// Name used in scene files.
    pub fn name(self) -> &'static str {
        match self {
            Guidance::OuterRace => "outer-race",
            Guidance::InnerRace => "inner-race",
            Guidance::Balls => "balls",
        }
    }
}

/// Geometry and laws of the cage's contacts, SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageContacts {
    pub pocket: Pocket,
    pub pocket_radius: f64,
    /// Distance of the pocket centres from the cage axis.
    pub pocket_pitch_radius: f64,
    pub guidance: Guidance,
    /// Inner and outer radius of the ring.
    pub ring: [f64; 2],
    /// Guiding surface of the cage: its outer or inner radius.
    pub guide_radius: f64,
    /// Radial gap between cage and guiding race when they are concentric.
    pub race_clearance: f64,
    /// Axial length of the cage.
    pub length: f64,
    pub force: CageForce,
    /// Coulomb coefficient (5.3.2: 0.1), regularised below `regularisation_speed` (m/s).
    pub friction: f64,
    pub regularisation_speed: f64,
}

/// Cage contact in inertial axes: force on the *other* body (ball or race) at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CageContact {
    /// m; negative is a gap.
    pub penetration: f64,
    pub normal_load: f64,
    /// Normal force and friction on the other body, N; the cage takes the opposite force at `point`.
    pub force: Vec3,
    pub point: Vec3,
    /// Unit vector of the normal force on the other body, and its sliding velocity over the cage (m/s).
    pub push: Vec3,
    pub slip: Vec3,
    /// Power of the friction, W, ≤ 0.
    pub power: f64,
}

/// Position and velocity of a body with an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisMotion {
    pub position: Vec3,
    pub velocity: Vec3,
    pub spin: Vec3,
    /// Unit vector along the body's X axis.
    pub axis: Vec3,
}

fn velocity_at(body: &AxisMotion, point: Vec3) -> Vec3 {
    let turning = cross(body.spin, sub(point, body.position));
    add_scaled(body.velocity, 1.0, turning)
}

/// Contact at `point`; `push` is the unit vector from the cage into the other body.
fn contact(
    law: &CageContacts,
    cage: &AxisMotion,
    other_velocity: Vec3,
    point: Vec3,
    push: Vec3,
    penetration: f64,
) -> CageContact {
    let load = cage_load(&law.force, penetration);
    if load == 0.0 {
        return CageContact { penetration, point, ..CageContact::default() };
    }
    let relative = sub(other_velocity, velocity_at(cage, point));
    let slip = add_scaled(relative, -dot(relative, push), push);
    let speed = norm(slip);
    let u0 = law.regularisation_speed;
    let per_speed = law.friction * load / (speed * speed + u0 * u0).sqrt();
    CageContact {
        penetration,
        normal_load: load,
        force: add_scaled(scale(push, load), -per_speed, slip),
        point,
        push,
        slip,
        power: -per_speed * speed * speed,
    }
}

/// Contact of a ball with its pocket; `towards` is the unit vector from the cage axis to the pocket, perpendicular to
/// the axis.
pub fn pocket_contact(
    law: &CageContacts,
    cage: &AxisMotion,
    towards: Vec3,
    ball: &AxisMotion,
    ball_radius: f64,
) -> CageContact {
    let centre = add_scaled(cage.position, law.pocket_pitch_radius, towards);
    let from_centre = sub(ball.position, centre);
    let aside = match law.pocket {
        Pocket::Spherical => from_centre,
        Pocket::Cylindrical => add_scaled(from_centre, -dot(from_centre, towards), towards),
    };
    let distance = norm(aside);
    let penetration = distance - (law.pocket_radius - ball_radius);
    if penetration <= 0.0 {
        return CageContact { penetration, ..CageContact::default() };
    }
    let out = scale(aside, 1.0 / distance);
    let point = add_scaled(ball.position, ball_radius, out);
    contact(law, cage, velocity_at(ball, point), point, scale(out, -1.0), penetration)
}

/// Contact of the cage ring with its guiding race, at the end plane `side` (−1 or +1) of the cage.
pub fn guide_contact(
    law: &CageContacts,
    cage: &AxisMotion,
    race: &AxisMotion,
    side: f64,
) -> CageContact {
    let end = add_scaled(cage.position, 0.5 * side * law.length, cage.axis);
    let arm = sub(end, race.position);
    let across = add_scaled(arm, -dot(arm, race.axis), race.axis);
    let eccentricity = norm(across);
    let penetration = eccentricity - law.race_clearance;
    if penetration <= 0.0 || law.guidance == Guidance::Balls {
        return CageContact { penetration, ..CageContact::default() };
    }
    let direction = scale(across, 1.0 / eccentricity);
    // An outer race is touched on the side to which the cage is displaced, an inner race on the opposite side.
    let (touching, push) = match law.guidance {
        Guidance::InnerRace => (-1.0, direction),
        _ => (1.0, direction),
    };
    let point = add_scaled(end, touching * law.guide_radius, direction);
    contact(law, cage, velocity_at(race, point), point, push, penetration)
}
