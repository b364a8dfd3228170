"""What a run answers: the verdict and the key numbers that its page opens with."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from railpatch.case.types import SIDES
from railpatch.log.waves import Waves, half_waves, waves
from railpatch.page.parts import BAD, GOOD, PLAIN, Key, opening
from railpatch.page.tables import short
from railpatch.report.beside import Beside
from railpatch.report.data import Positions
from railpatch.report.reference import Match, differences
from railpatch.report.scene import MPH, contact_places, friction_of, scene_of, speed_of


def rig(data: Positions, matches: list[Match], measured: Beside | None) -> str:
    """Of a roller rig: L/V over the angle of attack."""
    friction, law = friction_of(data.run)
    speed = speed_of(data)
    about = [data.run.metadata["railpatch"].get("scene", "")]
    if np.isfinite(speed):
        about.append(f"{speeds(speed)}")
    if np.isfinite(friction):
        about.append(f"friction coefficient {short(friction)}" + f", {law}" * (law != "constant"))
    peaks = {side: _peak(data, side) for side in SIDES}
    keys = [
        Key(f"greatest L/V, {side} wheel", short(abs(value)), f"at {short(yaw)} mrad")
        for side, (value, yaw) in peaks.items()
        if np.isfinite(value)
    ]
    greatest = max((abs(value) for value, _ in peaks.values()), default=np.nan)
    if np.isfinite(friction):
        share = f"greatest L/V is {short(greatest / friction)} of it" if greatest >= 0 else law
        keys.append(Key("friction coefficient", short(friction), share))
    if np.isfinite(speed):
        keys.append(Key("speed", f"{short(speed)} m/s", _other_speeds(speed)))
    load = data.state["vertical_force"]
    if np.isfinite(load).any():
        keys.append(Key("load on the wheelset", f"{short(1e-3 * np.nanmean(load))} kN"))
    text, beside = _agreement(data, matches, measured)
    keys += beside
    verdict = f"L/V reaches {short(greatest)}. {text}" if np.isfinite(greatest) else text
    return opening(
        "Roller rig: L/V over the angle of attack",
        ", ".join(filter(None, about)),
        *_judged(data, verdict, keys),
    )


def wheelset(data: Positions) -> str:
    """Of a wheelset on track: its waves beside Klingel's, whether they die, what they cost."""
    found = waves_of(data)
    speed, (friction, law) = speed_of(data), friction_of(data.run)
    about = [data.run.metadata["railpatch"].get("scene", "")]
    if np.isfinite(speed):
        about.append(speeds(speed))
    if np.isfinite(friction):
        about.append(f"friction coefficient {short(friction)}" + f", {law}" * (law != "constant"))
    ratio = decay(data)
    keys = _wave_keys(found, ratio) + energy_keys(data.energy, data.has_energy)
    keys.append(Key("distance", f"{short(np.ptp(data.state['x']))} m", speeds(speed)))
    return opening(
        "Wheelset on track",
        ", ".join(filter(None, about)),
        *_judged(data, _wave_verdict(found, ratio), keys),
    )


def hunting(data: Positions, found: dict[str, Any]) -> str:
    """Of a search for the critical speed, and the run above or below it."""
    critical, below = found["critical_speed"], found.get("critical_speed_below")
    keys, ran = [], found["logged_speed"]
    if critical is not None:
        verdict = (
            f"Critical speed {speeds(critical)}: above it waves of {short(found['wave_length'])} "
            "m grow."
        )
        keys += [
            Key("critical speed", f"{short(critical)} m/s", f"{short(3.6 * critical)} km/h"),
            Key("frequency there", f"{short(found['frequency'])} Hz"),
            Key("wave length there", f"{short(found['wave_length'])} m", _klingel(data)),
        ]
    elif below is not None:
        verdict = f"Waves grow already at the lowest speed tried, {speeds(below)}."
    else:
        verdict = "No speed that was tried makes waves grow."
    away = found.get("divergence")
    if away is not None:
        verdict += (
            f" At {speeds(away['speed'])} the wheelset leaves the middle without a wave, by "
            f"{short(away['growth'])} 1/s."
        )
    if "critical_speed_in_time" in found and found["critical_speed_in_time"] is not None:
        in_time = found["critical_speed_in_time"]
        keys.append(Key("the same from runs in time", f"{short(in_time)} m/s"))
    ratio = decay(data)
    note = ""
    if np.isfinite(ratio):
        note = f"waves {'grow' if ratio > 1 else 'die'}: {short(ratio)} times a wave"
    keys.append(Key("speed of this run", f"{short(ran)} m/s", note))
    keys += energy_keys(data.energy, data.has_energy)[:1]
    scene = data.run.metadata["railpatch"].get("scene", "")
    return opening("Hunting", scene, *_judged(data, verdict, keys))


def waves_of(data: Positions) -> Waves:
    """Of the run's lateral position over its distance."""
    state = data.state
    radii = np.column_stack([data.contact[side]["rolling_radius"] for side in SIDES])
    nominal = (scene_of(data.run).get("wheelset") or {}).get("nominal_radius")
    radius = float(nominal) if nominal else float(np.nanmean(radii))
    return waves(state["x"], state["y"], state["roll"], radii, contact_places(data), radius)


