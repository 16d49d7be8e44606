"""Studies, in this process and by workers of which one is killed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import bar_dict, disc_dict

import carom


def test_arms_and_grid(bar: carom.Case) -> None:
    """Chung-Hulbert conserves energy with rho_inf = 1, and Hu's scheme dissipates."""
    found = carom.study(
        bar,
        {"conserving": {"time.scheme.rho_inf": 1.0}, "Hu": {"time.scheme": {"kind": "hu"}}},
        progress=False,
    )
    table = found.to_pandas()
    assert list(table.index) == ["conserving", "Hu"] and (table["status"] == "finished").all()
    assert abs(table.loc["conserving", "energy_lost"]) < 0.02 < table.loc["Hu", "energy_lost"]
    assert found["Hu"].case["time"]["scheme"]["kind"] == "hu" and found.missing == []
    assert table.attrs["units"]["contact_duration"] == "s"
    swept = carom.study(bar.copy().set("time.end", 0.8), grid={"time.step": [0.002, 0.004]}, jobs=2, progress=False)
    assert len(swept.arms) == len(swept) == 2 and list(swept) == swept.arms


def test_a_study_starts_from_the_changed_case(tmp_path: Path) -> None:
    path = tmp_path / "bar.toml"
    path.write_text(carom.Case.from_dict(bar_dict()).to_toml())
    case = carom.Case.from_file(path).set({"time.end": 0.4, "time.scheme.rho_inf": 0.9})
    found = carom.study(case, {"as it is": {}}, out=tmp_path / "study", progress=False)
    time_spec = found["as it is"].case["time"]
    assert time_spec["end"] == 0.4 and time_spec["scheme"]["rho_inf"] == 0.9
    assert (tmp_path / "study/study.csv").is_file()
    with pytest.raises(carom.RecordError, match="exists already"):
        carom.study(case, {"again": {}}, out=tmp_path / "study", progress=False)
    with pytest.raises(carom.CaseError, match="rho_inf"):
        carom.study(case, {"wrong": {"time.scheme.rho_inf": 3}}, progress=False)


SQUARE = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
1
2 1 "square"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
$EndNodes
$Elements
2
1 2 2 1 1 1 2 3
2 2 2 1 1 1 3 4
$EndElements
"""


def test_a_study_of_a_case_without_a_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is the case in memory that is studied: its mesh is found, and no file takes its place."""
    monkeypatch.chdir(tmp_path)
    Path("q.msh").write_text(SQUARE)
    Path("case").write_text(carom.Case.from_dict(bar_dict() | {"title": "another"}).to_toml())
    case = carom.Case.from_dict(
        {
            "dimension": 2,
            "plane": "strain",
            "material": [
                {"name": "soft", "law": "linear-elastic", "density": 1.0, "young": 1.0, "poisson": 0.0}
            ],
            "body": [
                {
                    "name": "square",
                    "material": "soft",
                    "element": "T3",
                    "mesh": {"file": "q.msh", "surface": "square"},
                    "velocity": [1.0, 0.0],
                }
            ],
            "time": {"end": 0.1, "step": 0.01, "scheme": {"kind": "chung-hulbert", "rho_inf": 0.5}},
        }
    )
    case.set("time.end", 0.2)
    found = carom.study(case, {"slow": {"body.square.velocity": [0.5, 0.0]}, "as it is": {}}, progress=False)
    # The momentum of a square of mass 1.
    momenta = [found[arm].history["momentum_x"][-1] for arm in found.arms]
    assert momenta == pytest.approx([0.5, 1.0], rel=1e-12)
    assert found["slow"].history["time"][-1] == pytest.approx(0.2)


def test_a_study_is_of_the_case_that_was_read(tmp_path: Path) -> None:
    path = tmp_path / "bar.toml"
    text = carom.Case.from_dict(bar_dict()).to_toml()
    path.write_text(text)
    case = carom.Case.from_file(path)
    path.write_text(text.replace("[-10.0]", "[-4.0]"))
    found = carom.study(case, {"as it is": {}}, set={"time.end": 0.1}, progress=False)
    bodies = found["as it is"].case["bodies"]
    assert bodies == case.resolved()["bodies"] != carom.Case.from_file(path).resolved()["bodies"]
    assert found["as it is"].case["time"]["end"] == 0.1


STUDY = """
case = "disc.toml"
[grid]
"time.scheme.rho_inf" = [0.2, 0.5, 0.8]
"time.step" = [5e-3, 2.5e-3]
"""


def test_the_parts_of_a_study(command: str, tmp_path: Path) -> None:
    """Planned, computed arm by arm, some twice and concurrently, and collected."""
    (tmp_path / "disc.toml").write_text(carom.Case.from_dict(disc_dict()).to_toml())
    (tmp_path / "sweep.toml").write_text(STUDY)

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([command, "study", *arguments], cwd=tmp_path, capture_output=True, text=True)

    assert run("sweep.toml", "--jobs", "1", "--out", "one", "--no-report").returncode == 0
    planned = run("plan", "sweep.toml", "--out", "many", "--slurm")
    assert planned.returncode == 0 and "6 runs in many" in planned.stdout
    script = (tmp_path / "many/slurm.sh").read_text()
    assert "#SBATCH --array=1-6" in script
    assert subprocess.run(["sh", "-n", str(tmp_path / "many/slurm.sh")]).returncode == 0
    for number in ("2", "2", "1"):
        assert run("arm", "many", number).returncode == 0
    early = run("collect", "many", "--no-report")
    assert early.returncode == 1 and "missing: 3 (" in early.stderr
    twice = [
        subprocess.Popen([command, "study", "arm", "many", "3"], cwd=tmp_path, stderr=subprocess.DEVNULL)
        for _ in range(2)
    ]
    codes = {process.wait() for process in twice}
    assert codes <= {0, 2} and 0 in codes
    environment = os.environ | {"SLURM_ARRAY_TASK_ID": "4", "PATH": f"{Path(command).parent}:{os.environ['PATH']}"}
    assert subprocess.run(["sh", str(tmp_path / "many/slurm.sh")], env=environment).returncode == 0
    for number in ("5", "6"):
        assert run("arm", "many", number).returncode == 0
    assert run("arm", "many", "7").returncode == 2
    assert run("collect", "many").returncode == 0
    assert (tmp_path / "many/study.html").is_file()
    assert (tmp_path / "many/study.csv").read_bytes() == (tmp_path / "one/study.csv").read_bytes()


