"""Workers of a sweep on this machine: this process, or as many others."""

from __future__ import annotations

import os
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager, suppress
from multiprocessing import current_process, get_context, parent_process
from multiprocessing.connection import wait as wait_for
from threading import Thread

from railpatch.errors import CaseError
from railpatch.sweep.work import Chunk, Row, get_ready, modules_of, solve_chunk

# how often the cases of a worker that ended are tried; each alone the last time
TRIES = 3
WORKER_DIED = "worker_died"
# elsewhere forks are missing, or not safe with what the system's libraries start
METHOD = "forkserver" if sys.platform == "linux" else "spawn"
GUARD = "a script that calls run_sweep(workers=...) does so under if __name__ == '__main__':"
QUEUED = 2  # chunks of each worker: one that it solves, one that waits
# what solving a case imports when it first comes to it
CASES_IMPORT = ("railpatch.sweep.work", "scipy.interpolate", "scipy.spatial")
Tried = tuple[Chunk, int]  # with the number of the try
Backend = Callable[[list[Chunk]], Iterable[tuple[Chunk, list[Row]]]]


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


def is_being_imported() -> bool:
    """Whether this process is a new one that reads its parent's script: it must start no others."""
    return getattr(current_process(), "_inheriting", False)


def start_server(kind: str) -> None:
    """Where processes are forks of a server, starts it: it imports what cases of a kind take beside
    this process and once for all."""
    if METHOD == "forkserver":
        from multiprocessing.forkserver import ensure_running

        get_context(METHOD).set_forkserver_preload([*CASES_IMPORT, *modules_of(kind)])
        ensure_running()


def end_with_parent() -> None:
    """Lets a worker end when the process that started the pool does, by a signal too."""
    parent = parent_process()
    assert parent is not None

    def watch() -> None:
        wait_for([parent.sentinel])
        os._exit(1)

    Thread(target=watch, daemon=True).start()


@contextmanager
def pool_of(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Processes that end with this one; what waits is dropped on an error."""
    pool = ProcessPoolExecutor(workers, mp_context=get_context(METHOD), initializer=end_with_parent)
    try:
        yield pool
    finally:
        pool.shutdown(wait=False, cancel_futures=True)


class LocalWorkers:
    """Solves chunks in this process, or in `count` others, of cases of one kind: these start with
    begin(), so that they are ready when the first case has been solved here. Raises CaseError in a
    process that is one of them and reads the script that starts them."""

    def __init__(self, count: int, kind: str) -> None:
        self.count = count
        self.kind = kind
        self._stack = ExitStack()
        self._pool: ProcessPoolExecutor | None = None
        self._ready: Future[None] | None = None  # of the pool's last worker
        if count > 1 and is_being_imported():
            raise CaseError(f"sweep: {count} workers of a script that a worker reads; {GUARD}")

    def __enter__(self) -> LocalWorkers:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def begin(self) -> None:
        """Starts the other processes, or what they are forks of, if there shall be any."""
        if self.count > 1 and self._pool is None:
            start_server(self.kind)
            if METHOD == "spawn":
                self._start()

    def _start(self) -> None:
        self._pool = self._stack.enter_context(pool_of(self.count))
        for _ in range(self.count):
            self._ready = self._pool.submit(get_ready, self.kind)

    def __call__(self, chunks: list[Chunk]) -> Iterable[tuple[Chunk, list[Row]]]:
        if self.count <= 1:
            return ((chunk, solve_chunk(chunk)) for chunk in chunks)
        waiting, suspects = deque((chunk, 1) for chunk in chunks), deque[Tried]()
        running: dict[Future[list[Row]], Tried] = {}
        # at once; workers that end before they have any are replaced below
        with suppress(BrokenProcessPool):
            self._hand_out(waiting, suspects, running)
        return self._in_processes(waiting, suspects, running)

    def _in_processes(
        self,
        waiting: deque[Tried],
        suspects: deque[Tried],
        running: dict[Future[list[Row]], Tried],
    ) -> Iterator[tuple[Chunk, list[Row]]]:
        """Those that ran when a worker ended are tried again alone, case by case, by new ones.
        Raises CaseError where new workers end before they are ready."""
        idle = 0  # sets of workers, one after the other, that ended so
        while waiting or suspects or running:
            broken = False
            while not broken and (waiting or suspects or running):
                try:
                    self._hand_out(waiting, suspects, running)
                    idle = 0
                except BrokenProcessPool:
                    # a worker ended while rows were taken in
                    broken = True
                    idle += not running
                    if idle == TRIES:
                        raise CaseError(
                            f"sweep: workers end before they are ready; {GUARD}"
                        ) from None
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
                self._pool = None
                for chunk, tries in running.values():
                    suspects += [(one, tries + 1) for one in single_cases(chunk)]
                running.clear()

    def _hand_out(
        self,
        waiting: deque[Tried],
        suspects: deque[Tried],
        running: dict[Future[list[Row]], Tried],
    ) -> None:
        """What waits to the workers, as far as they have room. Raises BrokenProcessPool; what was
        not handed out waits on."""
        if self._pool is None:
            start_server(self.kind)
            self._start()
        assert self._pool is not None
        if self._ready is not None:
            self._ready.result()
            self._ready = None
        while waiting and len(running) < QUEUED * self.count and not suspects:
            running[self._pool.submit(solve_chunk, waiting[0][0])] = waiting[0]
            waiting.popleft()
        if suspects and not running:
            running[self._pool.submit(solve_chunk, suspects[0][0])] = suspects[0]
            suspects.popleft()
