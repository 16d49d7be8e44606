#!/usr/bin/env python3
"""The graph of imports: which file of a crate uses what another one defines, and which crate uses which.

    scripts/imports.py [--dot] [CRATE...]      cycles between files and arrows from a lower crate to a higher one; exit code 1 if there are any

An arrow goes from a file that uses an item to the file that defines it, wherever it is imported from: re-exports are followed. `mod x;` and `pub use` alone
are no arrows, and uses in code of tests do not count. A file that a macro lists (`schemes!`) is used by the file with the list where the macro writes
`$file::ITEM`. A path whose last name is not found, as of an item a macro makes, leads to the file of its module. Methods are not seen: they come without a
name that could be followed.

--dot prints the graph for Graphviz, and the report beside it on the error stream.
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

# From the lowest up, as in ARCHITECTURE.md: a crate may use those of the rows above its own.
ORDER = [
    ["carom-algebra", "carom-formula", "carom-time"],
    ["carom-solid", "carom-record"],
    ["carom-contact", "carom-case"],
    ["carom-mechanics"],
    ["carom", "carom-report"],
    ["carom-study"],
    ["carom-cli"],
]
ROW = {crate: row for row, crates in enumerate(ORDER) for crate in crates}

NOT_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|\bb?r(#*)".*?"\1|\bb?"(?:\\.|[^"\\])*"|"(?:\\.|[^"\\])*"|\'(?:\\[^\']+|[^\'\\])\'', re.S
)
TEST_FILE = re.compile(r'#\[cfg\(test\)\]\s*(?:#\[path = "(\w+)\.rs"\]\s*)?(?:pub(?:\([^)]*\))? )?mod (\w+);')
ITEM = re.compile(r"\b(?:fn|struct|enum|union|trait|type|const|static|macro_rules!)\s+(?!fn\b|unsafe\b|mut\b)(\w+)")
USE = re.compile(r"\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);")
PATH = re.compile(r"(?<![\w$:.])(?:[A-Za-z_]\w*)(?:\s*::\s*[A-Za-z_]\w*)*")


def block(text, start):
    """Where the bracket that opens at `start` has closed."""
    depth = 0
    for i in range(start, len(text)):
        depth += (text[i] in "([{") - (text[i] in ")]}")
        if depth == 0:
            return i + 1
    return len(text)


def without_tests(text):
    """The text without what stands behind #[cfg(test)]: an item up to its block or semicolon, a variant or arm up to its comma."""
    while (at := text.find("#[cfg(test)]")) >= 0:
        end = at + len("#[cfg(test)]")
        item = re.match(r"\s*(#\[|pub\b|(fn|mod|use|impl|struct|enum|trait|const|static|type)\b)", text[end:])
        while end < len(text):
            if text[end] in "([{":
                attribute, brace = text[end - 1] == "#", text[end] == "{"
                end = block(text, end)
                if brace and not attribute:
                    break
            elif text[end] == ";" or (text[end] == "," and not item):
                end += 1
                break
            else:
                end += 1
        text = text[:at] + text[end:]
    return text


def outside_blocks(text):
    """The text without what stands in brackets."""
    out, at = [], 0
    for bracket in re.finditer(r"[(\[{]", text):
        if bracket.start() >= at:
            out.append(text[at : bracket.start()])
            at = block(text, bracket.start())
    return " ".join([*out, text[at:]])


def leaves(tree, before=()):
    """(path, name) of everything a use declaration imports; the name of a glob is `*`."""
    tree = tree.strip()
    brace = tree.find("{")
    if brace >= 0:
        before += tuple(part.strip() for part in tree[:brace].split("::") if part.strip())
        depth, part = 0, ""
        for letter in tree[brace + 1 : block(tree, brace) - 1] + ",":
            depth += (letter == "{") - (letter == "}")
            if letter == "," and depth == 0:
                if part.strip():
                    yield from leaves(part, before)
                part = ""
            else:
                part += letter
        return
    tree, _, alias = (part.strip() for part in tree.partition(" as "))
    path = before + tuple(part.strip() for part in tree.split("::") if part.strip())
    if path[-1] == "self" and len(path) > 1:
        path = path[:-1]
    yield path, alias or path[-1]


class Module:
    """A file: what it defines, what it imports, its children, and the paths its code uses."""

    def __init__(self, path, name, text):
        self.path, self.name = path, name
        text = without_tests(NOT_CODE.sub('""', text))
        self.children = set(re.findall(r"\bmod\s+(\w+)\s*;", text))
        self.imports, self.globs, self.private = defaultdict(list), [], []
        for public, tree in USE.findall(text):
            for path, name in leaves(tree):
                if name == "*":
                    self.globs.append(path[:-1])
                    continue
                self.imports[name].append(path)
                if not public:
                    self.private.append(path)
        code = USE.sub("", text)
        self.items = set(ITEM.findall(outside_blocks(code)))
        self.used = []
        for found in PATH.finditer(code):
            parts = tuple(re.split(r"\s*::\s*", found.group()))
            defined = re.search(r"\b(fn|let|mod)\s+$", code[max(0, found.start() - 8) : found.start()])
            called = re.match(r"\s*[(!]", code[found.end() : found.end() + 4])
            if len(parts) > 1 or (not defined and (called or parts[0][0].isupper())):
                self.used.append(parts)
        for macro in re.finditer(r"macro_rules!\s+(\w+)\s*{", code):
            body = code[macro.end() : block(code, macro.end() - 1)]
            if (listed := re.search(r"\bmod\s+\$(\w+)\s*;", body)) is None:
                continue
            items = re.findall(rf"\${listed[1]}\s*::\s*(\w+)", body)
            for invoked in re.findall(rf"\b{macro[1]}!\s*[{{(\[]([\w\s,]*)[)}}\]]", code):
                files = re.findall(r"\w+", invoked)
                self.children.update(files)
                self.used += [(file, item) for file in files for item in items]


