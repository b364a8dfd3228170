"""What the digits of control words are here, and those that have no counterpart."""

from __future__ import annotations

USUAL = (8.0, 4.0, 12.0)  # D_SEP, D_COMB, D_TURN, mm
NORMAL = {0: "half_space", 2: "hertz", 3: "hertz", 5: "kik_piotrowski", 6: "analyn"}
REGIME = {0: "none", 1: "shift", 2: "transient_rolling", 3: "steady_rolling"}
SHAPE = {2: "linear", 3: "rational", 4: "exponential"}
# where a digit of a module has no counterpart, and why
REFUSED = {
    "B": {1: "a thin sheet", 4: "SDEC"},
    "P": {1: "a sequence without its tractions", 3: "a step that is repeated"},
}
REFUSED_ON_WHEELS = {
    "T": {1: "a shift of wheels on rails"},
    "D": {3: "slip of true surfaces", 6: "search", 7: "search", 8: "search", 9: "search"},
    "C3": {3: "bilinear elements"},
}
FACTORS = {"k0": "K0", "alpha": "ALFA", "beta": "BETA"}
# values of digits that no block looks at; of modules where they differ
ALLOWED: dict[str, tuple[int, ...]] = {
    "P": (0, 1, 2, 3),
    "B": tuple(range(7)),
    "T": (0, 1, 2, 3),
    "N": (0, 1),
    "S": (0, 1, 2, 3),
    "X": (0, 1),
    "H": (0, 1, 3),
    "I": (0, 1, 2, 3),
    "A": (0, 1, 2),
    "R": (0, 1, 2, 3),
}
ALLOWED_OF = {
    1: {"C1": (0, 1, 4, 5), "F": (0, 1, 2, 3), "V": (0, 1, 2), "C3": (0, 1, 2, 3, 4)},
    3: {"F": (0, 1, 2), "V": (0, 3), "C3": (0, 1, 2, 3, 4, 9), "E": (0, 1, 2, 3, 9)},
}


def out_of_range(module: int, digits: dict[str, int]) -> str | None:
    """The first digit that has no such value, and what it may be."""
    for name, value in digits.items():
        allowed = ALLOWED_OF[module].get(name, ALLOWED.get(name))
        if allowed is not None and value not in allowed:
            return f"{name} = {value}: allowed {', '.join(map(str, allowed))}"
    return None
