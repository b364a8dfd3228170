"""Commands whose work goes on where it was ended: what they say when a signal ends them."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType

import click


class Ended(BaseException):
    """The process was asked to end. code: as shells tell it, 128 and the signal's number."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.code = 128 + number


@contextmanager
def told_when_ended(text: Callable[[], str]) -> Iterator[None]:
    """Ctrl-C and SIGTERM end what is inside with a line on stderr in place of a trace, and with
    exit code 130 or 143."""

    def end(number: int, _frame: FrameType | None) -> None:
        raise Ended(number)

    whole = threading.current_thread() is threading.main_thread()
    before = {n: signal.signal(n, end) for n in (signal.SIGINT, signal.SIGTERM) if whole}
    try:
        yield
    except Ended as ended:
        # what is told now is short, and said whole
        for number in before:
            signal.signal(number, signal.SIG_IGN)
        click.echo(f"ended by {signal.Signals(ended.code - 128).name}: {text()}", err=True)
        click.get_current_context().exit(ended.code)
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
