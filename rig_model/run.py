"""A whole run: every position balanced and logged."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from railpatch.case.types import SIDES
from railpatch.damage.run import RunWear, rows_of
from railpatch.log import RunLog, scene_geometry
from railpatch.result import Warned

from rig_model.balance import Balance, Balancer
from rig_model.record import Recorder, attachments, ran_with
from rig_model.scene import RigScene


@dataclass(frozen=True)
class Summary:
    """Of a run with n positions.

    path: of the log. converged: [n]. evaluations: [n], of both wheels. wall_time: s, [n], of
    finding each balance. logging_share: of the run, in the log. warned: of all positions. wear: of
    a scene with [damage], each position for the time since the one before.
    """

    path: Path
    converged: NDArray[np.bool_]
    evaluations: NDArray[np.int64]
    wall_time: NDArray[np.float64]
    logging_share: float
    warned: Warned
    wear: RunWear | None = None

    @property
    def good(self) -> bool:
        """Whether every position is balanced."""
        return bool(self.converged.all())

    def text(self) -> str:
        """The summary in a few lines."""
        count = len(self.converged)
        later = self.evaluations[1:]
        return (
            f"positions     {count}, {int(self.converged.sum())} converged\n"
            f"evaluations   {self.evaluations.mean():.2f} of both wheels a position; "
            f"first {self.evaluations[0]}, at most {later.max()} later\n"
            f"wall time     {1e3 * np.median(self.wall_time):.3g} ms a position (median), "
            f"{self.wall_time.sum():.3g} s in all\n"
            f"logging       {100 * self.logging_share:.2g} % of the run's wall time\n"
            + ("" if self.wear is None else f"wear          {self.wear.text()}\n")
            + f"log           {self.path}"
        )


def replay(
    scene: RigScene,
    path: str | PathLike[str],
    progress: Callable[[Balance], None] = lambda _: None,
) -> Summary:
    """Balances every position of the scene and writes the log; ``progress`` is told of each.

    Raises CaseError, ProfileError before a file is made, and OSError where the log cannot be
    written. A position without balance is no error: it is logged with its status.
    """
    balancer = Balancer(scene)
    recorder = Recorder(scene)
    snapshots = scene.snapshot_every()
    rows = []
    warned = Warned()
    wear = wear_of(scene)
    before = 0.0
    with RunLog(
        path,
        case_text=scene.text,
        case_name=scene.name,
        profiles=attachments(scene),
        geometry=scene_geometry(scene.case),
        ran_with=ran_with(scene),
    ) as log:
        for position in scene.positions():
            begin = time.perf_counter()
            balance = balancer.solve(position)
            wall_time = time.perf_counter() - begin
            with log.stream.counted():
                chosen = bool(snapshots) and position.index % snapshots == 0
                messages = recorder.messages(balance, wall_time, snapshot=chosen)
                if chosen:
                    fields = balancer.fields(balance)
                    messages["fields"] = {side: fields[side]["patches"] for side in SIDES}
                log.write(position.time, **messages)
            if wear is not None and balance.converged:
                way = abs(scene.case.track.roller_radius * scene.speed_at(position))
                worn = rows_of(balancer.fields(balance).to_dict())
                wear.add(1, worn, way * (position.time - before))
            before = position.time
            warned.add(f"{position.time:.4g} s", balance.result.warnings)
            rows.append((balance.converged, balance.evaluations, wall_time))
            progress(balance)
        if wear is not None:
            log.write_wear(before, {side: wear.message((1, side)) for side in SIDES})
    converged, evaluations, wall_times = (np.array(column) for column in zip(*rows, strict=True))
    return Summary(Path(path), converged, evaluations, wall_times, log.share, warned, wear)


def wear_of(scene: RigScene) -> RunWear | None:
    """What lays wear over the profiles of wheels and rollers; None without [damage]."""
    law = scene.case.damage
    if law is None:
        return None
    case = scene.case
    return RunWear(law, [case.wheelset.nominal_radius], math.tau * case.track.roller_radius)
