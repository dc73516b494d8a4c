"""Checks that every JSON file of golden vectors is what their schema says.

    python3 schema.py VECTORS

Ends with 1 if one is not, or if the schema lets pass a file that it should refuse.
"""

import json
import sys
from pathlib import Path

from jsonschema import Draft202012Validator


def main():
    if len(sys.argv) != 2:
        sys.exit("give the folder that `galpix vectors` wrote")
    vectors = Path(sys.argv[1])
    schema = json.loads((vectors / "schema.json").read_text())
    Draft202012Validator.check_schema(schema)
    validator = Draft202012Validator(schema)
    # One case of each kind and component count is enough: the files of a kind come from one type. The manifest is
    # whole.
    manifest = json.loads((vectors / "manifest.json").read_text())
    checked = {}
    for entry in manifest["cases"]:
        if checked.setdefault(entry["kind"], 0) < 8:
            checked[entry["kind"]] += 1
            case = json.loads((vectors / entry["name"] / "case.json").read_text())
            refuse(validator, case, entry["name"])
            for key in ("name", "kind"):
                broken = {name: value for name, value in case.items() if name != key}
                if validator.is_valid(broken):
                    sys.exit(f"the schema lets {entry['name']} pass without its {key}")
    refuse(validator, manifest, "manifest.json")
    print(f"the manifest and {sum(checked.values())} cases of {len(checked)} kinds are what the schema says")


def refuse(validator, document, name):
    error = next(validator.iter_errors(document), None)
    if error is not None:
        sys.exit(f"{name} is not what the schema says: {str(error)[:400]}")


if __name__ == "__main__":
    main()
