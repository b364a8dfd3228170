"""The reference series inside an FMU: an importer that sets its inputs gets its outputs."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmpy import read_csv, read_model_description, simulate_fmu
from fmu_scenes import OWN
from railpatch.fmu import pack_fmu
from railpatch.fmu.scenes import kind_scene, kinds

SERIES = ("inputs", "outputs")


@pytest.mark.parametrize(("name", "fmi"), [*((k, 2) for k in kinds()), ("wheelset_rail", 3)])
def test_fmpy_gets_the_series(name: str, fmi: int, tmp_path: Path) -> None:
    path = pack_fmu(kind_scene(name)[1], tmp_path / "a.fmu", name=name, backend=OWN, fmi=fmi)
    with zipfile.ZipFile(path) as archive:
        for part in SERIES:
            archive.extract(f"documentation/reference_{part}.csv", tmp_path)
    inputs, outputs = (
        read_csv(str(tmp_path / f"documentation/reference_{part}.csv")) for part in SERIES
    )
    names = list(outputs.dtype.names[1:])
    step = float(read_model_description(str(path)).defaultExperiment.stepSize)
    assert outputs["time"] == pytest.approx(step * np.arange(21))
    # something moves, and is seen
    assert any(np.ptp(inputs[n]) > 0 for n in inputs.dtype.names[1:])
    force = "left.force[3]" if "left.force[3]" in names else None
    force = force or ("force[3]" if "force[3]" in names else "approach")
    assert np.ptp(outputs[force]) > 1e-4 * abs(outputs[force]).max()
    asked = names if fmi == 2 else sorted({n.partition("[")[0] for n in names if "patch" not in n})
    found = simulate_fmu(
        str(path),
        input=inputs,
        output=asked,
        stop_time=20 * step,
        step_size=step,
        output_interval=step,
    )
    assert len(found) == 21
    for name_of in names:
        if fmi == 3 and "patch" in name_of:
            continue
        vector, _, rest = name_of.partition("[")
        number = int(rest.rstrip("]")) - 1 if fmi == 3 and rest else None
        values = found[name_of if fmi == 2 else vector]
        values = values if number is None else values[:, number]
        size = max(abs(outputs[n]).max() for n in names if n.partition("[")[0] == vector)
        assert values == pytest.approx(outputs[name_of], rel=1e-6, abs=1e-7 * size + 1e-12), name_of
