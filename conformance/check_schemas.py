"""Checks every file of the packs in a folder against its JSON Schema, and the columns of tables against
schemas/columns.json: python check_schemas.py SET BEARING

Needs the package jsonschema. The schema of scenes is the output of `BEARING schema`.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

from jsonschema import Draft202012Validator

here = Path(__file__).parent / "schemas"
schemas = {name: json.loads((here / f"{name}.json").read_text()) for name in ("manifest", "tolerances", "summary")}
schemas["resolved"] = json.loads(subprocess.run([sys.argv[2], "schema"], check=True, capture_output=True).stdout)
checks = {name: Draft202012Validator(schema) for name, schema in schemas.items()}
columns = json.loads((here / "columns.json").read_text())


def describes(column, header):
    name, unit = re.fullmatch(r"(.+) \[(.*)\]", header).groups()
    return re.fullmatch(column["name"], name) and column["unit"] in (unit, "*")


checked, wrong = 0, []
for pack in sorted(path.parent for path in Path(sys.argv[1]).glob("*/manifest.json")):
    kind = json.loads((pack / "manifest.json").read_text())["about"]["kind"]
    for name in checks:
        path = pack / f"{name}.json"
        if not path.exists() or (kind == "refused" and name == "resolved"):
            continue
        checked += 1
        for error in checks[name].iter_errors(json.loads(path.read_text())):
            wrong.append(f"{path}: {error.json_path}: {error.message[:200]}")
    for table in sorted(pack.glob("*.csv")):
        checked += 1
        for header in table.read_text().splitlines()[0].split(","):
            if not any(describes(column, header) for column in columns[table.name]):
                wrong.append(f"{table}: {header} is not described in columns.json")
print("\n".join(wrong) or f"{checked} files have the form of their schemas")
sys.exit(bool(wrong) or not checked)
