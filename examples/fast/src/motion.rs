//! Runs of a bearing without traction and cage: Newton's and Euler's laws, Runge–Kutta steps, one scene in each lane.

use crate::lanes::{Real, add, cross, dot};
use crate::scene::{Outcome, Run, Scene, Stop};
use crate::statics::{Common, Equilibrium, Problem, solve_lanes};
use wide::f64x8;

type R = f64x8;
type Vector = [R; 3];

/// Coordinates of the inner race, their rates, then position and velocity of each ball.
#[derive(Clone)]
pub struct State(Vec<R>);

impl State {
    #[inline(always)]
    fn race(&self) -> [[R; 5]; 2] {
        let n = &self.0[..10];
        [[n[0], n[1], n[2], n[3], n[4]], [n[5], n[6], n[7], n[8], n[9]]]
    }

    #[inline(always)]
    fn ball(&self, ball: usize) -> [Vector; 2] {
        let numbers = &self.0[10 + 6 * ball..16 + 6 * ball];
        [[numbers[0], numbers[1], numbers[2]], [numbers[3], numbers[4], numbers[5]]]
    }

    /// `base` + `factor` · `slope`.
    fn set(&mut self, base: &State, factor: f64, slope: &State) {
        let factor = R::splat(factor);
        self.0.iter_mut().zip(&base.0).zip(&slope.0).for_each(|((own, base), slope)| *own = *base + factor * *slope);
    }

    fn increase(&mut self, factor: f64, slope: &State) {
        let factor = R::splat(factor);
        self.0.iter_mut().zip(&slope.0).for_each(|(own, slope)| *own += factor * *slope);
    }
}

/// Contact of one ball with one race.
#[derive(Clone, Copy)]
pub struct Contact {
    pub load: R,
    /// Direction of the force on the race.
    pub normal: Vector,
    /// Arm about the race's centre, times the normal.
    lever: Vector,
    /// Tangent of the contact angle.
    pub tangent: [R; 2],
}

/// One race of all lanes.
struct Groove {
    axial: R,
    radial: R,
    room: R,
    stiffness: R,
}

pub struct Runs<'a> {
    common: &'a Common,
    grooves: [Groove; 2],
    damping: R,
    inertia: [R; 3],
    ball_mass: R,
    gravity: [f64; 3],
    load: [R; 5],
    spin: R,
    pub steps: usize,
    pub step: f64,
}

fn lanes<T>(items: &[T], value: impl Fn(&T) -> f64) -> R {
    R::from_lanes(|lane| value(&items[lane.min(items.len() - 1)]))
}

/// The run of a scene.
pub fn run_of(scene: &Scene) -> Outcome<Run> {
    scene.run.ok_or_else(|| Stop::Unclaimed("a scene without numerics as a run".into()))
}

/// Equilibria with the balls moved on by `phase` of each scene, under the weight of the race too.
fn rest(scenes: &[Scene], common: &Common, phase: impl Fn(&Scene) -> f64) -> Vec<Equilibrium> {
    let problem = |scene: &Scene| {
        let mut moved = *scene;
        moved.phase += phase(scene);
        let mass = scene.run.map_or(0.0, |run| run.inertia[0]);
        for i in (0..3).filter(|i| scene.free[*i]) {
            moved.condition[i] += mass * scene.gravity[i];
        }
        Problem::new(&moved, common)
    };
    solve_lanes(common, &scenes.iter().map(problem).collect::<Vec<_>>())
}

/// Ball centres in the scene.
pub fn positions(common: &Common, balls: &[[f64; 2]], pitch: f64, [pc, ps]: [f64; 2]) -> Vec<[f64; 3]> {
    let place = |([a, r], [c, s]): (&[f64; 2], &[f64; 2])| {
        let far = pitch + r;
        let v = [*a, far * (pc * c - ps * s), far * (ps * c + pc * s)];
        std::array::from_fn(|i| common.centre[i] + (0..3).map(|k| common.frame[k][i] * v[k]).sum::<f64>())
    };
    balls.iter().zip(&common.ring).map(place).collect()
}

