"""A ball bearing in equilibrium and in simple motion, from the documentation of bearing-dynamics.

Usage: python candidate.py KIND RESOLVED_JSON OUT_FOLDER, as docs/guide/conformance.md describes. Equation numbers are
those of the dissertation; axes, signs and symbols are those of docs/theory.md; quantities are in SI units and radians.
Exit code 3: the pack needs something that this program does not claim. It leaves out the channels of the tags life,
frequencies, energy and statistics.
"""

import json
import sys
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

COORDINATES = ("x", "y", "z", "tilt_y", "tilt_z")
DEGREE = np.pi / 180.0


class Refused(Exception):
    """The scene needs something that this program does not claim."""


def claim(kind, scene):
    """Refuses what this program does not compute."""
    bearing, inner, outer = (scene.get(key, {}) for key in ("bearing", "inner_race", "outer_race"))
    profiles = "dent spall waviness" if kind == "statics" else ""
    known = {"": "title source defaults units assumptions bearing inner_race outer_race ball_forces traction "
                 "contact_damping ball_contact numerics output", "inner_race.": "x y z tilt_y tilt_z speed inertia",
             "outer_race.": "x y z tilt_y tilt_z", "bearing.": "kind balls ball_phase hertz pitch_radius length "
             "contact_angle clearance inner_race outer_race ball rating cage " + profiles}
    neutral = (None, False, 0.0, {}, [], "inner_race", "outer_race", "fixed")
    refused = [prefix + key for (prefix, keys), table in zip(known.items(), (scene, inner, outer, bearing))
               for key, item in table.items() if key not in keys.split() and item not in neutral]
    constant = [inner.get("speed"), *outer.values(), *(v for key in COORDINATES for v in inner.get(key, {}).values())]
    reasons = {"a scene in TOML": not scene, f"kind {kind}": kind not in ("statics", "run"),
               "a profile over time": any(isinstance(item, dict) for item in constant)}
    if kind == "run":
        reasons |= {"traction": scene.get("traction", {}).get("law") != "none",
                    "a moving cage": "mass" in bearing.get("cage", {}),
                    "a deviation": "deviations" in bearing.get("ball", {})}
    for name in refused + [name for name, true in reasons.items() if true]:
        raise Refused(name)


def boundary(table):
    """Prescribed coordinates, loads, and which coordinates of the inner race are free."""
    entries = [table.get(key, {}) for key in COORDINATES]
    q = np.array([entry.get("displacement", entry.get("tilt", 0.0)) for entry in entries])
    load = np.array([entry.get("load", entry.get("moment", 0.0)) for entry in entries])
    return q, load, np.array([not entry.keys() & {"displacement", "tilt"} for entry in entries])


def sizes(table):
    """Sizes in use, with the clearance applied: section "Derived sizes" of docs/scene.md."""
    ball, races = table["ball"], (table["inner_race"], table["outer_race"])
    clearance, angle = table.get("clearance", {}), table.get("contact_angle", 0.0)
    nominal = radius = ball["radius"] if "radius" in ball else 0.5 * ball["diameter"]
    gap, through = clearance.get("radial", 0.5 * clearance.get("diametral", 0.0)), clearance.get("through", "ball")
    grooves = np.array([race["groove_radius"] if "groove_radius" in race else 2 * nominal * race["conformity"]
                        if "conformity" in race else nominal / race["osculation"] for race in races])
    rooms, before = (grooves - nominal) * [1.0, -1.0], 0.0
    axial, centres = rooms * np.sin(angle), table["pitch_radius"] + rooms * np.cos(angle)   # parts that just touch
    if table["kind"] == "deep-groove":                                      # gap between the nominal parts
        before = races[1]["radius"] - races[0]["radius"] - 2.0 * radius
        gap, centres = gap if clearance else before, [race["radius"] for race in races] + grooves * [1.0, -1.0]
    share = {"inner-race": (-1.0, 0.0), "outer-race": (0.0, 1.0), "races": (-0.5, 0.5), "ball": (0.0, 0.0)}[through]
    centres = centres + np.array(share) * (gap - before)
    if through == "ball" and clearance:
        radius = 0.5 * (sum(grooves) - np.hypot(axial[0] - axial[1], centres[0] - centres[1] + gap))
    return radius, nominal, gap, through, list(zip(axial, centres, grooves))


