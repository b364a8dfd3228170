"""A signal whose handler raises ends a long step soon, and the contact goes on as a new one."""

from __future__ import annotations

import signal
import time
from typing import Any

import pytest
from case_samples import PATCH, with_values
from railpatch import CaseError, Contact

# some seconds of work
LONG = with_values(
    PATCH,
    grid__elements=[200, 200],
    method={"normal": "half_space", "tangential": "full", "tolerance": 1e-10},
    motion__creepage=[5e-4, 3e-4],
    motion__spin_creepage=0.3,
    friction={
        "law": "slip_velocity",
        "kinetic": 0.1,
        "amplitude": 0.2,
        "halving_speed": 0.02,
    },
)
AFTER = 0.15  # s of processor time


class Stop(Exception):
    """What the handler raises."""


def stop(*_: Any) -> None:
    raise Stop


def test_a_long_step_ends_soon_after_a_signal() -> None:
    contact, other = Contact(LONG), Contact(LONG)
    before = signal.signal(signal.SIGPROF, stop)
    try:
        begin = time.process_time()
        signal.setitimer(signal.ITIMER_PROF, AFTER)
        with pytest.raises(Stop):
            contact.step()
        took = time.process_time() - begin
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)
        signal.signal(signal.SIGPROF, before)
    assert took + 0.02 >= AFTER
    assert took < AFTER + 0.2
    with pytest.raises(CaseError, match="there is no step"):
        contact.last()
    # nothing slips: a short step
    still = {"creepage": [0.0, 0.0], "spin_creepage": 0.0}
    first, second = (c.step(**still).to_dict() for c in (contact, other))
    assert first["status"] == "converged"
    assert {**first, "wall_time": 0} == {**second, "wall_time": 0}
