"""The kinds of FMU that come with the package: each has what its scene needs, and nothing else."""

from __future__ import annotations

import contextlib
import re
import resource
import sys
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
from fmpy.validation import validate_fmu
from fmu_scenes import OWN, STEP
from railpatch.case.load import Scene
from railpatch.errors import CaseError
from railpatch.fmu import pack_fmu
from railpatch.fmu.scenes import kind_scene, kinds
from slave import OK, Fmu, Slave

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

DOCUMENT = Path(__file__).parents[2] / "docs" / "fmu.md"
TABLE = tomllib.loads((resources.files("railpatch.fmu") / "variables.toml").read_text())
SIDES = ("left", "right")


@dataclass(frozen=True)
class Wanted:
    """What a kind has, in the words of variables.toml."""

    kind: str
    conditions: set[str]
    sides: tuple[int, ...] = (1,)
    patches: int = 1

    @property
    def exchange(self) -> bool:
        """Whether it offers model exchange."""
        return "history" not in self.conditions

    @property
    def derivatives(self) -> bool:
        """Whether the core has exact ones."""
        return not self.conditions & {"history", "temperature"}


PATCH = {"tangential", "force", "creepage[1]", "creepage[2]"}
WHEEL = {"tangential", "position", "coulomb"}
HISTORY = {"history", "substeps"}
HEAT = {"temperature", "exchange"}
BOTH = (0, 1)
WANTED = {
    "patch": Wanted("patch", PATCH | {"coulomb"}),
    "patch_temperature": Wanted("patch", PATCH | HISTORY | HEAT | {"warm friction"}),
    "patch_plastic": Wanted("patch", PATCH | HISTORY | {"coulomb", "yields"}),
    "patch_transient": Wanted("patch", PATCH | HISTORY | {"coulomb"}),
    "wheel": Wanted("wheel_rail", WHEEL),
    "wheel_flange": Wanted("wheel_rail", {"tangential", "force", "coulomb", "shares"}, patches=6),
    "wheelset_rail": Wanted("wheelset", WHEEL | {"shares"}, BOTH, 6),
    "wheelset_rollers": Wanted("wheelset", WHEEL | {"shares", "roller"}, BOTH, 6),
    "wheelset_temperature": Wanted("wheelset", WHEEL | HEAT | {"shares"}, BOTH, 3),
}


def names_of(wanted: Wanted) -> Iterator[tuple[int, str]]:
    """Reference and name of every variable, by what the head of variables.toml says."""
    has = wanted.conditions
    for group in TABLE["group"]:
        for row in group["variables"]:
            asks = {**group, **row}
            needed = set(asks.get("when", ()))
            needed |= set(asks.get("when_patch", ())) if wanted.kind == "patch" else set()
            if wanted.kind not in asks.get("kinds", (wanted.kind,)) or not needed <= has:
                continue
            if not has & set(asks.get("without", ())):
                yield from spelled(asks, wanted)


def spelled(row: dict[str, Any], wanted: Wanted) -> Iterator[tuple[int, str]]:
    """One row, everywhere where it occurs."""
    output = row["causality"] == "output" and wanted.kind != "patch"
    for side in wanted.sides if row["scope"] != "scene" else (None,):
        for patch in range(1, 1 + wanted.patches) if row["scope"] == "patch" else (0,):
            of_side = f"{SIDES[side]}." if side is not None and wanted.kind == "wheelset" else ""
            before = f"{of_side}{f'patch[{patch}].' if patch else ''}" if output else ""
            name = before + row["name"].replace("{side}", "" if side is None else SIDES[side])
            first = row["reference"] + 100 * patch + (0 if side is None else 1000 * (side + 1))
            for k in row.get("components", (None,)):
                yield (first, name) if k is None else (first + k - 1, f"{name}[{k}]")


@pytest.fixture(scope="session")
def made(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Fmu]:
    """Name of a kind -> its FMU, unpacked."""
    folder = tmp_path_factory.mktemp("kinds")
    found: dict[str, Fmu] = {}

    def make(name: str) -> Fmu:
        if name not in found:
            path = folder / f"{name}.fmu"
            pack_fmu(kind_scene(name)[1], path, name=name, backend=OWN)
            assert validate_fmu(str(path)) == []
            zipfile.ZipFile(path).extractall(folder / name)
            found[name] = Fmu(folder / name)
        return found[name]

    return make


def test_every_kind_is_described() -> None:
    assert kinds() == sorted(WANTED)


@pytest.mark.parametrize("name", WANTED)
def test_exactly_the_variables_of_the_scene(name: str, made: Callable[[str], Fmu]) -> None:
    wanted = sorted(names_of(WANTED[name]))
    fmu = made(name)
    found = {
        n: r for n, r in fmu.references.items() if fmu.variables[n].get("causality") != "local"
    }
    assert sorted((reference, n) for n, reference in found.items()) == wanted
    exchange = fmu.root.find("ModelExchange")
    assert (exchange is not None) == WANTED[name].exchange
    provides = fmu.root.find("CoSimulation").attrib["providesDirectionalDerivative"]
    assert provides == str(WANTED[name].derivatives).lower()