impl<'a> Runs<'a> {
    /// Runs of up to four scenes, and their start.
    ///
    /// # Errors
    ///
    /// An equilibrium at the start that is not found.
    pub fn new(scenes: &[Scene], common: &'a Common, fraction: f64) -> Outcome<(Self, State)> {
        let run = run_of(&scenes[0])?;
        let here = rest(scenes, common, |_| 0.0);
        // The parts start with the velocity at which their equilibrium moves as the balls roll on.
        let ahead = |scene: &Scene| {
            let orbital = scene.orbital();
            (0.02 * std::f64::consts::PI / scene.count as f64).min(1e-4 * orbital.abs()).copysign(orbital)
        };
        let (first, second) = (rest(scenes, common, ahead), rest(scenes, common, |scene| 2.0 * ahead(scene)));
        let hertz: Vec<_> = scenes.iter().map(Scene::hertz).collect();
        if run.from_equilibrium && here.iter().any(|one| !one.converged || !one.determinate) {
            return Err(Stop::Unclaimed("a start without a determinate equilibrium".into()));
        }
        // The fastest oscillation is that of a ball between its two contacts under twice the largest load.
        let fastest = |(scene, one): (&Scene, &Equilibrium)| {
            let load = one.ball_loads.iter().flatten().copied().fold(10.0, f64::max) * 2.0;
            let stiffness = scene.hertz().map(|hertz| 1.5 * hertz.stiffness.powf(2.0 / 3.0) * load.cbrt());
            ((stiffness[0] + stiffness[1]) / scene.ball_mass).sqrt()
        };
        let fastest = scenes.iter().zip(&here).map(fastest).fold(0.0, f64::max);
        let steps = (run.interval / run.step.unwrap_or(fraction / fastest) - 1e-9).ceil() as usize;
        let start: Vec<Vec<f64>> = (0..scenes.len())
            .map(|i| {
                let (scene, orbital, step) = (&scenes[i], scenes[i].orbital(), ahead(&scenes[i]));
                let moving = run.from_equilibrium && step != 0.0;
                let rate = |here: f64, first: f64, second: f64| {
                    if moving { orbital * (4.0 * (first - here) - (second - here)) / (2.0 * step) } else { 0.0 }
                };
                let nominal = vec![[0.0; 2]; scene.count];
                let balls = if run.from_equilibrium { &here[i].balls } else { &nominal };
                let (sin, cos) = scene.phase.sin_cos();
                let places = positions(common, balls, scene.pitch, [cos, sin]);
                let drifts: Vec<[f64; 2]> = (0..scene.count)
                    .map(|k| [0, 1].map(|j| rate(here[i].balls[k][j], first[i].balls[k][j], second[i].balls[k][j])))
                    .collect();
                let drifts = positions(common, &drifts, 0.0, [cos, sin]);
                let axis = common.frame[0];
                let speeds: Vec<[f64; 3]> = places
                    .iter()
                    .zip(&drifts)
                    .map(|(place, drift)| {
                        let orbit = cross(axis, add(*place, -1.0, common.centre));
                        add(add(*drift, -1.0, common.centre), orbital, orbit)
                    })
                    .collect();
                let prescribed = std::array::from_fn(|k| if scene.free[k] { 0.0 } else { scene.condition[k] });
                let q = if run.from_equilibrium { here[i].position } else { prescribed };
                let v = (0..5).map(|k| rate(here[i].position[k], first[i].position[k], second[i].position[k]));
                let balls = places.iter().zip(&speeds).flat_map(|(place, speed)| [*place, *speed]).flatten();
                q.into_iter().chain(v).chain(balls).collect()
            })
            .collect();
        let five = |value: &dyn Fn(&Scene, usize) -> f64| [0, 1, 2, 3, 4].map(|i| lanes(scenes, |scene| value(scene, i)));
        let groove = |side: usize| {
            let race = |scene: &Scene| if side == 0 { scene.inner } else { scene.outer };
            Groove {
                axial: lanes(scenes, |scene| race(scene).axial),
                radial: lanes(scenes, |scene| race(scene).radial),
                room: lanes(scenes, |scene| race(scene).groove - scene.ball_radius),
                stiffness: lanes(&hertz, |hertz| hertz[side].stiffness),
            }
        };
        let runs = Runs {
            common,
            grooves: [groove(0), groove(1)],
            damping: lanes(scenes, |scene| 1.5 * scene.run.map_or(0.0, |run| run.alpha)),
            inertia: run.inertia.map(R::splat),
            ball_mass: lanes(scenes, |scene| scene.ball_mass),
            gravity: scenes[0].gravity,
            load: five(&|scene, i| if scene.free[i] { scene.condition[i] } else { 0.0 }),
            spin: lanes(scenes, |scene| scene.speed),
            steps,
            step: run.interval / steps as f64,
        };
        let state = (0..start[0].len()).map(|i| lanes(&start, |start| start[i])).collect();
        Ok((runs, State(state)))
    }

