"""Pages of the book on the keys of the case file.

There is one page for each table, with the meaning, values and default of every key from `carom
schema`. Below each key are the lines of a shipped case that uses it; `carom run` or `carom study`
runs that case.

    pages(schema, root, into) -> keys that no case uses
"""

import json
import re
import tomllib


def pages(schema, root, into):
    """Writes INTO/NAME.md for each top-level table, and INTO/index.md, which lists them."""
    cases = [Case(root, path) for path in [*sorted(root.glob("cases/*/*.toml")), *sorted(root.glob("docs/book/examples/*.toml"))]]
    tables = []
    collect("", schema, tables)
    texts, unused = {}, []
    for path, spec, title in tables:
        page = path.split(".")[0] or "top"
        kind = next((key["const"] for key in spec["properties"].values() if "const" in key), None)
        head = f"# {title}\n\n" if page not in texts else f"## {title}\n\n"
        text = head + spec.get("description", "") + "\n\n"
        before = None
        for name, key in spec["properties"].items():
            example = shortest(cases, path, kind, name)
            if example is None:
                unused.append(f"{path}{f'[{kind}]' if kind else ''}.{name}".strip("."))
            text += section(path, name, key, name in spec["required"], example, example == before)
            before = example
        texts[page] = texts.get(page, "") + text
    into.mkdir(parents=True, exist_ok=True)
    rows = []
    for page, text in texts.items():
        (into / f"{page}.md").write_text(text, encoding="utf-8")
        heading, described = text.split("\n")[0][2:], text.split("\n")[2]
        rows.append(f"- [{heading}](../generated/keys/{page}.md): {described}\n")
    (into / "index.md").write_text("".join(rows), encoding="utf-8")
    return unused


def section(path, name, key, required, example, again):
    """One key: meaning, values, and lines of a case that runs."""
    meaning, unit, paper = described(key)
    default = "required" if required else toml(key["default"]) if "default" in key else "optional"
    if "const" in key:
        default = "selects this table"
    facts = [f"Values: {values(key)}", f"Default: {default}" if "default" in key else default.capitalize()]
    facts += [f"With `preset = \"paper\"`: `{paper}`"] if paper else []
    facts += [f"Unit: {unit}"] if unit else []
    level = "###" if path and "." in path else "##"
    text = f"{level} `{name}`\n\n{meaning}\n\n" + " · ".join(facts) + "\n\n"
    if example:
        lines, case = example
        text += f"See the lines above, from `{case.name}`.\n\n" if again else f"```toml\n{lines}\n```\n\n`carom {case.command} {case.name}`\n\n"
    return text


class Case:
    """A file of the repository, split into blocks that begin with the header of a table."""

    def __init__(self, root, path):
        self.name = path.relative_to(root)
        text = path.read_text(encoding="utf-8")
        self.study = "case" in tomllib.loads(text)
        self.command = "study" if self.study else "run"
        starts = [0, *(m.start() for m in re.finditer(r"^\[", text, re.M)), len(text)]
        self.blocks = [without_tail(text[a:b]) for a, b in zip(starts, starts[1:])]

    def uses(self, path, kind, name):
        """The lines that use a key, or None."""
        parts = [*filter(None, path.split(".")), name]
        for block in self.blocks:
            header = re.match(r"\[+([\w.]+)\]+", block)
            header = header.group(1) if header else ""
            if self.study and header in ("arm", "arm.set", "grid"):
                if line := arm_sets(block, parts, kind):
                    return line
            elif header == (parts[0] if path else ""):
                # At the top level only the line with the key is used; the first line is a comment.
                own = block if path else "\n".join(line for line in block.splitlines() if re.match(rf"{name}\s*=", line))
                if not path and not own:
                    continue
                if (not kind or f'"{kind}"' in block) and all(has(block, part) for part in parts[1:]):
                    return own
            elif path.startswith(header) and header == "body.mesh" and has(block, name) and (not kind or f'"{kind}"' in block):
                return block
            elif not path and header == name:
                return block
        return None


