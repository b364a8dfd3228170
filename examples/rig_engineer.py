# %% [markdown]
# # Rig engineer: an own run, replayed and matched
#
# From a machine's file to computed forces beside the measured ones, and to the friction that the run had. The same on the
# command line: `railpatch init rig mine`, `railpatch rig`, `railpatch report`, `railpatch match`. `pip install 'railpatch[match]'`.

# %%
from pathlib import Path

import numpy as np
from railpatch.export import write_table
from railpatch.log import read_run
from railpatch.match import load_match, run_match, write_match
from railpatch.report import write_report

from rig_model.run import replay
from rig_model.scene import load_rig_scene

folder = Path("mine")
folder.mkdir()

# %% [markdown]
# ## Profiles
#
# Two columns, y and z in mm, as an instrument writes them; `railpatch profile wheel.csv --role wheel` shows what is read. These are a
# coned wheel without a flange and a roller with a crown of 300 mm. `railpatch init rig DIR` has NRC's measured ones.

# %%
wheel_y = np.arange(10.0, 136.0, 5.0)  # from the back of the flange
roller_y = np.arange(-34.0, 35.0, 2.0)
wheel = np.column_stack([wheel_y, -(wheel_y - 70.0) / 20.0])
roller = np.column_stack([roller_y, 300.0 - np.sqrt(300.0**2 - roller_y**2)])
np.savetxt(folder / "wheel.csv", wheel, "%.5f", ",")
np.savetxt(folder / "roller.csv", roller, "%.5f", ",")

# %% [markdown]
# ## The record
#
# A machine writes columns of its own. Here a replay with friction 0.45 stands for the machine: with noise of 600 N, and
# with heads and units as they may be, so that one sees whether 0.45 is found again.

# %%
scene = """
kind = "wheelset"

[grid]
element_size = [1.0e-3, 1.0e-3]      # m; 0.4e-3 in earnest

[friction]
coefficient = 0.45

[wheelset]
vertical_force = 118e3               # N
nominal_radius = 0.3556              # m
flange_back_distance = 1.347         # m

[track]
kind = "roller"
gauge = 1.435                        # m
gauge_height = 1.5e-3               # m, where the gauge is measured
roller_radius = 0.8001               # m
roller_pitch_rate = 5.587302         # rad/s, 10 mph

[profiles]
wheel = "wheel.csv"
rail = "roller.csv"
wheel_file = { mirror = "none" }     # it has no flange to tell by: right-hand, z down

[rig]
"""
machine = folder / "machine.toml"
machine.write_text(
    scene
    + """
duration = 20.0
positions = 5
yaw = [[0.0, 0.0], [0.5, 9e-3], [1.0, 0.0]]                # progress, rad
lateral_position = [[0.0, 0.0], [0.5, 1e-3], [1.0, 0.0]]   # progress, m
"""
)
replay(load_rig_scene(machine), "machine.mcap")
run = read_run("machine.mcap")
noise = np.random.default_rng(3)
state, left, right = (run[name] for name in ("/wheelset/state", "/left/contact", "/right/contact"))
rows = [
    state.time,
    np.degrees(state["yaw"]),
    1e3 * state["y"],
    # the machine measures what the wheel does to the roller: against the force on the wheel
    (-left["force"][:, 1] + 600.0 * noise.standard_normal(len(state))) / 1e3,
    (-right["force"][:, 1] + 600.0 * noise.standard_normal(len(state))) / 1e3,
]
lines = ["Zeit;Winkel;Quer;Y links;Y rechts", "s;deg;mm;kN;kN"]
lines += [
    ";".join(f"{value:.4f}".replace(".", ",") for value in row) for row in zip(*rows, strict=True)
]
(folder / "run.csv").write_text("\n".join(lines) + "\n")
print("\n".join(lines[:4]))

# %% [markdown]
# ## The scene of the run
#
# `[rig.columns]` says which column is what; units come from the head. Nothing has to be converted. The friction is a
# first guess.

# %%
own = scene.replace("coefficient = 0.45", "coefficient = 0.3")
own += """
record = "run.csv"

[rig.columns]
time = { name = "Zeit" }
yaw = { name = "Winkel" }
lateral_position = { name = "Quer" }
left_lateral = { name = "Y links" }
right_lateral = { name = "Y rechts" }
"""
(folder / "own.toml").write_text(own)
loaded = load_rig_scene(folder / "own.toml")
print(loaded.measured.text())
print(replay(loaded, "own.mcap").text().splitlines()[0])
write_report("own.mcap", "own.html")  # measured over computed: open it in a browser
write_table(read_run("own.mcap").table(), "own.csv")

# %% [markdown]
# ## What friction was it
#
# `[match]` names what is sought, between which ends, and what was observed. The interval holds the value with 95 %.

# %%
(folder / "match.toml").write_text(
    own
    + """
[match]
starts = 1
intervals = "covariance"
discrepancy = false                  # nothing but noise is left here

[match.observed]
left_lateral = {}
right_lateral = {}

[match.seek]
"friction.coefficient" = { low = 0.2, high = 0.8 }
"""
)
found = run_match(load_match(folder / "match.toml"))
friction = found.parameters["friction.coefficient"]
print(f"friction {friction.value:.3f}, 95 % from {friction.low:.3f} to {friction.high:.3f}")
print([path.name for path in write_match(found, Path("matched"))])
assert friction.low < 0.45 < friction.high

# %% [markdown]
# ## From here
#
# - [Measured runs](../docs/measured_runs.md): every column, unit and filter. [Profiles](../docs/profiles.md): your own files.
# - [Parameters from points](../docs/matching.md): several parameters at once, explanations compared.
# - [Keys of a rig](../rig_model/tables.py), [commands](../plugins/python_mbs/railpatch/command/cli.py).