def decay(data: Positions) -> float:
    """-, amplitude of a wave over that of the wave before, mean of the run; NaN of a short one."""
    _, peaks = half_waves(data.state["x"], data.state["y"])
    if len(peaks) < 2 or not peaks[0] > 0:
        return float("nan")
    # two peaks a wave
    return float((peaks[-1] / peaks[0]) ** (2 / (len(peaks) - 1)))


def energy_keys(energy: Any, known: bool) -> list[Key]:
    """What is lost in friction, and what is open in the balances."""
    if not known:
        return []
    friction, damping = (energy[name] for name in ("friction_work", "damping_work"))
    lost = float(np.nansum([friction[-1], damping[-1]]))
    keys = [Key("lost in friction", f"{short(friction[-1])} J", f"dampers {short(damping[-1])} J")]
    if lost > 0:
        open_ = sum(
            float(np.nanmax(np.abs(energy[name])))
            for name in ("mechanical_residual", "contact_residual")
            if np.isfinite(energy[name]).any()
        )
        keys.append(
            Key("open in the balances", f"{short(100 * open_ / lost)} %", "of what is lost")
        )
    return keys


def agreement_text(data: Positions, matches: list[Match]) -> str:
    """Greatest L/V, and how far it is from the reference, in a sentence."""
    greatest = max(abs(_peak(data, side)[0]) for side in SIDES)
    return f"L/V reaches {short(greatest)}. {_agreement(data, matches, None)[0]}"


def wave_text(data: Positions) -> str:
    """Waves beside Klingel's, in a sentence."""
    return _wave_verdict(waves_of(data), decay(data))


def speeds(value: float) -> str:
    """m/s and km/h."""
    return f"{short(value)} m/s ({short(3.6 * value)} km/h)" if np.isfinite(value) else ""


def _other_speeds(value: float) -> str:
    return f"{short(value / MPH)} mph, {short(3.6 * value)} km/h"


def _peak(data: Positions, side: str) -> tuple[float, float]:
    """Greatest ratio by size and the yaw angle in mrad."""
    ratio = data.ratio[side]
    if not np.isfinite(ratio).any():
        return float("nan"), float("nan")
    index = int(np.nanargmax(np.abs(ratio)))
    return float(ratio[index]), 1e3 * float(data.state["yaw"][index])


def _agreement(
    data: Positions, matches: list[Match], measured: Beside | None
) -> tuple[str, list[Key]]:
    """How far it is from what was measured, or from the reference."""
    ratios = measured.ratios() if measured is not None else {}
    if ratios:
        off = np.concatenate([pair.difference for pair in ratios.values()])
        named = measured.what if measured is not None else ""
        what = "what was measured" if named == "measured" else named
    elif matches:
        off = differences(matches, data)["ratio"]
        what = "the reference"
    else:
        return "Nothing is laid beside it.", []
    off = off[np.isfinite(off)]
    if not off.size:
        return f"It has no position in common with {what}.", []
    rms, largest = float(np.sqrt((off**2).mean())), float(np.abs(off).max())
    note = f"root mean square; largest {short(largest)}"
    text = (
        f"It is off {what} by {short(rms)} (root mean square of {off.size} values of both wheels), "
        f"at most {short(largest)}."
    )
    return text, [Key(f"L/V off {what}", short(rms), note)]


def _wave_keys(found: Waves, ratio: float) -> list[Key]:
    keys = []
    if np.isfinite(found.length):
        keys.append(Key("wave length", f"{short(found.length)} m", _beside_klingel(found)))
    if np.isfinite(ratio):
        word = "grows" if ratio > 1 else "dies"
        note = f"{word}: {short(1e3 * found.first)} mm at first, {short(1e3 * found.last)} at last"
        state = BAD if ratio > 1.05 else GOOD if ratio < 1 else PLAIN
        keys.append(Key("amplitude from wave to wave", f"{short(ratio)} times", note, state))
    if np.isfinite(found.conicity):
        keys.append(Key("conicity found in the run", short(found.conicity)))
    return keys


def _wave_verdict(found: Waves, ratio: float) -> str:
    if not np.isfinite(found.length):
        return "The run is too short for a wave."
    text = f"Waves of {short(found.length)} m"
    if np.isfinite(found.klingel):
        text += f", {_beside_klingel(found)}"
    if np.isfinite(ratio):
        word = "grow" if ratio > 1 else "die away"
        text += f"; they {word}, each {short(ratio)} times the one before"
    return text + "."


def _beside_klingel(found: Waves) -> str:
    if not np.isfinite(found.klingel):
        return ""
    off = 100 * (found.length / found.klingel - 1)
    return f"Klingel's are {short(found.klingel)} m ({off:+.2g} %)".replace("-", "\u2212")


def _klingel(data: Positions) -> str:
    found = waves_of(data)
    return f"Klingel {short(found.klingel)} m" if np.isfinite(found.klingel) else ""


def _judged(data: Positions, verdict: str, keys: Iterable[Key]) -> tuple[str, list[Key], str]:
    """With what was not solved before all else."""
    bad = int((~data.solved).sum())
    if not bad:
        return verdict, list(keys), GOOD
    return f"{bad} of {data.count} positions did not converge. {verdict}", list(keys), BAD
