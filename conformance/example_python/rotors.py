"""A program of level 4: equilibria and whirl of one shaft on bearings and springs, from docs/guide/conformance_solids.md.

    python rotors.py {kind} {resolved} {out}

Two-node Timoshenko elements of 10 mm, bearings of candidate.py. Needs numpy and scipy.
"""

import json
import os
import sys
from pathlib import Path

# Packs run side by side; more threads for one slow all of them down tenfold.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import candidate
import numpy as np
import scipy.linalg
from candidate import COORDINATES, DEGREE, coordinates, value

LONGEST = 0.01
# Natural modes in which whirl is computed; `modes` has fewer.
KEPT = 100
# A motion with more of its energy along the axis is no whirl.
AXIAL = 0.9999
TURNS = dict(x="x", y="y", z="z", tilt_y="turn_y", tilt_z="turn_z")


def element(material, section, length):
    """Stiffness, mass, rotary inertia and the integral of w' w' over (w, w', w, w'); axial stiffness and mass."""
    e, nu, rho = (material[key] for key in ("youngs_modulus", "poisson_ratio", "density"))
    outer, inner = section["outer_diameter"], section["inner_diameter"]
    area, second, hollow = np.pi / 4 * (outer**2 - inner**2), np.pi / 64 * (outer**4 - inner**4), 1 + (inner / outer) ** 2
    cowper = 6 * (1 + nu) * hollow**2 / ((7 + 6 * nu) * hollow**2 + (20 + 12 * nu) * (hollow - 1))
    shear = 12 * e * second * 2 * (1 + nu) / (cowper * e * area * length**2)
    x, weights = np.polynomial.legendre.leggauss(6)
    x, weights = (x + 1) / 2, weights / 2 * length
    w = np.array([1 - 3 * x**2 + 2 * x**3 + shear * (1 - x), length * (x - 2 * x**2 + x**3 + shear / 2 * (x - x**2)),
                  3 * x**2 - 2 * x**3 + shear * x, length * (x**3 - x**2 + shear / 2 * (x**2 - x))]) / (1 + shear)
    slope = np.array([6 * (x**2 - x) - shear, length * (1 - 4 * x + 3 * x**2 + shear / 2 * (1 - 2 * x)),
                      6 * (x - x**2) + shear, length * (3 * x**2 - 2 * x + shear / 2 * (2 * x - 1))]) / (1 + shear) / length
    turn = np.array([6 * (x**2 - x) / length, 1 - 4 * x + 3 * x**2 + shear * (1 - x),
                     6 * (x - x**2) / length, 3 * x**2 - 2 * x + shear * x]) / (1 + shear)
    a, b = 6 * length, length**2
    bending = np.array([[12, a, -12, a], [a, (4 + shear) * b, -a, (2 - shear) * b],
                        [-12, -a, 12, -a], [a, (2 - shear) * b, -a, (4 + shear) * b]])
    return dict(
        bending=bending * e * second / ((1 + shear) * length**3),
        mass=rho * area * (w * weights) @ w.T, rotary=rho * second * (turn * weights) @ turn.T, slopes=(slope * weights) @ slope.T,
        stiff=e * area, heavy=rho * area, length=length)


