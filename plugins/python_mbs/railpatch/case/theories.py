"""The fast theories of the tangential problem, from the core's table of them."""

from __future__ import annotations

from railpatch import _core

FAST: tuple[str, ...] = tuple(_core.THEORIES)
# keys of [method] that only some theories read, and which
READERS: dict[str, tuple[str, ...]] = _core.THEORY_READERS
# normal theories that build contacts of any shape from rows along rolling
BY_ROWS = ("kik_piotrowski", "kik_piotrowski_corrected", "analyn")
FAST_NUMBERS = tuple(
    name for name in READERS if name not in ("traction_bound", "flexibility_blending")
)


def has_tractions(tangential: str) -> bool:
    """Whether the theory gives tractions on a grid, not only their resultants."""
    return tangential not in FAST or bool(_core.THEORIES[tangential]["tractions"])


def blends_as_contact(tangential: str) -> bool:
    """Whether it knows the flexibilities of the program CONTACT."""
    return tangential in FAST and bool(_core.THEORIES[tangential]["contact_blending"])


def follows_slip(tangential: str) -> bool:
    """Whether friction follows the speed of slip in it, without memory."""
    return tangential in FAST and bool(_core.THEORIES[tangential]["slip_law"])
