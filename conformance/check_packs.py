"""Checks that a pack tests what its tags name, and nothing that another program could not meet.

    python check_packs.py SET BEARING

A change of `resolved.json` that belongs to a tag must fail the pack. A change of the size of rounding, and a finer
accuracy, must pass.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

# Tag -> top-level tables, keys in and below them, factor.
CHANGES = {
    "accelerometer": ("sensor", ["angle"], 1.1),
    "beam": ("body", ["youngs_modulus"], 1.1),
    "bushing-springs": ("spring", ["length"], 1.1),
    "cage": ("bearing", ["mass"], 1.1),
    "cage-mesh": ("solid", ["density"], 1.1),
    "centrifugal": ("inner_race", ["speed"], 1.1),
    "clearance": ("bearing", ["radial", "diametral"], 1.1),
    "damping": ("contact_damping", ["alpha"], 1.1),
    "dent": ("bearing", ["depth"], 1.1),
    "gravity": ("ball_forces", ["gravity"], 1.1),
    "gyroscopic": ("body", ["axial"], 0.95),
    "hertz-exact": ("bearing", ["groove_radius", "conformity", "osculation"], 1.001),
    "hertz-fit": ("bearing", ["groove_radius", "conformity", "osculation"], 1.001),
    "housing-explicit": ("solid", ["youngs_modulus", "density"], 1.1),
    "housing-modes": ("solid", ["density"], 1.1),
    "housing-quasi-static": ("solid", ["youngs_modulus"], 1.1),
    "housing-static": ("solid", ["youngs_modulus"], 1.1),
    "impact": ("inner_race", ["half_sine"], 1.1),
    "life": ("inner_race", ["load"], 1.01),
    "motion": ("inner_race", "body", ["load", "moment", "half_sine", "displacement", "amplitude", "force", "speed", "ramp", "fit"], 1.1),
    "pockets": ("bearing", ["pocket_radius"], 1.001),
    "rigid-shaft": ("body", ["mass", "load", "moment"], 1.1),
    "rotating-load": ("inner_race", ["force", "phase", "speed"], 1.1),
    "rubber-dynamic": ("solid", ["gamma"], 1.1),
    "rubber-static": ("solid", ["rubber_modulus"], 1.1),
    "shaft-of-elements": ("body", ["youngs_modulus"], 1.1),
    "solid-explicit": ("solid", ["density"], 1.1),
    "solid-modes": ("solid", ["density"], 1.1),
    "solid-static": ("solid", ["youngs_modulus"], 1.1),
    "spall": ("bearing", ["length"], 1.1),
    "spall-sides": ("bearing", ["width"], 1.1),
    "spin": ("solid", ["spin"], 1.1),
    "springs": ("spring", ["y", "z"], 1.1),
    "telemeter": ("sensor", ["distance", "offset"], 1.1),
    "traction": ("traction", ["b", "d", "coefficient"], 1.1),
    "unbalance": ("body", ["size"], 1.1),
    "whirl": ("body", ["youngs_modulus", "mass"], 1.1),
}


# Parts of results that repeat the input.
ECHOES = ("body_inertia", "geometry", "mass")


def scale(value, keys, factor):
    """Multiplies the numbers and lists of numbers of these keys; returns whether there is one that is not zero."""
    found = False
    if isinstance(value, list):
        return any([scale(item, keys, factor) for item in value])
    if not isinstance(value, dict):
        return False
    for key, item in value.items():
        numbers = item if isinstance(item, list) else [item]
        plain = all(isinstance(of, (int, float)) and not isinstance(of, bool) for of in numbers)
        if key in keys and plain and any(numbers):
            value[key] = [of * factor for of in numbers] if isinstance(item, list) else item * factor
            found = True
        else:
            found |= scale(item, keys, factor)
    return found


def tagged(about, scene):
    """Changed scenes that must fail: name of the change, scene; `None` where there is nothing to change."""
    for tag in about["tags"]:
        if tag not in CHANGES:
            continue
        changed = json.loads(json.dumps(scene))
        *names, keys, factor = CHANGES[tag]
        tables = [changed.get(name) for name in names]
        if tag == "clearance" and not scale(changed["bearing"], keys, 1.0):
            # It follows from the sizes.
            tables, keys, factor = [changed["bearing"].get("outer_race")], ["radius"], 1.00001
        any_found = any([scale(table, keys, factor) for table in tables])
        yield f"{tag}: {', '.join(keys)} times {factor}", changed if any_found else None


def alike(scene):
    """Changed scenes that must pass."""
    for keys, factor in [(["density", "youngs_modulus"], 1 + 3e-13), (["accuracy"], 0.2)]:
        changed = json.loads(json.dumps(scene))
        if scale(changed, keys, factor):
            yield f"{', '.join(keys)} times {factor}", changed


def differences(bearing, kind, pack, scene):
    """Solves a changed scene; returns the channels in which its results do not pass."""
    with tempfile.TemporaryDirectory() as folder:
        # Meshes are found from the folder of the scene.
        copy, out = Path(folder) / "pack", Path(folder) / "out"
        shutil.copytree(pack, copy)
        (copy / "changed.json").write_text(json.dumps(scene))
        run = [bearing, kind, copy / "changed.json", "--out", out]
        solved = subprocess.run(run, capture_output=True, text=True, check=False)
        compare = [bearing, "compare", "--json", pack, out]
        compared = subprocess.run(compare, capture_output=True, text=True, check=False)
        if solved.returncode != 0 or compared.returncode > 1:
            raise RuntimeError(solved.stderr or compared.stderr)
        channels = json.loads(compared.stdout)["channels"]
        return [of["channel"] for of in channels if of["differing"]]


def check(bearing, pack):
    """Returns the number of changes of a pack, and what is wrong."""
    about = json.loads((pack / "manifest.json").read_text())["about"]
    if about["generated_by"] != "this program" or about["kind"] == "refused":
        return 0, []
    scene, wrong, count = json.loads((pack / "resolved.json").read_text()), [], 0
    for change, changed in tagged(about, scene):
        count += 1
        if changed is None:
            wrong.append(f"{pack.name}: {change}: no such number")
        elif all(channel.startswith(ECHOES) for channel in differences(bearing, about["kind"], pack, changed)):
            wrong.append(f"{pack.name}: {change}: passes")
    for change, changed in alike(scene):
        found = differences(bearing, about["kind"], pack, changed)
        count += 1
        if found:
            wrong.append(f"{pack.name}: {change}: differs in {', '.join(found)}")
    return count, wrong


def main():
    packs = sorted(path.parent for path in Path(sys.argv[1]).glob("*/manifest.json"))
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = list(pool.map(lambda pack: check(sys.argv[2], pack), packs))
    wrong = [line for _, lines in found for line in lines]
    print("\n".join([*wrong, f"{sum(count for count, _ in found)} changed scenes, {len(wrong)} not judged as they should be"]))
    sys.exit(bool(wrong) or not found)


if __name__ == "__main__":
    main()
