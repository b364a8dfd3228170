"""Sweeps on a cluster that Dask knows: a scheduler's address, or a batch system by dask-jobqueue.

Workers read the scene's files by their absolute paths, so they need the same file system; nothing
else is shared. What is done is written here, on the machine that asks: a worker or scheduler that
ends costs the chunks that were under way.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import suppress
from typing import Any

from railpatch.errors import CaseError
from railpatch.sweep.local import TRIES, Backend, died, single_cases
from railpatch.sweep.work import Chunk, Row, solve_chunk

RETRY = 2.0  # s, between attempts to reach a scheduler
PATIENCE = 120.0  # s, of attempts without one that answers
ALLOWED = TRIES - 1  # workers that a chunk may end before its cases are tried alone


def need_dask() -> Any:
    """dask's distributed. Raises CaseError that says what to install."""
    try:
        import distributed
    except ImportError:
        raise CaseError(
            "sweep: a cluster is reached through Dask, which is not installed; "
            "pip install 'railpatch[cluster]' has it"
        ) from None
    return distributed


def dask_backend(
    connect: Callable[[], Any], *, patience: float = PATIENCE, tell: Callable[[str], None] = print
) -> Backend:
    """Solves chunks on a cluster. connect: gives a distributed.Client, anew after each loss.

    patience: s, how long a scheduler may not answer. tell: of losses, a line each.
    """
    distributed = need_dask()

    def run(chunks: list[Chunk]) -> Iterable[tuple[Chunk, list[Row]]]:
        return _on_dask(distributed, list(chunks), connect, patience, tell)

    return run


def scheduler(address: str, timeout: float = 10.0) -> Callable[[], Any]:
    """A client of a running scheduler. timeout: s. Raises CaseError where none answers."""
    distributed = need_dask()

    def connect() -> Any:
        return distributed.Client(address, timeout=timeout, set_as_default=False)

    try:
        connect().close()
    except (OSError, ValueError, TimeoutError) as error:
        raise CaseError(
            f"--scheduler: value is {address!r}, where no scheduler answers ({error}), allowed the "
            "address that `dask scheduler` prints, as tcp://HOST:8786"
        ) from None
    return connect


def batch_system(name: str, jobs: int) -> Callable[[], Any]:
    """A client of a cluster of that many jobs. Queue, memory and time stand in dask-jobqueue's own
    configuration file. Raises CaseError."""
    need_dask()
    try:
        import dask_jobqueue
    except ImportError:
        raise CaseError(
            "--cluster: batch systems are reached through dask-jobqueue, which is not installed; "
            "pip install 'railpatch[cluster]' has it"
        ) from None
    kinds = {
        "slurm": "SLURMCluster",
        "pbs": "PBSCluster",
        "sge": "SGECluster",
        "lsf": "LSFCluster",
        "htcondor": "HTCondorCluster",
    }
    if name not in kinds:
        raise CaseError(f"--cluster: value is {name!r}, allowed {', '.join(kinds)}")
    try:
        cluster = getattr(dask_jobqueue, kinds[name])()
    except (ValueError, TypeError) as error:
        told = " ".join(str(error).split())
        raise CaseError(
            f"--cluster: {name}: {told}; cores and memory of a job stand in dask's configuration, "
            "~/.config/dask/jobqueue.yaml"
        ) from None
    cluster.scale(jobs=jobs)
    return cluster.get_client


def _on_dask(
    distributed: Any,
    chunks: list[Chunk],
    connect: Callable[[], Any],
    patience: float,
    tell: Callable[[str], None],
) -> Iterator[tuple[Chunk, list[Row]]]:
    waiting = {f"{chunk.ids[0]}-{len(chunk.ids)}": (chunk, 1) for chunk in chunks}
    answered = time.monotonic()
    while waiting:
        try:
            client = connect()
        except (OSError, TimeoutError) as error:
            if time.monotonic() - answered > patience:
                left = sum(len(chunk.ids) for chunk, _ in waiting.values())
                raise CaseError(
                    f"--scheduler: no scheduler answers for {patience:g} s ({error}); {left} cases "
                    "are left; the same command goes on with them"
                ) from None
            time.sleep(RETRY)
            continue
        try:
            for key, rows in _answers(distributed, client, waiting):
                answered = time.monotonic()
                chunk, tries = waiting.pop(key)
                if rows is not None:
                    yield chunk, rows
                elif tries < TRIES:
                    for one in single_cases(chunk):
                        waiting[f"{one.ids[0]}-{tries}"] = (one, TRIES)
                else:
                    yield chunk, died(chunk)
        except (OSError, TimeoutError, CancelledError) as error:
            tell(f"the scheduler is lost ({type(error).__name__}); trying again")
            time.sleep(RETRY)
        finally:
            _close(client)


def _answers(
    distributed: Any, client: Any, waiting: dict[str, tuple[Chunk, int]]
) -> Iterator[tuple[str, list[Row] | None]]:
    """Key and rows as they come; None for a chunk whose workers ended.

    Each thread of the cluster has a chunk and one that waits: a worker that ends takes with it no
    more than these, and results that nobody has fetched.
    """
    left = deque((key, chunk) for key, (chunk, _) in waiting.items())
    keys: dict[Any, str] = {}
    answers = distributed.as_completed(loop=client.loop, raise_errors=False)

    def fill() -> None:
        most = 2 * max(1, sum(client.nthreads().values()))
        while left and len(keys) < most:
            key, chunk = left.popleft()
            future = client.submit(solve_chunk, chunk, key=f"railpatch-{key}", pure=True)
            keys[future] = key
            answers.add(future)

    fill()
    for future in answers:
        key = keys.pop(future)
        if future.status == "finished":
            rows = future.result(timeout=60)
            fill()
            yield key, rows
            continue
        error = future.exception(timeout=10) if future.status == "error" else None
        if isinstance(error, distributed.KilledWorker):
            fill()
            yield key, None
        elif error is not None and not isinstance(error, OSError | CancelledError):
            raise error
        else:
            raise CancelledError(future.status)


def _close(client: Any) -> None:
    """Also of a scheduler that is gone."""
    with suppress(OSError, TimeoutError, CancelledError):
        client.close(timeout=5)
