"""Critical speed against the textbook's equations of lateral motion with Kalker's linear theory.

A wheelset on rails that do not give way, with the lateral position y and the yaw angle psi (in the
manner of Wickens, Fundamentals of Rail Vehicle Dynamics, 2003); x forward, y right, z down. Cones
of inclination g on crowns of radius R, contacts at y = +-e and r below the axle. The wheelset rolls
by -g y / e, which moves the tread by s = 1 + g r / e of y and the contacts on the crowns, so that
the radii differ by the conicity g (1 + R g / e). Creepages of the right wheel, and likewise the
left's:

    xi = -e psi' / V - conicity y / r,   eta = s y' / V - psi,   phi = psi' / V - g y / (e r)

with Fx = -f11 xi, Fy = -f22 eta - f23 phi, Mz = f23 eta - f33 phi. To these come the suspension,
gravity by the wheels' slopes, and the spinning wheelset's gyroscopic moments.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import railpatch
from scipy.optimize import brentq

from wheelset_demo.hunting import critical_mode
from wheelset_demo.scene import WheelsetScene, load_wheelset_scene, scene_file
from wheelset_demo.start import released
from wheelset_demo.system import System

SLOPE, CROWN = 1 / 20, 0.3  # of the scene's profiles
# of a grid of 12 x 12 elements in place of Kalker's coefficients: some per cent of each of them
BOUND = 0.02


def creep_coefficients(scene: WheelsetScene, radius: float) -> tuple[float, ...]:
    """f11, f22 (N), f23 (N m), f33 (N m^2) of one wheel: Hertz's ellipse, Kalker's coefficients."""
    case = scene.case
    load = case.wheelset.vertical_force / 2
    small = 1e-7

    def forces(creepage: list[float], spin: float) -> np.ndarray:
        motion: dict[str, Any] = {"creepage": creepage, "spin_creepage": spin}
        patch = {
            "kind": "patch",
            "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
            "geometry": {"curvatures": [0.5 / radius, 0.5 / CROWN]},
            "load": {"normal_force": load},
            "motion": {"regime": "steady_rolling", "rolling_speed": 10.0, **motion},
            "friction": {"coefficient": 0.3},
            "method": {"normal": "hertz", "tangential": "linear"},
        }
        result = railpatch.solve(patch)
        return np.array([*result["creep_force"], result["spin_moment"]]) / -small

    along, across, spin = forces([small, 0], 0), forces([0, small], 0), forces([0, 0], small)
    return along[0], across[1], spin[1], spin[2]


def contact_places(scene: WheelsetScene) -> tuple[float, float]:
    """m: rolling radius and half the distance of the contacts, straight on."""
    straight = scene.at_speed(20.0, 0.0)
    system = System(straight)
    system.rates(0.0, released(straight, system).motion)
    result = system.element.result()
    (patch,) = result["right"]["patches"]
    return result["right"]["rolling_radius"], patch["position"][1]


def textbook(scene: WheelsetScene, speed: float, radius: float, half: float, creep) -> np.ndarray:
    """[4, 4], of y, psi and their rates."""
    f11, f22, f23, f33 = creep
    body, k, c = scene.body, scene.suspension.stiffness, scene.suspension.damping
    roll = SLOPE / half
    s, conicity = 1 + roll * radius, SLOPE * (1 + CROWN * roll)
    load = scene.case.wheelset.vertical_force
    inertia = body.roll_inertia + body.carrier_inertia
    spin = roll * body.pitch_inertia * speed / radius
    mass = np.diag([body.total_mass + inertia * roll**2, inertia])
    damping = np.array(
        [
            [c.y + 2 * f22 * s**2 / speed, 2 * f23 * s / speed - spin],
            [spin - 2 * f23 * s / speed, c.yaw + 2 * (f11 * half**2 + f33) / speed],
        ]
    )
    stiffness = np.array(
        [
            [k.y + load * roll * (1 + CROWN * roll) - 2 * f23 * s * roll / radius, -2 * f22 * s],
            [
                2 * (f11 * half * conicity - f33 * roll) / radius,
                k.yaw - load * SLOPE * half + 2 * f23,
            ],
        ]
    )
    lower = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    return np.vstack([np.hstack([np.zeros((2, 2)), np.eye(2)]), lower])


def test_critical_speed(measured):
    scene = load_wheelset_scene(scene_file("hunting.toml"))
    mode = critical_mode(scene, 10.0, 100.0)
    radius, half = contact_places(scene)
    creep = creep_coefficients(scene, radius)

    def eigenvalues(speed: float) -> np.ndarray:
        return np.linalg.eigvals(textbook(scene, speed, radius, half, creep))

    speed = brentq(lambda v: eigenvalues(v).real.max(), 10.0, 100.0)
    frequency = np.abs(eigenvalues(speed).imag).max() / (2 * np.pi)
    measured(
        f"critical speed, textbook: {speed:.3f} m/s, {frequency:.3f} Hz; here "
        f"{mode.speed:.3f} m/s ({100 * (mode.speed / speed - 1):+.2f} %), "
        f"{mode.frequency:.3f} Hz"
    )
    assert abs(mode.speed / speed - 1) < BOUND
    assert abs(mode.frequency / frequency - 1) < BOUND
