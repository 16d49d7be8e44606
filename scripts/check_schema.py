#!/usr/bin/env python3
"""Checks `carom schema` against the cases and studies of the repository.

    scripts/check_schema.py target/release/carom        needs jsonschema-rs (pip)

An independent validator must confirm that the output is a JSON Schema, that it accepts every case
and study, and that it rejects every misspelt key. `cargo test` checks that the reader does the
same.
"""

import copy
import json
import pathlib
import subprocess
import sys
import tomllib

import jsonschema_rs

ROOT = pathlib.Path(__file__).resolve().parent.parent


def validator(program, *options):
    schema = json.loads(subprocess.run([program, "schema", *options], check=True, capture_output=True, text=True).stdout)
    jsonschema_rs.meta.validate(schema)
    return jsonschema_rs.Draft202012Validator(schema)


def places(value, path=()):
    """The path of every key; in a list of tables, only its first occurrence."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield (*path, key)
            # The keys of `exact` are names of columns, those of `materials` of groups.
            if key not in ("exact", "materials"):
                yield from places(inner, (*path, key))
    elif isinstance(value, list):
        seen = set()
        for i, inner in enumerate(value):
            for place in places(inner, (*path, i)):
                if place[len(path) + 1 :] not in seen:
                    seen.add(place[len(path) + 1 :])
                    yield place


def misspelt(document, place):
    changed = copy.deepcopy(document)
    table = changed
    for step in place[:-1]:
        table = table[step]
    table[place[-1] + place[-1][-1]] = table.pop(place[-1])
    return changed


def main(program):
    kinds = {False: validator(program), True: validator(program, "--study")}
    files = keys = 0
    for path in sorted([*ROOT.glob("cases/*/*.toml"), *ROOT.glob("crates/carom/templates/*.toml"), *ROOT.glob("docs/book/examples/*.toml")]):
        document = tomllib.loads(path.read_text())
        kind = kinds["case" in document]
        errors = [f"{error.message} at {error.instance_path}" for error in kind.iter_errors(document)]
        assert not errors, f"{path}: {errors}"
        files += 1
        for place in places(document):
            assert not kind.is_valid(misspelt(document, place)), f"{path}: the schema accepts a misspelt {place}"
            keys += 1
    print(f"the schema accepts {files} files and rejects {keys} misspelt keys")
    assert files > 50 and keys > 1000


if __name__ == "__main__":
    main(sys.argv[1])
