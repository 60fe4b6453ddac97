"""A stepped, hollow, overhung rotor on two unlike bearings in ROSS: eigenvalues over speed, response to an unbalance, a run-up.

pip install ross-rotordynamics "plotly<6"; python rotor.py kept.json
("-" prints it as the last line.)
"""

import json
import re
import sys

import numpy
import ross
import scipy.linalg

ELEMENT = 0.01
# Length, outer and inner diameter, m.
SEGMENTS = [(0.05, 0.03, 0.0), (0.2, 0.04, 0.01), (0.15, 0.035, 0.01), (0.1, 0.025, 0.0)]
# Place, m; mass, kg; axial and transverse inertia, kg m2.
DISCS = [(0.25, 8.0, 0.05, 0.03), (0.5, 3.0, 0.02, 0.011)]
# Place, m; stiffness, N/m, and damping, N s/m, along the first and second lateral axis.
BEARINGS = [(0.05, 4e7, 7e7, 500.0, 800.0), (0.4, 6e7, 9e7, 700.0, 700.0)]
# Place, m; kg m.
UNBALANCE = (0.25, 1e-3)
SPEEDS = [0.0, 100.0, 200.0, 300.0, 400.0, 500.0, 750.0, 1000.0, 1500.0, 2000.0]
MODES = 8
# From rest at a constant rate: end, s; speed there, rad/s; kg m; Newmark step and interval of rows, s; places, m.
RUN_UP = {"end": 0.5, "top": 2600.0, "unbalance": 1e-5, "step": 1e-5, "interval": 1e-2, "places": [0.25, 0.5]}
# Interval at which the largest distance is sought, s.
PEAK_INTERVAL = 5e-4


def node(place):
    return round(place / ELEMENT)


def rotor():
    steel = ross.Material(name="Steel", rho=7850.0, E=210e9, Poisson=0.3)
    shaft = []
    for length, outer, inner in SEGMENTS:
        shaft += [
            ross.ShaftElement(L=ELEMENT, idl=inner, odl=outer, material=steel)
            for _ in range(node(length))
        ]
    discs = [ross.DiskElement(n=node(at), m=m, Ip=ip, Id=it) for at, m, ip, it in DISCS]
    bearings = [
        ross.BearingElement(n=node(at), kxx=kx, kyy=ky, cxx=cx, cyy=cy)
        for at, kx, ky, cx, cy in BEARINGS
    ]
    return ross.Rotor(shaft, discs, bearings)


def lateral_modes(rotor, speed):
    """Eigenvalues of ROSS' matrices over the lateral coordinates, those with a positive imaginary part, ascending."""
    count = rotor.ndof // 6
    lateral = [6 * node + i for node in range(count) for i in (0, 1, 3, 4)]
    cut = numpy.ix_(lateral, lateral)
    m, k = rotor.M(speed)[cut], rotor.K(speed)[cut]
    c = rotor.C(speed)[cut] + speed * rotor.G()[cut]
    inverse = numpy.linalg.inv(m)
    zero, unit = numpy.zeros_like(m), numpy.eye(len(m))
    values = scipy.linalg.eigvals(numpy.block([[zero, unit], [-inverse @ k, -inverse @ c]]))
    found = sorted((value.imag, value.real) for value in values if value.imag > 1.0)
    return [[re, im] for im, re in found[:MODES]]


def run_up(rotor, driven_along_x):
    """Displacements (m) along both lateral axes at the places, a row each PEAK_INTERVAL. A drive torque along X exerts a moment on tilted discs
    that accelerate; a torque along each section's own axis does not."""
    end, step = RUN_UP["end"], RUN_UP["step"]
    rate = RUN_UP["top"] / end
    time = numpy.arange(round(end / step) + 1) * step
    speed, angle = rate * time, 0.5 * rate * time**2
    force = numpy.zeros((len(time), rotor.ndof))
    first = 6 * node(UNBALANCE[0])
    out, back = RUN_UP["unbalance"] * speed**2, RUN_UP["unbalance"] * rate
    force[:, first] = out * numpy.cos(angle) + back * numpy.sin(angle)
    force[:, first + 1] = out * numpy.sin(angle) - back * numpy.cos(angle)
    of_acceleration = rotor.Ksdt() * (1.0 if driven_along_x else 0.0)
    _, moved = rotor.integrate_system(speed, force, time, Ksdt=of_acceleration)
    every = round(PEAK_INTERVAL / step)
    columns = [6 * node(place) + i for place in RUN_UP["places"] for i in (0, 1)]
    return moved[::every, columns]


def digits(value):
    return float(f"{value:.6e}")


def peaks(rows):
    return [digits(max(numpy.hypot(rows[:, 2 * i], rows[:, 2 * i + 1]))) for i in (0, 1)]


def main():
    of = rotor()
    result = {"version": ross.__version__, "speeds": SPEEDS}
    result["eigenvalues"] = [lateral_modes(of, speed) for speed in SPEEDS]
    at, moment = UNBALANCE
    response = of.run_unbalance_response(
        node(at), moment, 0.0, frequency=numpy.array(SPEEDS[1:])
    )
    amplitude = numpy.abs(response.forced_resp)
    result["response"] = [
        {
            "at": place,
            "first": amplitude[6 * node(place)].tolist(),
            "second": amplitude[6 * node(place) + 1].tolist(),
        }
        for place in (0.05, 0.25, 0.5)
    ]
    rows = run_up(of, False)
    every = round(RUN_UP["interval"] / PEAK_INTERVAL)
    result["run_up"] = RUN_UP | {
        "rows": [[digits(value) for value in row] for row in rows[::every]],
        "peaks": peaks(rows),
        "peak_driven_along_x": peaks(run_up(of, True))[0],
    }
    if sys.argv[1] == "-":
        # The last line: its imports print lines of their own.
        print(json.dumps(result))
        return
    with open(sys.argv[1], "w") as file:
        text = json.dumps(result, indent=1)
        # A list of numbers a line.
        listed = lambda found: "[" + re.sub(r",\s+", ", ", found[1]) + "]"
        file.write(re.sub(r"\[\s+(?=[-\d])([^\[\]]*?)\s+\]", listed, text) + "\n")


main()
