"""What a step through the FMU costs beyond the solve; printed, `pytest -s` shows it."""

from __future__ import annotations

import ctypes as ct
import time
from collections.abc import Callable

from slave import OK, Fmu, Integer, Real, Reference, Size, Slave


def test_overhead_of_a_step(unpacked: Callable[..., Fmu]) -> None:
    """Apart, so that nothing is solved: set all inputs, step, read all outputs."""
    fmu = unpacked("patch_approach")
    reals = fmu.names("input", "Real")
    outputs = fmu.names("output", "Real")
    set_references = (Reference * len(reals))(*(fmu.references[n] for n in reals))
    get_references = (Reference * len(outputs))(*(fmu.references[n] for n in outputs))
    values = (Real * len(reals))(*(-1e-4 if n == "approach" else 0.0 for n in reals))
    found = (Real * len(outputs))()
    library, count = fmu.binary, 20000
    with Slave(fmu).initialize() as slave:
        component = ct.c_void_p(slave.component)
        sizes = Size(len(reals)), Size(len(outputs))
        steps = [Real(k * 1e-3) for k in range(count)]
        length = Real(1e-3)
        begin = time.perf_counter()
        for point in steps:
            library.fmi2SetReal(component, set_references, sizes[0], values)
            library.fmi2DoStep(component, point, length, 1)
            library.fmi2GetReal(component, get_references, sizes[1], found)
        total = time.perf_counter() - begin
        begin = time.perf_counter()
        for _ in steps:
            library.fmi2GetReal(component, get_references, Size(0), found)
            library.fmi2GetReal(component, get_references, Size(0), found)
            library.fmi2GetReal(component, get_references, Size(0), found)
        calls = time.perf_counter() - begin
        [status] = slave.get("status")
        assert slave.call("GetInteger", None, Size(0), (Integer * 1)()) == OK
    assert status == 1
    overhead = 1e6 * (total - calls) / count
    print(f"\nset, step and get: {overhead:.2f} us, and {1e6 * calls / count:.2f} us of ctypes")
