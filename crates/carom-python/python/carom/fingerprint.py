"""A fingerprint of a function, or of a law: of its code and of the values that it has with it.

Two functions with the same code, defaults, enclosed values and attributes have the same fingerprint,
in every process. What a function reads from files or global variables is not seen. A law that
changes its attributes while it is called has another fingerprint afterwards.
"""

from __future__ import annotations

import hashlib
import types
from collections.abc import Mapping

import numpy as np

from .errors import CaseError

#: Values that are all that their text says.
_PLAIN = (bool, int, float, complex, str, bytes, type(None), type(...), np.generic)


def fingerprint(value: object) -> str:
    """The fingerprint, in hexadecimal."""
    try:
        return _Walk().digest(value).hex()
    except RecursionError:
        raise CaseError(
            f"{value!r} has values with it that are nested too deeply to be compared\n"
            "try: let it read them from a global variable"
        ) from None


def fingerprint_of_law(law: object) -> str:
    """The fingerprint of a law: also of what its classes define."""
    classes = [vars(of_law) for of_law in type(law).__mro__ if of_law is not object]
    defined = [(name, value) for names in classes for name, value in names.items() if not _is_internal(name)]
    return fingerprint((law, defined))


def _is_internal(name: str) -> bool:
    return name.startswith("__") and name.endswith("__")


class _Walk:
    """Digests of values: of a kind and of the digests of the parts, so that parts are not confused."""

    def __init__(self) -> None:
        #: Digests by identity; the value is kept with it, so that its identity is not given again.
        self.known: dict[int, tuple[bytes, object]] = {}
        #: Values whose digest is being made, from the outside in.
        self.within: list[int] = []

    def digest(self, value: object) -> bytes:
        if isinstance(value, _PLAIN):
            return _hash(type(value).__qualname__, repr(value).encode())
        if id(value) in self.within:
            # It contains itself: a function that calls itself, for example.
            return _hash("within", str(self.within.index(id(value))).encode())
        if id(value) not in self.known:
            self.within.append(id(value))
            self.known[id(value)] = (self.of_parts(value), value)
            self.within.pop()
        return self.known[id(value)][0]

    def all(self, kind: str, *parts: object) -> bytes:
        return _hash(kind, *(self.digest(part) for part in parts))

    def of_parts(self, value: object) -> bytes:
        kind = type(value).__qualname__
        if isinstance(value, types.CodeType):
            return self.all(kind, value.co_code, value.co_names, value.co_varnames, value.co_consts)
        if isinstance(value, types.FunctionType):
            cells = [_content(cell) for cell in value.__closure__ or ()]
            return self.all(kind, value.__code__, value.__defaults__, value.__kwdefaults__, cells)
        if isinstance(value, types.MethodType):
            return self.all(kind, value.__func__, value.__self__)
        if isinstance(value, type):
            # Its module is `__main__` or not, as the program is started.
            return self.all(kind, value.__qualname__, vars(value).get("__call__"), *value.__bases__)
        if isinstance(value, types.ModuleType):
            return self.all(kind, value.__name__)
        if isinstance(value, np.ndarray) and not value.dtype.hasobject:
            return _hash(kind, repr((value.dtype, value.shape)).encode(), value.tobytes())
        if isinstance(value, np.vectorize):
            # Its other attributes change when it is called.
            return self.all(kind, value.pyfunc, value.otypes, value.excluded, value.signature)
        if isinstance(value, (tuple, list)):
            return self.all(kind, *value)
        if isinstance(value, (set, frozenset)):
            return _hash(kind, *sorted(self.digest(part) for part in value))
        if isinstance(value, Mapping):
            return self.all(kind, *value.keys(), *value.values())
        return self.all(kind, type(value), *_state(value))


def _hash(kind: str, *parts: bytes) -> bytes:
    digest = hashlib.blake2b(kind.encode(), digest_size=8)
    for part in parts:
        digest.update(len(part).to_bytes(8, "little") + part)
    return digest.digest()


def _content(cell: types.CellType) -> object:
    try:
        return cell.cell_contents
    except ValueError:
        # It has no value yet.
        return ...


def _state(value: object) -> list[object]:
    """The attributes of an object, and what else a copy of it would have."""
    state: list[object] = [vars(value)] if hasattr(value, "__dict__") else []
    try:
        reduced = value.__reduce_ex__(2)
    except Exception:
        # It cannot be copied: its attributes are all that is seen.
        return state
    # A name, or the arguments from which a copy is made; some of them are iterators.
    parts = reduced[1:] if isinstance(reduced, tuple) else (reduced,)
    return state + [list(part) if hasattr(part, "__next__") else part for part in parts]
