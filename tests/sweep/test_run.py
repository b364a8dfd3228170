"""Sweeps on this machine: rows against single solves, going on, sharing, failures, the page."""

from __future__ import annotations

import json
import multiprocessing
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
import railpatch
from click.testing import CliRunner
from page_checks import check_page
from railpatch.case.kinds import kind_of, write_example
from railpatch.command.cli import cli
from railpatch.sweep import Sweep, read_sweep, run_sweep
from railpatch.sweep import local as runner
from railpatch.sweep.local import WORKER_DIED
from railpatch.sweep.page import MEANS, _means
from railpatch.sweep.plan import load_plan
from railpatch.sweep.sensitivity import indices_of
from railpatch.sweep.store import write_chunk
from railpatch.sweep.work import Chunk, Row, solve_chunk, solve_first

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
outputs = ["creep_force[0]", "max_pressure", "spin_moment"]
[[vary]]
key = "friction.coefficient"
values = [0.1, 0.3]
[[vary]]
key = "motion.creepage[0]"
values = [-2e-3, 1e-3, 4e-3]
"""


def files(folder: Path, sweep: str = SWEEP, scene: str = PATCH) -> Path:
    """A sweep beside its scene."""
    (folder / "scene.toml").write_text(scene, encoding="utf-8")
    path = folder / "sweep.toml"
    path.write_text(sweep, encoding="utf-8")
    return path


def same(one: Sweep, other: Sweep) -> bool:
    """But for the times."""
    return [(r.id, r.status, r.reason, r.outputs) for r in one.rows] == [
        (r.id, r.status, r.reason, r.outputs) for r in other.rows
    ]


def test_rows_are_single_solves(tmp_path: Path) -> None:
    """To the bit, in the order of the points; the table has the keys beside the outputs."""
    path = files(tmp_path)
    sweep = run_sweep(path, tmp_path / "out")
    assert len(sweep.rows) == 6
    assert sweep.failed == []
    for point, row in zip(sweep.plan.points, sweep.rows, strict=True):
        alone = railpatch.solve(sweep.plan.case(point))
        assert row.outputs == (alone["creep_force"][0], alone["max_pressure"], alone["spin_moment"])
    table = read_sweep(tmp_path / "out").to_pydict()
    assert table["friction.coefficient"] == [0.1] * 3 + [0.3] * 3
    assert table["motion.creepage[0]"] == [-2e-3, 1e-3, 4e-3] * 2
    assert table["creep_force[0]"] == [row.outputs[0] for row in sweep.rows]
    assert set(table["status"]) == {"converged"}
    parts = [pq.read_table(file) for file in (tmp_path / "out" / "results").iterdir()]
    rows = [row for part in parts for row in part.to_pylist()]
    assert {row["id"]: row for row in rows} == {
        row["id"]: row for row in read_sweep(tmp_path / "out").to_pylist()
    }
    assert len(rows) == 6


def test_sweeps_go_on_and_share(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What a sweep that was ended has done is not solved again, nor what another one in the same
    folder has; a damaged file is."""
    solved: list[str] = []

    def counted(chunk: Chunk) -> list[Row]:
        if len(solved) >= 3:
            raise KeyboardInterrupt
        solved.extend(chunk.ids)
        return solve_chunk(chunk)

    path, folder = files(tmp_path), tmp_path / "out"
    monkeypatch.setattr(runner, "solve_chunk", counted)
    with pytest.raises(KeyboardInterrupt):
        run_sweep(path, folder)
    assert not (folder / "sweep.parquet").exists()
    monkeypatch.setattr(runner, "solve_chunk", solve_chunk)
    rest = run_sweep(path, folder)
    assert (rest.reused, rest.solved) == (1 + len(solved), 5 - len(solved))
    assert same(rest, run_sweep(path, tmp_path / "whole"))

    larger = files(tmp_path, SWEEP.replace("values = [0.1, 0.3]", "values = [0.3, 0.4]"))
    shared = run_sweep(larger, folder)
    assert (shared.reused, shared.solved) == (3, 3)

    for file in (folder / "results").iterdir():
        file.write_bytes(file.read_bytes()[:-9])
    again = run_sweep(larger, folder)
    assert again.solved == 6
    assert same(again, shared)


