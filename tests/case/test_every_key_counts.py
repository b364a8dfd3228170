"""A key that does nothing is a defect.

Every key of the schema is changed on every kind, method, regime and law. The change shows in the
numbers of the results, or the case is refused by a text that names the key, or the key stands in
IDLE with the reason why it does nothing there. That a method, regime or law does not read a key is
no reason: such a key is refused. One key at a time on base cases, and on pairs of
features: some here, all in `make test-long`.
"""

from __future__ import annotations

import functools
import itertools
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import railpatch
from case.idle_keys import IDLE, get, idle
from case.key_cases import (
    KEYS_OF_SOME,
    SINGLE,
    Case,
    Numbers,
    features,
    keys_of,
    numbers,
    others,
    run,
    whole,
    with_features,
)
from case_samples import with_values
from railpatch.case import scene_profiles
from railpatch.case.load import KINDS


@pytest.fixture(scope="module", autouse=True)
def profiles_read_once() -> Iterator[None]:
    """Splines of built-in profiles are the same in every case."""
    first = scene_profiles.load_profile

    @functools.cache
    def read(name: str, body: Any, folder: Path, smoothing: float | None, reading: Any) -> Any:
        return first(name, body, folder=folder, smoothing=smoothing, reading=reading)

    scene_profiles.load_profile = lambda name, body, *, folder, smoothing, reading: read(
        name, body, folder, smoothing, reading
    )
    yield
    scene_profiles.load_profile = first


# --- the test ------------------------------------------------------------------------------------


def put(case: Case, path: str, value: Any) -> Case:
    return with_values(case, **{path.replace(".", "__"): value})


def differ(plain: list[Numbers], changed: Iterator[Numbers]) -> bool:
    """Whether results do; no more of them are asked for than that takes."""
    same = lambda x, y: x == y or (x != x and y != y)  # noqa: E731
    return any(
        a is None or b is None or a.keys() != b.keys() or not all(same(a[k], b[k]) for k in a)
        for a, b in itertools.zip_longest(plain, changed)
    )


# what the solver spent is not what it found, nor what it thinks of its errors; fields would hide
# what no number of the result shows
SPENT = ("iterations", "residual", "evaluations", "ambiguous", "error_estimate")
OF_FIELDS = ("temperature.depth",)


def found(case: Case, path: str) -> Iterator[Numbers]:
    """What is looked at for a key."""
    for result in run(case, fields=path in OF_FIELDS):
        values = numbers(result.to_dict())
        yield {key: v for key, v in values if not any(word in key for word in SPENT)}


def dead_keys(case: Case, only: random.Random | None = None) -> list[str]:
    """Keys that change nothing, and refusals that do not name the key."""
    try:
        plain = {path: list(found(case, path)) for path in ("", *OF_FIELDS)}
    except railpatch.CaseError:
        return []
    dead = []
    keys = [key for key in keys_of(KINDS[case["kind"]], case) if others(*key)]
    for path, field, value in only.sample(keys, KEYS_OF_SOME) if only else keys:
        for other in others(path, field, value):
            try:
                counts = differ(plain.get(path, plain[""]), found(put(case, path, other), path))
            except (railpatch.CaseError, railpatch.ProfileError) as error:
                if not names_key(str(error), path, other):
                    dead.append(f"{path} = {other!r}: refused by {str(error)[:200]!r}")
                continue
            if not counts and idle(path, case, other) is None:
                dead.append(f"{path} = {other!r}: changes nothing")
    return dead


def names_key(text: str, path: str, value: Any) -> bool:
    """Whether a refusal says which key it is: by its name, a word it was given, or as one of the
    elastic constants, whose relation counts."""
    if path.startswith("material.") and "material" in text:
        return True
    return path.rpartition(".")[2] in text or (isinstance(value, str) and repr(value) in text)


def traits(case: Case) -> tuple[str, ...]:
    """Kind, methods, regime and law."""
    return (
        case["kind"],
        get(case, "method.normal", "half_space"),
        get(case, "method.tangential", "full"),
        get(case, "motion.regime", "steady_rolling"),
        get(case, "friction.law", "coulomb"),
        "fitted" if get(case, "grid.fitted") else "grid",
    )


