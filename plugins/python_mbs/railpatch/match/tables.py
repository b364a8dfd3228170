"""The table [match] in schemas of scenes that can be matched."""

from __future__ import annotations

from collections.abc import Callable

from railpatch.case.kinds import SceneKind
from railpatch.match.plan import MatchTable


def match() -> tuple[type[MatchTable], Callable[[SceneKind], bool]]:
    """Of scenes of one contact, and of runs that are followed."""
    return (
        MatchTable,
        lambda kind: kind.follow is not None or kind.command.startswith("railpatch solve"),
    )