class Shaft:
    """Nodes with (x, y, z, tilt_y, tilt_z): the slope y' is tilt_z, the slope z' is -tilt_y."""

    def __init__(self, scene):
        if len(scene.get("body", {})) != 1 or "solid" in scene:
            raise candidate.Refused("not a scene with one shaft")
        (self.name, self.body), = scene["body"].items()
        beam = self.beam = self.body.get("beam", {})
        if not beam or "mesh" in beam or beam["internal_damping"]:
            raise candidate.Refused("no shaft of beams, or internal damping")
        self.bearings = scene.get("bearing", {})
        self.springs = scene.get("spring", {})
        loose = [of for of in self.bearings.values() if of["outer_on"] != "outer_race" or of["reversed"]]
        if loose or any("to_at" not in spring or "damping" in spring for spring in self.springs.values()):
            raise candidate.Refused("bearings and springs between shaft and ground alone")
        places = [of["at"] for key in ("disc", "load", "unbalance", "probe") for of in beam.get(key, [])]
        places += [of["inner_at"] for of in self.bearings.values()] + [of["to_at"] for of in self.springs.values()]
        self.mesh(places)
        self.contacts = {
            name: candidate.Bearing("statics", {"bearing": of, "ball_forces": scene.get("ball_forces", {}),
                                                "outer_race": scene.get("outer_race", {}).get(name, {})})
            for name, of in self.bearings.items()}
        self.speed = final(self.body.get("speed", 0.0))

    def mesh(self, places):
        beam, at = self.beam, [self.beam["start"]]
        sections = []
        for segment in beam["segments"]:
            first, last = at[-1], at[-1] + segment["length"]
            stops = sorted({first, last, *(place for place in places if first + 1e-9 < place < last - 1e-9)})
            for start, end in zip(stops, stops[1:]):
                count = int(np.ceil((end - start) / LONGEST - 1e-9))
                at += list(start + (end - start) * np.arange(1, count + 1) / count)
                sections += [segment] * count
        self.at, size = np.array(at), 5 * len(at)
        self.stiffness, self.mass, self.gyroscopic = (np.zeros((size, size)) for _ in range(3))
        self.elements = []
        for first, section in enumerate(sections):
            of = element(beam, section, at[first + 1] - at[first])
            n = 5 * first
            along = [n, n + 5]
            # Both planes with their signs: slopes are w' = tilt_z and w' = -tilt_y.
            planes = [([n + 1, n + 4, n + 6, n + 9], np.ones(4)), ([n + 2, n + 3, n + 7, n + 8], np.array([1, -1, 1, -1.0]))]
            self.elements.append((of, along, planes))
            for plane, sign in planes:
                self.stiffness[np.ix_(plane, plane)] += of["bending"] * np.outer(sign, sign)
                self.mass[np.ix_(plane, plane)] += (of["mass"] + of["rotary"]) * np.outer(sign, sign)
            (y, _), (z, sign) = planes
            self.gyroscopic[np.ix_(y, z)] += 2 * of["rotary"] * sign
            self.gyroscopic[np.ix_(z, y)] -= 2 * of["rotary"] * sign[:, None]
            self.stiffness[np.ix_(along, along)] += of["stiff"] / of["length"] * np.array([[1, -1], [-1, 1]])
            self.mass[np.ix_(along, along)] += of["heavy"] * of["length"] / 6 * np.array([[2, 1], [1, 2]])
        for disc in beam.get("disc", []):
            n = self.node(disc["at"])
            if "mass" in disc:
                mass, axial, transverse = (disc.get(key, 0.0) for key in ("mass", "axial", "transverse"))
            else:
                outer, inner, width = (disc[key] for key in ("outer_diameter", "inner_diameter", "width"))
                mass = beam["density"] * np.pi / 4 * (outer**2 - inner**2) * width
                axial, transverse = mass / 8 * (outer**2 + inner**2), mass / 16 * (outer**2 + inner**2) + mass * width**2 / 12
            self.mass[range(n, n + 5), range(n, n + 5)] += [mass] * 3 + [transverse] * 2
            self.gyroscopic[n + 3, n + 4] += axial
            self.gyroscopic[n + 4, n + 3] -= axial
        for spring in self.springs.values():
            n, stiffness = self.node(spring["to_at"]), spring["stiffness"]
            for i, key in enumerate(COORDINATES):
                self.stiffness[n + i, n + i] += stiffness[TURNS[key]]
            if stiffness["yz"] or stiffness["zy"]:
                raise candidate.Refused("circulatory springs")
        # Rigid motions about the centre of mass, and the motion of the body as their mean over its mass.
        rigid = np.zeros((size, 5))
        for i in range(5):
            rigid[i::5, i] = 1
        centre = rigid[:, 1] @ self.mass @ (rigid[:, 1] * np.repeat(self.at, 5)) / (rigid[:, 1] @ self.mass @ rigid[:, 1])
        rigid[2::5, 3], rigid[1::5, 4] = centre - self.at, self.at - centre
        self.mean = np.linalg.solve(rigid.T @ self.mass @ rigid, rigid.T @ self.mass)

    def node(self, place):
        return 5 * int(np.argmin(abs(self.at - place)))

    def internal(self, q):
        """Forces of shaft, springs and bearings, and their derivative: axial force EA (u' + the mean of w'w'/2)."""
        forces, tangent = self.stiffness @ q, self.stiffness.copy()
        for of, along, planes in self.elements:
            slopes = [sign * (of["slopes"] @ (sign * q[plane])) for plane, sign in planes]
            bent = sum(q[plane] @ slope for (plane, _), slope in zip(planes, slopes)) / 2 / of["length"]
            axial = of["stiff"] * ((q[along[1]] - q[along[0]]) / of["length"] + bent)
            forces[along] += of["stiff"] * bent * np.array([-1, 1])
            dofs = along + planes[0][0] + planes[1][0]
            stretched = np.concatenate([[-1, 1], *slopes]) / of["length"]
            straight = np.concatenate([[-1, 1], np.zeros(8)]) / of["length"]
            change = of["stiff"] * of["length"] * (np.outer(stretched, stretched) - np.outer(straight, straight))
            for i, ((plane, sign), slope) in enumerate(zip(planes, slopes)):
                forces[plane] += axial * slope
                own = slice(2 + 4 * i, 6 + 4 * i)
                change[own, own] += axial * of["slopes"] * np.outer(sign, sign)
            tangent[np.ix_(dofs, dofs)] += change
        for name, bearing in self.contacts.items():
            own = self.node(self.bearings[name]["inner_at"]) + np.arange(5)
            _, loads, stiffness, _ = bearing.condensed(q[own])
            forces[own] += loads
            tangent[np.ix_(own, own)] += stiffness
        return forces, tangent

    def equilibrium(self):
        """Newton's method with short steps, and at first with springs to the ground that fade."""
        loads = np.array([start(self.body.get(key, {}).get("load", self.body.get(key, {}).get("moment", 0.0))) for key in COORDINATES])
        outer = self.mean.T @ loads
        for load in self.beam.get("load", []):
            outer[self.node(load["at"]) + np.arange(3)] += [start(load.get(axis, 0.0)) for axis in "xyz"]
        q = np.zeros(len(outer))
        for count in range(200 if outer.any() or self.contacts else 0):
            forces, tangent = self.internal(q)
            ground = 1e6 * 0.3**count
            step = np.linalg.solve(tangent + (self.mass * ground if ground > 1 else 0.0), outer - forces)
            largest = abs(step).max()
            q += step * min(1.0, 2e-5 / largest) if count < 60 else step
            if largest < 1e-14 and ground < 1:
                break
        return q, loads, self.internal(q)[1]


