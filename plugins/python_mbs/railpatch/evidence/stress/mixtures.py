"""Random mixtures of everything, each from the program's seed and its own number."""

from __future__ import annotations

from typing import Any

import numpy as np

from railpatch.evidence.bench.problems import merged
from railpatch.evidence.stress.inelastic_trials import SLIDING
from railpatch.evidence.stress.laws import SHAPES
from railpatch.evidence.stress.trial import (
    CREEPAGE,
    FORCE,
    FRICTION,
    METHODS,
    MODULUS,
    POISSON,
    SAYS_SO,
    SEMI_AXIS,
    Move,
    Trial,
    expected,
    nominal,
)

COUNT, QUICK_COUNT = 10_000, 150
# elements across: mostly few, for the time; now and then many
USUAL, MOST = 40, 128
# of the mixtures; the other fast theories have the last, the full theory the rest
SHARES = {"fitted rows": 0.12, "linear": 0.04, "polach": 0.04, "fastsim": 0.06}
FAST_SHARE = 0.05
Random = np.random.Generator


def mixture(seed: int, number: int) -> Trial:
    """The mixture with this number."""
    random = np.random.default_rng([seed, number])
    draw = Draw(random)
    return Trial("mixture", f"{number}: {draw.text}", draw.case, draw.moves, draw.note)


def log_uniform(random: Random, low: float, high: float) -> float:
    """Between two positive numbers, evenly in the logarithm."""
    return float(np.exp(random.uniform(np.log(low), np.log(high))))


def shares() -> list[float]:
    """Of METHODS, in their order."""
    others = [SHARES.get(name, FAST_SHARE) for name in METHODS if name != "full"]
    return [1 - sum(others), *others]


