"""Checks the FMU with FMPy: python check.py BEARING MAKE_FMU

1. The FMU is valid and has no variable that its library does not know.
2. Forces on a prescribed path of the inner race converge to those of `bearing run` with the second order in the
   communication step.
3. A mass on the inner race, integrated here, moves as the race of `bearing run` does, with the first order.
4. A state restored, also from bytes and in another instance, gives the same bits; an input must be finite.
"""

import csv
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

SCENE = Path(__file__).with_name("bearing.toml")
BEARING, MAKE_FMU = sys.argv[1:3]
FOLDER = Path(tempfile.mkdtemp())
END = 4e-3
MASS, PULL = 20.0, -800.0
FORCES = [f"inner.force.{axis}" for axis in "yz"]


class Fmu:
    """An instance in step mode, with variables by name."""

    def __init__(self, path, inputs, start=0.0):
        self.description = read_model_description(path)
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.time = start
        self.slave = FMU3Slave(
            guid=self.description.guid,
            unzipDirectory=extract(path),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName="bearing",
        )
        self.slave.instantiate()
        self.slave.enterInitializationMode(startTime=start)
        self.set(inputs)
        self.slave.exitInitializationMode()

    def set(self, values):
        references = [self.references[name] for name in values]
        self.slave.setFloat64(references, [float(value) for value in values.values()])

    def get(self, names):
        return np.array(self.slave.getFloat64([self.references[name] for name in names]))

    def step(self, size):
        self.slave.doStep(self.time, size)
        self.time += size


def native(name):
    """Columns of a run of a scene beside this file."""
    out = FOLDER / name
    command = [BEARING, "run", SCENE.with_name(f"{name}.toml"), "--out", out]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(out / "series.csv", newline="") as file:
        rows = list(csv.reader(file))
    columns = np.array(rows[1:], dtype=float).T
    return {head.split(" [")[0]: column for head, column in zip(rows[0], columns)}


def orbit(t):
    """Inputs on the path of orbit.toml, which begins at rest."""
    inputs = {}
    for axis, amplitude, frequency in (("y", 2e-6, 300.0), ("z", 1e-6, 500.0)):
        w = 2 * math.pi * frequency
        inputs[f"inner.position.{axis}"] = amplitude * (1 - math.cos(w * t))
        inputs[f"inner.velocity.{axis}"] = amplitude * w * math.sin(w * t)
    return inputs


def on_orbit(fmu, count, step):
    """Forces after every 100 us. Races move at the mean rate of the step, which ends at the next position."""
    rows = [fmu.get(FORCES)]
    for i in range(count):
        now, next = orbit(fmu.time), orbit(fmu.time + step)
        for axis in "yz":
            at = f"inner.position.{axis}"
            fmu.set({at: now[at], f"inner.velocity.{axis}": (next[at] - now[at]) / step})
        fmu.step(step)
        if (i + 1) % round(1e-4 / step) == 0:
            rows.append(fmu.get(FORCES))
    return np.array(rows).T


def with_mass(path, step):
    """Positions after every 100 us, by velocity Verlet: the mean velocity of a step is its rate."""
    z, v = 0.0, 0.0
    fmu = Fmu(path, {"inner.position.z": z})
    push = fmu.get(FORCES)[1] + PULL
    rows = [z]
    for i in range(round(END / step)):
        half = v + 0.5 * step * push / MASS
        fmu.set({"inner.position.z": z, "inner.velocity.z": half})
        fmu.step(step)
        z += step * half
        push = fmu.get(FORCES)[1] + PULL
        v = half + 0.5 * step * push / MASS
        if (i + 1) % round(1e-4 / step) == 0:
            rows.append(z)
    return np.array(rows)


def converge(what, errors, steps, order, limit):
    found = math.log(errors[0] / errors[-1]) / math.log(steps[0] / steps[-1])
    print(f"{what}: error {errors[0]:.2e} and {errors[-1]:.2e} of the largest, order {found:.2f}")
    assert found >= order, found
    assert errors[-1] <= limit, errors


def main():
    path = FOLDER / "bearing.fmu"
    subprocess.run([MAKE_FMU, SCENE, path], check=True)
    problems = validate_fmu(path)
    assert problems == [], problems

    run = native("orbit")
    expected = np.array([run[f"contact_force_on_inner_{axis}"] for axis in "yz"])
    steps = [2e-5, 1e-5]
    errors = []
    for step in steps:
        fmu = Fmu(path, orbit(0.0) | {"inner.speed": 0.0})
        forces = on_orbit(fmu, round(END / step), step)
        errors.append(np.abs(forces - expected).max() / np.abs(expected).max())
    converge("prescribed path, forces", errors, steps, 1.8, 5e-4)

    # Friction sees a speed that changes in steps: first order.
    run = native("mass")
    steps = [5e-5, 1e-5]
    errors = []
    for step in steps:
        z = with_mass(path, step)
        errors.append(np.abs(z - run["inner_z"]).max() / np.abs(run["inner_z"]).max())
    converge("mass on the inner race, position", errors, steps, 1.0, 1e-3)

    step = 2e-5
    fmu = Fmu(path, orbit(0.0), start=0.5)
    fmu.time = 0.5
    on_orbit(fmu, 20, step)
    time, state = fmu.time, fmu.slave.getFMUState()
    kept = fmu.slave.serializeFMUState(state)
    first = on_orbit(fmu, 20, step)
    fmu.time = time
    fmu.slave.setFMUState(state)
    assert (on_orbit(fmu, 20, step) == first).all()
    other = Fmu(path, {})
    other.time = time
    other.slave.setFMUState(other.slave.deserializeFMUState(kept))
    assert (on_orbit(other, 20, step) == first).all()
    fmu.slave.freeFMUState(state)
    try:
        fmu.set({"inner.position.x": math.nan})
    except FMICallException:
        pass
    else:
        raise AssertionError("a position that is no number was taken")
    print("a restored state gives the same bits, in another instance too")


main()
