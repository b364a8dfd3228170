"""Tables of shapes for a pair of profiles: made small, read on every surface, and refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import railpatch
from click.testing import CliRunner
from railpatch import CaseError, Contact
from railpatch.case.creep_table import describe_table
from railpatch.command.cli import cli
from railpatch.evidence.table import pair_command, shapes
from railpatch.evidence.table.gaps import LEFT, Gaps
from railpatch.evidence.table.pair import CHECK, COARSE, FULL, Pair, Place, Ranges
from railpatch.evidence.table.pair_command import pair_case

PROFILES = ("S1002", "UIC60@1:40")
# on the tread about the middle
NARROW = Ranges(y=(-1e-3, 1e-3), yaw=5e-3, roll=1e-4, load=(6e4, 1e5), curvature=1 / 1000)


def pair(seed: int) -> Pair:
    return Pair(pair_case(*PROFILES), ".", NARROW, seed, "tread")


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Of sixteen shapes, half of them solved at a third of the creepages, told by 100 states."""
    file = tmp_path_factory.mktemp("shapes") / "tread.bin"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shapes, "FIRST", 16)
        patch.setattr(shapes, "WHOLE", 8)
        patch.setattr(shapes, "ROUND", 4)
        for name in ("NODES", "DIVIDED"):
            patch.setattr(shapes, name, (24, 8))
        parts = file.with_name("parts")
        file.write_bytes(shapes.make_shapes(pair(1), 0.01, 100, 1, lambda _text: None, 18, parts))
    return file


def method(table: Path | None) -> dict[str, str]:
    return {"tangential": "table"} | ({} if table is None else {"table_file": str(table)})


def wheel(table: Path | None, **changes: object) -> dict:
    case = pair_case(*PROFILES)
    case["wheelset"] |= {"vertical_force": 8e4, "speed": 20.0, "pitch_rate": -20.05 / 0.46}
    return {**case, "grid": COARSE, "method": method(table), **changes}


def test_it_is_nearer_to_the_full_theory_than_ellipses_are(table: Path) -> None:
    """At places and creepages that made no node, against the full theory on finer rows."""
    other = pair(2)
    errors: dict[str, list[float]] = {"shapes": [], "ellipses": []}
    for _ in range(8):
        place = other.place()
        creepages, friction = other.natural(place, 6)
        moved = COARSE["elements"]
        grid = other.grid(place, CHECK)
        full, solved = other.solve(place, creepages, FULL, grid, 1, friction, moved)
        for name, file in (("shapes", table), ("ellipses", None)):
            fast, _ = other.solve(place, creepages, method(file), COARSE, 1, friction)
            errors[name] += np.hypot(*(full - fast)[solved, :2].T).tolist()
    median = {name: float(np.median(found)) for name, found in errors.items()}
    worst = {name: float(np.percentile(found, 90)) for name, found in errors.items()}
    print(f"\nmedian {median}, 90 % {worst}")
    assert len(errors["shapes"]) > 40
    assert worst["shapes"] < 0.5 * worst["ellipses"]
    # what the table states of 100 states bounds the median of these
    assert median["shapes"] < describe_table(table.read_bytes())["error"]["force"][2]


def test_it_states_its_error(table: Path) -> None:
    stated = describe_table(table.read_bytes())["error"]["force"][2]
    result = railpatch.solve(wheel(table))
    assert result.status == "converged"
    patch = result["patches"][0]
    bound = 0.3 * patch["normal_force"]
    assert 0 < patch["error_estimate"]["creep_force"] <= stated * bound * (1 + 1e-6)
    # of ellipses nobody measured it
    assert np.isnan(railpatch.solve(wheel(None))["patches"][0]["error_estimate"]["creep_force"])


def test_what_it_has_not_seen_is_out_of_range(table: Path) -> None:
    case = wheel(table)
    case["wheelset"] |= {"y": 6.5e-3, "vertical_force": 1e5}
    result = railpatch.solve(case)
    assert result.status == "out_of_range"
    assert result.reason


def test_wheelsets_copies_and_many_states_have_it(table: Path, tmp_path: Path) -> None:
    case = wheel(table)
    whole = {key: value for key, value in case.items() if key != "wheel"} | {"kind": "wheelset"}
    whole["wheelset"] = case["wheelset"] | {"vertical_force": 1.6e5}
    contact = Contact(whole)
    assert contact.step().status == "converged"
    # by a path from the case's folder, as from any other
    (tmp_path / "near.bin").write_bytes(table.read_bytes())
    near = {**whole, "method": {"tangential": "table", "table_file": "near.bin"}}
    force = railpatch.solve(near, folder=tmp_path)["force"]
    assert list(force) == list(contact.last()["force"])
    states = railpatch.solve_many(case, {"pitch_rate": np.linspace(-43.7, -43.4, 5)})
    for k, rate in enumerate(np.linspace(-43.7, -43.4, 5)):
        alone = Contact(case).step(pitch_rate=rate)["patches"][0]["creep_force"]
        assert list(states["patches.creep_force"][k, 0]) == list(alone)