def rotation(tilt_y, tilt_z):
    """R_y(xi) R_z(lambda): components of the race to those of the scene, transpose of (2.16)."""
    cy, sy, cz, sz = np.cos(tilt_y), np.sin(tilt_y), np.cos(tilt_z), np.sin(tilt_z)
    return np.stack([np.stack(row, -1) for row in (
        [cy * cz, -cy * sz, sy], [sz, cz, 0.0 * cz], [-sy * cz, sy * sz, cy])], -2)


class Race:
    """A raceway as a torus, and its Hertz contact with a ball at the nominal geometry."""
    def __init__(self, groove_circle, materials, radius, cosine, sign, fit):
        self.axial, self.radial, groove = groove_circle
        self.groove, self.bottom = groove, self.radial - sign * groove      # radii of cross-section and groove bottom
        self.gap = groove - radius                                          # groove centre to ball centre
        self.rolling = 1.0 / (1.0 / radius + sign / (self.radial / cosine - sign * groove))     # R_x
        self.transverse = 1.0 / (1.0 / radius - 1.0 / groove)                                   # R_y
        ratio, self.curvature = self.transverse / self.rolling, 1.0 / self.rolling + 1.0 / self.transverse
        self.modulus = 2.0 / sum((1.0 - m["poisson_ratio"]**2) / m["youngs_modulus"] for m in materials)    # E'
        integrals = lambda k: (ellipk(1.0 - k**-2.0), ellipe(1.0 - k**-2.0))
        if fit:                                                             # Hamrock and Brewe
            self.ellipticity = 1.0339 * ratio**0.636
            first, self.second = 1.5277 + 0.6023 * np.log(ratio), 1.0003 + 0.5968 / ratio
        else:                                                               # R_y / R_x = (k^2 E - F) / (F - E)
            misfit = lambda k, first, second: (k * k * second - first) / (first - second) - ratio
            self.ellipticity = brentq(lambda k: misfit(k, *integrals(k)), 1.0 + 1e-6, 1e5, xtol=1e-15, rtol=1e-15)
            first, self.second = integrals(self.ellipticity)
        self.stiffness = np.pi * self.ellipticity * self.modulus * np.sqrt(                     # K_H
            2.0 * self.second / (9.0 * self.curvature * first**3))

    def contact(self, frame, arm):
        """Approach, normal (from groove to ball centre: force on the race), elastic load (2.1), contact angle."""
        local = np.einsum("...ji,...j->...i", frame, arm)
        distance = np.sqrt(local[..., 1]**2 + local[..., 2]**2)
        axial, radial = local[..., 0] - self.axial, distance - self.radial
        length = np.sqrt(axial**2 + radial**2)
        normal = np.stack([axial, radial * local[..., 1] / distance, radial * local[..., 2] / distance], -1)
        normal = np.einsum("...ij,...j->...i", frame, normal / length[..., None])
        overlap = np.where((approach := length - self.gap).real > 0.0, approach, 0.0)
        angle = np.arctan2((axial * np.sign(radial.real)).real, abs(radial.real))
        return approach, normal, self.stiffness * overlap * np.sqrt(overlap), angle

    def ellipse(self, load):
        """Semi-axes and peak pressure."""
        major = np.cbrt(6.0 * self.ellipticity**2 * self.second * load / (np.pi * self.modulus * self.curvature))
        return major, (minor := major / self.ellipticity), 1.5 * load / (np.pi * np.maximum(major * minor, 1e-300))