    /// Contact of a ball with the inner race (`SIDE` 0), which turns, or the outer one, which does not.
    #[inline(always)]
    fn contact<const SIDE: usize>(&self, axis: Vector, arm: Vector, velocity: Vector, turn: Vector) -> Contact {
        let groove = &self.grooves[SIDE];
        let (zero, one) = (R::zero(), R::splat(1.0));
        let axial = dot(axis, arm);
        let across = add(arm, -axial, axis);
        let radial = dot(across, across).root();
        let (dx, dr) = (axial - groove.axial, radial - groove.radial);
        // Beyond 90° the groove walls continue straight.
        let dr = if SIDE == 0 { dr.smallest(zero) } else { dr.largest(zero) };
        let distance = (dx * dx + dr * dr).root();
        let both = one / (distance * radial);
        let (factor, share) = (dr * both, dx * both * radial);
        let normal = add(across.map(|v| v * factor), share, axis);
        let (lever, rate) = if SIDE == 0 {
            let lever = cross(arm, normal);
            (lever, dot(normal, velocity) - dot(lever, turn))
        } else {
            ([zero; 3], dot(normal, velocity))
        };
        let overlap = (distance - groove.room).largest(zero);
        let elastic = groove.stiffness * overlap * overlap.root();
        let load = elastic * (one + self.damping * rate).largest(zero);
        let outward = if SIDE == 0 { -one } else { one };
        Contact { load, normal, lever, tangent: [outward * dx, outward * dr] }
    }

    /// Contacts of a ball with the inner and the outer race.
    #[inline(always)]
    pub fn contacts(&self, state: &State, pose: &Pose, ball: usize) -> [Contact; 2] {
        let [place, velocity] = state.ball(ball);
        let [q, v] = state.race();
        let minus = R::splat(-1.0);
        let (centre, moving) = ([q[0], q[1], q[2]], [v[0], v[1], v[2]]);
        let inner = self.contact::<0>(pose.frame[0], add(place, minus, centre), add(velocity, minus, moving), pose.turn);
        let arm = add(place, minus, self.common.centre.map(R::splat));
        let outer = self.contact::<1>(self.common.frame[0].map(R::splat), arm, velocity, [R::zero(); 3]);
        [inner, outer]
    }

    /// Derivative of the state by time.
    fn rates(&self, state: &State, out: &mut State) {
        let zero = R::zero();
        let pose = Pose::new(state);
        let [_, v] = state.race();
        let (mut force, mut moment) = ([zero; 3], [zero; 3]);
        let per_mass = R::splat(-1.0) / self.ball_mass;
        let gravity = self.gravity.map(R::splat);
        let (race, balls) = out.0.split_at_mut(10);
        for (ball, slot) in balls.chunks_exact_mut(6).enumerate() {
            let [inner, outer] = self.contacts(state, &pose, ball);
            force = add(force, inner.load, inner.normal);
            moment = add(moment, inner.load, inner.lever);
            let acceleration = add(gravity, per_mass * inner.load, inner.normal);
            let acceleration = add(acceleration, per_mass * outer.load, outer.normal);
            let velocity = state.ball(ball)[1];
            for i in 0..3 {
                (slot[i], slot[3 + i]) = (velocity[i], acceleration[i]);
            }
        }
        let [mass, axial, transverse] = self.inertia;
        let (sin, cos) = pose.second;
        // Euler's law in axes that tilt with the race and do not spin.
        let (w2, w3, f1) = (v[3] * cos, v[4], v[3] * sin);
        let momentum = axial * self.spin;
        let dw2 = (dot(moment, pose.frame[1]) + self.load[3] / cos - w3 * momentum) / transverse + f1 * w3;
        let dw3 = (dot(moment, pose.frame[2]) + self.load[4] + w2 * momentum) / transverse - f1 * w2;
        let straight = [0, 1, 2].map(|i| (force[i] + self.load[i]) / mass + gravity[i]);
        let all = [straight[0], straight[1], straight[2], (dw2 + f1 * w3) / cos, dw3];
        race[..5].copy_from_slice(&v);
        for (i, slot) in race[5..].iter_mut().enumerate() {
            *slot = if self.common.free[i] { all[i] } else { zero };
        }
    }

    /// Advances the state by one output interval with classical Runge–Kutta steps.
    pub fn advance(&self, state: &mut State, work: &mut [State; 3]) {
        let [slope, trial, sum] = work;
        let (h, half, one) = (self.step, 0.5 * self.step, 1.0);
        for _ in 0..self.steps {
            self.rates(state, sum);
            trial.set(state, half, sum);
            for (ahead, weight) in [(half, 2.0), (h, 2.0), (0.0, one)] {
                self.rates(trial, slope);
                sum.increase(weight, slope);
                if ahead > 0.0 {
                    trial.set(state, ahead, slope);
                }
            }
            state.increase(h / 6.0, sum);
        }
    }
}

/// Axes of the inner race, the sine and cosine of its second tilt, and its angular velocity without the spin.
pub struct Pose {
    pub frame: [Vector; 3],
    second: (R, R),
    turn: Vector,
}