def test_slopes_are_those_of_what_it_gives(table: Path) -> None:
    """Derivatives by its own interpolation: against wide differences."""
    contact = Contact(wheel(table) | {"method": method(table) | {"derivatives": True}})
    contact.step()
    rates = contact.differentiate(pitch_rate=1.0)
    assert rates["kind"] == "exact"
    slope = rates["force"][0]
    rate, step = -20.05 / 0.46, 1e-4
    ends = [Contact(wheel(table)).step(pitch_rate=rate + s)["force"][0] for s in (-step, step)]
    assert slope == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=1e-2)


def test_other_files_are_refused(table: Path, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.bin"
    for content, words in (
        (b"profile", "is no creep table"),
        (table.read_bytes()[:-8], "length"),
        (table.read_bytes()[:4000] + b"\1" * 8 + table.read_bytes()[4008:], "altered"),
    ):
        wrong.write_bytes(content)
        with pytest.raises(CaseError, match=words):
            Contact(wheel(wrong))
    with pytest.raises(CaseError, match=r"method.table_file: .* cannot be read"):
        Contact(wheel(tmp_path / "none.bin"))
    case = wheel(table)
    case["method"] = {"tangential": "fastsim", "table_file": str(table)}
    with pytest.raises(CaseError, match=r"table_file.*only with tangential = 'table'"):
        Contact(case)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--wheel", "S1002"), "--rail: value is none"),
        (("--wheel", "S1002", "--rail", "nothing.csv"), "nothing.csv"),
        (("--wheel", "S1002", "--rail", "UIC60", "--y", "3", "1"), "--y: value is 3 1"),
        (("--wheel", "S1002", "--rail", "UIC60", "--load", "0", "10"), "--load: value is 0 10"),
        (("--wheel", "S1002", "--rail", "UIC60", "--yaw", "0"), "--yaw: value is 0"),
        (("--wheel", "S1002", "--rail", "UIC60", "--shapes", "20"), "--shapes"),
    ],
)
def test_wrong_calls(tmp_path: Path, arguments: tuple[str, ...], words: str) -> None:
    done = CliRunner().invoke(cli, ["table", *arguments, "-o", str(tmp_path / "out.bin")])
    assert done.exit_code == 2, done.output
    assert words in done.output
    assert not (tmp_path / "out.bin").exists()


def test_the_recipe_is_in_it(table: Path) -> None:
    about = describe_table(table.read_bytes())
    assert about["pair"] == "tread"
    assert about["error"]["cases"] >= 90
    assert 16 <= about["shapes"] <= 18
    json.dumps(about)


def test_states_held_out_that_err_make_shapes_and_others_tell_the_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the rounds' few states were lucky: the states that showed it are held out no longer."""
    for name, value in (("FIRST", 4), ("ROUND", 2), ("WHOLE", 3)):
        monkeypatch.setattr(shapes, name, value)
    for name in ("NODES", "DIVIDED", "CHECK"):
        monkeypatch.setattr(shapes, name, (16, 6))
    # lucky in every round; of what is held out two places in four err, until they are known
    of_table: list[str] = []
    tried_places: list[list[float]] = []
    plain_judge = shapes.judge

    def tried(known: shapes.Shapes, place: Place, _table: Path) -> tuple[Any, Any]:
        if not of_table:
            return np.full(4, 1e-3), np.zeros(4)
        tried_places[-1].append(place.at["y"])
        few = np.full(4, 0.015 if len(known) == 4 and len(tried_places[-1]) % 2 else 1e-3)
        return few, few

    def judge(*arguments: Any) -> Any:
        of_table.append("judged")
        tried_places.append([])
        found = plain_judge(*arguments)
        of_table.clear()
        return found

    monkeypatch.setattr(shapes, "tried", tried)
    monkeypatch.setattr(shapes, "judge", judge)
    data = shapes.make_shapes(pair(1), 0.01, 16, 1, lambda _text: None, 50, tmp_path / "parts")
    about = describe_table(data)
    assert about["shapes"] == 4 + 2
    assert about["error"]["force"][2] == pytest.approx(1e-3)
    first, second = tried_places
    assert len(first) == len(second) == 4
    assert not set(first) & set(second)
    # no more shapes than allowed: what it errs by is told
    tried_places.clear()
    data = shapes.make_shapes(pair(1), 0.01, 16, 1, lambda _text: None, 4, tmp_path / "few")
    assert describe_table(data)["error"]["force"][2] == pytest.approx(0.015)