def test_matched_costs_need_one_machine(command: str, tmp_path: Path) -> None:
    """The steps are found where the study is planned, and the other runs are computed on any
    machine."""
    (tmp_path / "disc.toml").write_text(carom.Case.from_dict(disc_dict()).to_toml())
    design = (
        'case = "disc.toml"\ndesign = "matched-cost"\n[ensemble]\nphases = 2\n'
        '[[arm]]\nname = "a"\n[[arm]]\nname = "b"\nset = { "time.scheme" = { kind = "hu" } }\n'
    )
    (tmp_path / "s.toml").write_text(design)

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([command, "study", *arguments], cwd=tmp_path, capture_output=True, text=True)

    told = run("plan", "s.toml", "--out", "d")
    assert told.returncode == 2 and "which trial runs find" in told.stderr and "--settle" in told.stderr
    assert not (tmp_path / "d/study.json").exists()
    told = run("plan", "s.toml", "--out", "d", "--settle", "--slurm")
    assert told.returncode == 0, told.stderr
    manifest = json.loads((tmp_path / "d/study.json").read_text())
    machine = manifest["machine"]
    assert "--array=1-4" in (tmp_path / "d/slurm.sh").read_text()
    # The first two runs are the trial runs; their members are left.
    # Warnings of the runs come first.
    assert "missing: 3 (" in run("collect", "d", "--no-report").stderr
    (tmp_path / "d/study.json").write_text(json.dumps(manifest | {"machine": machine | {"processor": "Z80"}}))
    assert [run("arm", "d", number).returncode for number in ("1", "3", "4")] == [0, 0, 0]
    assert run("collect", "d", "--no-report").returncode == 0
    case = carom.Case.from_dict(disc_dict())
    arms = {"a": {}, "b": {"time.scheme": {"kind": "hu"}}}
    with pytest.raises(carom.RecordError, match="which trial runs find.*\ntry: "):
        carom.study(case, arms, design="matched-cost", client=object(), out=tmp_path / "e")


#: A sweep of six arms of 600 steps with checkpoints.
GRID = {"time.scheme.rho_inf": [0.2, 0.5, 0.8], "body.disc.velocity": [[0.0, -2.0], [0.0, -1.5]]}


def sweep() -> carom.Case:
    return carom.Case.from_dict(disc_dict()).set({"time.step": 5e-4, "output.checkpoint_every": 20})


@pytest.fixture(scope="module")
def table_of_one_process(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    out = tmp_path_factory.mktemp("study") / "one"
    carom.study(sweep(), grid=GRID, jobs=1, out=out, progress=False)
    return (out / "study.csv").read_bytes()


class Killer(threading.Thread):
    """Kills a worker, with signal 9, in the middle of a run of a study."""

    def __init__(self, study: Path, worker: Callable[[], int | None]) -> None:
        super().__init__()
        self.study, self.worker = study, worker
        self.killed: int | None = None
        self.start()

    def run(self) -> None:
        for _ in range(2000):
            time.sleep(0.01)
            begun = list(self.study.glob("arms/*/checkpoint"))
            if any(len(list(place.iterdir())) > 1 for place in begun):
                self.killed = self.worker()
                if self.killed:
                    os.kill(self.killed, signal.SIGKILL)
                    return


def test_dask_with_a_killed_worker(tmp_path: Path, table_of_one_process: bytes) -> None:
    """Two worker processes, one of which is killed: the study ends complete, with the table of one
    process."""
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        pids: dict[str, Any] = client.run(os.getpid)
        killer = Killer(tmp_path / "dask", lambda: next(iter(pids.values())))
        found = carom.study(sweep(), grid=GRID, client=client, out=tmp_path / "dask")
        killer.join()
    assert killer.killed and found.missing == []
    assert (found.to_pandas()["status"] == "finished").all()
    assert (tmp_path / "dask/study.csv").read_bytes() == table_of_one_process


def test_ray_with_a_killed_worker(tmp_path: Path, table_of_one_process: bytes) -> None:
    """The same by Ray, where it is installed."""
    ray = pytest.importorskip("ray")
    psutil = pytest.importorskip("psutil")

    def worker() -> int | None:
        for process in psutil.Process().children(recursive=True):
            if "".join(process.cmdline()[:1]).startswith("ray::_arm"):
                return int(process.pid)
        return None

    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        killer = Killer(tmp_path / "ray", worker)
        found = carom.study(sweep(), grid=GRID, client=ray, out=tmp_path / "ray")
        killer.join()
    finally:
        ray.shutdown()
    assert killer.killed and found.missing == []
    assert (found.to_pandas()["status"] == "finished").all()
    assert (tmp_path / "ray/study.csv").read_bytes() == table_of_one_process


def test_functions_cannot_be_studied() -> None:
    case = carom.Case.from_dict(
        disc_dict() | {"load": [{"on": ["block.top"], "pressure": lambda t, x: 0.0}]}
    )
    with pytest.raises(carom.CaseError, match="cannot have Python functions"):
        carom.study(case, {"a": {}}, progress=False)