class Bearing:
    def __init__(self, kind, scene):
        table, ball, forces = scene["bearing"], scene["bearing"]["ball"], scene.get("ball_forces", {})
        self.ball, self.nominal, self.clearance, self.through, circles = sizes(table)
        self.count, self.pitch, self.angle = table["balls"], table["pitch_radius"], table.get("contact_angle", 0.0)
        self.mass = ball["material"]["density"] * 4.0 / 3.0 * np.pi * self.ball**3
        self.gravity = np.array(forces.get("gravity", [0.0, 0.0, 0.0]))
        cosine, fit = np.cos(self.angle), table["hertz"] == "hamrock-brewe"
        self.gamma = self.ball / self.pitch * cosine
        self.inner, self.outer = (
            Race(circle, (ball["material"], table[name]["material"]), self.ball, cosine, sign, fit)
            for circle, name, sign in zip(circles, ("inner_race", "outer_race"), (1.0, -1.0)))
        self.speed = scene.get("inner_race", {}).get("speed", 0.0)
        self.orbital = 0.5 * (1.0 - self.gamma) * self.speed                # rolling without slip, nominal angle
        self.spin = self.mass * self.orbital**2 if kind == "run" or forces.get("centrifugal") else 0.0  # runs: always
        place = [scene.get("outer_race", {}).get(key, 0.0) for key in COORDINATES]
        self.centre, self.frame = np.array(place[:3]), rotation(place[3], place[4])   # of the outer race
        self.axis = self.frame[:, 0]
        self.turn_balls(table["ball_phase"])

    def turn_balls(self, phase):
        """Sets the azimuths of the balls, and the radial direction and that of the orbit at each."""
        self.azimuth = phase + 2.0 * np.pi * np.arange(self.count) / self.count
        self.radial = np.stack([np.cos(self.azimuth), np.sin(self.azimuth)], 1) @ self.frame[:, 1:].T
        self.along = np.cross(self.axis, self.radial)

    def positions(self, balls):
        """Ball centres in the scene, from axial and radial position in the meridian planes of the outer race."""
        return self.centre + balls[..., :1] * self.axis + balls[..., 1:2] * self.radial

    def forces(self, u):
        """Energy and its gradient by u = (x, y, z, xi, lambda, ball axial, ball radial), one row a ball."""
        place = self.positions(u[..., 5:])
        arm = place - u[..., :3]
        approach_i, normal_i, load_i, _ = self.inner.contact(rotation(u[..., 3], u[..., 4]), arm)
        approach_o, normal_o, load_o, _ = self.outer.contact(self.frame, place - self.centre)
        weight, stored = self.mass * self.gravity, 0.4 * (load_i * approach_i + load_o * approach_o)
        energy = stored - place @ weight - 0.5 * self.spin * u[..., 6]**2
        on_race = load_i[..., None] * normal_i
        moment = np.cross(arm, on_race)
        about_z = moment[..., 0] * np.sin(u[..., 3]) + moment[..., 2] * np.cos(u[..., 3])   # tilted Z of the race
        on_ball = weight - on_race - load_o[..., None] * normal_o
        rest = np.stack([moment[..., 1], about_z, on_ball @ self.axis,
                         np.sum(on_ball * self.radial, -1) + self.spin * u[..., 6]], -1)
        return energy.real, -np.concatenate([on_race, rest], -1)

    def derivatives(self, q, balls, columns):
        """Energy, gradient and Hessian by some columns of u (complex step: exact to rounding), a row a ball."""
        u = np.concatenate([np.tile(q, (self.count, 1)), balls], 1)
        steps = np.zeros((len(columns) + 1, 1, 7), complex)
        steps[range(1, len(columns) + 1), 0, columns] = 1e-30j
        energy, gradient = self.forces(u + steps)
        return energy[0], gradient[0].real, np.moveaxis(gradient[1:].imag, 0, -1) / 1e-30

    def settle(self, q):
        """Equilibrium of every ball in its meridian plane: Newton's method, from two springs in series."""
        share = 1.0 / (1.0 + (self.outer.stiffness / self.inner.stiffness)**(2.0 / 3.0))
        balls, base = np.tile([0.0, self.pitch], (self.count, 1)), np.array([self.outer.axial, self.outer.radial])
        for _ in range(4):
            approach, normal, _, _ = self.inner.contact(rotation(q[3], q[4]), self.positions(balls) - q[:3])
            away = np.stack([normal @ self.axis, np.sum(normal * self.radial, 1)], 1)
            line = balls - away * (approach + self.inner.gap)[:, None] - base
            overlap = (length := np.linalg.norm(line, axis=1, keepdims=True)) - self.inner.gap - self.outer.gap
            balls = base + line / length * (self.outer.gap + overlap * np.where(overlap > 0.0, share, 0.5))
        for _ in range(60):
            _, gradient, hessian = self.derivatives(q, balls, (5, 6))
            values, vectors = np.linalg.eigh(hessian[:, 5:])
            values = np.maximum(abs(values), 1e-10 * abs(values).max(1, keepdims=True) + 1e-300)
            step = -np.einsum("bij,bj,bkj,bk->bi", vectors, 1.0 / values, vectors, gradient[:, 5:])
            step *= np.minimum(1.0, 0.02 * self.ball / (np.linalg.norm(step, axis=1) + 1e-300))[:, None]
            step[np.linalg.norm(gradient[:, 5:], axis=1) < 2e-16 * self.pitch * values.max(1)] = 0.0    # rounding
            if not step.any():
                break
            balls = balls + step
        return balls

    def condensed(self, q):
        """Energy, loads and 5 x 5 stiffness with every ball in equilibrium, and the balls."""
        balls = self.settle(q)
        energy, gradient, hessian = self.derivatives(q, balls, range(7))
        stiffness = sum((h[:5, :5] - h[:5, 5:] @ np.linalg.pinv(h[5:, 5:], hermitian=True) @ h[5:, :5]
                         for h in hessian if h[:5, 5:].any()), np.zeros((5, 5)))
        return energy.sum(), gradient[:, :5].sum(0), 0.5 * (stiffness + stiffness.T), balls

    def equilibrium(self, table, weight=np.zeros(3)):
        """Position of the inner race where contact forces balance the loads (3.4.5, 4.3): trust-radius Newton."""
        q, load, free = boundary(table)
        load[:3] += weight
        scale = np.array([1.0, 1.0, 1.0, self.pitch, self.pitch])[free]
        state, radius, enough = self.condensed(q), 2e-6, 1e-6 * max(1.0, abs(load).max())
        for _ in range(300 if free.any() else 0):
            gradient = (state[1] - load)[free] / scale
            values, vectors = np.linalg.eigh(state[2][np.ix_(free, free)] / np.outer(scale, scale))
            part, old = vectors.T @ gradient, np.linalg.norm(gradient)
            shift = 0.0 if values[0] > 1e-7 * abs(values).max() else 1e-3 - values[0]
            if shift == 0.0 and np.linalg.norm(part / values) < 1e-16 * self.pitch:
                break
            while np.linalg.norm(part / (values + shift)) > radius:
                shift = max(1.5 * shift, 1e-6 * max(abs(values).max(), 1.0))
            step = np.zeros(5)
            step[free] = -(vectors @ (part / (values + shift))) / scale
            trial = self.condensed(q + step)
            change = trial[0] - state[0] - load @ step
            new = np.linalg.norm((trial[1] - load)[free] / scale)
            if change < 0.0 or (new < old and change < 1e-10 * abs(state[0])):
                q, state, radius = q + step, trial, min(2.0 * radius, 1e-4)
            elif old < enough:                                              # as good as rounding allows
                break
            else:
                radius = 0.25 * np.linalg.norm(step[free] * scale)
        if free.any() and (old > enough or values[0] <= 1e-9 * values[-1]):
            raise Refused("a position that the loads do not determine, or that is not found,")
        return q, state


