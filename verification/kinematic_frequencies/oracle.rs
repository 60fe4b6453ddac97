//! Pure rolling, solved as a linear system of contact velocities; knows no frequency formula.

/// Motion of one ball for an inner race at unit angular speed and a fixed outer race.
pub struct Rolling {
    /// Angular speed of the ball's centre about the bearing axis.
    pub orbit: f64,
    /// Angular speed of the ball relative to the cage, about its own axis.
    pub spin: f64,
}

type Vector = [f64; 3];

/// Solve for the ball's orbit and angular velocity (four unknowns) such that both contact points
/// have the velocity of the race there (two tangential and one meridional condition) and the ball
/// does not pivot about its contact normal relative to the cage.
///
/// Frame: axis X along the bearing, R outwards through the ball's centre, T tangential. The
/// outer contact lies at `contact_angle` from R towards X, the inner contact opposite.
pub fn pure_rolling(ball_radius: f64, pitch_radius: f64, contact_angle: f64) -> Rolling {
    let normal = [contact_angle.sin(), contact_angle.cos(), 0.0];
    let meridian = [contact_angle.cos(), -contact_angle.sin(), 0.0];
    let tangent = [0.0, 0.0, 1.0];
    let centre = [0.0, pitch_radius, 0.0];
    let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], tangent];

    // Columns: orbit, then the ball's angular velocity along X, R and T.
    let row = |side: f64, direction: Vector, race_speed: f64| {
        let arm = scale(normal, side * ball_radius);
        let mut row = [0.0; 5];
        row[0] = dot(cross(units[0], centre), direction);
        for (axis, unit) in units.iter().enumerate() {
            row[1 + axis] = dot(cross(*unit, arm), direction);
        }
        let point = add(centre, arm);
        row[4] = dot(cross(scale(units[0], race_speed), point), direction);
        row
    };
    let no_pivot = [-normal[0], normal[0], normal[1], normal[2], 0.0];
    let [orbit, x, r, t] =
        solve([row(1.0, tangent, 0.0), row(-1.0, tangent, 1.0), row(1.0, meridian, 0.0), no_pivot]);
    let relative = [x - orbit, r, t];
    Rolling { orbit, spin: dot(relative, relative).sqrt() }
}

/// Gaussian elimination with row pivoting of a 4 × 4 system with its right-hand side appended.
fn solve(mut rows: [[f64; 5]; 4]) -> [f64; 4] {
    for column in 0..4 {
        let pivot = (column..4)
            .max_by(|a, b| rows[*a][column].abs().total_cmp(&rows[*b][column].abs()))
            .unwrap_or(column);
        rows.swap(column, pivot);
        for below in column + 1..4 {
            let factor = rows[below][column] / rows[column][column];
            let upper = rows[column];
            for (entry, above) in rows[below].iter_mut().zip(upper) {
                *entry -= factor * above;
            }
        }
    }
    let mut solution = [0.0; 4];
    for row in (0..4).rev() {
        let known: f64 = (row + 1..4).map(|column| rows[row][column] * solution[column]).sum();
        solution[row] = (rows[row][4] - known) / rows[row][row];
    }
    solution
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn scale(a: Vector, factor: f64) -> Vector {
    a.map(|component| factor * component)
}
