"""Checks that a pack tests what its tags name: a change of the tagged feature must fail it.

    python check_tags.py SET BEARING

Each change multiplies numbers of `resolved.json` that belong to a tag. A program without the feature, or with an
error in it of that size, then fails the pack as well.
"""

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

# Tag -> top-level tables, keys in and below them, factor.
CHANGES = {
    "accelerometer": ("sensor", ["radius", "angle"], 1.1),
    "beam": ("body", ["youngs_modulus"], 1.1),
    "bushing-springs": ("spring", ["length"], 1.1),
    "cage": ("bearing", ["mass"], 1.1),
    "cage-mesh": ("solid", ["density"], 1.1),
    "centrifugal": ("inner_race", ["speed"], 1.1),
    "clearance": ("bearing", ["radial", "diametral"], 1.1),
    "damping": ("contact_damping", ["alpha"], 1.1),
    "dent": ("bearing", ["depth"], 1.1),
    "gravity": ("ball_forces", ["gravity"], 1.1),
    "hertz-exact": ("bearing", ["groove_radius", "conformity", "osculation"], 1.001),
    "hertz-fit": ("bearing", ["groove_radius", "conformity", "osculation"], 1.001),
    "housing-explicit": ("solid", ["youngs_modulus", "density"], 1.1),
    "housing-modes": ("solid", ["density"], 1.1),
    "housing-quasi-static": ("solid", ["youngs_modulus"], 1.1),
    "housing-static": ("solid", ["youngs_modulus"], 1.1),
    "impact": ("inner_race", ["half_sine"], 1.1),
    "life": ("inner_race", ["load"], 1.01),
    "motion": ("inner_race", "body", ["load", "moment", "half_sine", "displacement", "amplitude", "force", "speed", "ramp", "fit"], 1.1),
    "rigid-shaft": ("body", ["mass", "load", "moment"], 1.1),
    "rotating-load": ("inner_race", ["force", "phase", "speed"], 1.1),
    "rubber-dynamic": ("solid", ["gamma"], 1.1),
    "rubber-static": ("solid", ["rubber_modulus"], 1.1),
    "shaft-of-elements": ("body", ["youngs_modulus"], 1.1),
    "solid-explicit": ("solid", ["density"], 1.1),
    "solid-modes": ("solid", ["density"], 1.1),
    "solid-static": ("solid", ["youngs_modulus"], 1.1),
    "spall": ("bearing", ["floor_radius", "length"], 1.1),
    "spin": ("solid", ["spin"], 1.1),
    "springs": ("spring", ["y", "z"], 1.1),
    "telemeter": ("sensor", ["distance", "offset"], 1.1),
    "traction": ("traction", ["b", "d", "coefficient"], 1.1),
    "unbalance": ("body", ["size"], 1.1),
    "whirl": ("body", ["youngs_modulus", "mass"], 1.1),
}


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


def main():
    root, bearing = Path(sys.argv[1]), sys.argv[2]
    failures, count = [], 0
    for manifest in sorted(root.glob("*/manifest.json")):
        pack, about = manifest.parent, json.loads(manifest.read_text())["about"]
        if about["generated_by"] != "this program" or about["kind"] == "refused":
            continue
        for tag in about["tags"]:
            if tag not in CHANGES:
                continue
            scene = json.loads((pack / "resolved.json").read_text())
            *names, keys, factor = CHANGES[tag]
            tables = [scene.get(name) for name in names]
            if tag == "clearance" and "clearance" not in scene["bearing"]:
                # It follows from the sizes.
                tables, keys, factor = [scene["bearing"].get("outer_race")], ["radius"], 1.00001
            what = f"{pack.name}: {tag}: {', '.join(keys)} times {factor}"
            if not any([scale(table, keys, factor) for table in tables]):
                failures.append(f"{what}: no such number")
                continue
            count += 1
            with tempfile.TemporaryDirectory() as folder:
                # Meshes are found from the folder of the scene.
                copy, out = Path(folder) / "pack", Path(folder) / "out"
                shutil.copytree(pack, copy)
                (copy / "changed.json").write_text(json.dumps(scene))
                run = [bearing, about["kind"], copy / "changed.json", "--out", out]
                solved = subprocess.run(run, capture_output=True, text=True, check=False)
                compare = [bearing, "compare", pack, out]
                compared = subprocess.run(compare, capture_output=True, text=True, check=False)
                if solved.returncode != 0 or compared.returncode != 1:
                    failures.append(f"{what}: {solved.stderr or compared.stderr or 'passes'}".strip())
    print("\n".join(failures + [f"{count} changes of tagged features, {len(failures)} not found"]))
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
