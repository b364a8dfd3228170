"""Packs an FMU: description, scene, library, documentation. No compiler is needed."""

from __future__ import annotations

import hashlib
import os
import re
import time
import uuid
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from importlib import resources
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

from railpatch import _core
from railpatch.case.load import Scene
from railpatch.case.patch import PatchCase
from railpatch.case.to_core import config_of
from railpatch.case.viscous import is_viscous
from railpatch.contact import Contact, at_balance
from railpatch.errors import CaseError
from railpatch.fmu.choice import chosen, input_conditions, with_patches
from railpatch.fmu.constants import constants_of
from railpatch.fmu.description import Labels, description_xml
from railpatch.fmu.description3 import description3_xml
from railpatch.fmu.document import index_html
from railpatch.fmu.libraries import Libraries, libraries_of
from railpatch.fmu.picture import model_png
from railpatch.fmu.profiles import TYPES, Choices, check_starts, choices_of, file_conditions
from railpatch.fmu.reference import csv_of, reference_csv, series
from railpatch.fmu.scene import kind_of, scene_text, variables_of
from railpatch.fmu.sources import build_description, with_source_files
from railpatch.fmu.step_size import step_size_of
from railpatch.fmu.table import Kind, Table, Variable
from railpatch.fmu.terminals import FOLDER, ICON, terminals_xml
from railpatch.pressure_error import run_doubts
from railpatch.result import SOLVED
from railpatch.writing import write_whole

Backend = Literal["eigen", "fftw"]
# "exact": where the core has them without further solves
Derivatives = Literal["exact", "always", "none"]
LICENCES = {"eigen": "Apache-2.0 AND MPL-2.0", "fftw": "GPL-3.0-or-later"}
# the name of the library tells the licence
SUFFIXES = {"eigen": "", "fftw": "_fftw_gpl"}
# ZIP knows no time before 1980
FIRST_DATE = 315532800


@dataclass(frozen=True)
class Options:
    """What an FMU offers beside a scene's outputs; see pack_fmu."""

    derivatives: Derivatives
    averages: bool
    largest_step: bool
    wheel_profiles: Sequence[str] = ()
    rail_profiles: Sequence[str] = ()
    profile_files: bool = False
    version: Literal[2, 3] = 2  # of FMI
    inputs: Sequence[str] = ()
    outputs: Sequence[str] = ()
    patches: int | None = None


@dataclass(frozen=True)
class Contents:
    """What an FMU is made of."""

    labels: Labels
    table: Table
    kind: Kind
    variables: list[Variable]
    scene: Scene
    backend: Backend
    libraries: Libraries
    creep_table: bytes | None
    choices: Choices
    config: dict[str, Any]
    version: int = 2

    def description(self, token: str) -> str:
        """modelDescription.xml."""
        write = description3_xml if self.version == 3 else description_xml
        return write(self.labels, self.table, self.kind, self.variables, token)

    def scene_text(self, guid: str) -> str:
        """resources/scene.txt."""
        provided = self.labels.derivatives
        return scene_text(self.scene, self.variables, guid, self.kind, provided, self.choices)


class PackedFmu(type(Path())):  # type: ignore[misc]
    """The path of an FMU, and what packing it was doubtful of."""

    warnings: tuple[str, ...] = ()


def pack_fmu(
    scene: Scene,
    output: str | Path,
    *,
    name: str = "scene",
    backend: Backend = "eigen",
    derivatives: Derivatives = "exact",
    averages: bool = False,
    largest_step: bool = False,
    libraries: Path | None = None,
    wheel_profiles: Sequence[str] = (),
    rail_profiles: Sequence[str] = (),
    profile_files: bool = False,
    fmi: Literal[2, 3] = 2,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    patches: int | None = None,
) -> PackedFmu:
    """Writes the FMU of a scene; gives its path, with `warnings` where the scene or a combination
    of profiles has no contact at the start values.

    name: of the model. backend: "eigen" (permissive), or "fftw" (then the FMU is under the
    GPL). derivatives: of the outputs; "exact": where they come from the solved conditions;
    "always": else by differences of further solves; a scene with a history has none. averages:
    outputs of forces averaged over a step, and sub-steps for them (scenes with wheels).
    largest_step: an output for masters, with mass and inertia of the wheelset as parameters, in
    scenes with wheels and derivatives; it costs two to three steps where it is read. libraries: a
    folder that `make fmu` made, with all platforms and sources; None: this one's library.
    wheel_profiles, rail_profiles: built-in names or files (relative ones start at the scene's
    folder), to choose from beside the case's own, for both sides; each combination's start must be
    solved. profile_files: of each wheel and rail a parameter with the path of a prepared profile
    (railpatch.profiles.prepared), read at run time. fmi: 2 (FMI 2.0) or 3 (FMI 3.0, vectors are
    arrays). inputs: "friction", coefficients of Coulomb's law or factors of another law as inputs.
    outputs: which to keep, by name, by patterns ("left.*") or groups (OUTPUT_GROUPS); none: all.
    patches: of each wheel, in place of the case's max_patches.
    The same scene, libraries and SOURCE_DATE_EPOCH give the same bytes. Raises CaseError.
    """
    output = Path(output)
    profiles: dict[str, Any] = {"wheel_profiles": wheel_profiles, "rail_profiles": rail_profiles}
    profiles["profile_files"] = profile_files
    asked = {"inputs": inputs, "outputs": outputs, "patches": patches}
    options = Options(derivatives, averages, largest_step, **profiles, version=fmi, **asked)
    contents = contents_of(scene, output.stem, name, backend, options, libraries)
    guid = guid_of(contents)
    files = files_of(contents, guid)
    packed = BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        for path, content in sorted(files.items()):
            archive.writestr(entry(path), content)
    try:
        written = PackedFmu(write_whole(output, packed.getvalue()))
    except OSError as error:
        raise CaseError(f"{output}: cannot be written: {error.strerror or error}") from None
    written.warnings = contents.labels.warnings
    return written


