"""FMI 3.0 called as it is: no importer between the test and the library.

Run as a program it restores a saved state and steps: python slave3.py FOLDER STATE
"""

from __future__ import annotations

import ctypes as ct
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

from slave import DISCARD, ERROR, OK, Reference, Size

__all__ = ["DISCARD", "ERROR", "OK", "Fmu3", "Slave3"]

Real = ct.c_double
Logger = ct.CFUNCTYPE(None, ct.c_void_p, ct.c_int, ct.c_char_p, ct.c_char_p)
# element of modelDescription.xml -> type, and what the calls are named after
TYPES = {
    "Float64": (ct.c_double, "Float64"),
    "Int32": (ct.c_int32, "Int32"),
    "Enumeration": (ct.c_int64, "Int64"),
    "String": (ct.c_char_p, "String"),
    "Boolean": (ct.c_bool, "Boolean"),
}


class Fmu3:
    """An unpacked FMU with its library loaded."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.root = ET.parse(folder / "modelDescription.xml").getroot()
        self.token = self.root.attrib["instantiationToken"]
        self.variables = {v.attrib["name"]: v for v in self.root.find("ModelVariables")}
        self.references = {n: int(v.attrib["valueReference"]) for n, v in self.variables.items()}
        identifier = self.root.find("CoSimulation").attrib["modelIdentifier"]
        self.binary_path = folder / "binaries" / "x86_64-linux" / f"{identifier}.so"
        self.binary = ct.CDLL(str(self.binary_path))
        self.binary.fmi3InstantiateCoSimulation.restype = ct.c_void_p
        self.binary.fmi3InstantiateModelExchange.restype = ct.c_void_p

    @property
    def location(self) -> str:
        """The path of the resources, as FMI 3.0 wants it."""
        return str(self.folder / "resources") + "/"

    def size(self, name: str) -> int:
        """Components of a variable."""
        dimension = self.variables[name].find("Dimension")
        return 1 if dimension is None else int(dimension.attrib["start"])

    def names(self, causality: str, element: str | None = None) -> list[str]:
        """Names of the variables of a causality, and of a type."""
        return [
            name
            for name, v in self.variables.items()
            if v.attrib["causality"] == causality and element in (None, v.tag)
        ]


class Slave3:
    """One instance. Methods return FMI's status; messages are kept in ``log``."""

    def __init__(
        self,
        fmu: Fmu3,
        *,
        location: str | None = "",
        logging: bool = True,
        callbacks: bool = True,
        token: str | None = "",
        exchange: bool = False,
        event_mode: bool = False,
    ) -> None:
        self.fmu = fmu
        self.log: list[tuple[int, str, str]] = []
        self.logger = Logger(self._hear)
        where = fmu.location if location == "" else location
        shared = (
            b"a slave",
            None if token is None else (token or fmu.token).encode(),
            None if where is None else where.encode(),
            ct.c_bool(False),
            ct.c_bool(logging),
        )
        listener = (None, self.logger if callbacks else None)
        if exchange:
            self.component = fmu.binary.fmi3InstantiateModelExchange(*shared, *listener)
        else:
            more = (ct.c_bool(event_mode), ct.c_bool(False), None, Size(0))
            self.component = fmu.binary.fmi3InstantiateCoSimulation(*shared, *more, *listener, None)

    def _hear(self, _environment: Any, status: int, category: bytes, text: bytes) -> None:
        self.log.append((status, category.decode(), text.decode()))

    def call(self, function: str, *arguments: Any) -> int:
        """Any function, with the instance first."""
        return getattr(self.fmu.binary, f"fmi3{function}")(ct.c_void_p(self.component), *arguments)

    def __enter__(self) -> Slave3:
        return self

    def __exit__(self, *_: Any) -> None:
        self.call("FreeInstance")

    def enter(self, start: float = 0.0) -> int:
        """fmi3EnterInitializationMode."""
        return self.call(
            "EnterInitializationMode",
            ct.c_bool(False),
            Real(0),
            Real(start),
            ct.c_bool(False),
            Real(0),
        )

    def initialize(self, start: float = 0.0) -> Slave3:
        """Up to the first step."""
        assert self.enter(start) == OK, self.log
        assert self.call("ExitInitializationMode") == OK, self.log
        return self

    def step(self, time: float, step: float) -> int:
        """fmi3DoStep; the last successful time is kept in ``time``."""
        flags = [ct.c_bool(True) for _ in range(3)]
        last = Real()
        status = self.call(
            "DoStep", Real(time), Real(step), ct.c_bool(True), *map(ct.byref, flags), ct.byref(last)
        )
        assert status == ERROR or not any(flag.value for flag in flags)
        self.time = last.value
        return status

    def set(self, name: str, *values: Any, count: int | None = None) -> int:
        """One variable, by its components."""
        kind, call = TYPES[self.fmu.variables[name].tag]
        numbers = (kind * len(values))(*values)
        size = Size(len(values) if count is None else count)
        reference = (Reference * 1)(self.fmu.references[name])
        return self.call(f"Set{call}", reference, Size(1), numbers, size)

    def get(self, name: str) -> list[Any]:
        """The components of one variable."""
        kind, call = TYPES[self.fmu.variables[name].tag]
        size = self.fmu.size(name)
        values = (kind * size)()
        reference = (Reference * 1)(self.fmu.references[name])
        status = self.call(f"Get{call}", reference, Size(1), values, Size(size))
        assert status == OK, (name, self.log)
        return list(values)

    def set_components(self, values: dict[str, float]) -> int:
        """By the names of FMI 2.0: components of arrays as "a.b[2]"."""
        status = OK
        for name, value in values.items():
            if name in self.fmu.variables:
                status = max(status, self.set(name, value))
                continue
            vector, _, number = name.rstrip("]").rpartition("[")
            whole = self.get(vector)
            whole[int(number) - 1] = value
            status = max(status, self.set(vector, *whole))
        return status

    def outputs(self) -> dict[str, Any]:
        """All outputs by the names of FMI 2.0."""
        found = {}
        for name in self.fmu.names("output"):
            values = self.get(name)
            if self.fmu.size(name) == 1:
                found[name] = values[0]
            else:
                found |= {f"{name}[{k}]": value for k, value in enumerate(values, 1)}
        return found

    def derivative(
        self, kind: str, unknowns: list[str], knowns: list[str], seed: list[float]
    ) -> tuple[int, list[float]]:
        """kind: "Directional" (seed of the knowns) or "Adjoint" (seed of the unknowns)."""
        lists = [
            (Reference * len(n))(*(self.fmu.references[v] for v in n)) for n in (unknowns, knowns)
        ]
        wanted = knowns if kind == "Adjoint" else unknowns
        found = (Real * sum(self.fmu.size(n) for n in wanted))()
        status = self.call(
            f"Get{kind}Derivative",
            *(lists[0], Size(len(unknowns)), lists[1], Size(len(knowns))),
            *((Real * len(seed))(*seed), Size(len(seed)), found, Size(len(found))),
        )
        return status, list(found)

    def save(self) -> ct.c_void_p:
        """fmi3GetFMUState."""
        state = ct.c_void_p()
        assert self.call("GetFMUState", ct.byref(state)) == OK, self.log
        return state

    def restore(self, state: ct.c_void_p) -> int:
        """fmi3SetFMUState."""
        return self.call("SetFMUState", state)

    def serialize(self, state: ct.c_void_p) -> bytes:
        """fmi3SerializeFMUState."""
        size = Size()
        assert self.call("SerializedFMUStateSize", state, ct.byref(size)) == OK
        content = ct.create_string_buffer(size.value)
        assert self.call("SerializeFMUState", state, content, size) == OK
        return content.raw

    def deserialize(self, content: bytes) -> tuple[int, ct.c_void_p]:
        """fmi3DeserializeFMUState."""
        state = ct.c_void_p()
        status = self.call("DeserializeFMUState", content, Size(len(content)), ct.byref(state))
        return status, state


def main() -> None:
    """Prints the outputs after a step from the saved state."""
    fmu = Fmu3(Path(sys.argv[1]))
    with Slave3(fmu) as slave:
        status, state = slave.deserialize(Path(sys.argv[2]).read_bytes())
        assert status == OK, slave.log
        assert slave.restore(state) == OK, slave.log
        assert slave.step(slave.get("time")[0], 1e-3) == OK, slave.log
        print({name: float(value).hex() for name, value in slave.outputs().items()})


if __name__ == "__main__":
    main()
