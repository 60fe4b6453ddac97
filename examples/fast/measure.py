"""Speed and accuracy of `fast batch` against `bearing sweep`, side by side.

Usage: python measure.py BEARING FAST [--points 100000] [--runs 1000] [--repeats 2] [--threads 2]

Both programs solve the same grids on the same number of threads, in turn. Times are those of whole commands,
reading and writing included; processor times depend less on other load. Standard library only.
"""

import argparse
import csv
import json
import math
import os
import resource
import subprocess
import tempfile
import time
from pathlib import Path

STEEL = {"youngs_modulus": "210 GPa", "poisson_ratio": 0.3, "density": "7850 kg/m^3"}
DEGREE = math.pi / 180.0


def bearing(hertz="exact"):
    """Deep-groove bearing 6205."""
    return {
        "kind": "deep-groove", "balls": 9, "hertz": hertz, "ball_phase": "0 deg",
        "clearance": {"radial": "5 um", "through": "outer-race"},
        "inner_race": {"radius": "15.281 mm", "groove_radius": "4.12776 mm", "material": STEEL},
        "outer_race": {"radius": "23.224 mm", "groove_radius": "4.12776 mm", "material": STEEL},
        "ball": {"radius": "3.969 mm", "material": STEEL},
    }


RADIAL = {"bearing": bearing(), "inner_race": {"x": {"load": "0 N"}, "y": {"load": "0 N"}, "z": {"load": "-2000 N"},
                                               "tilt_y": {"tilt": "0 deg"}, "tilt_z": {"tilt": "0 deg"}}}
FIVE = {"bearing": bearing("hamrock-brewe"), "inner_race": {
    "x": {"load": "500 N"}, "y": {"load": "100 N"}, "z": {"load": "-2000 N"},
    "tilt_y": {"moment": "2 N m"}, "tilt_z": {"moment": "-1 N m"}}}
SPINNING = FIVE | {"inner_race": FIVE["inner_race"] | {"speed": "10000 rpm"},
                   "ball_forces": {"centrifugal": True, "gravity": ["0 m/s^2", "0 m/s^2", "-9.81 m/s^2"]}}
GRID = [("inner_race.z.load", -500, -4000, "N"), ("bearing.clearance.radial", -5, 10, "um"), ("bearing.ball_phase", 0, 39, "deg")]


def running(**numerics):
    """Preloaded bearing in motion, without traction and cage."""
    return {
        "bearing": bearing() | {"clearance": {"radial": "-5 um", "through": "outer-race"}},
        "inner_race": RADIAL["inner_race"] | {
            "z": {"load": "-150 N"}, "speed": "3000 rpm",
            "inertia": {"mass": "0.12 kg", "axial": "4.2e-5 kg m^2", "transverse": "2.6e-5 kg m^2"}},
        "traction": {"law": "none"}, "contact_damping": {"law": "hunt-crossley", "alpha": "0.2 s/m"},
        "ball_contact": {"law": "none"},
        "numerics": {"end": "5 ms", "output_interval": "20 us", "start": "nominal"} | numerics,
        "output": {"plots": [], "window_start": "0 s"},
    }


RUN_GRID = [("inner_race.z.load", -50, -300, "N"), ("bearing.clearance.radial", -6, -3, "um"), ("bearing.ball_phase", 0, 39, "deg")]


BALL_LOADS = tuple(f"ball_{ball}_{race}_load" for ball in range(1, 10) for race in ("inner", "outer"))


SI = {"um": 1e-6, "mm": 1e-3, "us": 1e-6, "ms": 1e-3, "deg": DEGREE, "rpm": math.pi / 30.0, "GPa": 1e9}


def in_si(node):
    """Texts such as "5 um" as numbers in SI units."""
    if isinstance(node, dict):
        return {key: in_si(item) for key, item in node.items()}
    if isinstance(node, list):
        return [in_si(item) for item in node]
    number, _, unit = node.partition(" ") if isinstance(node, str) else ("", "", "")
    return float(number) * SI.get(unit, 1.0) if unit else node


def counts(points):
    """Three counts whose product is about `points`."""
    side = max(2, round((points / 2.0) ** (1.0 / 3.0)))
    return side, side, max(2, round(points / side**2))


class Programs:
    def __init__(self, options, folder):
        self.bearing, self.fast, self.threads, self.folder = options.bearing, options.fast, options.threads, Path(folder)

    def timed(self, command):
        start, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL,
                       env=os.environ | {"RAYON_NUM_THREADS": str(self.threads)})
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return time.perf_counter() - start, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def reference(self, scene, grid, of):
        """Wall and processor time, and table, of `bearing sweep`."""
        (self.folder / "scene.json").write_text(json.dumps(scene))
        out = self.folder / f"reference-{of}"
        vary = [text for key, low, high, unit, count in grid for text in ("--vary", f"{key}={low} {unit} .. {high} {unit} / {count}")]
        spent = self.timed([self.bearing, "sweep", self.folder / "scene.json", "--of", of, "--out", out, "--fresh",
                            "--threads", str(self.threads), *vary])
        name = "sweep.csv" if of == "statics" else "series.csv"
        return spent, list(csv.DictReader(open(out / name)))

    def candidate(self, scene, grid, of):
        """Wall and processor time, and table, of `fast batch`."""
        vary = [{"key": key, "from": low * SI.get(unit, 1.0), "to": high * SI.get(unit, 1.0), "count": count}
                for key, low, high, unit, count in grid]
        kind = "statics" if of == "statics" else "run"
        batch = {"scene": in_si(scene), "of": kind, "vary": vary, "balls": False}
        (self.folder / "batch.json").write_text(json.dumps(batch))
        spent = self.timed([self.fast, "batch", self.folder / "batch.json", self.folder / "fast.csv"])
        return spent, list(csv.DictReader(open(self.folder / "fast.csv")))


