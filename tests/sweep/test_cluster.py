"""Sweeps on Dask: two processes here, one of them killed; a scheduler that is started anew."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

import pytest
from distributed import Client, LocalCluster
from pyarrow.parquet import ParquetFile
from railpatch import CaseError
from railpatch.sweep import Sweep, cluster, run_sweep
from railpatch.sweep.cluster import batch_system, dask_backend, scheduler
from railpatch.sweep.store import CHUNKS

PATCH = """kind = "patch"
[geometry]
curvatures = [2.0, 1.5]
[load]
normal_force = 1e4
[method]
tangential = "polach"
[friction]
coefficient = 0.3
[motion]
creepage = [1e-3, 0.0]
rolling_speed = 10.0
"""
SWEEP = """[sweep]
scene = "scene.toml"
outputs = ["creep_force[0]", "creep_force[1]", "spin_moment"]
[[vary]]
key = "motion.creepage[0]"
low = -5e-3
high = 5e-3
count = 30
"""


@pytest.fixture
def sweep_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A sweep of 30 cases whose workers count."""
    (tmp_path / "scene.toml").write_text(PATCH, encoding="utf-8")
    path = tmp_path / "sweep.toml"
    path.write_text(SWEEP, encoding="utf-8")
    here = str(Path(__file__).parent)
    monkeypatch.setenv("PYTHONPATH", here, prepend=os.pathsep)
    monkeypatch.syspath_prepend(here)
    monkeypatch.setenv("COUNTED", str(tmp_path / "counted.txt"))
    monkeypatch.setattr(cluster, "solve_chunk", import_module("counted").counted)
    # four chunks for each worker would all be under way at once
    monkeypatch.setattr("railpatch.sweep.run.SECONDS", 0.0)
    return path


def solved(folder: Path) -> list[str]:
    """Cases in the order in which workers solved them."""
    path = folder / "counted.txt"
    return [line.split()[0] for line in path.read_text().splitlines()] if path.exists() else []


def stored(folder: Path) -> list[str]:
    """Cases whose rows are in a sweep's folder."""
    files = (folder / CHUNKS).glob("*.parquet")
    return [name for path in files for name in ParquetFile(path).read(["id"])["id"].to_pylist()]


def outputs(sweep: Sweep) -> list[tuple[str, str, tuple[object, ...]]]:
    """What does not hang on the clock."""
    return [(row.id, row.status, row.outputs) for row in sweep.rows]


def test_a_killed_worker_costs_what_it_had_under_way(sweep_file: Path, tmp_path: Path) -> None:
    """The same rows as here, to the bit; what was fetched before is not solved again, and what is
    solved again was under way: two threads with a case and one that waits each."""
    killed: list[int] = []
    fetched: set[str] = set()

    def kill(done: int, _count: int) -> None:
        if done > 8 and not killed:
            fetched.update(stored(tmp_path / "out"))
            killed.append(int((tmp_path / "counted.txt").read_text().split()[-1]))
            os.kill(killed[0], signal.SIGKILL)

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as two:
        backend = dask_backend(scheduler(two.scheduler_address))
        found = run_sweep(sweep_file, tmp_path / "out", backend=backend, progress=kill, page=False)
    assert killed
    here = run_sweep(sweep_file, tmp_path / "here", page=False)
    assert outputs(found) == outputs(here)
    counts = Counter(solved(tmp_path))
    assert len(counts) == 29
    assert len(fetched) == 9
    again = {name for name, count in counts.items() if count > 1}
    assert again.isdisjoint(fetched)
    assert len(again) <= 2 * 2


def free_port() -> int:
    """One that nobody listens at."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def process(*command: str) -> Iterator[subprocess.Popen[bytes]]:
    """A part of a cluster."""
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    with subprocess.Popen([sys.executable, "-m", "dask", *command], **quiet) as one:  # type: ignore[call-overload]
        try:
            yield one
        finally:
            one.terminate()


@contextmanager
def small_cluster(port: int) -> Iterator[subprocess.Popen[bytes]]:
    """A scheduler and two workers, as one starts them on a cluster; gives the scheduler."""
    address = f"tcp://127.0.0.1:{port}"
    main = ("scheduler", "--host", "127.0.0.1", "--port", str(port), "--no-dashboard")
    worker = ("worker", address, "--nthreads", "1", "--no-dashboard", "--nanny")
    with process(*main) as one, process(*worker), process(*worker):
        with Client(address, timeout=60) as client:
            client.wait_for_workers(2, timeout=60)
        yield one


@pytest.mark.long
def test_a_scheduler_that_is_started_anew(sweep_file: Path, tmp_path: Path) -> None:
    """The sweep goes on by itself; at most what was under way, or waited to be written, is solved
    again."""
    port = free_port()
    told: list[str] = []
    with small_cluster(port) as first:
        second: list[object] = []

        def restart(done: int, _count: int) -> None:
            if done > 8 and not second:
                first.kill()
                first.wait()
                time.sleep(1.0)
                again = small_cluster(port)
                second.append(again)
                again.__enter__()

        backend = dask_backend(scheduler(f"tcp://127.0.0.1:{port}"), tell=told.append)
        found = run_sweep(
            sweep_file, tmp_path / "out", backend=backend, progress=restart, page=False
        )
        second[0].__exit__(None, None, None)  # type: ignore[attr-defined]
    assert told
    assert outputs(found) == outputs(run_sweep(sweep_file, tmp_path / "here", page=False))
    assert sum(Counter(solved(tmp_path)).values()) <= 29 + 12


def test_what_does_not_answer_is_told() -> None:
    """With the address; batch systems by name."""
    with pytest.raises(CaseError, match="where no scheduler answers"):
        scheduler(f"tcp://127.0.0.1:{free_port()}", timeout=0.5)
    with pytest.raises(CaseError, match="--cluster: value is 'slrum', allowed slurm"):
        batch_system("slrum", 2)
    with pytest.raises(CaseError, match=r"--cluster: slurm: .*jobqueue\.yaml"):
        batch_system("slurm", 2)
