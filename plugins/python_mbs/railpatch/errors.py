"""Errors of a wrong call. A solve that does not converge is not an error but a status."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


class CaseError(ValueError):
    """A case, or a change of it, is not valid.

    ``problems`` lists every problem found as ``key: value is ..., allowed ...``.
    """

    def __init__(self, problems: str | Iterable[str]) -> None:
        self.problems = [problems] if isinstance(problems, str) else list(problems)
        super().__init__("\n".join(self.problems))


class StateError(CaseError):
    """One of many states is not valid. ``state``: its number, from 0; ``problem``: of what."""

    def __init__(self, state: int, problem: str) -> None:
        self.state, self.problem = int(state), problem
        super().__init__(f"state {self.state}: {problem}")


class FileError(ValueError):
    """A file cannot be used. Names it, the line and what is wrong."""

    def __init__(self, source: str | Path, problem: str, line: int | None = None) -> None:
        self.source = str(source)
        self.line = line
        self.problem = problem
        where = self.source if line is None else f"{self.source}:{line}"
        super().__init__(f"{where}: {problem}")


class ProfileError(FileError):
    """A profile cannot be used. Names the file (or built-in name), the line and what is wrong."""


class RecordError(FileError, CaseError):
    """A record of a measured run cannot be used. Names the file, the line and what is wrong."""
