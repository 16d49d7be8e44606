#!/usr/bin/env python3
"""Writes keys.txt: mistakes made in the cases of this folder, one in every way for every key.

    carom schema | crates/carom-case/tests/corpus/make.py

A mistake is a line `CASE: OLD -> NEW`, a replacement in the text of CASE.toml (`\\n`: line end; `&&`:
another one). checks.txt has those that no table of keys implies, and is written by hand.
The messages below it are written by the test: CAROM_CORPUS=write cargo test -p carom-case corpus.
"""

import json
import pathlib
import re
import sys
import tomllib

HERE = pathlib.Path(__file__).parent
CASES = ["plane", "space", "line", "rigid", "made", "mesh", "layers"]


def main():
    schema = json.load(sys.stdin)
    known = old_messages(HERE / "keys.txt")
    seen, lines = set(), []
    for case in CASES:
        text = (HERE / f"{case}.toml").read_text(encoding="utf-8")
        for change in changes(text, schema, seen):
            entry = f"{case}: {change[0]} -> {change[1]}".replace("\n", "\\n")
            lines += [entry, *known.get(entry, [])]
    (HERE / "keys.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


def old_messages(path):
    """The messages below each mistake that the file has already."""
    found, entry = {}, None
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else []:
        if line.startswith("  "):
            found[entry].append(line)
        else:
            entry = line
            found[entry] = []
    return found


def changes(text, schema, seen):
    """Mistakes in every block of a case, once for each key of each table."""
    starts = [0, *(m.start() for m in re.finditer(r"^\[", text, re.M)), len(text)]
    for start, end in zip(starts, starts[1:]):
        block = text[start:end].rstrip("\n")
        header = block.split("\n")[0] if start else ""
        path = re.sub(r"[\[\]]", "", header)
        given = tomllib.loads("\n".join(block.split("\n")[1:] if start else block.split("\n")))
        table = table_at(schema, path, given)
        if table is None or path == "exact":
            continue
        place = (path, json.dumps(next((k.get("const") for k in table["properties"].values() if "const" in k), "")))
        for key, spec in table["properties"].items():
            line = re.search(rf"^{key} = .*$", block, re.M)
            if (*place, key, bool(line)) in seen:
                continue
            seen.add((*place, key, bool(line)))
            for old, new in of_key(block, header, key, spec, line.group(0) if line else None):
                if text.count(old) != 1:
                    # With as many lines before it as make it unique.
                    before = text[:start].rstrip("\n").split("\n")
                    at = block.index(old)
                    lead = block[:at]
                    for count in range(len(before) + 1):
                        more = "\n".join(before[len(before) - count:]) + "\n" * (2 if count and before else 0) if count else ""
                        whole = lead + old if not count else text[len("\n".join(before[:len(before) - count])) + (1 if len(before) > count else 0): start + at] + old
                        if text.count(whole) == 1:
                            old, new = whole, whole[: len(whole) - len(old)] + new
                            break
                if text.count(old) == 1 and old != new:
                    yield old, new


def of_key(block, header, key, spec, line):
    """Mistakes with a key: in its line if it is there, else in a new one below the header."""
    if line is None:
        if not header or spec.get("type") == "array" and spec.get("items", {}).get("properties"):
            return
        for value in wrong_values(spec, "")[:2]:
            yield header, f"{header}\n{key} = {value}"
        return
    value = line.split(" = ", 1)[1]
    yield line, f"{key}{key[-1]} = {value}"
    yield line, f"# {line}"
    if block.split("\n")[1 if header else 0] == line:
        yield line, f"zzz = 1\n{line}"
    for wrong in wrong_values(spec, value):
        yield line, f"{key} = {wrong}"


def wrong_values(spec, value):
    """Values that a key does not take: of another type, out of range, no word of its own."""
    found = []
    for one in spec.get("oneOf", [spec]):
        kind = one.get("type", "")
        words = one.get("enum") or one.get("items", {}).get("enum", [])
        if words:
            near = f'"{words[-1]}{words[-1][-1]}"'
            found += [near, '"zzz"'] if kind != "array" else [f"[{near}]", '["zzz"]', "[]", '"x"', "[1]"]
            found += ["1", "true"]
        elif kind == "number":
            found += ['"text"', "nan"]
            for end, sign in (("minimum", -1), ("exclusiveMinimum", -1), ("maximum", 1), ("exclusiveMaximum", 1)):
                if end in one:
                    found += [str(one[end] + sign * 0.5), *([str(one[end])] if end.startswith("ex") else [])]
            found += ['"3 mm"', "[1.0]"]
        elif kind == "integer":
            found += ['"text"', "1.5", str(one.get("minimum", 0) - 1), "-7"]
        elif kind == "boolean":
            found += ['"true"', "1"]
        elif kind == "string":
            found += ["7", "[7]"] + (['"a b"', '""'] if "\\s" in one.get("pattern", "") else [])
            found += ['"nothing.top"', '"block"', '"block.topp"'] if "[^.]+\\." in one.get("pattern", "") else []
        elif kind == "array":
            found += ["3.5", '"text"', "[]", "[1.0, 2.0, 3.0, 4.0]", "[true, false]", "[inf, 0.0]", '["1 +", "X*q"]', "[{}]"]
        elif kind == "object":
            found += ["3.5", "[1.0]", "{ zzz = 1 }"]
        elif isinstance(kind, list):
            found += ["true", '"1 +"', '"2*q"', '"sinn(t)"', "[1.0]", "inf"]
    return [wrong for wrong in dict.fromkeys(found) if wrong != value]


def table_at(schema, path, given):
    """The schema of the table with this path, of the variant that has the keys that are given."""
    table = schema
    for name in filter(None, path.split(".")):
        table = table["properties"].get(name)
        if table is None:
            return None
        table = table.get("items", table)
        if "oneOf" in table:
            tables = [one for one in table["oneOf"] if one.get("properties")]
            if len(tables) > 1:
                return variant(tables, given, name, path) if path.endswith(name) else variant_with(tables, path.split(name + ".", 1)[1])
            # Without tables they say which keys replace each other.
            table = tables[0] if tables else table
        if table is None or "properties" not in table:
            return None
    return table


def variant(tables, given, name, path):
    return max(tables, key=lambda table: (sum(given.get(k) == v["const"] for k, v in table["properties"].items() if "const" in v), len(given.keys() & table["properties"].keys())))


def variant_with(tables, rest):
    """The only inner table of a variant that has one, the plane shape of an extrusion."""
    inner = next(table["properties"][rest] for table in tables if rest in table["properties"])
    return inner["oneOf"][0]


main()