impl Pose {
    #[inline(always)]
    pub fn new(state: &State) -> Pose {
        let [q, v] = state.race();
        let ((sy, cy), (sz, cz)) = (q[3].sin_cos_small(), q[4].sin_cos_small());
        let zero = R::zero();
        let frame = [[cy * cz, sz, -sy * cz], [-cy * sz, cz, sy * sz], [sy, zero, cy]];
        Pose { frame, second: (sz, cz), turn: add([zero, v[3], zero], v[4], frame[2]) }
    }
}

/// One row of a run: columns of [`columns`], in SI units, of one lane.
pub fn row(runs: &Runs, state: &State, scene: &Scene, lane: usize, time: f64, turned: &mut [f64]) -> Vec<f64> {
    let pose = Pose::new(state);
    let mut row = vec![time];
    row.extend(state.0[..8].iter().map(|value| value.lane(lane)));
    row.push(scene.speed);
    let mut sums = [[0.0; 5]; 2];
    let mut loads = Vec::with_capacity(2 * turned.len());
    for (ball, turned) in turned.iter_mut().enumerate() {
        let [place, velocity] = state.ball(ball).map(|v| v.map(|value| value.lane(lane)));
        let ([y, z], [_, vy, vz]) = ([1, 2].map(|i| place[i] - scene.outer_at[i]), velocity);
        let turn = std::f64::consts::TAU;
        *turned += (z.atan2(y) - *turned + 0.5 * turn).rem_euclid(turn) - 0.5 * turn;
        row.extend([*turned, (y * vz - z * vy) / (y * y + z * z)]);
        for (contact, sum) in runs.contacts(state, &pose, ball).iter().zip(&mut sums) {
            let load = contact.load.lane(lane);
            let [axial, radial] = contact.tangent.map(|value| value.lane(lane));
            loads.push(load);
            for i in 0..3 {
                sum[i] += load * contact.normal[i].lane(lane);
            }
            sum[3] += load * axial.atan2(radial);
            sum[4] += load;
        }
    }
    row.extend(sums.map(|sum| if sum[4] > 0.0 { sum[3] / sum[4] } else { 0.0 }));
    row.extend(loads);
    row.extend(sums.iter().flat_map(|sum| sum[..3].to_vec()));
    row
}

/// Name and unit of each column of a run; angles are in rad.
pub fn columns(count: usize) -> Vec<(String, &'static str)> {
    let mut names: Vec<(String, &str)> = vec![("time".into(), "s")];
    names.extend(["x", "y", "z"].map(|axis| (format!("inner_{axis}"), "m")));
    names.extend(["tilt_y", "tilt_z"].map(|axis| (format!("inner_{axis}"), "rad")));
    names.extend(["x", "y", "z"].map(|axis| (format!("inner_velocity_{axis}"), "m/s")));
    names.push(("inner_speed".into(), "rad/s"));
    for ball in 1..=count {
        names.extend([(format!("ball_{ball}_angle"), "rad"), (format!("ball_{ball}_orbital_speed"), "rad/s")]);
    }
    names.extend(["inner", "outer"].map(|race| (format!("mean_{race}_contact_angle"), "rad")));
    for ball in 1..=count {
        names.extend(["inner", "outer"].map(|race| (format!("ball_{ball}_{race}_load"), "N")));
    }
    for race in ["inner", "outer"] {
        names.extend(["x", "y", "z"].map(|axis| (format!("contact_force_on_{race}_{axis}"), "N")));
    }
    names
}

/// Rows of up to four runs with the same span, a table for each.
///
/// # Errors
///
/// A start that is not found, or balls that touch.
pub fn tables(scenes: &[Scene], common: &Common, fraction: f64) -> Outcome<Vec<Vec<Vec<f64>>>> {
    let run = run_of(&scenes[0])?;
    let (runs, mut state) = Runs::new(scenes, common, fraction)?;
    let mut work = [state.clone(), state.clone(), state.clone()];
    let mut tables = vec![Vec::new(); scenes.len()];
    let azimuths = |scene: &Scene| common.ring.iter().map(|[c, s]| scene.phase + s.atan2(*c)).collect::<Vec<_>>();
    let mut turned: Vec<_> = scenes.iter().map(azimuths).collect();
    for index in 0..=(run.end / run.interval).round() as usize {
        if index > 0 {
            runs.advance(&mut state, &mut work);
        }
        for (lane, scene) in scenes.iter().enumerate() {
            tables[lane].push(row(&runs, &state, scene, lane, index as f64 * run.interval, &mut turned[lane]));
            let at = |ball: usize| state.ball(ball % scene.count)[0].map(|value| value.lane(lane));
            let apart = |ball: usize| {
                let (a, b) = (at(ball), at(ball + 1));
                (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
            };
            if run.touching && (0..scene.count).any(|ball| apart(ball) < 2.0 * scene.ball_radius) {
                return Err(Stop::Unclaimed("contact between balls".into()));
            }
        }
    }
    Ok(tables)
}
