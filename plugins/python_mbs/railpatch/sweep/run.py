"""Runs a sweep: chunks of about a second to workers, a file for each that is done."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from statistics import median_low
from threading import Thread

import numpy as np

from railpatch.case.load import KINDS, check_case
from railpatch.case.moving import moving_keys
from railpatch.errors import CaseError, ProfileError
from railpatch.sweep.local import WORKER_DIED, Backend, LocalWorkers
from railpatch.sweep.outcome import Sweep
from railpatch.sweep.plan import Plan, load_plan, steps_of
from railpatch.sweep.store import is_new, need_pyarrow, read_rows, write_chunk, write_results
from railpatch.sweep.work import REFUSED, Chunk, Row, solve_chunk, solve_first

SECONDS = 1.0  # of a chunk, about
MOST_IN_CHUNK = 5000
# cases that are tried for one that is not refused: at first, besides, and s for these
LEAST_TRIED, MOST_TRIED, LONGEST_TRIED = 3, 60, 10.0
PAGE = "railpatch.sweep.page"  # imported late: workers import this module


def run_sweep(
    plan: Plan | str | Path,
    folder: str | Path,
    *,
    workers: int = 1,
    backend: Backend | None = None,
    progress: Callable[[int, int], None] = lambda _done, _all: None,
    page: bool = True,
) -> Sweep:
    """Solves the cases of a sweep that its folder has not, and writes table and page.

    plan: the path of its file, or load_plan()'s. workers: processes on this machine; backend: in
    their place what solves chunks elsewhere, as railpatch.sweep.cluster.dask_backend. progress:
    told how many of how many cases are done. A case that fails is a row with status and reason;
    Ctrl-C leaves what is done. Raises CaseError, ProfileError, OSError.
    """
    begin = time.perf_counter()
    if not isinstance(plan, Plan):
        plan = load_plan(plan)
    need_pyarrow()
    if plan.kind not in KINDS:
        need_toml_writer()
    folder = Path(folder)
    logs = folder / "logs" if plan.table.keep_logs and plan.kind not in KINDS else None
    if logs is not None:
        logs.mkdir(parents=True, exist_ok=True)
    ids = plan.ids()
    outputs = tuple(plan.table.outputs or ())
    row = first = None
    with LocalWorkers(workers if backend is None else 1, plan.kind) as local:
        if not outputs or is_new(folder):
            local.begin()
            outputs, row = first_of(plan, ids, list(range(len(ids))), outputs, logs)
        found = read_rows(folder, ids, outputs)
        reused = sum(name in found for name in ids)
        missing = in_order(plan, name_places(ids, found))
        solved = len(missing)
        known = [found[name] for name in ids[:20] if name in found]
        seconds = [one.seconds for one in known if was_solved(one)]
        if missing:
            # one is solved here: what is wrong with all is told at once
            if len(missing) > 1:
                local.begin()
            if row is None or row.id in found:
                _, row = first_of(plan, ids, missing, outputs, logs)
            place = ids.index(row.id)
            first = chunk_of(plan, ids, [place], outputs, logs)
            found[row.id] = row
            seconds.append(time_of(plan, first, row))
            missing.remove(place)
        progress(len(ids) - len(missing), len(ids))
        each = median_low(seconds) if seconds else SECONDS
        chunks = chunks_of(plan, ids, missing, outputs, logs, each, workers)
        done = len(ids) - len(missing)
        if page and (backend or workers > 1):
            # plotly takes a while to import, in which others solve
            Thread(target=import_module, args=(PAGE,), daemon=True).start()
        others = (backend or local)(chunks)
        if first is not None and row is not None:
            # pyarrow imports pandas where it is, while others solve
            write_chunk(folder, first, [row])
        for chunk, rows in others:
            write_chunk(folder, chunk, rows)
            found |= {row.id: row for row in rows}
            done += len(rows)
            progress(min(done, len(ids)), len(ids))
    rows = [found[name] for name in ids]
    sweep = Sweep(plan, folder, outputs, rows, reused, solved, time.perf_counter() - begin)
    sweep.written.append(write_results(folder, plan, rows, outputs))
    if page:
        sweep.written.append(import_module(PAGE).write_page(sweep))
    sweep.wall_time = time.perf_counter() - begin
    return sweep


def kept_of(plan: Plan, folder: Path) -> str:
    """How many of a sweep's cases its folder has, for one that was ended."""
    ids = plan.ids()
    found = read_rows(folder, ids, tuple(plan.table.outputs or ()))
    count = sum(name in found for name in ids)
    kept = f"{count} of {len(ids)} cases are kept in {folder}"
    return f"{kept}; the same command goes on with them" if count else kept