@pytest.mark.parametrize("names", [n for n in SINGLE if whole(n)], ids=" ".join)
def test_one_key_at_a_time(names: tuple[str, ...]) -> None:
    dead = dead_keys(with_features(*names))
    assert not dead, "\n".join(dead)


@pytest.mark.parametrize("names", [n for n in SINGLE if not whole(n)], ids=" ".join)
def test_some_keys_of_wheels(names: tuple[str, ...]) -> None:
    """Of what takes wheels long, all with the pairs."""
    dead = dead_keys(with_features(*names), only=random.Random(SINGLE.index(names)))
    assert not dead, "\n".join(dead)


def test_idle_keys_count_elsewhere() -> None:
    """What may do nothing in some cases does something in the base case that its entry names."""
    for entry in IDLE:
        kinds = [
            k for k in ("patch", "wheelset") if entry.counts and entry.counts[0] in features(k)
        ]
        counted = [counts(with_features(kind, *entry.counts), entry.key) for kind in kinds]
        assert any(counted) or not entry.counts, entry.key


def counts(case: Case, wanted: str) -> bool:
    """Whether a key does something."""
    for path, field, value in keys_of(KINDS[case["kind"]], case):
        if path != wanted:
            continue
        plain = list(found(case, path))
        for other in others(path, field, value):
            try:
                if differ(plain, found(put(case, path, other), path)):
                    return True
            except railpatch.CaseError:
                continue
    return False


def pairs_of(kind: str) -> list[tuple[str, ...]]:
    """Two features at a time, and a left wheel on its own."""
    if kind == "wheel_rail":
        return [(kind, "other side", name) for name in features(kind) if name != "other side"]
    return [(kind, *names) for names in itertools.combinations(features(kind), 2)]


PAIRS = [pair for kind in KINDS for pair in pairs_of(kind)]
REST = [names for names in SINGLE if not whole(names)]
SOME = random.Random(20261122).sample(PAIRS, 60)


@pytest.mark.parametrize("part", range(4))
def test_keys_of_some_pairs(part: int) -> None:
    dead = []
    for k, names in enumerate(SOME[part::4]):
        some = random.Random(100 * part + k)
        dead += [(names, text) for text in dead_keys(with_features(*names), only=some)]
    assert not dead, dead


@pytest.mark.long
@pytest.mark.parametrize("names", [*REST, *PAIRS], ids=" ".join)
def test_keys_of_all_pairs(names: tuple[str, ...]) -> None:
    dead = dead_keys(with_features(*names))
    assert not dead, "\n".join(dead)


def test_how_much_is_looked_at(capsys: pytest.CaptureFixture[str]) -> None:
    """Values of keys by kind, methods, regime and law, without solving any: no base case is
    refused."""
    seen: set[tuple[str, ...]] = set()
    keys: set[tuple[str, str]] = set()
    for names in SINGLE:
        case = with_features(*names)
        for path, field, value in keys_of(KINDS[case["kind"]], case):
            if others(path, field, value):
                seen.add((path, *traits(case)))
                keys.add((case["kind"], path))
        railpatch.case.load_scene(case)
    bases = {traits(with_features(*names)) for names in SINGLE}
    with capsys.disabled():
        print(
            f"\n{len(keys)} keys of {len(KINDS)} kinds, {len(bases)} combinations of kind, methods,"
            f" regime and law: {len(seen)} in {len(SINGLE)} base cases, {len(PAIRS)} pairs"
        )
    assert len(keys) > 180
    assert len(seen) > 2500
    # each as often as the schema allows, with every theory and law
    theories = {"none", *railpatch._core.THEORIES, "full"}
    assert {base[2] for base in bases} == theories
    assert {base[4] for base in bases} == set(railpatch._core.CHOICES["friction_law"])
    assert {base[3] for base in bases} == {"none", "shift", "transient_rolling", "steady_rolling"}
