"""Friction, layer and lateral positions of NRC's dry run from yaw angles and forces alone.

    python docs/match_nrc.py -o DIR

The record is what the authors' own model of the rig gives at the 13 positions that are published of
the run at 10 mph and 13,750 lb (railpatch/report/nrc_dry_10mph_13750lb.csv, with its source), as if
it were measured: yaw angle, lateral, vertical and longitudinal forces of both wheels. The match
knows neither lateral positions nor a frame. Printed: what is found beside what was published. DIR
gets the record, the scene and what `railpatch match` writes.
"""

from __future__ import annotations

import argparse
import csv
from importlib import resources
from pathlib import Path

import tomli_w
from railpatch.case.load import plain, read_toml
from railpatch.match import load_match, run_match, write_match
from railpatch.match.model import placed

from rig_model.scene import default_scene

SIDES = {"L": "left", "R": "right"}
COMPONENTS = {"fx": "longitudinal", "fy": "lateral", "fz": "vertical"}
# of the published model
FRICTION, THICKNESS = 0.52, 50e-6
MATCH = {
    "starts": 1,
    "observed": {
        "left_ratio": {}, "right_ratio": {}, "left_longitudinal": {}, "right_longitudinal": {},
    },
    "seek": {
        "friction.coefficient": {"low": 0.2, "high": 0.8, "start": 0.4},
        "layer.thickness": {"low": 1e-6, "high": 1e-3, "start": 2e-5, "logarithmic": True},
    },
    "rows": {"lateral_position": {"low": -8e-3, "high": 8e-3}},
}  # fmt: skip


def published() -> list[dict[str, dict[str, str]]]:
    """Positions in their order, by side."""
    file = resources.files("railpatch.report").joinpath("nrc_dry_10mph_13750lb.csv")
    lines = [line for line in file.read_text("utf-8").splitlines() if not line.startswith("#")]
    rows = list(csv.DictReader(lines))
    return [
        {SIDES[row["side"]]: row for row in pair}
        for pair in zip(rows[::2], rows[1::2], strict=True)
    ]


def write_scene(folder: Path) -> Path:
    """record.csv and scene.toml."""
    folder.mkdir(parents=True, exist_ok=True)
    found = published()
    heads = ["yaw [rad]", *(f"{s}_{c} [N]" for s in SIDES.values() for c in COMPONENTS.values())]
    lines = [",".join(heads)]
    for position in found:
        forces = [position[s][f"{c}_on_roller_N"] for s in SIDES.values() for c in COMPONENTS]
        lines.append(",".join([position["left"]["yaw_rad"], *forces]))
    (folder / "record.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    own = default_scene()
    content = placed(plain(read_toml(own)), own.parent)
    content["friction"]["coefficient"] = 0.4
    content["layer"]["thickness"] = 20e-6
    # the convention of the program that made the forces
    content.setdefault("method", {})["patch_rule"] = "contact"
    kept = {key: content["rig"][key] for key in ("balance",) if key in content["rig"]}
    content["rig"] = kept | {"record": "record.csv", "duration": 120.0}
    content["match"] = MATCH
    path = folder / "scene.toml"
    path.write_text(tomli_w.dumps(content), encoding="utf-8")
    return path


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("-o", "--output", type=Path, required=True)
    options = parser.parse_args()
    found = run_match(load_match(write_scene(options.output)), tell=print)
    write_match(found, options.output)
    truths = {"friction.coefficient": FRICTION, "layer.thickness": THICKNESS}
    for key, one in found.parameters.items():
        print(f"{key}: {one.value:.5g} ({one.low:.5g} to {one.high:.5g}), {truths[key]:g}")
    own = found.explanations[0]
    rows = own.rows
    assert rows is not None
    inside = 0
    for position, at, low, high in zip(published(), rows.values, rows.low, rows.high, strict=True):
        true, yaw = 1e-3 * float(position["left"]["y_ws_mm"]), float(position["left"]["yaw_rad"])
        inside += low <= true <= high
        print(
            f"{1e3 * yaw:5.0f} mrad: {1e3 * at:.3f} mm ({1e3 * low:.3f} to {1e3 * high:.3f}), "
            f"{1e3 * true:.3f}"
        )
    print(f"{inside} of {len(rows.values)} lateral positions inside")
    for key, rms in zip(found.plan.table.observed, own.fit.rms, strict=True):
        print(f"rms of {key}: {rms:.4g}")


if __name__ == "__main__":
    main()
