"""Properties of time integrators."""

from __future__ import annotations

from typing import Any

from . import _carom


def explain(kind: str, /, **parameters: float | str) -> dict[str, Any]:
    """Numbers about a time integrator: order, ρ∞, damping and period error.

    Parameters
    ----------
    kind
        As in a case file: ``"chung-hulbert"``.
    **parameters
        Its parameters: ``rho_inf=0.1``.

    Returns
    -------
    dict
        What ``carom explain KIND --json`` prints.
    """
    return _carom.explain(kind, [f"{key}={value}" for key, value in parameters.items()])


def schemes() -> Any:
    """All kinds of time integrators with their parameters, as ``carom explain --json`` prints them."""
    return _carom.schemes()