def contents_of(
    scene: Scene,
    stem: str,
    name: str,
    backend: Backend,
    options: Options,
    folder: Path | None,
) -> Contents:
    """Everything that is known before the GUID."""
    scene = at_balance(with_patches(scene, options.patches), name)
    libraries = libraries_of(backend, folder, options.version)
    table = Table(Path(str(resources.files("railpatch.fmu") / "variables.toml")))
    check_regime(scene)
    config = config_of(scene)
    kind = kind_of(scene.case, _core.config_numbers(config), averages=options.averages)
    check_options(options, kind)
    choices = choices_of(scene, {"wheel": options.wheel_profiles, "rail": options.rail_profiles})
    also = {"version 3"} if options.version == 3 else set()
    also |= input_conditions(options.inputs, kind)
    also |= file_conditions(scene) if options.profile_files else set()
    kind = replace(kind, conditions=kind.conditions | choices.conditions() | also)
    for body in choices.sources:
        table.fill(TYPES[body], choices.items(body))
    # solved once, so that an FMU is never made of a scene that the core refuses or cannot start
    kinds, start = derivative_kind(
        scene, name, asked=options.derivatives != "none" and not kind.has_history
    )
    doubtful = [f"{name}: {text}, at the start values" for text in start["warnings"]]
    if start["status"] == "no_contact":
        doubtful.append(f"{name}: no contact at the start values")
    if not isinstance(scene.case, PatchCase):
        doubtful += [f"{name}: {text}" for text in run_doubts(scene.case, scene.folder)]
    apart = check_starts(choices, name)
    provided = kinds == "exact" or (kinds == "differences" and options.derivatives == "always")
    if options.largest_step:
        if not provided:
            raise CaseError("--largest-step: given, allowed with derivatives only")
        kind = replace(kind, conditions=kind.conditions | {"largest step"})
    labels = Labels(
        identifier=identifier_of(stem) + SUFFIXES[backend],
        name=name,
        description=describe(kind, backend),
        licence=LICENCES[backend],
        version=_core.version(),
        date=time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(epoch())),
        tolerance=scene.case.method.tolerance,
        step=step_size_of(scene.case, kind, table, start),
        derivatives=provided,
        warnings=(*doubtful, *apart),
    )
    variables = chosen(variables_of(table, kind, scene.case), options.outputs)
    variables += constants_of(scene.case, table, variables)
    creep_table = config["creep_table"].tobytes() if "creep_table" in config else None
    return Contents(
        labels=labels,
        table=table,
        kind=kind,
        variables=variables,
        scene=scene,
        backend=backend,
        libraries=libraries,
        creep_table=creep_table,
        choices=choices,
        config=config,
        version=options.version,
    )


def check_options(options: Options, kind: Kind) -> None:
    """What a scene of this kind cannot have. Raises CaseError."""
    for name, given in (("averages", options.averages), ("largest-step", options.largest_step)):
        if given and kind.kind == "patch":
            raise CaseError(f"--{name}: given, allowed with wheels only")
    if options.derivatives == "always" and kind.has_history:
        raise CaseError(
            "--derivatives: value is 'always', allowed 'exact' (none in a scene whose steps depend "
            "on earlier ones) or 'none'"
        )


def check_regime(scene: Scene) -> None:
    """A step of a slave is one in time. Raises CaseError."""
    motion = getattr(scene.case, "motion", None)
    for key in ("regimes", "regime_changes"):
        if getattr(motion, key, None):
            raise CaseError(f"motion.{key}: given, allowed in an FMU: left out, one regime for all")
    if getattr(motion, "slip_field", None) is not None:
        raise CaseError("motion.slip_field: given, allowed in an FMU: left out, inputs are numbers")
    if is_viscous(scene.case.material):
        raise CaseError("material.viscoelastic_ratio: given, allowed in an FMU: 0, elastic bodies")
    if scene.case.material.influence_file is not None:
        raise CaseError("material.influence_file: given, allowed in an FMU: left out, half-spaces")
    regime = getattr(motion, "regime", "none")
    if regime == "shift":
        raise CaseError(
            "motion.regime: value is 'shift', allowed 'none', 'steady_rolling' or "
            "'transient_rolling' in an FMU"
        )
    steps = getattr(getattr(scene.case, "motion", None), "steps", None) or 1
    if steps != 1:
        raise CaseError(f"motion.steps: value is {steps}, allowed 1 in an FMU: each step is one")


