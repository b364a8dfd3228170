"""Several instances, threads, and loading again and again."""

from __future__ import annotations

import ctypes as ct
import locale
import math
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from fmu_scenes import MOTIONS, run
from slave import ERROR, OK, Fmu, Slave

Unpack = Callable[..., Fmu]


def test_instances_do_not_touch_each_other(unpacked: Unpack) -> None:
    names = ["rail", "patch", "rail"]
    alone = []
    for name in names:
        with Slave(unpacked(name)).initialize() as slave:
            alone.append(run(slave, MOTIONS[name], 0))
    slaves = [Slave(unpacked(name), name="same").initialize() for name in names]
    for k in range(4):
        for name, slave in zip(names, slaves, strict=True):
            assert slave.set(MOTIONS[name][k]) == OK
            assert slave.step(k * 1e-3, 1e-3) == OK
    assert [slave.outputs() for slave in slaves] == alone
    for slave in slaves:
        slave.free()


def test_instances_on_threads_give_the_same_bits(unpacked: Unpack) -> None:
    fmu = unpacked("patch")
    found = []

    def work() -> None:
        for _ in range(5):
            with Slave(fmu).initialize() as slave:
                found.append(run(slave, MOTIONS["patch"], 0))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 10
    assert all(outputs == found[0] for outputs in found)


def resident() -> int:
    """Bytes of this process in memory."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096


def test_loading_and_unloading_leaves_nothing(unpacked: Unpack) -> None:
    fmu = Fmu(unpacked("patch").folder)
    close = ct.CDLL(None).dlclose
    close.argtypes = [ct.c_void_p]
    # the fixture's own handle, so that the library really goes
    path = fmu.folder / "binaries" / "linux64" / "again.so"
    path.write_bytes(fmu.binary_path.read_bytes())
    sizes = []
    # threads of the system; those of other tests may end meanwhile
    threads = set(Path("/proc/self/task").iterdir())
    for _ in range(100):
        fmu.binary = ct.CDLL(str(path))
        fmu.binary.fmi2Instantiate.restype = ct.c_void_p
        with Slave(fmu).initialize() as slave:
            assert slave.step(0, 1e-3) == OK
        assert close(fmu.binary._handle) == 0
        assert str(path) not in Path("/proc/self/maps").read_text()
        sizes.append(resident())
    assert sizes[-1] - sizes[20] < 4e6
    assert set(Path("/proc/self/task").iterdir()) <= threads


# bits of MXCSR, the control register of SSE: set, cleared
HOSTS = {
    "rounds upwards": (0x4000, 0),
    "flushes to zero": (0x8040, 0),
    "traps": (0, 0x0680),  # invalid, division by zero, overflow
}


@pytest.mark.parametrize("host", HOSTS)
def test_locale_and_floating_point_do_not_matter(host: str, unpacked: Unpack) -> None:
    fmu = unpacked("rail")
    with Slave(fmu).initialize() as slave:
        expected = run(slave, MOTIONS["rail"], 0)
    before = locale.setlocale(locale.LC_ALL)
    comma = next((n for n in ("de_DE.UTF-8", "fr_FR.UTF-8") if settable(n)), None)
    libm = ct.CDLL("libm.so.6")
    own, changed, after = (ct.create_string_buffer(32) for _ in range(3))  # fenv_t
    libm.fegetenv(own)
    changed.raw = own.raw
    register = ct.c_uint32.from_buffer(changed, 28)
    register.value = (register.value | HOSTS[host][0]) & ~HOSTS[host][1]
    try:
        if comma:
            locale.setlocale(locale.LC_ALL, comma)
        libm.fesetenv(changed)
        with Slave(fmu).initialize() as slave:
            found = run(slave, MOTIONS["rail"], 0)
            # a comparison with no number must not trap either
            refused = [
                slave.set({"wheelset.y": math.nan}),
                slave.step(math.nan, 1e-3),
                slave.step(0.0, math.nan),
            ]
        libm.fegetenv(after)
    finally:
        libm.fesetenv(own)
        locale.setlocale(locale.LC_ALL, before)
    control = 0xFFC0  # all but the flags of what has happened
    assert ct.c_uint32.from_buffer(after, 28).value & control == register.value & control
    assert found == expected
    assert refused == [ERROR] * 3


def process_state() -> list[str]:
    """Signals blocked, ignored and caught, mask of new files, working directory and locale."""
    lines = Path("/proc/self/status").read_text().splitlines()
    kept = [line for line in lines if line.startswith(("Sig", "Umask"))]
    # pending ones come and go
    kept = [line for line in kept if not line.startswith(("SigQ", "SigPnd"))]
    return [*kept, str(Path.cwd()), locale.setlocale(locale.LC_ALL)]


def test_the_process_stays_as_it_is(unpacked: Unpack) -> None:
    fmu = Fmu(unpacked("rail").folder)
    before = process_state()
    assert len(before) == 6
    with Slave(fmu).initialize() as slave:
        run(slave, MOTIONS["rail"], 0)
        assert process_state() == before
    assert process_state() == before


def settable(name: str) -> bool:
    """Whether this machine has the locale."""
    before = locale.setlocale(locale.LC_ALL)
    try:
        locale.setlocale(locale.LC_ALL, name)
    except locale.Error:
        return False
    locale.setlocale(locale.LC_ALL, before)
    return True