def test_chunks_are_of_what_cases_take_after_the_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A first case that reads profiles and imports for 10 s does not make each case a file."""

    def slow(chunk: Chunk) -> tuple[tuple[str, ...], Row]:
        names, row = solve_first(chunk)
        return names, replace(row, seconds=10.0)

    monkeypatch.setattr(import_module("railpatch.sweep.run"), "solve_first", slow)
    found = run_sweep(files(tmp_path), tmp_path / "out", page=False)
    # the first one, and at least four for a worker
    assert len(list((tmp_path / "out" / "results").iterdir())) == 1 + 3
    assert found.solved == 6


def test_chunks_of_a_sweep_that_goes_on_are_of_what_solved_cases_took(tmp_path: Path) -> None:
    """Neither a refused case nor one without contact, which take next to nothing, makes chunks of
    thousands of slow ones."""
    sweep = SWEEP.replace("-2e-3, 1e-3, 4e-3", "-2e-3, 1e-3, 4e-3, 5e-3, 6e-3, 7e-3")
    path, folder = files(tmp_path, sweep), tmp_path / "out"
    plan = load_plan(path)
    seconds = [0.9, 0.9, 0.9, 1e-4, 1e-4]
    status = ["converged", "converged", "converged", "no_contact", "refused"]
    outputs = tuple(plan.table.outputs or ())
    rows = [
        Row(name, said, None, (), took, (0.0, 0.0, 0.0))
        for name, took, said in zip(plan.ids(), seconds, status, strict=False)
    ]
    ids, points = tuple(plan.ids()[:5]), tuple(plan.points[:5])
    chunk = Chunk(0, plan.kind, plan.content, plan.keys, ids, points, outputs)
    (folder / "results").mkdir(parents=True)
    write_chunk(folder, chunk, rows)
    given: list[int] = []

    def backend(chunks: list[Chunk]) -> Iterator[tuple[Chunk, list[Row]]]:
        given.extend(len(one.ids) for one in chunks)
        return ((one, solve_chunk(one)) for one in chunks)

    run_sweep(plan, folder, backend=backend, page=False)
    assert given == [1] * 6


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_ended_command_says_what_is_kept(
    number: signal.Signals, code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of all cases, those that are there; the same command goes on with as many."""
    solved: list[str] = []

    def ended(chunk: Chunk) -> list[Row]:
        if len(solved) >= 2:
            signal.raise_signal(number)
        solved.extend(chunk.ids)
        return solve_chunk(chunk)

    path, folder = files(tmp_path), tmp_path / "out"
    call = ["sweep", str(path), "-o", str(folder), "--json"]
    monkeypatch.setattr(runner, "solve_chunk", ended)
    found = CliRunner().invoke(cli, call)
    assert found.exit_code == code
    # the first case is solved before the chunks
    kept = 1 + len(solved)
    words = f"ended by {number.name}: {kept} of 6 cases are kept in {folder}; the same command"
    assert words in found.output
    monkeypatch.setattr(runner, "solve_chunk", solve_chunk)
    rest = CliRunner().invoke(cli, call)
    assert json.loads(rest.stdout)["reused"] == kept
    told = CliRunner().invoke(cli, ["sweep", "--help"]).output
    assert "130" in told
    assert "143" in told


