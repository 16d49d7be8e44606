"""What the docstrings say: examples are run, parameters and results are described."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterator
from typing import Any

import pytest
from conftest import ROOT

import carom

MODULES = [
    importlib.import_module(module.name)
    for module in pkgutil.walk_packages(carom.__path__, "carom.")
    if module.name not in ("carom.__main__", "carom._carom")
]


def test_examples(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    attempted = 0
    for module in [carom, *MODULES]:
        done = doctest.testmod(module, extraglobs={"carom": carom})
        assert done.failed == 0, module.__name__
        attempted += done.attempted
    assert attempted > 15


def documented() -> Iterator[tuple[str, Any]]:
    """The functions, and methods of classes, that users call."""
    for module in (carom, carom.plot, carom.export, carom.fields):
        names = getattr(module, "__all__", [name for name in vars(module) if not name.startswith("_")])
        for name in names:
            found = getattr(module, name)
            if not getattr(found, "__module__", "").startswith("carom"):
                continue
            if inspect.isfunction(found):
                yield f"{module.__name__}.{name}", found
            elif inspect.isclass(found):
                for key, method in inspect.getmembers(found, callable):
                    if not key.startswith("_") and key in vars(found):
                        yield f"{module.__name__}.{name}.{key}", method


@pytest.mark.parametrize("name, function", [pytest.param(*found, id=found[0]) for found in documented()])
def test_parameters_and_results_are_described(name: str, function: Any) -> None:
    text = inspect.getdoc(function)
    assert text, name
    sections = dict(re.findall(r"^(\w+)\n-+\n(.*?)(?=^\w+\n-+\n|\Z)", text, re.M | re.S))
    described = re.findall(r"^(\*{0,2}\w+(?:, \w+)*) : \S", sections.get("Parameters", ""), re.M)
    found = {part.strip("* ") for names in described for part in names.split(",")}
    parameters = [p for p in inspect.signature(function).parameters if p not in ("self", "cls")]
    assert found == set(parameters), name
    result = inspect.signature(function).return_annotation
    assert ("Returns" in sections) == (result not in ("None", "Iterator[None]", "Any | None")), name
