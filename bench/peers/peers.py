"""Where the peers come from, and how a process is run on one core."""

import json
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
VENV = ROOT / "target" / "peers-venv"
ONE = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
DEBIAN = "/usr/bin/python3"
APPLICATIONS = ["", "LinearSolversApplication", "StructuralMechanicsApplication", "ConstitutiveLawsApplication", "ContactStructuralMechanicsApplication"]
KRATOS = ["KratosMultiphysics==10.4.4", *(f"Kratos{name}==10.4.4" for name in APPLICATIONS[1:])]


def pinned(command):
    return ["taskset", "-c", "0", *map(str, command)]


def timed(command):
    """CPU seconds and memory in KiB of a process."""
    process = subprocess.Popen(pinned(command), stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"{' '.join(map(str, command))} ended with status {status}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss


def peer(python, script, *arguments, limit=None):
    """The JSON object that a job of a peer prints last; None if it takes longer than the limit, in
    seconds."""
    try:
        done = subprocess.run(pinned([python, HERE / script, *arguments]), check=True, capture_output=True, env=ONE, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    return json.loads(done.stdout.strip().splitlines()[-1])


def install(*more):
    """Installs the peers, and packages of PyPI in the environment of Kratos."""
    subprocess.run(["apt-get", "install", "-yq", "--no-install-recommends", "python3-getfem"], check=True)
    install_python(*more)


def install_python(*more):
    """Installs Kratos and packages of PyPI in its environment."""
    subprocess.run([sys.executable, "-m", "venv", VENV], check=True)
    subprocess.run([VENV / "bin" / "pip", "install", "-q", "--disable-pip-version-check", *KRATOS, *more], check=True)


def missing(**more):
    """Names of what is not installed; `more` gives the modules of further names."""
    kratos = "; ".join("import " + ".".join(filter(None, ["KratosMultiphysics", name])) for name in APPLICATIONS)
    wanted = [("GetFEM", DEBIAN, "import getfem"), ("Kratos", VENV / "bin" / "python", kratos)]
    wanted += [(name, VENV / "bin" / "python", f"import {module}") for name, module in more.items()]
    for what, python, code in wanted:
        if not pathlib.Path(python).exists() or subprocess.run([python, "-c", code], capture_output=True).returncode:
            yield what