UNITS = {"um": ("m", 1e-6), "deg": ("rad", DEGREE), "MPa": ("Pa", 1e6)}


def deviations(reference, table):
    """Largest difference and largest value of each shared channel, in SI units; mirrored positions count as equal."""
    found = {}
    for column in reference[0]:
        name, unit = column.split(" [")[0], column.split("[")[-1].rstrip("]")
        other, factor = UNITS.get(unit, (unit, 1.0))
        column_of_table = f"{name} [{other}]"
        if column_of_table not in table[0] or name in ("point", "load_zone", "warnings"):
            continue
        pairs = [(float(r[column]) * factor, float(t[column_of_table])) for r, t in zip(reference, table)]
        found[name] = max(abs(a - b) for a, b in pairs), max(abs(a) for a, _ in pairs)
    return found


def worst(found, *parts):
    """Largest difference over channels whose name starts with one of `parts`, and the largest value of those channels."""
    chosen = [pair for name, pair in found.items() if name.startswith(parts)]
    return max((e for e, _ in chosen), default=0.0), max((v for _, v in chosen), default=0.0)


def report(label, points, pairs):
    reference, fast = [min(time for time, _ in times) for times in zip(*pairs)]
    wall = ", ".join(f"{r[0] / f[0]:.1f}" for r, f in pairs)
    processor = ", ".join(f"{r[1] / f[1]:.1f}" for r, f in pairs)
    print(f"{label}: {points} points; bearing {points / reference:.0f}/s, fast {points / fast:.0f}/s; "
          f"ratios of wall time {wall}, of processor time {processor}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bearing")
    parser.add_argument("fast")
    for name, default in (("points", 100_000), ("runs", 1000), ("repeats", 2), ("threads", 2)):
        parser.add_argument(f"--{name}", type=int, default=default)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        programs = Programs(options, folder)
        for label, scene in (("radial load, 3 free coordinates", RADIAL), ("five loads", FIVE), ("five loads, weight, centrifugal force", SPINNING)):
            grid = [(*axis, count) for axis, count in zip(GRID, counts(options.points))]
            pairs = []
            for _ in range(options.repeats):
                slow, reference = programs.reference(scene, grid, "statics")
                quick, table = programs.candidate(scene, grid, "statics")
                pairs.append((slow, quick))
            report(label, len(table), pairs)
            found = deviations(reference, table)
            state = {status: sum(row["status [1]"] == status for row in table) for status in "012"}
            print("  status", state)
            for title, parts in (("position, m", ("x", "y", "z")), ("tilt, rad", ("tilt_y", "tilt_z")),
                                 ("ball load, N", ("largest_inner_load", "largest_outer_load"))):
                named = {key: pair for key, pair in found.items() if key in parts}
                print("  {}: largest difference {:.1e} of {:.1e}".format(title, *worst(named, *parts)))
        grid = [(*axis, count) for axis, count in zip(RUN_GRID, counts(options.runs))]
        few = [(*axis, count) for axis, count in zip(RUN_GRID, (2, 2, 4))]
        fixed, default = {"integrator": "rk4", "step": "1 us"}, {}
        _, exact = programs.reference(running(integrator="dormand-prince", accuracy=1e-8), few, "runs")
        for label, numerics in (("runs, both rk4 with 1 us", fixed), ("runs, bearing with its defaults, fast rk4 with 1 us", default)):
            pairs = []
            for _ in range(options.repeats):
                slow, reference = programs.reference(running(**numerics), grid, "runs")
                quick, table = programs.candidate(running(**fixed), grid, "runs")
                pairs.append((slow, quick))
            report(label, len(table), pairs)
            print("  between the programs, ball load, N: largest difference {:.1e} of {:.1e}".format(*worst(deviations(reference, table), *BALL_LOADS)))
            for name, solve, settings in (("bearing", programs.reference, numerics), ("fast", programs.candidate, fixed)):
                found = deviations(exact, solve(running(**settings), few, "runs")[1])
                for title, parts in (("position of the race, m", ("inner_x", "inner_y", "inner_z")), ("ball load, N", BALL_LOADS)):
                    print("  {}, {}: largest error {:.1e} of {:.1e}".format(name, title, *worst(found, *parts)))


if __name__ == "__main__":
    main()
