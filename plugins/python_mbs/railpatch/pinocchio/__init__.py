"""Wheelsets on track in Pinocchio: force elements, a model builder, energies.

    from railpatch.pinocchio import ForceElement, Suspension, wheelset_model

Needs the extra: pip install 'railpatch[pinocchio]'. The host calls forwardKinematics(model, data,
q, v), then the force elements' step(), each of which adds to ``fext``, then aba(..., fext), or
acceleration_derivatives(...) for implicit steps and eigenvalues. World axes are the track's (x
forward, y right, z down) unless a placement of the track is given; the track is straight.
"""

try:
    from pinocchio import StdVec_Force as _  # noqa: F401
except ImportError as error:
    # another package of that name lacks it
    raise ImportError(
        "railpatch.pinocchio needs Pinocchio: pip install 'railpatch[pinocchio]'"
    ) from error

from railpatch.pinocchio.derivative import (
    AccelerationDerivatives,
    StateChain,
    acceleration_derivatives,
)
from railpatch.pinocchio.element import ForceElement
from railpatch.pinocchio.energy import Energies, Powers, energies, powers
from railpatch.pinocchio.model import Body, wheelset_model
from railpatch.pinocchio.suspension import Suspension

__all__ = [
    "AccelerationDerivatives",
    "Body",
    "Energies",
    "ForceElement",
    "Powers",
    "StateChain",
    "Suspension",
    "acceleration_derivatives",
    "energies",
    "powers",
    "wheelset_model",
]
