"""Critical speed against the textbook's equations of lateral motion with Kalker's linear theory.

A wheelset on rails that do not give way, with the lateral position y and the yaw angle psi (in the
manner of Wickens, Fundamentals of Rail Vehicle Dynamics, 2003); x forward, y right, z down. Cones
of inclination g on crowns of radius R, contacts at y = +-e and r below the axle. The tread moves by
u = y - r roll, and roll = -g u / e keeps both wheels on their rails: u = s y, s = 1/(1 - g r / e),
roll = -q y with q = g s / e. The contacts move by -R q y on the crowns, so that the radii differ by
twice g s (1 + R g / e) y, the conicity. Their planes roll with the wheelset; the normals keep their
angle to the axle, and the spin its size. Creepages of the right wheel, and likewise the left's:

    xi = -e psi' / V - conicity y / r,   eta = s y' / V - psi,   phi = psi' / V

with Fx = -f11 xi, Fy = -f22 eta - f23 phi, Mz = f23 eta - f33 phi. Gravity W: the planes roll by
-q y, which makes -W q y; moments about x shift W y (1 + (R + r) q)/(e - g r) from wheel to wheel,
whose slopes make -W q (1 + (R + r) q) y of it. To these come the suspension and the spinning wheel-
set's gyroscopic moments. test_terms compares these terms with single solves.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import railpatch
from railpatch.case.common import without_friction
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


def kinematics(radius: float, half: float) -> tuple[float, float, float]:
    """s (-), q (rad/m) and conicity (-)."""
    s = 1 / (1 - SLOPE * radius / half)
    return s, SLOPE * s / half, SLOPE * s * (1 + CROWN * SLOPE / half)


def gravity(load: float, radius: float, half: float) -> float:
    """N/m, lateral."""
    _, roll, _ = kinematics(radius, half)
    return load * roll * (2 + (CROWN + radius) * roll)


def textbook(scene: WheelsetScene, speed: float, radius: float, half: float, creep) -> np.ndarray:
    """[4, 4], of y, psi and their rates."""
    f11, f22, f23, f33 = creep
    body, k, c = scene.body, scene.suspension.stiffness, scene.suspension.damping
    s, roll, conicity = kinematics(radius, half)
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
            [k.y + gravity(load, radius, half), -2 * f22 * s],
            [2 * f11 * half * conicity / radius, k.yaw - load * SLOPE * half + 2 * f23],
        ]
    )
    lower = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    return np.vstack([np.hstack([np.zeros((2, 2)), np.eye(2)]), lower])


def test_terms():
    """By differences over y of single solves with the roll that follows: conicity, spin, and
    gravity's lateral stiffness, the generalised force of y and roll without friction."""
    scene = load_wheelset_scene(scene_file("hunting.toml"))
    radius, half = contact_places(scene)
    _, q, conicity = kinematics(radius, half)
    y, speed, load = 2e-4, 20.0, scene.case.wheelset.vertical_force

    def solved(at: float, friction: bool) -> railpatch.Result:
        case = scene.case.model_dump()
        motion = {"y": at, "roll": -q * at, "speed": speed, "pitch_rate": -speed / radius}
        case["wheelset"] |= motion
        case["method"]["derivatives"] = False
        return railpatch.solve(case if friction else without_friction(case))

    ends = [solved(at, True) for at in (y, -y)]
    spins = [end["right"]["patches"][0]["spin_creepage"] for end in ends]
    found = [end["conicity"] for end in ends]
    assert np.allclose(found, conicity, rtol=1e-3)
    # with normals that do not turn with the wheelset it were g y/(e r)
    assert abs(spins[0] - spins[1]) < 0.1 * 2 * y * SLOPE / (half * radius)
    ends = [solved(at, False) for at in (y, -y)]
    across = (ends[0]["force"][1] - ends[1]["force"][1]) / (2 * y)
    turning = (ends[0]["moment"][0] - ends[1]["moment"][0]) / (2 * y)
    assert abs(-(across - q * turning) / gravity(load, radius, half) - 1) < 0.01


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