def arm_sets(block, parts, kind):
    """The line of an arm that sets a key: "body.NAME.key" = … or { key = … }."""
    for line in block.splitlines():
        for place in range(len(parts), 0, -1):
            named = r"\.(?:[^.\"]+\.)?".join(map(re.escape, parts[:place]))
            if re.search(rf'"{named}"\s*=', line) and all(has(line, part) for part in parts[place:]) and (not kind or f'"{kind}"' in line):
                return f"{block.splitlines()[0]}\n{line}"
    return None


def has(text, key):
    return re.search(rf"(?<![\w.\"-]){re.escape(key)}\s*=", text)


def without_tail(block):
    """A block without trailing blank lines and comments, which belong to the next block."""
    lines = block.splitlines()
    while lines and (not lines[-1].strip() or lines[-1].startswith("#")):
        lines.pop()
    return "\n".join(lines)


def shortest(cases, path, kind, name):
    found = [(lines, case) for case in cases if (lines := case.uses(path, kind, name))]
    return min(found, key=lambda pair: (pair[1].study, len(pair[0])), default=None)


def collect(path, spec, tables):
    """Appends every table of the schema in the order of the file: (path of keys, schema, heading)."""
    last = path.rsplit(".", 1)[-1]
    kinds = [key for key in spec.get("properties", {}).items() if "const" in key[1]]
    if not path:
        title = "The top level"
    elif kinds:
        title = f"`{last} = {{ {kinds[0][0]} = \"{kinds[0][1]['const']}\" }}`"
    elif "." in path:
        title = f"`{last} = {{ … }}` of `{path.split('.')[0]}`"
    else:
        title = f"`[[{path}]]`" if spec.get("list") else f"`[{path}]`"
    tables.append((path, spec, title))
    for name, key in spec.get("properties", {}).items():
        inner = f"{path}.{name}".strip(".")
        for one in [key, *key.get("oneOf", []), *key.get("anyOf", [])]:
            if one.get("type") == "array" and one.get("items", {}).get("properties"):
                collect(inner, {**one["items"], "list": True}, tables)
            elif one.get("properties"):
                collect(inner, one, tables)


def described(key):
    """Meaning, unit, and default of the preset `paper`, extracted from a description."""
    text = key.get("description", "")
    paper = re.search(r" With preset = \"paper\": (.*)\.$", text)
    text = text[: paper.start()] if paper else text
    unit = re.search(r" Unit: ([^:]*)\.$", text)
    text = text[: unit.start()] if unit else text
    return text, unit and unit.group(1), paper and paper.group(1)


def values(key):
    """The values of a key, in words."""
    if "const" in key:
        return "this one"
    for several in ("oneOf", "anyOf"):
        if several in key:
            words = [f"`{'true' if one['const'] else 'false'}`" if isinstance(one.get("const"), bool) else values(one) for one in key[several]]
            return " or ".join(dict.fromkeys(words))
    if "enum" in key:
        return " ".join(f"`{json.dumps(word, ensure_ascii=False)}`" for word in key["enum"])
    kind = key.get("type")
    if isinstance(kind, list):
        return " or ".join(values({**key, "type": one}) for one in kind).replace("number or text", "number or formula")
    if kind == "array":
        items = key.get("items", {})
        if items.get("properties"):
            return "tables"
        least, most = key.get("minItems"), key.get("maxItems")
        count = "" if least is None else f"{least} " if least == most else f"{least} to {most} " if most else f"at least {least} "
        return f"list: {count}of {values(items)}"
    if kind in ("number", "integer"):
        bounds = [("minimum", "≥"), ("exclusiveMinimum", ">"), ("maximum", "≤"), ("exclusiveMaximum", "<")]
        limits = [f"{sign} {key[name]:g}" for name, sign in bounds if name in key]
        return " ".join(filter(None, [kind, ", ".join(limits)]))
    return {"object": "table", "string": "text", "boolean": "`true` `false`"}.get(kind, "–")


def toml(value):
    """A value as TOML, formatted as code."""

    def plain(value):
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, dict):
            return "{ " + ", ".join(f"{k} = {plain(v)}" for k, v in value.items()) + " }"
        if isinstance(value, list):
            return "[" + ", ".join(map(plain, value)) + "]"
        return json.dumps(value, ensure_ascii=False)

    return f"`{plain(value)}`"
