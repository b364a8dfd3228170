# %% [markdown]
# # Vehicle engineer: own profiles, Y/Q, wear number, own vehicle
#
# A coach of 50 degrees of freedom on your profiles and with your masses: guiding forces, Y/Q, wear number. On the command
# line `railpatch init vehicle mine`, `railpatch vehicle mine/vehicle.toml -o run.mcap`. `pip install 'railpatch[pinocchio]'`.

# %%
from pathlib import Path

import numpy as np
import plotly.graph_objects as go
import railpatch
from railpatch.case.kinds import kind_of, write_example
from railpatch.profiles import load_profile

from wheelset_demo.vehicle import Simulation, load_vehicle_scene

# %% [markdown]
# ## Own profiles
#
# A file of two columns, y and z in mm. Here a worn wheel stands for yours; `railpatch profile wheel.csv --role wheel` makes a page
# that shows points, fit and contact.

# %%
folder = Path("mine")
scene = write_example(kind_of("vehicle"), folder)[0]
worn = load_profile("worn@7", "wheel")
y = np.linspace(worn.y[0], worn.y[-1], 400)
np.savetxt(
    folder / "wheel.csv", 1e3 * np.column_stack([y, np.interp(y, worn.y, worn.z)]), "%.5f", ","
)
own = load_profile(folder / "wheel.csv", "wheel", smoothing=0.004)
print(f"{len(own.y)} points from {1e3 * own.y[0]:.0f} to {1e3 * own.y[-1]:.0f} mm")

# %% [markdown]
# ## One wheelset in place
#
# Before a run: where does this wheel touch, and how hard? A wheelset 6 mm beside the middle, rolled so that both wheels carry.

# %%
case = {
    "kind": "wheelset",
    "friction": {"coefficient": 0.3},
    "method": {"normal": "kik_piotrowski", "tangential": "fastsim"},
    "wheelset": {
        "y": 0.006,
        "roll": "balanced",
        "vertical_force": 107e3,
        "speed": 50.0,
        "pitch_rate": "free",
        "nominal_radius": 0.46,
        "flange_back_distance": 1.36,
        "flange_back_position": -0.070,
    },
    "track": {"kind": "rail"},
    "profiles": {"wheel": "wheel.csv", "rail": "UIC60@1:40", "smoothing": 0.004},
}
found = railpatch.solve(case, folder=folder)
for side in ("left", "right"):
    wheel = found[side]
    outward = 1 if side == "right" else -1
    guiding, load = -outward * wheel["force"][1], -wheel["force"][2]  # N, on the rail
    pressure = max(patch["max_pressure"] for patch in wheel["patches"])
    print(
        f"{side:5} Q {load / 1e3:5.1f} kN, Y/Q {guiding / load:+.3f},"
        f" {pressure / 1e6:.0f} MPa, wear number {wheel['creep_power'] / 50.0:.1f} N"
    )

# %% [markdown]
# ## Own vehicle
#
# The scene is a TOML file: masses, springs, dampers, bogies, the track. A car body of 40 t in place of 32 t, your wheels, and a
# curve of 1000 m that begins at once, at 130 km/h; theories are fast ones, and the run is short, 20 s in the file.

# %%
text = scene.read_text().replace("mass = 32000.0", "mass = 40000.0")
text = text.replace('wheel = "S1002"', 'wheel = "wheel.csv"\nsmoothing = 0.004')
changes = {
    "straight = 150.0": "straight = 22.0",
    "transition = 300.0": "transition = 20.0",
    "radius = 4000.0": "radius = 1000.0",
    "speed = 83.333333": "speed = 36.0",
}
for old, new in changes.items():
    assert old in text, old
    text = text.replace(old, new)
scene.write_text(text)
loaded = load_vehicle_scene(scene).with_run(duration=1.0)
loaded = loaded.with_method(normal="hertz", tangential="fastsim")
simulation = Simulation(loaded)
times, guiding, loads, wear = [], [], [], []
for state in simulation.steps():
    wheels = simulation.element.wheels  # [wheelset, left and right, force], N
    times.append(state.time)
    guiding.append(simulation.means.guiding.copy())  # Y, means over 2 m as EN 14363 has them
    loads.append(simulation.means.loads.copy())  # Q
    wear.append(simulation.element.creep_power / loaded.speed)
print(
    f"axle load {loaded.axle_load / 1e3:.1f} kN, {len(times)} steps at {3.6 * loaded.speed:.0f} km/h"
)
ratio = np.array(guiding) / np.array(loads)
print(f"greatest Y/Q {np.nanmax(ratio):.3f}, Y outward, limit 0.8 (EN 14363)")
print(f"wear number of all eight wheels {np.mean(wear):.1f} N")

figure = go.Figure(layout={"template": "plotly_white", "height": 420})
for k, name in enumerate(("1 left", "1 right", "2 left", "2 right")):
    figure.add_scatter(x=times, y=np.array(loads)[:, k] / 1e3, name=f"wheelset {name}")
figure.update_xaxes(title="time, s")
figure.update_yaxes(title="wheel load Q, mean over 2 m, kN")
figure

# %% [markdown]
# ## From here
#
# - [Vehicle](../docs/vehicle.md): the model, the curve, time steps, run times. [Track](../docs/track.md): curves and irregularities.
# - [Profiles](../docs/profiles.md): what is read of files, noise, smoothing. [Wheelset in balance](../docs/balance.md).
# - [Keys of a vehicle](../wheelset_demo/vehicle/scene.py): every one with its unit and range.
