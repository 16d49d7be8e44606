"""Cases: keys, errors and round trips."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, bar_dict
from hypothesis import given, settings
from hypothesis import strategies as st

import carom

IMPACT = ROOT / "cases/impact/impact.toml"


def test_errors_are_those_of_the_command(command: str) -> None:
    told = subprocess.run(
        [command, "check", str(IMPACT), "--set", "time.scheme.rho_inf=1.2"], capture_output=True, text=True
    )
    with pytest.raises(carom.CaseError) as error:
        carom.Case.from_file(IMPACT).set("time.scheme.rho_inf", 1.2)
    assert str(error.value).strip() == told.stderr.strip()
    assert "must be a number in [0, 1], not 1.2" in str(error.value)
    assert "= try:" in str(error.value)


def test_errors_of_a_file_are_those_of_the_command(command: str, tmp_path: Path) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text(IMPACT.read_text().replace("density", "densty"))
    told = subprocess.run([command, "check", str(path)], capture_output=True, text=True)
    with pytest.raises(carom.CaseError) as error:
        carom.Case.from_file(path)
    assert str(error.value).strip() == told.stderr.strip()


def test_errors_that_only_the_mesh_shows(bar: carom.Case) -> None:
    case = bar_dict()
    case["probe"][0]["at"] = [99.0]
    with pytest.raises(carom.CaseError, match="lies outside body"):
        carom.Case.from_dict(case).run(progress=False)


def test_a_case_is_unchanged_after_an_error(bar: carom.Case) -> None:
    before = bar.to_toml()
    with pytest.raises(carom.CaseError):
        bar.set({"time.step": 0.001, "time.scheme.rho_inf": -1})
    assert bar.to_toml() == before
    with pytest.raises(TypeError, match="complex"):
        bar.set("time.step", 1j)


def test_numbers_of_threads_and_integers_have_limits(bar: carom.Case) -> None:
    """As on the command line, and before anything is computed."""
    for threads in (0, -1, 20000, 2**70):
        for use in (lambda: bar.run(threads=threads), lambda: carom.Simulation(bar, threads)):
            with pytest.raises(ValueError, match=f"threads must be from 1 to .*, not {threads};"):
                use()
        with pytest.raises(ValueError, match="jobs must be"):
            carom.study(bar, {"a": {}}, jobs=threads)
    with pytest.raises(carom.CaseError, match="64 bits"):
        bar.set("output.history_every", 2**70)


def test_values_are_set_by_path_and_by_name(bar: carom.Case) -> None:
    bar.set("time.scheme.rho_inf", np.float64(0.25)).set("body.bar.velocity", np.array([-3.0]))
    assert bar.to_dict()["body"][0]["velocity"] == [-3.0]
    assert bar.resolved()["time"]["scheme"]["rho_inf"] == 0.25
    other = bar.copy().set("time.scheme", {"kind": "hu"})
    assert bar.to_dict()["time"]["scheme"]["kind"] == "chung-hulbert"
    assert other.to_dict()["time"]["scheme"] == {"kind": "hu"}


numbers = st.floats(allow_nan=False, allow_infinity=False, width=64)
positive = st.floats(min_value=1e-6, max_value=1e6)


@settings(max_examples=60, deadline=None)
@given(
    title=st.text(st.characters(codec="utf-8", exclude_categories=("Cc", "Cs"))),
    density=positive,
    young=positive,
    velocity=numbers,
    cells=st.integers(1, 1000),
    rho=st.floats(0.0, 1.0),
    length=positive,
)
def test_cases_round_trip(
    title: str, density: float, young: float, velocity: float, cells: int, rho: float, length: float
) -> None:
    """What is given is read back: through the text, and through the resolved case."""
    given_case = bar_dict()
    given_case["title"] = title
    given_case["material"][0] |= {"density": density, "young": young}
    given_case["body"][0]["velocity"] = [velocity]
    given_case["body"][0]["mesh"] |= {"min": 0.0, "max": length, "cells": cells}
    given_case["time"]["scheme"]["rho_inf"] = rho
    del given_case["probe"]
    case = carom.Case.from_dict(given_case)
    assert case.to_dict() == given_case
    assert carom.Case.from_text(case.to_toml()).to_dict() == given_case
    resolved = case.resolved()
    assert resolved["materials"][0]["density"] == density
    assert resolved["bodies"][0]["velocity"] == [velocity]
    assert carom.Case.from_text(case.to_toml()).resolved() == resolved


def test_schemes_are_explained() -> None:
    """Chung and Hulbert: alpha_f = rho / (1 + rho), second order, and rho_inf as asked for."""
    found = carom.explain("chung-hulbert", rho_inf=0.1)
    assert found["order"] == 2
    assert found["rho_inf"] == pytest.approx(0.1, abs=1e-12)
    assert found["scheme"]["alpha_f"] == pytest.approx(0.1 / 1.1, abs=1e-15)
    assert carom.schemes()
    with pytest.raises(carom.CaseError, match="did you mean"):
        carom.explain("chung-hulbrt")
