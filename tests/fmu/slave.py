"""FMI 2.0 called as it is: no importer between the test and the library.

Run as a program it restores a saved state and steps: python slave.py FOLDER STATE INPUTS.json
"""

from __future__ import annotations

import ctypes as ct
import json
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any
from urllib.parse import quote

OK, WARNING, DISCARD, ERROR = range(4)
Reference, Real, Integer, Size = ct.c_uint, ct.c_double, ct.c_int, ct.c_size_t
Logger = ct.CFUNCTYPE(None, ct.c_void_p, ct.c_char_p, ct.c_int, ct.c_char_p, ct.c_char_p)


class Callbacks(ct.Structure):
    """fmi2CallbackFunctions."""

    _fields_ = (
        ("logger", Logger),
        ("allocate", ct.c_void_p),
        ("free", ct.c_void_p),
        ("finished", ct.c_void_p),
        ("environment", ct.c_void_p),
    )


class Fmu:
    """An unpacked FMU with its library loaded."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        root = ET.parse(folder / "modelDescription.xml").getroot()
        self.guid = root.attrib["guid"]
        self.root = root
        self.variables = {}
        for variable in root.iter("ScalarVariable"):
            self.variables[variable.attrib["name"]] = variable
        self.references = {n: int(v.attrib["valueReference"]) for n, v in self.variables.items()}
        identifier = root.find("CoSimulation").attrib["modelIdentifier"]
        self.binary_path = folder / "binaries" / "linux64" / f"{identifier}.so"
        self.binary = ct.CDLL(str(self.binary_path))
        self.binary.fmi2Instantiate.restype = ct.c_void_p

    @property
    def location(self) -> str:
        """A well-formed URI of the resources."""
        return "file://" + quote(str(self.folder / "resources"))

    def names(self, causality: str, base: str | None = None) -> list[str]:
        """Names of the variables of a causality, and of a base type."""
        return [
            name
            for name, v in self.variables.items()
            if v.attrib["causality"] == causality and base in (None, v[0].tag)
        ]


class Slave:
    """One instance. Methods return FMI's status; messages are kept in ``log``."""

    def __init__(
        self,
        fmu: Fmu,
        *,
        location: str | None = "",
        logging: bool = True,
        callbacks: bool = True,
        guid: str | None = "",
        name: str = "a slave",
        exchange: bool = False,
    ) -> None:
        self.fmu = fmu
        self.log: list[tuple[int, str, str]] = []
        self.callbacks = Callbacks(logger=Logger(self._hear))
        where = fmu.location if location == "" else location
        self.component = fmu.binary.fmi2Instantiate(
            name.encode(),
            0 if exchange else 1,
            None if guid is None else (guid or fmu.guid).encode(),
            None if where is None else where.encode(),
            ct.byref(self.callbacks) if callbacks else None,
            0,
            int(logging),
        )

    def _hear(self, _environment: Any, _name: Any, status: int, category: Any, text: Any) -> None:
        self.log.append((status, category.decode(), text.decode()))

    def call(self, function: str, *arguments: Any) -> int:
        """Any function, with the component first."""
        return getattr(self.fmu.binary, f"fmi2{function}")(ct.c_void_p(self.component), *arguments)

    def free(self) -> None:
        """fmi2FreeInstance; twice does nothing."""
        if self.component:
            self.call("FreeInstance")
        self.component = None

    def __enter__(self) -> Slave:
        return self

    def __exit__(self, *_: Any) -> None:
        self.free()

    def initialize(self, start: float = 0.0, **values: float) -> Slave:
        """Up to the first step; dots and brackets in names: pass a dictionary to ``set``."""
        assert self.setup(start) == OK, self.log
        assert self.set(values) == OK, self.log
        assert self.call("EnterInitializationMode") == OK
        assert self.call("ExitInitializationMode") == OK, self.log
        return self

    def setup(self, start: float = 0.0) -> int:
        """fmi2SetupExperiment."""
        return self.call("SetupExperiment", 0, Real(0), Real(start), 0, Real(0))

    def step(self, time: float, step: float) -> int:
        """fmi2DoStep."""
        return self.call("DoStep", Real(time), Real(step), 1)

    def set(self, values: dict[str, float]) -> int:
        """fmi2SetReal and fmi2SetInteger."""
        status = OK
        for name, value in values.items():
            number = (Reference * 1)(self.fmu.references[name])
            base = self.fmu.variables[name][0].tag
            kind, call = (Real, "SetReal") if base == "Real" else (Integer, "SetInteger")
            status = max(status, self.call(call, number, Size(1), (kind * 1)(value)))
        return status

    def derivative(self, unknown: list[str], seeds: dict[str, float]) -> tuple[int, list[float]]:
        """fmi2GetDirectionalDerivative."""
        of, by = len(unknown), len(seeds)
        change = (Real * of)()
        status = self.call(
            "GetDirectionalDerivative",
            (Reference * of)(*(self.fmu.references[n] for n in unknown)),
            Size(of),
            (Reference * by)(*(self.fmu.references[n] for n in seeds)),
            Size(by),
            (Real * by)(*seeds.values()),
            change,
        )
        return status, list(change)

    def set_derivatives(self, values: dict[str, float], order: int = 1) -> int:
        """fmi2SetRealInputDerivatives."""
        count = len(values)
        return self.call(
            "SetRealInputDerivatives",
            (Reference * count)(*(self.fmu.references[n] for n in values)),
            Size(count),
            (Integer * count)(*[order] * count),
            (Real * count)(*values.values()),
        )

    def output_derivatives(self, names: list[str], order: int = 1) -> tuple[int, list[float]]:
        """fmi2GetRealOutputDerivatives."""
        count = len(names)
        found = (Real * count)()
        status = self.call(
            "GetRealOutputDerivatives",
            (Reference * count)(*(self.fmu.references[n] for n in names)),
            Size(count),
            (Integer * count)(*[order] * count),
            found,
        )
        return status, list(found)

    def get(self, *names: str) -> list[float]:
        """Values of variables of any type."""
        return [self._get(name) for name in names]

    def _get(self, name: str) -> float:
        base = self.fmu.variables[name][0].tag
        kind, call = (Real, "GetReal") if base == "Real" else (Integer, "GetInteger")
        value = (kind * 1)()
        status = self.call(call, (Reference * 1)(self.fmu.references[name]), Size(1), value)
        assert status == OK, self.log
        return value[0]

    def outputs(self) -> dict[str, float]:
        """All outputs."""
        names = self.fmu.names("output")
        return dict(zip(names, self.get(*names), strict=True))

    def save(self) -> ct.c_void_p:
        """fmi2GetFMUstate."""
        state = ct.c_void_p()
        assert self.call("GetFMUstate", ct.byref(state)) == OK, self.log
        return state

    def restore(self, state: ct.c_void_p) -> int:
        """fmi2SetFMUstate."""
        return self.call("SetFMUstate", state)

    def serialize(self, state: ct.c_void_p) -> bytes:
        """fmi2SerializeFMUstate."""
        size = Size()
        assert self.call("SerializedFMUstateSize", state, ct.byref(size)) == OK
        content = ct.create_string_buffer(size.value)
        assert self.call("SerializeFMUstate", state, content, size) == OK
        return content.raw

    def deserialize(self, content: bytes) -> tuple[int, ct.c_void_p]:
        """fmi2DeSerializeFMUstate."""
        state = ct.c_void_p()
        status = self.call("DeSerializeFMUstate", content, Size(len(content)), ct.byref(state))
        return status, state


def main() -> None:
    """Restores in this process, on an instance that was only instantiated."""
    folder, state, inputs = sys.argv[1:]
    with Slave(Fmu(Path(folder))) as slave:
        status, handle = slave.deserialize(Path(state).read_bytes())
        assert status == OK, slave.log
        assert slave.restore(handle) == OK, slave.log
        steps = json.loads(Path(inputs).read_text())
        time = steps["time"]
        for values in steps["values"]:
            assert slave.set(values) == OK, slave.log
            assert slave.step(time, 1e-3) == OK, slave.log
            time += 1e-3
        print(
            json.dumps(
                {
                    name: value.hex() if isinstance(value, float) else value
                    for name, value in slave.outputs().items()
                }
            )
        )


if __name__ == "__main__":
    main()
