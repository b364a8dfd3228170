"""Railpatch: wheel-rail contact mechanics.

    import railpatch

    result = railpatch.solve("case.toml")         # or a dictionary of the same form
    contact = railpatch.Contact("case.toml")      # keeps memory and the last solution
    result = contact.step(creepage=[2e-3, 0.0])
    states = railpatch.solve_many("case.toml", {"creepage": pairs}, threads=4)   # arrays

Units are SI. Forces act on the wheel; creepages are wheel minus rail over the rolling speed.
"""

from railpatch._core import version as _version
from railpatch.contact import Contact, solve
from railpatch.errors import CaseError, ProfileError, StateError
from railpatch.many import States, solve_many
from railpatch.result import Result
from railpatch.subsurface import Subsurface

__version__ = _version()

__all__ = [
    "CaseError",
    "Contact",
    "ProfileError",
    "Result",
    "StateError",
    "States",
    "Subsurface",
    "__version__",
    "solve",
    "solve_many",
]
