"""What a worker does: the cases of one chunk, each to a row.

A chunk is plain data, so that it can go to another process or machine; the scene's files are read
there by their absolute paths. A row does not depend on the chunk that its case lies in.
"""

from __future__ import annotations

import tempfile
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railpatch.case.kinds import Ending, kind_of
from railpatch.case.load import KINDS, Case, Scene, check_case
from railpatch.case.moving import moving_keys
from railpatch.case.patch import PatchCase
from railpatch.case.patch_doubts import patch_doubts
from railpatch.contact import Contact, solve
from railpatch.errors import CaseError, ProfileError
from railpatch.pressure_error import run_doubts
from railpatch.sweep.outputs import Output, default_names, value_of
from railpatch.sweep.plan import Value, put, steps_of

if TYPE_CHECKING:
    from railpatch.log import Run

# of a case that is wrong at its point, in place of a result's status
REFUSED = "refused"
_kept = threading.local()


@dataclass(frozen=True)
class Chunk:
    """Cases of one sweep. number: of the chunk; logs: the folder for the logs of runs, if kept."""

    number: int
    kind: str
    content: dict[str, Any]
    keys: tuple[str, ...]
    ids: tuple[str, ...]
    points: tuple[tuple[Value, ...], ...]
    outputs: tuple[str, ...]
    logs: str | None = None


@dataclass(frozen=True)
class Row:
    """One case: its result's status, reason and warnings, outputs in the sweep's order; seconds
    it took."""

    id: str
    status: str
    reason: str | None
    warnings: tuple[str, ...]
    seconds: float
    outputs: tuple[Output, ...]


def get_ready(kind: str) -> None:
    """Imports what cases of a kind take, before the first one comes."""
    for name in modules_of(kind):
        import_module(name)


def modules_of(kind: str) -> list[str]:
    """What runs of a kind are made with; none for contacts, which this package solves itself."""
    if kind in KINDS:
        return []
    runner = kind_of(kind).run
    assert runner is not None
    return ["tomli_w", "railpatch.log", runner.__module__]


def solve_chunk(chunk: Chunk) -> list[Row]:
    """The rows of its cases. What is wrong with one case is said in its row."""
    return [
        solve_case(chunk, name, point) for name, point in zip(chunk.ids, chunk.points, strict=True)
    ]


def solve_case(chunk: Chunk, name: str, point: Sequence[Value]) -> Row:
    """One case to its row."""
    begin = time.perf_counter()
    try:
        ending, run = ending_of(chunk, name, point)
        values = tuple(value_of(output, ending.values, run) for output in chunk.outputs)
    except (CaseError, ProfileError) as error:
        reason = "; ".join(str(error).splitlines())
        empty = (None,) * len(chunk.outputs)
        return Row(name, REFUSED, reason, (), time.perf_counter() - begin, empty)
    seconds = time.perf_counter() - begin
    return Row(name, ending.status, ending.reason, tuple(ending.warnings), seconds, values)


def solve_first(chunk: Chunk) -> tuple[tuple[str, ...], Row]:
    """The first case, and the names of the outputs: the chunk's, or those of a sweep that names
    none. Raises CaseError, ProfileError where the case or a name is wrong."""
    begin = time.perf_counter()
    ending, run = ending_of(chunk, chunk.ids[0], chunk.points[0])
    names = chunk.outputs or tuple(default_names(ending.values))
    values = tuple(value_of(output, ending.values, run) for output in names)
    seconds = time.perf_counter() - begin
    row = Row(chunk.ids[0], ending.status, ending.reason, tuple(ending.warnings), seconds, values)
    return names, row


def ending_of(chunk: Chunk, name: str, point: Sequence[Value]) -> tuple[Ending, Run | None]:
    """Solves or runs the scene at a point. Raises CaseError, ProfileError."""
    if chunk.kind in KINDS:
        return contact_ending(chunk, point), None
    return run_ending(chunk, name, point)


def at_point(chunk: Chunk, point: Sequence[Value]) -> dict[str, Any]:
    """The scene's content there."""
    content = deepcopy(chunk.content)
    for key, value in zip(chunk.keys, point, strict=True):
        put(content, key, value)
    return content


def contact_ending(chunk: Chunk, point: Sequence[Value]) -> Ending:
    """Of one contact. One whose moving inputs alone differ from the last one's is kept and starts
    anew: its result is that of a new one, to the bit."""
    content = at_point(chunk, point)
    case = check_case(content)
    if case.kind == "patch" and case.motion.steps is not None:
        return of_result(solve(content).to_dict())
    tables = set(moving_keys(case).values())
    fixed = {name: table for name, table in content.items() if name not in tables}
    moving = {name: content[name] for name in tables if name in content}
    keys = {(step[0], step[1]) for step in map(steps_of, chunk.keys) if len(step) > 1}
    moves = {
        key: moving[table][key]
        for table, key in keys
        if table in moving and moving_keys(case).get(str(key)) == table
    }
    rest = {
        table: {key: value for key, value in values.items() if key not in moves}
        for table, values in moving.items()
    }
    state = (fixed, rest, set(moves))
    if getattr(_kept, "state", None) == state and moves:
        contact = _kept.contact
        contact.reset()
        # what does not move from step to step, as whether a number is found, needs a new one
        with suppress(CaseError):
            return of_result(contact.step(**moves).to_dict(), doubts_of(case))
    _kept.state = None
    contact = Contact(Scene(case, Path()))
    result = contact.step().to_dict()
    _kept.contact, _kept.state = contact, state
    return of_result(result, doubts_of(case))


def doubts_of(case: Case) -> list[str]:
    """Warnings of the profiles of wheels, found once for each pair, and of patches."""
    if isinstance(case, PatchCase):
        return patch_doubts(case, Path())
    known = getattr(_kept, "doubts", None)
    if known is None:
        known = _kept.doubts = {}
    name = repr((case.profiles, case.track, case.wheelset.flange_back_position))
    if name not in known:
        known[name] = run_doubts(case, Path())
    return known[name]


def of_result(data: Mapping[str, Any], doubts: Sequence[str] = ()) -> Ending:
    """The ending of a solve. doubts: further warnings."""
    return Ending(
        str(data["status"]), data.get("reason"), [*data.get("warnings", ()), *doubts], dict(data)
    )


def run_ending(chunk: Chunk, name: str, point: Sequence[Value]) -> tuple[Ending, Run | None]:
    """Of a run: its scene is written and read as a user's file."""
    import tomli_w

    runner = kind_of(chunk.kind).run
    assert runner is not None
    with tempfile.TemporaryDirectory(prefix="railpatch-sweep-") as folder:
        scene = Path(folder) / f"{chunk.kind}.toml"
        scene.write_text(tomli_w.dumps(at_point(chunk, point)), encoding="utf-8")
        log = Path(folder) / "run.mcap"
        if chunk.logs is not None:
            log = Path(chunk.logs) / f"{name}.mcap"
        ending = runner(scene, log)
        if log.is_file() and any("/" in output for output in chunk.outputs):
            from railpatch.log import read_run

            return ending, read_run(log)
        return ending, None
