"""Python functions as values of a case, and their names.

A case names a function by its qualified name and its fingerprint. A run, or a checkpoint, with
functions continues only with functions of the same names.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from .errors import CaseError
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


def takes_place(function: Callable[..., Any]) -> bool:
    """Whether a function is one of time and place, ``f(t, X)``, and not of time only, ``f(t)``.

    Arguments with defaults are its own: ``lambda t, gain=gain: gain * t`` is a function of time.
    """
    if isinstance(function, np.ufunc):
        required = function.nin
    else:
        try:
            parameters = inspect.signature(function).parameters.values()
        except (TypeError, ValueError):
            return True
        places = [p for p in parameters if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
        required = sum(p.default is p.empty for p in places)
        if required < 2 and any(p.kind is p.VAR_POSITIONAL for p in parameters):
            return True
    if required not in (1, 2):
        raise CaseError(
            f"the function {function!r} has {required} arguments without default\n"
            "try: f(t), or f(t, X) with the reference positions X, shape (points, dimension)"
        )
    return required == 2


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
        takes_place(value)
        name = name_of(value, functions)
        functions[name] = value
        return f"@{name}"
    return value