def start(profile):
    """Value at t = 0."""
    return profile["ramp"][0] if isinstance(profile, dict) and "ramp" in profile else number(profile)


def final(profile):
    return profile["ramp"][1] if isinstance(profile, dict) and "ramp" in profile else number(profile)


def number(value):
    if isinstance(value, dict):
        raise candidate.Refused("a profile over time")
    return value


def modes(shaft):
    _, _, stiffness = shaft.equilibrium()
    squares, shapes = scipy.linalg.eigh((stiffness + stiffness.T) / 2, shaft.mass, subset_by_index=[0, min(KEPT, len(stiffness)) - 1])
    if "displacement" in shaft.body.get("x", {}):
        along = [shape[::5] @ shaft.mass[::5, ::5] @ shape[::5] for shape in shapes.T]
        moved = np.arange(len(squares)) != np.argmin(np.where(np.array(along) > 0.5, abs(squares), np.inf))
        squares, shapes = squares[moved], shapes[:, moved]
    gyroscopic, count = shapes.T @ shaft.gyroscopic @ shapes, len(squares)
    damping = shaft.beam["damping"] * np.eye(count) if shaft.beam["damped_motion"] == "absolute" else np.zeros((count, count))
    y, z = (np.sort(np.concatenate([np.arange(i, len(stiffness), 5) for i in of])) for of in ((1, 4), (2, 3)))
    signs = np.tile([1.0, -1.0], len(shaft.at))
    plane = shaft.mass[np.ix_(y, y)]

    def seen(vector):
        """Direction, and the share of the motion along the axis."""
        shape = shapes @ vector
        forward, backward = ((shape[y] + i * signs * shape[z]) / 2 for i in (1j, -1j))
        forward, backward = ((of.conj() @ plane @ of).real for of in (forward, backward))
        along = (shape[::5].conj() @ shaft.mass[::5, ::5] @ shape[::5]).real
        whole = along + 2 * (forward + backward)
        return 2 * (forward - backward) / whole, along / whole

    def whirl(speed):
        matrix = np.block([[np.zeros((count, count)), np.eye(count)], [-np.diag(squares), -damping - speed * gyroscopic]])
        found = []
        roots, vectors = np.linalg.eig(matrix)
        for root, vector in zip(roots, vectors.T):
            if root.imag > 1e-3:
                direction, along = seen(vector[:count])
                if along < AXIAL:
                    found.append((root.imag / 2 / np.pi, direction if speed else 0.0, -root.real / abs(root)))
        return sorted(found)

    critical = []
    inverses, vectors = scipy.linalg.eigh(np.eye(count) - 1j * gyroscopic, np.diag(squares))
    for inverse, vector in zip(inverses, vectors.T):
        if inverse > 0:
            speed, (direction, along) = inverse**-0.5, seen(vector)
            if speed <= 2 * shaft.speed and along < AXIAL:
                critical.append((speed, direction))
    listed = [{"mode": i + 1, "frequency": value(np.sqrt(max(square, 0.0)) / 2 / np.pi, "Hz")} for i, square in enumerate(squares)]
    summary = {"kind": "natural modes of bodies", "modes": listed[: count // 2], "rotor": {
        "speed": value(shaft.speed, "rad/s"),
        "whirl": [{"frequency": value(f, "Hz"), "direction": value(d, "1"), "damping_ratio": value(r, "1")}
                  for f, d, r in whirl(shaft.speed)],
        "critical_speeds": [{"speed": value(s, "rad/s"), "direction": value(d, "1")} for s, d in sorted(critical)]}}
    header = ["speed [rad/s]"]
    for line in range(1, 9):
        header += [f"frequency_{line} [Hz]", f"direction_{line} [1]", f"damping_ratio_{line} [1]"]
    speeds = np.linspace(0.0, shaft.speed, 51)
    return summary, [header] + [[speed, *np.ravel(whirl(speed)[:8])] for speed in speeds]


