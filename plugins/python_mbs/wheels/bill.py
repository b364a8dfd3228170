"""The software bill of materials of a release, CycloneDX 1.6: python bill.py FOLDER

What the files in FOLDER contain of others, with versions read where the compiler read them, what
the Python package depends on, with the versions that are installed beside this program, and each
file with its SHA-256. Writes FOLDER/railpatch-VERSION.cdx.json, checked against the schema of the
standard. Needs the Python packages railpatch (of this checkout), nanobind, ziglang, fmpy and
cyclonedx-bom. The same files give the same bill.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import re
import subprocess
import sys
import uuid
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, requires, version
from pathlib import Path

from cyclonedx.model import HashAlgorithm, HashType
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentScope, ComponentType
from cyclonedx.model.license import LicenseExpression
from cyclonedx.output.json import JsonV1Dot6
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator
from packageurl import PackageURL
from packaging.requirements import Requirement

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "plugins" / "fmu" / "cross"))

from build import package  # noqa: E402

ENDINGS = (".whl", ".tar.gz", ".fmu")
EIGEN = Path("/usr/include/eigen3/Eigen/src/Core/util/Macros.h")


def numbers_of(path: Path, *names: str) -> str:
    """A version from #define lines of a header."""
    text = path.read_text(encoding="utf-8", errors="replace")
    found = [re.search(rf"#define {name}\s+(\d+)", text) for name in names]
    if not all(found):
        sys.exit(f"{path} has no {' '.join(names)}")
    return ".".join(match.group(1) for match in found if match is not None)


def contained() -> list[Component]:
    """What is compiled into the libraries, or lies beside them."""
    zig, nanobind = package("ziglang"), package("nanobind")
    told = subprocess.run(
        [zig / "zig", "c++", "--version"], capture_output=True, text=True, check=True
    )
    clang = re.search(r"clang version (\d+\.\d+\.\d+)", told.stdout)
    if clang is None:
        sys.exit("the compiler does not tell its version")
    windows = zig / "lib" / "libc" / "include" / "any-windows-any" / "_mingw_mac.h"
    tsl = nanobind / "ext" / "robin_map" / "include" / "tsl" / "robin_growth_policy.h"
    eigen = numbers_of(EIGEN, "EIGEN_WORLD_VERSION", "EIGEN_MAJOR_VERSION", "EIGEN_MINOR_VERSION")
    robin = numbers_of(tsl, *(f"TSL_RH_VERSION_{part}" for part in ("MAJOR", "MINOR", "PATCH")))
    mingw = numbers_of(windows, "__MINGW64_VERSION_MAJOR", "__MINGW64_VERSION_MINOR")
    rows = (
        ("Eigen", eigen, "MPL-2.0", "gitlab", "libeigen/eigen", "transforms; in all binaries"),
        ("nanobind", version("nanobind"), "BSD-3-Clause", "pypi", None, "extension module"),
        ("robin-map", robin, "MIT", "github", "tessil/robin-map", "extension module"),
        (
            "libcxx",
            clang.group(1),
            "Apache-2.0 WITH LLVM-exception",
            "github",
            "llvm/llvm-project",
            "libc++, libc++abi and libunwind, linked into all binaries",
        ),
        ("ziglang", version("ziglang"), "MIT", "pypi", None, "compiler-rt, in all binaries"),
        ("mingw-w64", mingw, "ZPL-2.1", "generic", None, "runtime, in binaries for Windows"),
        ("fmpy", version("fmpy"), "BSD-2-Clause", "pypi", None, "headers of FMI, in FMUs"),
    )
    return [
        Component(
            type=ComponentType.LIBRARY,
            name=name,
            version=number,
            bom_ref=f"contained/{name.lower()}",
            scope=ComponentScope.REQUIRED,
            licenses=[LicenseExpression(licence)],
            purl=PackageURL.from_string(f"pkg:{kind}/{place or name.lower()}@{number}"),
            description=text,
        )
        for name, number, licence, kind, place, text in rows
    ]


def needed(extra: str | None) -> Iterable[tuple[Requirement, bool]]:
    """What the Python package asks for; whether by an extra alone."""
    for line in requires("railpatch") or []:
        wanted = Requirement(line)
        by_extra = wanted.marker is not None and "extra" in str(wanted.marker)
        if "test" in str(wanted.marker) or wanted.name == "railpatch":
            continue
        if by_extra == (extra is not None):
            yield wanted, by_extra


def dependencies() -> list[Component]:
    """What the Python package imports, not contained: pip fetches it."""
    found: dict[str, Component] = {}
    for wanted, by_extra in [*needed(None), *needed("any")]:
        try:
            number: str | None = version(wanted.name)
        except PackageNotFoundError:
            number = None  # not asked for by this Python
        name = wanted.name.lower()
        if name not in found:
            found[name] = Component(
                type=ComponentType.LIBRARY,
                name=wanted.name,
                version=number,
                bom_ref=f"needed/{name}",
                scope=ComponentScope.OPTIONAL if by_extra else ComponentScope.REQUIRED,
                purl=PackageURL("pypi", None, name, number),
                description=f"fetched by pip: {wanted.specifier or 'any version'}",
            )
    return [found[name] for name in sorted(found)]


def files(folder: Path) -> list[Component]:
    """What is released."""
    paths = sorted(path for path in folder.iterdir() if path.name.endswith(ENDINGS))
    return [
        Component(
            type=ComponentType.FILE,
            name=path.name,
            bom_ref=f"file/{path.name}",
            hashes=[
                HashType(
                    alg=HashAlgorithm.SHA_256,
                    content=hashlib.sha256(path.read_bytes()).hexdigest(),
                )
            ],
        )
        for path in paths
    ]


def bill(folder: Path) -> str:
    """The text of the bill."""
    number = version("railpatch")
    product = Component(
        type=ComponentType.LIBRARY,
        name="railpatch",
        version=number,
        bom_ref="railpatch",
        licenses=[LicenseExpression("Apache-2.0")],
        purl=PackageURL("pypi", None, "railpatch", number),
    )
    inside, outside, released = contained(), dependencies(), files(folder)
    bom = Bom(components=[*inside, *outside, *released])
    bom.metadata.component = product
    bom.register_dependency(product, [*inside, *outside])
    content = json.loads(JsonV1Dot6(bom).output_as_string())
    # a bill that says the same is the same: no time, a number made of what it says
    content["metadata"].pop("timestamp", None)
    content.pop("serialNumber", None)
    name = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
    content["serialNumber"] = uuid.uuid5(uuid.NAMESPACE_OID, name).urn
    text = json.dumps(content, indent=2, sort_keys=True) + "\n"
    wrong = JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)
    if wrong is not None:
        sys.exit(f"the bill does not follow CycloneDX 1.6: {wrong}")
    return text


def main() -> None:
    """Writes it beside the files."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    target = folder / f"railpatch-{version('railpatch')}.cdx.json"
    target.write_text(bill(folder), encoding="utf-8")
    print(target)


if __name__ == "__main__":
    main()