def value(number, unit):
    return {"value": float(number), "unit": unit}


def vector(numbers, unit):
    return {axis: value(number, unit) for axis, number in zip("xyz", numbers)}


def coordinates(numbers, force, moment, factor=1.0):
    return vector(numbers[:3], force) | {key: value(n * factor, moment) for key, n in zip(COORDINATES[3:], numbers[3:])}


def flat(node, name=""):
    """One row of the table: column names joined by underscores, with units."""
    if not isinstance(node, dict) or set(node) == {"value", "unit"}:
        return {f"{name} [{node['unit']}]": node["value"]} if isinstance(node, dict) else {f"{name} [1]": node}
    return {k: v for key, item in node.items() for k, v in flat(item, f"{name}_{key}" if name else key).items()}


def geometry(bearing):
    """Sizes in use."""
    def lengths(**named):
        return {name: value(1e3 * length, "mm") for name, length in named.items()}
    races = {f"{name}_race": {"conformity": value(0.5 * of.groove / bearing.nominal, "1"),
                              "osculation": value(bearing.nominal / of.groove, "1")} | lengths(
        radius=of.bottom, groove_radius=of.groove, groove_centre_radius=of.radial, groove_centre_axial=of.axial)
        for name, of in (("inner", bearing.inner), ("outer", bearing.outer))}
    return races | {"clearance_through": bearing.through, "contact_angle": value(bearing.angle / DEGREE, "deg"),
                    "ball_mass": value(bearing.mass, "kg")} | lengths(
        radial_clearance=bearing.clearance, pitch_radius=bearing.pitch, ball_radius=bearing.ball)