class Draw:
    """One draw: case, steps, and its features in words."""

    def __init__(self, random: Random) -> None:
        self.random = random
        self.text = ""
        self.note = ""
        self.expects: tuple[str, ...] = ("converged",)
        self.friction = FRICTION
        self.method = str(random.choice(list(METHODS), p=shares()))
        self.features: list[str] = []
        self.regime = "steady_rolling"
        if self.method == "full":
            self.regime = str(
                random.choice(["steady_rolling", "transient_rolling", "shift"], p=[0.6, 0.25, 0.15])
            )
        else:
            self.expects = expected(self.method)
        self.case = nominal(
            self.shape(), self.bodies(), self.friction_law(), self.layer(), self.heat()
        )
        self.case = merged(merged(self.case, self.motion()), METHODS[self.method])
        if self.method == "full":
            self.case["grid"] = self.grid()
        self.moves = tuple(self.steps())
        self.text = ", ".join([self.regime.replace("_", " "), *self.features])

    def chance(self, share: float) -> bool:
        """True in such a share of draws."""
        return bool(self.random.random() < share)

    def shape(self) -> dict[str, Any]:
        """Semi-axes of any ratio; the load goes with their size, and beyond."""
        random = self.random
        self.force = log_uniform(random, 1.0, 1e6)
        widest = 100.0 if self.chance(0.2) else 10.0
        ratio = log_uniform(random, 1 / widest, widest)
        size = SEMI_AXIS * float(np.cbrt(self.force / FORCE)) * log_uniform(random, 0.3, 3.0)
        self.axes = [size * ratio**0.5, size / ratio**0.5]
        return {"geometry": {"semi_axes": self.axes}, "load": {"normal_force": self.force}}

    def grid(self) -> dict[str, Any]:
        """Elements across."""
        most = MOST if self.chance(0.02) else USUAL
        size = [round(log_uniform(self.random, 3, most)) for _ in range(2)]
        return {"elements": size}

    def bodies(self) -> dict[str, Any]:
        """Elastic constants."""
        self.modulus = log_uniform(self.random, 1e9, 1e12) if self.chance(0.3) else MODULUS
        ratio = float(self.random.uniform(0, 0.5)) if self.chance(0.5) else POISSON
        return {"material": {"shear_modulus": self.modulus, "poisson_ratio": ratio}}

    def friction_law(self) -> dict[str, Any]:
        """Coulomb mostly; other laws where the full theory rolls."""
        self.friction = 0.0 if self.chance(0.02) else log_uniform(self.random, 1e-6, 2.0)
        if self.chance(0.5):
            self.friction = float(self.random.uniform(0.05, 0.7))
        if self.method == "full" and self.regime != "shift":
            if self.chance(0.2):
                return {"friction": self.slip_velocity()}
            if self.chance(0.1):
                return {"friction": self.by_temperature()}
        law: dict[str, Any] = {"coefficient": self.friction}
        if self.method == "full" and self.chance(0.05):
            self.features.append("friction by place")
            law["factor"] = [[-0.2 * self.axes[1], 0.5], [0.3 * self.axes[1], 1.5]]
        return {"friction": law}

    def slip_velocity(self) -> dict[str, Any]:
        """Falling or rising friction."""
        random = self.random
        shape = str(random.choice([name for name in SHAPES if name != "polach"]))
        rising = self.chance(0.3)
        self.features.append(f"{'rising' if rising else 'falling'} friction")
        if not rising:
            self.says_so("falling friction may have several solutions, or none that is stable")
        amplitude = (-0.5 if rising else 0.9) * self.friction
        return {
            "law": "slip_velocity", "shape": shape, "coefficient": None,
            "kinetic": self.friction - amplitude, "amplitude": amplitude,
            "halving_speed": log_uniform(random, 1e-2, 10.0),
            "memory_distance": log_uniform(random, 1e-4, 1e-2) if self.chance(0.4) else 0.0,
        }  # fmt: skip

    def by_temperature(self) -> dict[str, Any]:
        """Friction that changes with temperature."""
        self.features.append("friction by temperature")
        self.says_so("steep feedback of heat on friction may have no stable solution")
        return {
            "law": "temperature", "coefficient": None, "reference": self.friction,
            "change": float(self.random.uniform(-1, 1)) * self.friction,
            "reference_temperature": 0.0,
            "temperature_range": log_uniform(self.random, 1.0, 1e3),
        }  # fmt: skip

    def says_so(self, note: str) -> None:
        """There may be no solution."""
        self.expects, self.note = SAYS_SO, note

    def layer(self) -> dict[str, Any]:
        """Elastic or plastic layer, where the theory takes one."""
        if self.method not in ("full", "fitted rows") or not self.chance(0.3):
            return {}
        random = self.random
        thickness = 1e-4
        ratio = log_uniform(random, 1e-3, 1e3)
        size = float(np.sqrt(self.axes[0] * self.axes[1]))
        own = {"thickness": thickness, "shear_modulus": ratio * self.modulus * thickness / size}
        self.features.append("layer")
        if self.method != "full" or not self.chance(0.5):
            return {"layer": own}
        if self.chance(0.3):
            own = {"thickness": 0.0}
        self.features.append("plastic")
        bound = self.friction * 1.5 * self.force / (np.pi * self.axes[0] * self.axes[1])
        own["yield_stress"] = max(log_uniform(random, 1e-4, 3.0) * bound, 1.0)
        # over the bodies' own stiffness on the scale of an element
        slope = self.modulus / (0.1 * min(self.axes))
        own["hardening"] = float(slope * random.choice([-10, -0.3, 0, 0.03, 1, 1e3]))
        own["plastic_rule"] = str(random.choice(["path", "magnitude"]))
        if own["hardening"] < 0:
            self.says_so("beyond the snap-back limit there need be no solution near by")
        return {"layer": own}

    def heat(self) -> dict[str, Any]:
        """Surface temperature."""
        law = "friction by temperature" in self.features
        if law or (self.method == "full" and self.regime != "shift" and self.chance(0.1)):
            self.features.append("temperature")
            return {"temperature": {"wheel": float(self.random.uniform(0, 300))}}
        return {}

    def velocities(self) -> dict[str, Any]:
        """Creepages and spin, in units of saturation and beyond."""
        random = self.random
        unit = CREEPAGE * self.pressure_ratio()
        size = min(unit * log_uniform(random, 1e-5, 1e3), 1.0)
        if self.regime == "shift":
            unit = SLIDING * self.pressure_ratio() * self.axes[0] / SEMI_AXIS
            size = min(unit * log_uniform(random, 1e-5, 1e3), 1.0)
        angle = random.uniform(0, 2 * np.pi)
        spin = 0.0
        if self.chance(0.5):
            spin = unit / max(self.axes) * log_uniform(random, 1e-4, 100) * random.choice([-1, 1])
        creepage = [float(size * np.cos(angle)), float(size * np.sin(angle))]
        return {"creepage": creepage, "spin_creepage": float(spin)}

    def pressure_ratio(self) -> float:
        """Friction over stiffness, by that of the nominal case."""
        here = max(self.friction, 1e-6) * self.force / (self.modulus * self.axes[0] * self.axes[1])
        return here / (FRICTION * FORCE / (MODULUS * SEMI_AXIS**2))

    def motion(self) -> dict[str, Any]:
        """[motion]."""
        random = self.random
        own: dict[str, Any] = {"regime": self.regime, **self.velocities()}
        own["rolling_speed"] = log_uniform(random, 1e-6, 150.0)
        own["direction"] = int(random.choice([-1, 1]))
        if self.regime == "transient_rolling":
            own |= {"steps": 1, "distance": self.axes[0] * log_uniform(random, 1e-3, 20.0)}
        coulomb = "law" not in self.case["friction"] and "factor" not in self.case["friction"]
        self.forced = (
            self.method in ("full", "fitted rows")
            and coulomb
            and self.friction > 0
            and self.chance(0.1)
        )
        if self.forced:
            self.features.append("prescribed force")
            self.says_so("lateral creepage and spin may take what the force asks for")
            share = float(random.choice([0.1, 0.7, 0.99, 0.999]))
            own["creepage"] = [0.0, own["creepage"][1]]
            own["tangential_force"] = [share * self.friction * self.force, "creepage"]
        return {"motion": own}

    def steps(self) -> list[Move]:
        """One step, or some with other loads and motions."""
        found = [Move({}, self.expects)]
        count = int(self.random.choice([0, 1, 3], p=[0.5, 0.3, 0.2]))
        if self.regime != "steady_rolling":
            count += 1
        for _ in range(count):
            changes = self.velocities()
            if self.forced:
                changes["creepage"][0] = 0.0
            elif self.chance(0.4):
                changes["normal_force"] = self.force * log_uniform(self.random, 0.01, 100.0)
            if self.regime == "transient_rolling" and self.chance(0.3):
                changes["distance"] = self.axes[0] * log_uniform(self.random, 1e-3, 20.0)
            found.append(Move(changes, self.expects))
        if count:
            self.features.append(f"{count + 1} steps")
        return found