def first_of(
    plan: Plan, ids: list[str], places: list[int], outputs: tuple[str, ...], logs: Path | None
) -> tuple[tuple[str, ...], Row]:
    """The names of the outputs and one case that is not refused: of the first, the middle and the
    last one, and then of others here and there. Raises CaseError, ProfileError of the first one
    where all these are, or of one that was solved and has no such output."""
    errors: list[CaseError | ProfileError] = []
    begin = time.monotonic()
    others = np.random.default_rng(0).permutation(len(places))[:MOST_TRIED]
    tried = (0, len(places) // 2, len(places) - 1, *others.tolist())
    for place in dict.fromkeys(places[k] for k in tried):
        if len(errors) >= LEAST_TRIED and time.monotonic() - begin > LONGEST_TRIED:
            break
        try:
            return solve_first(chunk_of(plan, ids, [place], outputs, logs))
        except (CaseError, ProfileError) as error:
            errors.append(error)
    of_outputs = (error for error in errors if str(error).startswith("sweep.outputs:"))
    raise next(of_outputs, errors[0])


def time_of(plan: Plan, chunk: Chunk, row: Row) -> float:
    """s, of a case like this one. A contact's is taken again, without imports and profiles that
    only the first one reads."""
    return solve_chunk(chunk)[0].seconds if plan.kind in KINDS else row.seconds


def was_solved(row: Row) -> bool:
    """Whether its time is that of a solution: a refused case's says nothing of others."""
    return row.status not in (REFUSED, WORKER_DIED)


def need_toml_writer() -> None:
    """Raises CaseError that says what to install."""
    try:
        import tomli_w  # noqa: F401
    except ImportError:
        raise CaseError(
            "sweep: scenes of runs are written with tomli-w, which is not installed; "
            "pip install 'railpatch[sweep]' has it"
        ) from None


def name_places(ids: list[str], found: dict[str, Row]) -> dict[str, int]:
    """Of cases that are not there: each once."""
    places: dict[str, int] = {}
    for place, name in enumerate(ids):
        if name not in found:
            places.setdefault(name, place)
    return places


def in_order(plan: Plan, places: dict[str, int]) -> list[int]:
    """The first one first; then cases that differ by moving inputs alone together, as they need one
    contact."""
    if plan.kind not in KINDS or not places:
        return sorted(places.values())
    tables: dict[str, str] = {}
    for point in (plan.points[0], plan.points[-1]):
        # one of them may be refused
        with suppress(CaseError):
            tables = moving_keys(check_case(plan.case(point)))
    steps = [[*steps_of(key), ""] for key in plan.keys]
    fixed = [i for i, step in enumerate(steps) if tables.get(str(step[1])) != step[0]]
    ranks: list[dict[str, int]] = []
    for i in fixed:
        values = dict.fromkeys(repr(point[i]) for point in plan.points)
        ranks.append({value: rank for rank, value in enumerate(values)})

    def rank(place: int) -> tuple[int, ...]:
        point = plan.points[place]
        return (*(one[repr(point[i])] for one, i in zip(ranks, fixed, strict=True)), place)

    return sorted(places.values(), key=rank)


def chunk_of(
    plan: Plan,
    ids: list[str],
    places: list[int],
    outputs: tuple[str, ...],
    logs: Path | None,
    number: int = 0,
) -> Chunk:
    """The cases at these places."""
    return Chunk(
        number,
        plan.kind,
        plan.content,
        plan.keys,
        tuple(ids[i] for i in places),
        tuple(plan.placed(plan.points[i]) for i in places),
        outputs,
        None if logs is None else str(logs.resolve()),
    )


def chunks_of(
    plan: Plan,
    ids: list[str],
    missing: list[int],
    outputs: tuple[str, ...],
    logs: Path | None,
    seconds: float,
    workers: int,
) -> list[Chunk]:
    """Of about a second each, and at least four for each worker."""
    size = int(min(MOST_IN_CHUNK, max(1.0, SECONDS / max(seconds, 1e-6))))
    size = max(1, min(size, -(-len(missing) // (4 * workers))))
    starts = range(0, len(missing), size)
    return [
        chunk_of(plan, ids, missing[start : start + size], outputs, logs, number)
        for number, start in enumerate(starts)
    ]
