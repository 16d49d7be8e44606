"""Properties of time integrators."""

from __future__ import annotations

from typing import Any

from . import _carom


def explain(kind: str, /, **parameters: float | str) -> dict[str, Any]:
    """Numbers about a time integrator: order, ρ∞, damping and period error.

    Parameters
    ----------
    kind : str
        As in a case file: ``"chung-hulbert"``.
    **parameters : float or str
        Its parameters: ``rho_inf=0.1``.

    Returns
    -------
    dict
        What ``carom explain KIND --json`` prints.

    Examples
    --------
    Chung and Hulbert's α_f is ρ∞ / (1 + ρ∞):

    >>> round(carom.explain("chung-hulbert", rho_inf=0.25)["scheme"]["alpha_f"], 12)
    0.2
    """
    return _carom.explain(kind, [f"{key}={value}" for key, value in parameters.items()])


def schemes() -> Any:
    """All kinds of time integrators with their parameters.

    Returns
    -------
    list of dict
        What ``carom explain --json`` prints.
    """
    return _carom.schemes()