def statics(shaft):
    q, loads, tangent = shaft.equilibrium()
    places = [of["inner_at"] for of in shaft.bearings.values()]
    places += [of["at"] for key in ("probe", "load", "unbalance") for of in shaft.beam.get(key, [])]
    sections = [coordinates(q[shaft.node(place) + np.arange(5)], "m", "rad") for place in places]
    bearings, rows = {}, []
    for name, bearing in shaft.contacts.items():
        own = q[shaft.node(shaft.bearings[name]["inner_at"]) + np.arange(5)]
        held = {key: {"tilt" if "tilt" in key else "displacement": of} for key, of in zip(COORDINATES, own)}
        summary, balls = candidate.statics({"inner_race": held}, bearing)
        for race, place in (("inner_race", own[:3]), ("outer_race", bearing.centre)):
            summary[race]["centre"] = candidate.vector(place, "m")
        for key in ("position", "loads"):
            del summary["inner_race"][key]
        bearings[name] = {key: of for key, of in summary.items() if key not in ("kind", "determinacy", "stiffness")}
        rows += [{"bearing [1]": len(bearings), **ball} for ball in balls]
    summary = {
        "kind": "static solution", "determinacy": {"kind": "determinate"},
        "bodies": {shaft.name: {"position": coordinates(shaft.mean @ q, "m", "deg", 1 / DEGREE), "loads": coordinates(loads, "N", "N m")}},
        "sections": sections, "bearings": bearings,
        "stiffness": {"coordinates": [f"{shaft.name}.{key}" for key in COORDINATES], "unit": "N, N m over m, rad",
                      "matrix": np.linalg.inv(shaft.mean @ np.linalg.solve(tangent, shaft.mean.T)).tolist()}}
    summary |= {key: {name: of.pop(key) for name, of in bearings.items()} for key in ("hertz", "geometry")}
    return summary, [list(rows[0])] + [list(row.values()) for row in rows]


def main(kind, resolved, out):
    if kind not in ("statics", "modes") or resolved.endswith(".toml"):
        raise candidate.Refused(kind)
    shaft, out = Shaft(json.loads(Path(resolved).read_text())), Path(out)
    summary, table = (modes if kind == "modes" else statics)(shaft)
    out.mkdir(parents=True, exist_ok=True)
    name = "campbell.csv" if kind == "modes" else "series.csv"
    lines = [table[0]] + [[str(float(number)) for number in row] for row in table[1:]]
    (out / name).write_text("".join(",".join(line) + "\n" for line in lines))
    (out / "summary.json").write_text(json.dumps(summary, indent=2))


if __name__ == "__main__":
    try:
        main(*sys.argv[1:4])
    except candidate.Refused as reason:
        print(f"{reason} is not claimed", file=sys.stderr)
        sys.exit(3)