@pytest.mark.parametrize("name", WANTED)
def test_the_document_has_these_numbers(name: str, made: Callable[[str], Fmu]) -> None:
    """Inputs, outputs, model exchange and derivatives as in the table of docs/fmu.md."""
    fmu = made(name)
    [row] = re.findall(rf"^\| `{name}` \|(.*)\|$", DOCUMENT.read_text(), re.M)
    cells = [cell.strip() for cell in row.split("|")]
    yes = {True: "yes", False: "no"}
    assert cells[1:5] == [
        str(len(fmu.names("input"))),
        str(len(fmu.names("output"))),
        yes[WANTED[name].exchange],
        yes[WANTED[name].derivatives],
    ]


@pytest.mark.parametrize("name", WANTED)
def test_it_runs(name: str, made: Callable[[str], Fmu]) -> None:
    with Slave(made(name)).initialize() as slave:
        for k in range(3):
            assert slave.step(k * STEP, STEP) == OK, slave.log
        outputs = slave.outputs()
        assert outputs["status"] == 0
        assert slave.log == []
    if "temperature" in name:
        assert outputs["max_temperature"] > 40.0  # the wheel's bulk temperature
    if "plastic" in name:
        assert outputs["plastic_power"] > 0
        assert outputs["elements.plastic"] > 0


def test_shares_are_those_of_the_forces(made: Callable[[str], Fmu]) -> None:
    """Of one patch 1; where patches join below 1, together 1 where the contacts are one."""
    with Slave(made("wheel_flange")).initialize() as slave:
        seen = []
        for k in range(40):
            assert slave.set({"wheelset.y": 5.5e-3 + 2.5e-5 * k}) == OK
            assert slave.step(k * STEP, STEP) == OK, slave.log
            [count, *shares] = slave.get("patch_count", *(f"patch[{p}].share" for p in range(1, 7)))
            assert all(0 < share <= 1 for share in shares[: int(count)])
            assert not any(shares[int(count) :])
            seen += shares[: int(count)]
    assert min(seen) < 1
    assert max(seen) == 1


def test_an_unknown_kind_is_refused(tmp_path: Path) -> None:
    from click.testing import CliRunner
    from railpatch.fmu.command import fmu

    run = CliRunner().invoke(fmu, ["--scene", "bogie", "-o", str(tmp_path / "a.fmu")])
    assert isinstance(run.exception, CaseError)
    assert "bogie" in str(run.exception)
    assert "wheelset_rollers" in str(run.exception)
    both = ["case.toml", "--scene", "patch", "-o", str(tmp_path / "a.fmu")]
    assert isinstance(CliRunner().invoke(fmu, both).exception, CaseError)
    assert list(tmp_path.iterdir()) == []


def test_a_kind_is_a_case_like_any_other() -> None:
    name, scene = kind_scene("patch_transient")
    assert name == "patch_transient"
    assert isinstance(scene, Scene)
    assert scene.case.motion.regime == "transient_rolling"


def resident() -> float:
    """MB of this process."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


@pytest.mark.parametrize("name", ["wheelset_rail", "wheelset_rollers"])
def test_an_instance_takes_less_than_12_MB(name: str, made: Callable[[str], Fmu]) -> None:
    """With derivatives, after two steps; the first instance pays for what all share."""
    count, fmu = 6, made(name)
    with contextlib.ExitStack() as stack:
        stack.enter_context(Slave(fmu)).initialize().step(0.0, STEP)
        before = resident()
        for _ in range(count):
            slave = stack.enter_context(Slave(fmu)).initialize()
            for k in range(2):
                assert slave.step(k * STEP, STEP) == OK, slave.log
            assert slave.derivative(["force[3]"], {"wheelset.y": 1.0})[0] == OK
        taken = (resident() - before) / count
    assert 1 < taken < 12


@pytest.mark.parametrize("name", WANTED)
def test_every_vector_names_its_frame_and_every_turn_its_point(
    name: str, made: Callable[[str], Fmu]
) -> None:
    """In its own description, for who sees the list of variables alone."""
    for variable in made(name).variables.values():
        if variable.attrib["causality"] == "local":
            continue
        text, quantity = variable.attrib["description"], variable[0].attrib.get("quantity")
        own = variable.attrib["name"]
        if own.endswith("]"):
            assert re.search(r"(track|wheelset|profile) axes|contact frame", text), own
        if own.startswith("wheelset") and quantity in ("Angle", "AngularVelocity"):
            assert re.search(r"through|about its axle", text), own
        if quantity == "Torque":
            assert re.search(r"about the wheelset's centre|contact reference", text), own
        if own.startswith("wheelset") and quantity in ("Length", "Velocity"):
            assert re.search(r"centre|origin|profile", text), own
