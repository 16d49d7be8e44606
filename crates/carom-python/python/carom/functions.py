"""Python functions as values of a case, and their names.

A case names a function by its qualified name and its fingerprint. A run, or a checkpoint, with
functions continues only with functions of the same names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .fingerprint import fingerprint


def name_of(function: Callable[..., Any], others: Mapping[str, Callable[..., Any]] | None = None) -> str:
    """The name of a function in a case: ``push:3f9a…``.

    Another function with the same fingerprint among `others` keeps its name, and this one has a number:
    ``push:3f9a…#2``. What the two do may differ later, as of two controllers that begin alike.
    """
    plain = getattr(function, "__qualname__", type(function).__qualname__)
    name = first = f"{plain.split('.')[-1].strip('<>')}:{fingerprint(function)}"
    number = 1
    while others and others.get(name, function) is not function:
        number += 1
        name = f"{first}#{number}"
    return name


def plain(value: object, functions: dict[str, Callable[..., Any]]) -> Any:
    """A value of a case as plain numbers, strings, lists and dictionaries.

    Functions are replaced by ``@name`` and added to `functions`.
    """
    if isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(part, functions) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part, functions) for part in value]
    if hasattr(value, "__fspath__"):
        return str(value)
    if callable(value):
        name = name_of(value, functions)
        functions[name] = value
        return f"@{name}"
    return value