def statics(scene, bearing):
    """Summary and table of the equilibrium."""
    q, (_, loads, stiffness, balls) = bearing.equilibrium(scene.get("inner_race", {}))
    place, contacts, summed = bearing.positions(balls), {}, {}
    for name, race, frame, centre in (("inner", bearing.inner, rotation(q[3], q[4]), q[:3]),
                                      ("outer", bearing.outer, bearing.frame, bearing.centre)):
        approach, normal, load, angle = race.contact(frame, place - centre)
        force = load[:, None] * normal
        contacts[name] = (load, approach, angle / DEGREE, *race.ellipse(load), force)
        summed[name] = {"contact_force": vector(force.sum(0), "N"),
                        "contact_moment": vector(np.cross(place - centre, force).sum(0), "N m")}
    cage = np.sum((contacts["inner"][-1] - bearing.mass * bearing.gravity) * bearing.along, 1)      # on the ball
    units = dict(load="N", approach="m", contact_angle="deg", semi_major="m", semi_minor="m", peak_pressure="Pa")
    listed = []
    for i, azimuth in enumerate(bearing.azimuth):
        ball = {"ball": i + 1, "azimuth": value(azimuth / DEGREE % 360.0, "deg"), "position": vector(place[i], "m"),
                "cage_force": value(cage[i], "N")}
        for name, data in contacts.items():
            ball[name] = {key: value(column[i], unit) for column, (key, unit) in zip(data, units.items())}
            ball[name]["force_on_race"] = vector(data[-1][i], "N")
        listed.append(ball)
    largest = {name: data[0].max() for name, data in contacts.items()}
    loaded = {name: np.flatnonzero(data[0] > 0.01 * largest[name]) for name, data in contacts.items()}
    where, count = loaded["inner"], bearing.count
    widest = np.diff(where, append=where[:1] + count).max(initial=0)        # from one loaded ball to the next
    extent = 360.0 if len(where) == count else 360.0 * (1.0 - widest / count) * bool(len(where))
    return {
        "kind": "static solution", "determinacy": {"kind": "determinate"},
        "inner_race": {"position": coordinates(q, "m", "deg", 1 / DEGREE), "loads": coordinates(loads, "N", "N m")}
        | summed["inner"], "outer_race": summed["outer"],
        "stiffness": {key: coordinates(row, top + "/m", top + "/rad")
                      for key, row, top in zip(COORDINATES, stiffness, ("N", "N", "N", "N m", "N m"))},
        "load_zone": {"extent": value(extent, "deg")}
        | {f"balls_loaded_{name}": len(index) for name, index in loaded.items()}
        | {f"largest_{name}_load": value(load, "N") for name, load in largest.items()}
        | {"largest_pressure": value(max(data[5].max() for data in contacts.values()), "Pa")},
        "balls": listed,
        "hertz": {name: {"stiffness": value(r.stiffness, "N/m^1.5"), "ellipticity": value(r.ellipticity, "1")}
                  | {f"radius_{key}": value(1e3 * getattr(r, key), "mm") for key in ("rolling", "transverse")}
                  for name, r in (("inner_race", bearing.inner), ("outer_race", bearing.outer))},
        "geometry": geometry(bearing),
    }, [flat(entry) for entry in listed]


