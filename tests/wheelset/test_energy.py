"""The balance of energies: open by less than 0.3 % of what friction and dampers take."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import wheelset_scenes as scenes

from wheelset_demo.simulation import simulate
from wheelset_demo.summary import summarise
from wheelset_demo.trace import Trace

LIMIT = 0.003


def shown(name: str, trace: Trace, measured) -> tuple[float, float]:
    """Errors of the two balances, in parts of the energy lost; printed."""
    summary = summarise(trace)
    energies = {key: round(value, 3) for key, value in summary.energies.items()}
    measured(
        f"energy, {name}: bodies and springs open by {100 * summary.mechanical_error:.4f} %, "
        f"contacts by {100 * summary.contact_error:.4f} % of the loss; J: {energies}"
    )
    return summary.mechanical_error, summary.contact_error


def test_demo(tmp_path: Path, measured):
    # the package's scene over two waves
    trace = simulate(scenes.scene(tmp_path, "s1002.toml", distance=18.0))
    mechanical, contact = shown("demo", trace, measured)
    assert mechanical < LIMIT
    assert contact < LIMIT
    lost = trace.work("friction") + trace.work("damping")
    assert lost[-1] > 20
    assert (np.diff(lost) > 0).all()
    # all of it at once: what the drive puts in is stored or lost
    assert np.abs(trace.balance_residual()).max() < LIMIT * lost[-1]


def test_explicit_stepper_closes_the_mechanical_balance(tmp_path: Path, measured):
    values = {"distance": 3.0, "step": 2.5e-4, "stepper": "rk4", "log_every": 20}
    trace = simulate(scenes.scene(tmp_path, "s1002.toml", **values))
    mechanical, _ = shown("explicit", trace, measured)
    assert mechanical < 1e-5
    # the contacts' part does not grow with the run: it comes and goes with the lateral position
    assert np.abs(trace.contact_residual()).max() < 0.06 * trace.energies[0][-1]


def test_flange_contact_and_lift_off(tmp_path: Path, measured):
    # wheels bounce off the flanges: the mechanical balance does not care, the steps must be short
    # and the log dense, as a contact on the flange comes and goes within some steps of 2 ms
    values = {"speed": 40.0, "distance": 3.0, "step": 1e-4, "stepper": "rk4", "log_every": 5}
    content = scenes.text_of("s1002.toml", **values)
    file = tmp_path / "scene.toml"
    file.write_text(content.replace("[wheelset]\n", "[wheelset]\nyaw = 0.01\n"))
    trace = simulate(scenes.load_wheelset_scene(file))
    mechanical, contact = shown("flange contact", trace, measured)
    assert trace.failure is None
    assert sum(summarise(trace).in_the_air.values()) > 0
    angles = [
        patch["contact_angle"]
        for side in ("left", "right")
        for patch in trace.result[side]["patches"]
    ]
    assert np.abs(angles).max(initial=0) < 1.3
    assert mechanical == pytest.approx(0, abs=1e-3)
    assert contact < LIMIT