def test_a_table_that_misses_its_error_says_by_how_much(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The 95th percentile, of states of which 90 % are within what was asked for."""
    told = np.concatenate([np.full(92, 1e-3), np.full(8, 0.03)])
    for name, value in (("FIRST", 4), ("ROUND", 2), ("WHOLE", 3), ("STATES", 100)):
        monkeypatch.setattr(shapes, name, value)
    for name in ("NODES", "DIVIDED"):
        monkeypatch.setattr(shapes, name, (16, 6))
    monkeypatch.setattr(shapes, "tried", lambda *_: (told, told))
    arguments = ["table", "--wheel", PROFILES[0], "--rail", PROFILES[1], "--shapes", "50"]
    monkeypatch.setattr(pair_command, "make_shapes", partial(few_shapes, shapes.make_shapes))
    out = tmp_path / "out.bin"
    done = CliRunner().invoke(cli, [*arguments, "--check", "100", "-o", str(out)])
    assert done.exit_code == 0, done.output
    assert "force 0.100 / 0.100 / 3.000 / 3.000 / 3.000" in done.stdout
    assert "95 % lie below 3.00 %, not 1 % as asked for" in done.stderr


def few_shapes(
    make: Callable[..., bytes], _pair: Pair, error: float, check: int, threads: int,
    step: Callable[[str], None], _most: int, parts: Path,
) -> bytes:  # fmt: skip
    """Four, of the narrow pair."""
    return make(pair(1), error, check, threads, step, 4, parts)


class Stopped(Exception):
    """In place of a machine that goes down."""


def test_a_run_that_was_stopped_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With the same places, shapes and errors as one that was not."""
    for name, value in (("FIRST", 4), ("ROUND", 2), ("WHOLE", 3), ("KEPT", 1)):
        monkeypatch.setattr(shapes, name, value)
    for name in ("NODES", "DIVIDED", "CHECK"):
        monkeypatch.setattr(shapes, name, (16, 6))
    solved: list[str] = []

    def stop(text: str) -> None:
        solved.append(text)
        if len(solved) == 3:
            raise Stopped

    def made(parts: str, step: Callable[[str], None] = lambda _text: None) -> dict[str, Any]:
        data = shapes.make_shapes(pair(1), 0.05, 8, 1, step, 5, tmp_path / parts)
        return {key: value for key, value in describe_table(data).items() if key != "seconds"}

    whole = made("whole")
    with pytest.raises(Stopped):
        made("parts", stop)
    assert len(np.load(tmp_path / "parts/shapes.npz")["features"]) == 2
    assert made("parts") == whole
    # of another pair, or damaged: they are solved anew
    other = shapes.Shapes(Pair(pair_case("S1002", "UIC60@1:20"), ".", NARROW, 1, "other"), 1)
    other.go_on(tmp_path / "parts/shapes.npz")
    (tmp_path / "parts/shapes.npz").write_bytes(b"no archive")
    shapes.Shapes(pair(1), 1).go_on(tmp_path / "parts/shapes.npz")
    assert len(other) == 0


def test_gaps_are_filled_by_what_rows_share() -> None:
    """Sums of five functions, known at a third of the places, to what noise leaves of them."""
    random = np.random.default_rng(3)
    functions = random.normal(size=(5, 99, 3))
    amounts = 0.01 * random.normal(size=(41, 5))
    rows = 0.1 + np.einsum("nk,kpc->npc", amounts, functions)
    known = np.arange(0, 99, 3)
    gaps = Gaps(rows[:40], known)
    # five numbers from 99 with a standard deviation of LEFT each, without any noise in them
    assert np.abs(gaps.filled(rows[40][known]) - rows[40]).max() < LEFT
    noisy = rows[40] + LEFT * random.normal(size=rows[40].shape)
    found = gaps.filled(noisy[known])
    assert (found[known] == noisy[known]).all()
    others = np.setdiff1d(np.arange(99), known)
    # the five amounts' errors, seen by functions of size 1: sqrt(5 / 99) LEFT expected
    assert np.sqrt(np.mean((found - rows[40])[others] ** 2)) < 2 * np.sqrt(5 / 99) * LEFT
