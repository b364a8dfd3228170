"""Runs a sweep: chunks of about a second to workers, a file for each that is done."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager, suppress
from multiprocessing import get_context
from pathlib import Path

from railpatch.case.load import KINDS, check_case
from railpatch.case.moving import moving_keys
from railpatch.errors import CaseError, ProfileError
from railpatch.sweep.outcome import Sweep
from railpatch.sweep.plan import Plan, load_plan, steps_of
from railpatch.sweep.store import need_pyarrow, read_rows, write_chunk, write_results
from railpatch.sweep.work import Chunk, Row, solve_chunk, solve_first

SECONDS = 1.0  # of a chunk, about
MOST_IN_CHUNK = 5000
# how often the cases of a worker that ended are tried; each alone the last time
TRIES = 3
WORKER_DIED = "worker_died"
Backend = Callable[[list[Chunk]], Iterable[tuple[Chunk, list[Row]]]]


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
    row = None
    if not outputs:
        outputs, row = first_of(plan, ids, list(range(len(ids))), outputs, logs)
    found = read_rows(folder, ids, outputs)
    reused = sum(name in found for name in ids)
    missing = in_order(plan, name_places(ids, found))
    solved = len(missing)
    seconds = [found[name].seconds for name in ids[:20] if name in found]
    if missing:
        # one is solved here: what is wrong with all is told at once
        if row is None or row.id in found:
            _, row = first_of(plan, ids, missing, outputs, logs)
        place = ids.index(row.id)
        write_chunk(folder, chunk_of(plan, ids, [place], outputs, logs), [row])
        found[row.id] = row
        seconds.append(row.seconds)
        missing.remove(place)
    progress(len(ids) - len(missing), len(ids))
    chunks = chunks_of(plan, ids, missing, outputs, logs, min(seconds, default=SECONDS), workers)
    done = len(ids) - len(missing)
    for chunk, rows in (backend or local_backend(workers))(chunks):
        write_chunk(folder, chunk, rows)
        found |= {row.id: row for row in rows}
        done += len(rows)
        progress(min(done, len(ids)), len(ids))
    rows = [found[name] for name in ids]
    sweep = Sweep(plan, folder, outputs, rows, reused, solved, time.perf_counter() - begin)
    sweep.written.append(write_results(folder, plan, rows, outputs))
    if page:
        # plotly takes a while to import, and workers import this
        from railpatch.sweep.page import write_page

        sweep.written.append(write_page(sweep))
    sweep.wall_time = time.perf_counter() - begin
    return sweep


def first_of(
    plan: Plan, ids: list[str], places: list[int], outputs: tuple[str, ...], logs: Path | None
) -> tuple[tuple[str, ...], Row]:
    """The names of the outputs and one case: the first, the middle or the last one, whichever is
    not refused. Raises CaseError, ProfileError of the first one where all are."""
    errors: list[CaseError | ProfileError] = []
    for place in dict.fromkeys((places[0], places[len(places) // 2], places[-1])):
        try:
            return solve_first(chunk_of(plan, ids, [place], outputs, logs))
        except (CaseError, ProfileError) as error:
            errors.append(error)
    raise errors[0]


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
        tuple(plan.points[i] for i in places),
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


def single_cases(chunk: Chunk) -> list[Chunk]:
    """Each case a chunk of its own."""
    return [
        Chunk(
            chunk.number,
            chunk.kind,
            chunk.content,
            chunk.keys,
            (name,),
            (point,),
            chunk.outputs,
            chunk.logs,
        )
        for name, point in zip(chunk.ids, chunk.points, strict=True)
    ]


def died(chunk: Chunk) -> list[Row]:
    """The rows of a case that ended its worker every time."""
    reason = f"the worker that solved it ended {TRIES} times: memory, or a signal"
    empty = (None,) * len(chunk.outputs)
    return [Row(name, WORKER_DIED, reason, (), 0.0, empty) for name in chunk.ids]


def local_backend(workers: int) -> Backend:
    """This process, or as many others on this machine."""
    if workers <= 1:
        return lambda chunks: ((chunk, solve_chunk(chunk)) for chunk in chunks)
    return lambda chunks: _in_processes(chunks, workers)


@contextmanager
def pool_of(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Processes that end with this one; what waits is dropped on an error."""
    pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"))
    try:
        yield pool
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


def _in_processes(chunks: list[Chunk], workers: int) -> Iterator[tuple[Chunk, list[Row]]]:
    """Those that ran when a worker ended are tried again alone, case by case."""
    waiting, suspects = deque(chunks), deque[tuple[Chunk, int]]()
    while waiting or suspects:
        with pool_of(workers) as pool:
            running: dict[Future[list[Row]], tuple[Chunk, int]] = {}
            broken = False
            while not broken and (waiting or suspects or running):
                while waiting and len(running) < workers and not suspects:
                    chunk = waiting.popleft()
                    running[pool.submit(solve_chunk, chunk)] = (chunk, 1)
                if suspects and not running:
                    chunk, tries = suspects.popleft()
                    running[pool.submit(solve_chunk, chunk)] = (chunk, tries)
                ended, _ = wait(running, return_when=FIRST_COMPLETED)
                for future in ended:
                    chunk, tries = running.pop(future)
                    try:
                        yield chunk, future.result()
                    except BrokenProcessPool:
                        broken = True
                        if tries < TRIES:
                            suspects += [(one, tries + 1) for one in single_cases(chunk)]
                        else:
                            yield chunk, died(chunk)
                if broken:
                    for chunk, tries in running.values():
                        suspects += [(one, tries + 1) for one in single_cases(chunk)]