class Crate:
    """The files of a crate by the paths of their modules."""

    def __init__(self, directory):
        self.name, self.modules = directory.name, {}
        source = directory / "src"
        texts = {path: path.read_text(encoding="utf-8") for path in sorted(source.glob("**/*.rs"))}
        tests = set()
        for path, text in texts.items():
            inside = path.parent if path.stem in ("mod", "lib", "main") else path.with_suffix("")
            tests |= {path.parent / own if own else inside / name for own, name in TEST_FILE.findall(text)}
        for path, text in texts.items():
            if any(path.with_suffix("") == test or test in path.parents for test in tests):
                continue
            parts = path.relative_to(source).with_suffix("").parts
            name = parts[:-1] if parts[-1] in ("mod", "lib", "main") else parts
            self.modules[name] = Module(path, name, text)

    def find(self, module, path, seen=(), sure=True):
        """The modules at the end of a path, and file and name of the items on it, as seen from a module. Where it is not sure that there are any, as of
        names a glob may import, none are taken to be there."""
        if (module, path) in seen:
            return set(), set()
        seen += ((module, path),)
        at, rest = module, list(path)
        while rest and rest[0] in ("crate", "self", "super"):
            at = {"crate": (), "self": at, "super": at[:-1]}[rest.pop(0)]
        if not rest:
            return {at}, set()
        here, (name, *further) = self.modules[at], rest
        if name in here.children and (*at, name) in self.modules:
            if not further:
                own = {(here.path, name)} if name in here.items else set()
                return {(*at, name)}, own
            return self.find((*at, name), ("self", *further), seen, sure)
        if name in here.items:
            return set(), {(here.path, name)}
        modules, items = set(), set()
        named = here.imports.get(name, [])
        for target in named or [(*glob, name) for glob in here.globs]:
            between, direct = self.find(at, target, seen, bool(named))
            items |= direct
            for m in between:
                more = self.find(m, ("self", *further), seen, sure) if further else ({m}, set())
                modules, items = modules | more[0], items | more[1]
        if sure and path[0] in ("crate", "self", "super") and not (modules or items or named):
            items = {(here.path, name)}
        return modules, items

    def arrows(self):
        """From file to file the names used."""
        found = defaultdict(set)
        for name, module in self.modules.items():
            for path in module.private + module.used:
                for file, item in self.find(name, path)[1]:
                    if file != module.path:
                        found[module.path, file].add(item)
        return found

    def crates(self):
        """From file to crate: other crates of Carom that code names."""
        own = self.name.replace("-", "_")
        for module in self.modules.values():
            for path in module.private + module.used:
                if re.fullmatch(r"carom(_\w+)?", path[0]) and path[0] != own and len(path) > 1:
                    yield module.path, path[0].replace("_", "-")


def cycles(arrows):
    """Sets of files of which each reaches all others."""
    after = defaultdict(set)
    for a, b in arrows:
        after[a].add(b)
    reached = {}
    for start in list(after):
        seen, todo = set(), [start]
        while todo:
            new = after[todo.pop()] - seen
            seen |= new
            todo += new
        reached[start] = seen
    knots = {frozenset(b for b in reached[a] if a in reached.get(b, ())) for a in reached}
    return sorted((sorted(knot) for knot in knots if knot), key=lambda knot: (len(knot), knot))


def main():
    dot, wanted = "--dot" in sys.argv, {a for a in sys.argv[1:] if a != "--dot"}
    root = Path(__file__).resolve().parent.parent / "crates"
    short = lambda path: str(path.relative_to(root)).replace("/src/", "/")
    wrong, lines, report = 0, [], sys.stderr if dot else sys.stdout
    for directory in sorted(path.parent for path in root.glob("*/Cargo.toml")):
        if wanted and directory.name not in wanted:
            continue
        crate = Crate(directory)
        arrows = crate.arrows()
        if crate.name not in ROW:
            wrong += 1
            print(f"{crate.name} is not in the order of crates", file=report)
        lines += [f'  "{short(a)}" -> "{short(b)}" [tooltip="{", ".join(sorted(names))}"];' for (a, b), names in sorted(arrows.items())]
        for knot in cycles(arrows):
            wrong += 1
            print(f"{crate.name}: {len(knot)} files in a cycle", file=report)
            for (a, b), names in sorted(arrows.items()):
                if a in knot and b in knot:
                    print(f"    {short(a)} -> {short(b)}: {', '.join(sorted(names))}", file=report)
        for path, other in sorted(set(crate.crates())):
            lines.append(f'  "{short(path)}" -> "{other}" [style=dashed];')
            if ROW.get(other, len(ORDER)) >= ROW.get(crate.name, len(ORDER)):
                wrong += 1
                print(f"{short(path)}: {crate.name} is not above {other}", file=report)
    if dot:
        print("digraph imports {", "  rankdir=LR;", *lines, "}", sep="\n")
    elif not wrong:
        print("no cycle between files, no arrow to a higher crate")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