def test_files_that_vary_count_by_their_content(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They start at the scene's folder, wherever the command runs; one that changed is solved
    anew, rows and table have the names that the sweep has for them."""
    scene = """kind = "patch"
[geometry]
undeformed_distance = "flat.csv"
[grid]
element_size = [5e-4, 5e-4]
[load]
normal_force = 1e3
"""
    sweep = """[sweep]
scene = "scene.toml"
outputs = ["max_pressure"]
[[vary]]
key = "geometry.undeformed_distance"
values = ["flat.csv", "steep.csv"]
"""
    x = 5e-4 * (np.arange(12) - 5.5)

    def write(name: str, radius: float) -> None:
        gap = (x**2 + x[:, None] ** 2) / (2 * radius)
        np.savetxt(tmp_path / name, gap, delimiter=",")

    write("flat.csv", 0.4)
    write("steep.csv", 0.2)
    path, elsewhere = files(tmp_path, sweep, scene), tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    first = run_sweep(path, tmp_path / "out", page=False)
    write("steep.csv", 0.1)
    second = run_sweep(path, tmp_path / "out", page=False)
    assert (second.solved, second.reused) == (1, 1)
    (flat, steep), (same_flat, steeper) = (
        [row.outputs[0] for row in found.rows] for found in (first, second)
    )
    assert same_flat == flat
    # by Hertz as the cube root of the curvature squared
    assert isinstance(steep, float)
    assert isinstance(steeper, float)
    assert steeper / steep == pytest.approx(4 ** (1 / 3), rel=0.1)
    table = read_sweep(tmp_path / "out")
    assert table["geometry.undeformed_distance"].to_pylist() == ["flat.csv", "steep.csv"]


FOR_EVER = """import sys
from railpatch.sweep import run_sweep
if __name__ == "__main__":
    def told(done, count):
        if done > 2:
            print("begun", flush=True)
    run_sweep(sys.argv[1], sys.argv[2], workers=2, progress=told, page=False)
"""


def test_workers_end_with_the_process_that_started_them(tmp_path: Path) -> None:
    """By a signal that it cannot answer: none holds its output any longer."""
    sweep = SWEEP.replace("values = [0.1, 0.3]", "low = 0.1\nhigh = 0.5\ncount = 100000")
    path, script = files(tmp_path, sweep), tmp_path / "script.py"
    script.write_text(FOR_EVER, encoding="utf-8")
    words = [sys.executable, str(script), str(path), str(tmp_path / "out")]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as started:
        assert started.stdout is not None
        assert started.stdout.readline() == "begun\n"
        started.kill()
        # the end of the pipe is told when all who could write to it have ended
        started.communicate(timeout=60)


def test_cases_that_fail_are_rows(tmp_path: Path) -> None:
    """With status and reason; the others are as they are. The command ends with exit code 3."""
    text = SWEEP.replace("[0.1, 0.3]", "[-1.0, 0.3]")
    path = files(tmp_path, text)
    sweep = run_sweep(path, tmp_path / "out")
    assert [row.status for row in sweep.rows] == ["refused"] * 3 + ["converged"] * 3
    assert "friction.coefficient: value is -1.0" in str(sweep.rows[0].reason)
    assert sweep.rows[0].outputs == (None, None, None)
    page = (tmp_path / "out" / "sweep.html").read_text(encoding="utf-8")
    assert "3 refused" in page
    assert "friction.coefficient: value is -1.0" in page
    check_page(tmp_path / "out" / "sweep.html", keys=(2, 5))
    ended = CliRunner().invoke(cli, ["sweep", str(path), "-o", str(tmp_path / "out")])
    assert ended.exit_code == 3
    assert "3 of 6 cases have no good result; the first, number 0: refused" in ended.output


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("friction.coefficient", "friction.coeficient", "friction.coeficient"),
        ('"creep_force[0]"', '"creep_fore[0]"', "'creep_fore' is none of"),
        ('"creep_force[0]"', '"status"', "value is 'status', which every row has"),
        ('"creep_force[0]"', '"max_pressure"', "value is 'max_pressure' twice, allowed once"),
        ('"scene.toml"', '"sene.toml"', "sene.toml: cannot be read"),
    ],
)
def test_what_is_wrong_with_all_is_told_at_once(
    tmp_path: Path, old: str, new: str, told: str
) -> None:
    """A wrong call, before anything is written."""
    path = files(tmp_path, SWEEP.replace(old, new))
    ended = CliRunner().invoke(cli, ["sweep", str(path), "-o", str(tmp_path / "out")])
    assert ended.exit_code == 2
    assert told in ended.output
    assert not (tmp_path / "out").exists()


def test_a_case_that_ends_workers_is_a_row(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its neighbours are solved, on two workers: the same rows as without, to the bit."""
    path = files(tmp_path)
    monkeypatch.setenv("DEADLY", load_plan(path).ids()[4])
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    monkeypatch.setattr(runner, "solve_chunk", import_module("deadly").die)
    monkeypatch.setattr(runner, "TRIES", 2)
    sweep = run_sweep(path, tmp_path / "out", workers=2, page=False)
    assert sweep.rows[4].status == WORKER_DIED
    assert "ended 2 times" in str(sweep.rows[4].reason)
    monkeypatch.setattr(runner, "solve_chunk", solve_chunk)
    whole = run_sweep(path, tmp_path / "whole", page=False)
    assert whole.failed == []
    sweep.rows[4] = whole.rows[4]
    assert same(sweep, whole)


def test_workers_that_end_while_rows_are_taken_in(tmp_path: Path) -> None:
    """Between two chunks, by a signal from outside: what waits goes to new ones."""
    path = files(tmp_path)
    killed: list[int] = []

    def kill(done: int, _all: int) -> None:
        if done < 2 or killed:
            return
        for worker in multiprocessing.active_children():
            killed.append(worker.pid or 0)
            worker.kill()
            worker.join()
        # until the pool has seen it
        time.sleep(0.3)

    sweep = run_sweep(path, tmp_path / "out", workers=2, page=False, progress=kill)
    assert killed
    assert same(sweep, run_sweep(path, tmp_path / "whole", page=False))


def test_workers_that_never_are_ready(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Said after a few tries, and by a worker that reads the script that starts workers."""
    path = files(tmp_path)
    monkeypatch.syspath_prepend(str(Path(__file__).parent))
    monkeypatch.setattr(runner, "get_ready", import_module("deadly").die_at_once)
    with pytest.raises(railpatch.CaseError, match="under if __name__"):
        run_sweep(path, tmp_path / "out", workers=2, page=False)
    monkeypatch.setattr(multiprocessing.current_process(), "_inheriting", True, raising=False)
    with pytest.raises(railpatch.CaseError, match="that a worker reads"):
        run_sweep(path, tmp_path / "other", workers=2, page=False)
    assert not (tmp_path / "other").exists()


def test_command_prints_a_summary(tmp_path: Path) -> None:
    """As JSON, with what was there."""
    path = files(tmp_path)
    call = ["sweep", str(path), "-o", str(tmp_path / "out"), "--json"]
    CliRunner().invoke(cli, call)
    ended = CliRunner().invoke(cli, call)
    assert ended.exit_code == 0, ended.output
    found = json.loads(ended.stdout)
    assert found["cases"] == found["reused"] == 6
    assert found["solved"] == 0
    assert found["statuses"] == {"converged": 6}


def test_outputs_that_no_case_has_are_told(tmp_path: Path) -> None:
    """A force has three components; a name that only some have leaves its place empty."""
    sweep = SWEEP.replace('"spin_moment"', '"creep_force[7]"')
    arguments = ["sweep", str(files(tmp_path, sweep)), "-o", str(tmp_path / "out")]
    ended = CliRunner().invoke(cli, arguments)
    assert ended.exit_code == 0, ended.output
    assert "outputs: no case has 'creep_force[7]'" in ended.output
    assert CliRunner().invoke(cli, [*arguments, "--strict"]).exit_code == 2


def test_example_of_the_docs(tmp_path: Path) -> None:
    """What the command prints is what docs/sweeps.md shows; with the scene that `railpatch init`
    writes it is solved."""
    text = CliRunner().invoke(cli, ["sweep", "--show-scene"]).output
    page = Path(__file__).resolve().parents[2] / "docs" / "sweeps.md"
    assert f"```toml\n{text}```" in page.read_text(encoding="utf-8")
    write_example(kind_of("wheel_rail"), tmp_path)
    path = tmp_path / "sweep.toml"
    path.write_text(text.replace("count = 36", "count = 3"), encoding="utf-8")
    sweep = run_sweep(path, tmp_path / "out", page=False)
    assert len(sweep.rows) == 9
    assert sweep.failed == []


def linear(plan: Any, coefficients: list[float]) -> np.ndarray:
    """An output that grows evenly with each key over its range."""
    return plan.unit_points() @ np.array(coefficients)


def test_sensitivities_of_a_linear_output(tmp_path: Path) -> None:
    """Closed form: mu* is the coefficient and sigma 0 (Morris 1991); Sobol's indices are the parts
    a_i^2 / sum a^2, first and total alike."""
    keys = "".join(
        f'[[vary]]\nkey = "{key}"\nlow = {low}\nhigh = {high}\n'
        for key, low, high in (
            ("friction.coefficient", 0.1, 0.5),
            ("load.normal_force", 1e3, 1e5),
            ("motion.rolling_speed", 1.0, 9.0),
        )
    )
    head = '[sweep]\nscene = "scene.toml"\nsamples = {}\ndesign = "{}"\n'
    a = [1.0, -2.0, 0.5]
    plan = load_plan(files(tmp_path, head.format(8, "morris") + keys))
    assert len(plan.points) == 8 * 4
    for (key, mu, _, sigma), size in zip(indices_of(plan, linear(plan, a)), a, strict=True):
        assert key in plan.keys
        assert mu == pytest.approx(abs(size), rel=1e-12)
        assert sigma == pytest.approx(0.0, abs=1e-12)
    assert load_plan(files(tmp_path, head.format(8, "morris") + keys)).points == plan.points
    plan = load_plan(files(tmp_path, head.format(1024, "saltelli") + keys))
    assert indices_of(plan, linear(plan, a)) == indices_of(plan, linear(plan, a))
    assert len(plan.points) == 1024 * 5
    whole = sum(size**2 for size in a)
    for (_, first, _, total, _), size in zip(indices_of(plan, linear(plan, a)), a, strict=True):
        assert first == pytest.approx(size**2 / whole, abs=0.01)
        assert total == pytest.approx(size**2 / whole, abs=0.01)


def test_the_page_names_outputs_that_do_not_vary(tmp_path: Path) -> None:
    """With their value, and those without a number; a case that failed has none."""
    text = SWEEP.replace('"spin_moment"', '"spin_moment", "normal_force"')
    run_sweep(files(tmp_path, text), tmp_path / "out")
    page = (tmp_path / "out" / "sweep.html").read_text(encoding="utf-8")
    assert "normal_force is 10\u00a0kN, the same in all 6 cases" in page
    assert "max_pressure is " in page
    text = SWEEP.replace("values = [0.1, 0.3]", "values = [0.1, -0.3]").replace(
        '"max_pressure"', '"max_temperature"'
    )
    run_sweep(files(tmp_path, text), tmp_path / "other")
    page = (tmp_path / "other" / "sweep.html").read_text(encoding="utf-8")
    assert (
        "the same in the 3 of 6 cases that have it; no case has a number of max_temperature."
        in page
    )


def test_a_sweep_whose_first_middle_and_last_cases_are_refused(tmp_path: Path) -> None:
    """They are rows as others; where all are refused it says why and writes nothing."""
    sweep = SWEEP.replace("[0.1, 0.3]", "[-0.1, 0.3, -0.2, 0.3, -0.3]").replace(
        "[-2e-3, 1e-3, 4e-3]", "[1e-3]"
    )
    found = run_sweep(files(tmp_path, sweep), tmp_path / "out", page=False)
    status = ["refused", "converged", "refused", "converged", "refused"]
    assert [row.status for row in found.rows] == status
    assert "value is -0.2, allowed >= 0" in str(found.rows[2].reason)
    wrong = sweep.replace("0.3, -0.2, 0.3, -0.3", "-0.3, -0.2, -0.3, -0.3")
    with pytest.raises(railpatch.CaseError, match=r"value is -0\.1, allowed >= 0"):
        run_sweep(files(tmp_path, wrong), tmp_path / "none", page=False)
    misspelt = sweep.replace("max_pressure", "max_presure")
    with pytest.raises(railpatch.CaseError, match="did you mean 'max_pressure'"):
        run_sweep(files(tmp_path, misspelt), tmp_path / "none", page=False)
    assert not (tmp_path / "none").exists()


def test_logarithmic_keys_have_logarithmic_axes(tmp_path: Path) -> None:
    """Of responses and parallel coordinates, with a mark on their names; others stay linear."""
    text = SWEEP.replace(
        "values = [0.1, 0.3]", "low = 1e-3\nhigh = 1.0\ncount = 25\nlogarithmic = true"
    )
    run_sweep(files(tmp_path, text), tmp_path / "out")
    shown = check_page(tmp_path / "out" / "sweep.html", keys=(2, 5))
    axes = [panel["layout"]["xaxis"] for panel in shown["responses"]["panels"]]
    assert {axis["title"]["text"]: axis.get("type") for axis in axes} == {
        "friction.coefficient (log)": "log",
        "motion.creepage[0]": None,
    }
    texts = {tuple(axis["ticktext"]) for axis in axes if axis.get("type") == "log"}
    assert texts == {("0.001", "0.01", "0.1", "1")}
    found = {axis["name"]: axis.get("logarithmic") for axis in shown["parallel"]["data"]["axes"]}
    assert found.pop("friction.coefficient (log)")
    assert not any(found.values())
    # of so many places the mean is one over equal parts of the range's logarithm
    at = np.geomspace(1e-3, 1.0, 25)
    x, mean = _means(at, np.log(at), logarithmic=True)
    edges = np.geomspace(1e-3, 1.0, MEANS + 1)
    assert x == pytest.approx(np.sqrt(edges[:-1] * edges[1:]))
    assert len(mean) == MEANS


def test_the_page_says_which_outputs_have_no_card(tmp_path: Path) -> None:
    """Four have one; of six the others are named, with their table."""
    names = ["creep_force[0]", "wear_number", "friction_power", "creep_power", "utilised_friction"]
    names.append("traction_coefficient")
    listed = ", ".join(f'"{name}"' for name in names)
    text = SWEEP.replace('"creep_force[0]", "max_pressure", "spin_moment"', listed)
    run_sweep(files(tmp_path, text), tmp_path / "out")
    page = (tmp_path / "out" / "sweep.html").read_text(encoding="utf-8")
    left = "utilised_friction, traction_coefficient"
    assert f"2 more of 6 outputs are in the table below, Results: {left}." in page
    assert "more of" not in page.split("<h2>Responses</h2>")[1].split("<h2>")[0]
