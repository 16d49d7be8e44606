"""Python functions as values of a case, and their names.

A case names a function by its qualified name and a fingerprint of its code, defaults and the values
it encloses. A run, or a checkpoint, with functions continues only with functions of the same names.
"""

from __future__ import annotations

import hashlib
import types
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np


def name_of(function: Callable[..., Any]) -> str:
    """The name of a function in a case: ``push:3f9a…``.

    Two functions with the same code, defaults and enclosed values have the same name. Of a callable
    object, the code of its class's ``__call__`` and its attributes count.
    """
    digest = hashlib.blake2b(digest_size=8)
    _add(digest.update, function, depth=0)
    plain = getattr(function, "__qualname__", type(function).__qualname__)
    return f"{plain.split('.')[-1].strip('<>')}:{digest.hexdigest()}"


def _add(update: Callable[[bytes], None], value: object, depth: int) -> None:
    """Adds a value to a fingerprint."""
    if isinstance(value, types.CodeType):
        update(value.co_code)
        for part in (value.co_names, value.co_varnames):
            update(repr(part).encode())
        for constant in value.co_consts:
            _add(update, constant, depth + 1)
    elif isinstance(value, types.FunctionType):
        _add(update, value.__code__, depth + 1)
        _add(update, value.__defaults__, depth + 1)
        for cell in value.__closure__ or ():
            _add(update, cell.cell_contents, depth + 1)
    elif isinstance(value, types.MethodType):
        _add(update, value.__func__, depth + 1)
        _add(update, value.__self__, depth + 1)
    elif isinstance(value, np.ndarray):
        update(repr((value.dtype, value.shape)).encode() + value.tobytes())
    elif isinstance(value, (tuple, list)):
        for part in value:
            _add(update, part, depth + 1)
    elif isinstance(value, (bool, int, float, complex, str, bytes, type(None), np.generic)):
        update(repr(value).encode())
    elif isinstance(value, Mapping):
        for key, part in value.items():
            update(repr(key).encode())
            _add(update, part, depth + 1)
    else:
        # An object: its class and, to some depth, its state at the time the case is made.
        update(type(value).__qualname__.encode())
        call = getattr(type(value), "__call__", None)
        if isinstance(call, types.FunctionType):
            _add(update, call.__code__, depth + 1)


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
        name = name_of(value)
        functions[name] = value
        return f"@{name}"
    return value
