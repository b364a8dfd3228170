"""The machine that run times belong to."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railpatch import _core

FFT_SIZE = 64
FFT_REPEAT = 4000
# us, the same transform on the machine of the peer's published times (FFTW, estimated plan)
PEER_FFT = 8.8


@dataclass(frozen=True)
class Machine:
    """processor: its name. cores: that this process may use. fft: library. fft_time: s, median of
    one real transform of 64 x 64 numbers. load: processes that were running, mean of a minute."""

    processor: str
    cores: int
    system: str
    version: str
    fft: str
    fft_time: float
    load: float

    @property
    def speed(self) -> float:
        """How much faster than the peer's machine, by the transform."""
        return 1e-6 * PEER_FFT / self.fft_time

    def rows(self) -> list[tuple[str, str]]:
        """What and its value, as text."""
        return [
            ("processor", f"{self.processor}, {self.cores} cores"),
            ("system", self.system),
            ("railpatch", f"{self.version}, FFT: {self.fft}"),
            (
                f"one real {FFT_SIZE} x {FFT_SIZE} FFT",
                f"{1e6 * self.fft_time:.1f} us; {PEER_FFT} us on the peer's machine",
            ),
            ("load before the run", f"{self.load:.1f} running processes"),
        ]


def this_machine() -> Machine:
    """Looks at the machine and times its FFT."""
    return Machine(
        processor=processor(),
        cores=len(os.sched_getaffinity(0)),
        system=f"{platform.system()} {platform.machine()}, Python {platform.python_version()}",
        version=_core.version(),
        fft=_core.fft_backend(),
        fft_time=float(np.median(_core.time_fft(FFT_SIZE, FFT_REPEAT))),
        load=os.getloadavg()[0],
    )


def processor() -> str:
    """Name of the processor."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()
