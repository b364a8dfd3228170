"""Hashes of results: whether two builds, or two computers, give the same bits.

    python tests/bits/hashes.py -o FILE.json           each case's hash, or how it was refused
    python tests/bits/hashes.py --compare A.json B.json

Three steps of each case of combinations.py with other motion, so that what is kept from step to
step counts too. Times are left out; quantities that one of two builds does not know may be
left out with --without NAME.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import struct
import sys
from collections import Counter
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import railpatch
from bits.combinations import Case, all_cases, sample

TIMES = ("wall_time",)
# what follows from other numbers of the result, and has tests of its own: of patches and wheels
FOLLOW = ("creep_power", "contact_power", "wheel_heat", "rail_heat")
FOLLOW += ("wheel_temperature", "rail_temperature")
FOLLOW += ("wear_number", "traction_coefficient", "utilised_friction", "max_traction")
FOLLOW += ("contact_size", "wheel_profile_position", "rail_profile_position", "guiding_force")
FOLLOW += ("wheel_load", "derailment_quotient", "rolling_radius_difference", "conicity")
SUMS = ("friction_power", "plastic_power", "elastic_energy", "max_temperature", "residual")


def words(value: Any, left_out: tuple[str, ...]) -> bytes:
    """The bits of every number and text of a result, by name."""
    if isinstance(value, dict):
        sums = SUMS if "patches" in value or "left" in value else ()
        kept = sorted(key for key in value if key not in (*left_out, *FOLLOW, *sums))
        return b"".join(key.encode() + words(value[key], left_out) for key in kept)
    if isinstance(value, list):
        return b"[" + b"".join(words(item, left_out) for item in value) + b"]"
    if isinstance(value, float):
        return struct.pack("<d", value)
    return repr(value).encode()


def changes(case: Case, step: int) -> dict[str, Any]:
    """Moving inputs of the second and third step."""
    if step == 0:
        return {}
    if case["kind"] != "patch":
        motion = {"y": case["wheelset"]["y"] + 2e-4 * step, "x": 1e-3 * step, "pitch": -2e-3 * step}
        return motion if step == 1 else {**motion, "yaw": 2e-3}
    if "tangential_force" in case["motion"]:
        return {"spin_creepage": 0.1 * step}
    if case["motion"]["regime"] in ("none", "shift"):
        return {}
    return {"spin_creepage": 0.1 * step, "creepage": [1.3e-3 + 2e-4 * step, 3e-4]}


def direction(case: Case) -> dict[str, Any]:
    """Rates that a derivative is asked for."""
    if case["kind"] != "patch":
        return {"y": 1.0, "yaw": 0.5, "vy": 0.1}
    return {"spin_creepage": 1.0}


def plain(value: Any) -> Any:
    """Without arrays and objects."""
    if hasattr(value, "to_dict"):
        return plain(value.to_dict())
    if hasattr(value, "_asdict"):
        return plain(value._asdict())
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    return value.tolist() if hasattr(value, "tolist") else value


def outcome(case: Case, left_out: tuple[str, ...]) -> str:
    """Hash of three steps with fields, or the refusal's text."""
    digest = hashlib.sha256()
    statuses = []
    try:
        contact = railpatch.Contact(case)
        for step in range(3):
            result = contact.step(**changes(case, step), fields=True)
            data = result.to_dict()
            statuses.append(data["status"])
            digest.update(words(data, left_out))
        if case.get("method", {}).get("derivatives"):
            rates = contact.differentiate(**direction(case))
            digest.update(words(plain(rates), left_out))
    except (railpatch.CaseError, railpatch.ProfileError) as error:
        return f"refused: {error}"
    return f"{','.join(statuses)} {digest.hexdigest()[:24]}"


def compare(one: dict[str, str], two: dict[str, str]) -> int:
    """Prints what differs; how many."""
    names = [name for name in one if name in two]
    differing = [name for name in names if one[name] != two[name]]
    for name in differing[:60]:
        print(f"{name}\n  {one[name]}\n  {two[name]}")
    solved = sum(not one[name].startswith("refused") for name in names)
    print(
        f"{len(names)} cases in both, {solved} of them solved: {len(differing)} differ"
        f" ({len(one.keys() ^ two.keys())} cases in one alone)"
    )
    return len(differing)


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=Path)
    parser.add_argument("--compare", nargs=2, type=Path, metavar="FILE")
    parser.add_argument("--without", nargs="*", default=[], metavar="NAME")
    parser.add_argument("--only", default="", help="names that begin so")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="each Nth case")
    parser.add_argument("--sample", type=int, metavar="N", help="N cases that hold every feature")
    arguments = parser.parse_args()
    if arguments.compare:
        found = [json.loads(path.read_text()) for path in arguments.compare]
        return min(compare(*found), 1)
    left_out = (*TIMES, *arguments.without)
    cases = all_cases() if arguments.sample is None else sample(arguments.sample)
    chosen = [(n, c) for n, c in cases if n.startswith(arguments.only)][:: arguments.every]
    found = {name: outcome(case, left_out) for name, case in chosen}
    counts = Counter(text.split(" ")[0].split(":")[0] for text in found.values())
    total = hashlib.sha256("".join(found.values()).encode()).hexdigest()[:24]
    print(f"{len(found)} cases, {total}: {dict(counts.most_common(8))}")
    if arguments.output:
        arguments.output.write_text(json.dumps(found, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
