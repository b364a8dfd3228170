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