def motion(scene, bearing):
    """Summary and table of a run without traction and cage: Newton's and Euler's laws (4.2.1.2)."""
    numerics, table, count, damping = scene["numerics"], scene["inner_race"], bearing.count, scene["contact_damping"]
    inertias = dict(mass="kg", axial="kg m^2", transverse="kg m^2")
    mass, axial, transverse = (table["inertia"][key] for key in inertias)
    alpha = damping["alpha"] if damping.get("law") == "hunt-crossley" else 0.0
    prescribed, load, free = boundary(table)
    def contacts(y):
        """Of each race: normal loads with damping, normals, arms cross normals, contact angles."""
        place, velocity = y[10:].reshape(2, count, 3) + [home, 0.0 * home]
        frame = rotation(y[3], y[4])
        omega = np.array([0.0, y[8], 0.0]) + y[9] * frame[:, 2]             # angular velocity without the spin
        for race, axes, arm, move, turn in (
                (bearing.inner, frame, place - y[:3], velocity - y[5:8], omega),
                (bearing.outer, bearing.frame, place - bearing.centre, velocity, 0.0 * omega)):
            _, normal, elastic, angle = race.contact(axes, arm)
            lever = np.cross(arm, normal)
            rate = np.sum(normal * move, 1) - lever @ turn
            yield elastic * np.maximum(1.0 + 1.5 * alpha * rate, 0.0), normal, lever, angle     # Hunt-Crossley
    def rates(_, y):
        (load_i, normal_i, lever, _), (load_o, normal_o, _, _) = contacts(y)
        moment = (load_i @ lever) @ rotation(y[3], y[4])
        # Euler's law in axes that tilt with the race and do not spin: w2, w3 about its Y and Z, f1 about its X.
        w2, w3, f1 = y[8] * np.cos(y[4]), y[9], y[8] * np.sin(y[4])
        dw2 = (moment[1] + load[3] / np.cos(y[4]) - w3 * axial * bearing.speed) / transverse + f1 * w3
        dw3 = (moment[2] + load[4] + w2 * axial * bearing.speed) / transverse - f1 * w2
        dw2 = (dw2 + f1 * w3) / np.cos(y[4])                                # second derivative of the first tilt
        race = np.concatenate([(load_i @ normal_i + load[:3]) / mass + bearing.gravity, [dw2, dw3]])
        balls = bearing.gravity - (load_i[:, None] * normal_i + load_o[:, None] * normal_o) / bearing.mass
        return np.concatenate([y[5:10], np.where(free, race, 0.0), y[10 + 3 * count:], balls.ravel()])
    def at_rest(phase):
        """Race and balls in equilibrium with ball 1 at this azimuth."""
        bearing.turn_balls(phase)
        q, state = bearing.equilibrium(table, mass * bearing.gravity)       # weight of the race
        return np.concatenate([q, state[3].ravel()])
    phase = scene["bearing"]["ball_phase"]
    start, speed = np.concatenate([prescribed, np.tile([0.0, bearing.pitch], count)]), np.zeros(5 + 2 * count)
    if numerics["start"] == "equilibrium":
        start = at_rest(phase)
        step = min(0.02 * np.pi / count, 1e-4 * abs(bearing.orbital)) * np.sign(bearing.orbital)
        if step:                                                            # it moves as the balls roll on
            first, second = at_rest(phase + step) - start, at_rest(phase + 2.0 * step) - start
            speed = bearing.orbital * (4.0 * first - second) / (2.0 * step)
    bearing.turn_balls(phase)
    balls, drift = start[5:].reshape(count, 2), speed[5:].reshape(count, 2)
    velocity = bearing.positions(drift) - bearing.centre + bearing.orbital * balls[:, 1:] * bearing.along
    home = bearing.positions(balls)                                         # the state has displacements from here
    y = np.concatenate([start[:5], speed[:5], 0.0 * home.ravel(), velocity.ravel()])
    small = np.repeat([1e-14, 1e-12, 1e-9, 1e-7, 1e-14, 1e-9], [3, 2, 3, 2, 3 * count, 3 * count])
    times = np.arange(round(numerics["end"] / numerics["output_interval"]) + 1) * numerics["output_interval"]
    rows, turned = [], bearing.azimuth
    for before, time in zip([times[0], *times], times):                     # interpolated rows would be less accurate
        y = solve_ivp(rates, (before, time), y, "DOP853", rtol=1e-13, atol=small, max_step=1e-5).y[:, -1]
        place, velocity = y[10:].reshape(2, count, 3) + [home, 0.0 * home]
        if np.min(np.linalg.norm(place - np.roll(place, 1, 0), axis=1)) < 2.0 * bearing.ball:
            raise Refused("contact between balls")
        (_, p2, p3), (_, v2, v3) = (place - bearing.centre).T, velocity.T       # axes of the scene
        turned = turned + (np.arctan2(p3, p2) - turned + np.pi) % (2 * np.pi) - np.pi       # all turns
        row = dict(time=value(time, "s"), inner=coordinates(y[:5], "m", "deg", 1 / DEGREE),
                   inner_velocity=vector(y[5:8], "m/s"), inner_speed=value(bearing.speed, "rad/s"))
        for i, orbit in enumerate((p2 * v3 - p3 * v2) / (p2**2 + p3**2)):
            row[f"ball_{i + 1}"] = {"angle": value(turned[i] / DEGREE, "deg"), "orbital_speed": value(orbit, "rad/s")}
        for name, (load_n, normal, _, angle) in zip(("inner", "outer"), contacts(y)):
            row[f"mean_{name}_contact_angle"] = value(load_n @ angle / max(load_n.sum(), 1e-300) / DEGREE, "deg")
            row[f"contact_force_on_{name}"] = vector(load_n @ normal, "N")
            row |= {f"ball_{i + 1}_{name}_load": value(number, "N") for i, number in enumerate(load_n)}
        rows.append(flat(row))
    inertia = {key: value(table["inertia"][key], unit) for key, unit in inertias.items()} | {"centre": value(0.0, "mm")}
    return {"kind": "run", "end": value(numerics["end"], "s"), "time": value(times[-1], "s"),
            "body_inertia": {"the inner race": inertia}}, rows


def main(kind, resolved, out):
    scene, out = {} if resolved.endswith(".toml") else json.loads(Path(resolved).read_text()), Path(out)
    claim(kind, scene)
    summary, rows = (motion if kind == "run" else statics)(scene, Bearing(kind, scene))
    out.mkdir(parents=True, exist_ok=True)
    lines = [list(rows[0])] + [[str(float(number)) for number in row.values()] for row in rows]
    (out / "series.csv").write_text("".join(",".join(line) + "\n" for line in lines))
    (out / "summary.json").write_text(json.dumps(summary, indent=2))


if __name__ == "__main__":
    try:
        main(*sys.argv[1:4])
    except Refused as reason:
        print(f"{reason} is not claimed", file=sys.stderr)
        sys.exit(3)