def derivative_kind(scene: Scene, name: str, *, asked: bool) -> tuple[str, dict[str, Any]]:
    """How derivatives are found: "exact", "differences" or "none"; and the result at the start.
    Raises CaseError where that cannot be solved."""
    curved = scene.case.method.reference_surface == "curved"
    asked = asked and not curved
    method = scene.case.method.model_copy(update={"derivatives": asked})
    contact = Contact(Scene(scene.case.model_copy(update={"method": method}), scene.folder))
    start = contact.step()
    if start.status not in SOLVED:
        why = f"{start.status}: {start.reason}" if start.reason else start.status
        raise CaseError(f"{name}: the start values cannot be solved: {why}")
    return contact.differentiate()["kind"] if asked else "none", start.data


def describe(kind: Kind, backend: Backend) -> str:
    """One sentence."""
    track = "roller" if "roller" in kind.conditions else "rail"
    what = {
        "patch": "Contact patch of wheel and rail",
        "wheel_rail": f"Contact of one wheel on its {track}",
        "wheelset": f"Contact of a wheelset on its {track}s",
    }[kind.kind]
    licence = " This variant contains FFTW and is under the GPL." if backend == "fftw" else ""
    return f"{what}: position and velocity in, forces and patches out.{licence}"


def identifier_of(stem: str) -> str:
    """A name for the library that C allows."""
    name = re.sub(r"\W", "_", stem, flags=re.ASCII)
    return name if re.match(r"[A-Za-z_]", name) else f"fmu_{name}"


def guid_of(contents: Contents) -> str:
    """A hash of everything but the date."""
    labels = replace(contents.labels, date="")
    text = replace(contents, labels=labels).description("")
    text += contents.scene_text("{}")
    digest = hashlib.sha256(text.encode() + (contents.creep_table or b""))
    built = contents.libraries.files(labels.identifier, contents.backend)
    for path, content in sorted(built.items()):
        digest.update(path.encode() + content)
    return "{" + str(uuid.UUID(bytes=digest.digest()[:16], version=4)) + "}"


def files_of(contents: Contents, guid: str) -> dict[str, bytes]:
    """Path in the archive -> content."""
    c = contents
    sources = c.libraries.sources
    description = c.description(guid)
    inputs, outputs = series(c.scene, c.variables, c.labels.step.seconds, c.labels.name)
    texts = {
        # FMI 3.0 has buildDescription.xml alone
        "modelDescription.xml": description
        if c.version == 3
        else with_source_files(description, sources),
        "resources/scene.txt": c.scene_text(guid),
        "documentation/reference.csv": reference_csv(c.scene, c.variables),
        "documentation/reference_inputs.csv": csv_of(inputs),
        "documentation/reference_outputs.csv": csv_of(outputs),
        "documentation/index.html": index_html(
            c.labels, c.table, c.kind, c.variables, guid, c.scene.case, c.config
        ),
    }
    if sources:
        name = c.labels.identifier
        texts["sources/buildDescription.xml"] = build_description(name, sources)
    files = {path: text.encode() for path, text in texts.items()}
    files |= {"model.png": model_png(), **c.libraries.files(c.labels.identifier, c.backend)}
    icons = {"icon.png": model_png(), "icon.svg": ICON.encode()}
    icons["terminalsAndIcons.xml"] = terminals_xml(c.variables, c.version).encode()
    files |= {f"{FOLDER}/{name}": content for name, content in icons.items()}
    if c.creep_table is not None:
        files["resources/creep_table.bin"] = c.creep_table
    return files


def epoch() -> int:
    """s, the date that the archive carries. Raises CaseError."""
    given = os.environ.get("SOURCE_DATE_EPOCH", str(int(time.time())))
    if not given.isdecimal():
        raise CaseError(f"SOURCE_DATE_EPOCH: value is {given!r}, allowed a number of seconds")
    return max(FIRST_DATE, int(given))


def entry(path: str) -> zipfile.ZipInfo:
    """Head of a file in the archive; nothing of this machine is in it."""
    info = zipfile.ZipInfo(path, time.gmtime(epoch())[:6])
    info.compress_type = zipfile.ZIP_DEFLATED
    info.create_system = 3
    mode = 0o755 if path.startswith("binaries/") else 0o644
    info.external_attr = (0o100000 | mode) << 16
    return info
