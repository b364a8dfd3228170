# %% [markdown]
# # FMU user: a mass on a contact
#
# A contact is packed as an FMU and coupled with a mass in a few lines of Python, by fmpy. The question that decides
# whether it works: which communication step? `pip install railpatch fmpy`.
#
# ## Pack
#
# On the command line `railpatch fmu --scene wheel -o wheel.fmu`; here a scene of our own, one wheel on one rail,
# whose height is an input.

# %%
import math
from pathlib import Path

import numpy as np
import plotly.graph_objects as go
import railpatch
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from railpatch.case import load_scene
from railpatch.fmu import pack_fmu

Path("wheel.toml").write_text("""
kind = "wheel_rail"
[grid]
elements = [10, 10]
[friction]
coefficient = 0.3
[method]
normal = "hertz"
tangential = "fastsim"
[wheelset]
z = 1e-4
speed = 20.0
pitch_rate = -43.478
nominal_radius = 0.46
flange_back_distance = 1.36
flange_back_position = -0.070
[track]
kind = "rail"
[profiles]
wheel = "S1002"
rail = "UIC60@1:40"
""")
packed = pack_fmu(load_scene("wheel.toml"), Path("wheel.fmu"))
description = read_model_description("wheel.fmu")
reference = {v.name: v.valueReference for v in description.modelVariables}
advised = float(description.defaultExperiment.stepSize)
print(f"{len(reference)} variables; the step that the description advises: {1e3 * advised:g} ms")

# %% [markdown]
# ## Couple
#
# The mass of half a wheelset stands on the rail under its load; a damper stands for what takes the bounce's energy.
# The master gives the height, reads the force, holds it over the step and moves the mass: explicit and without iteration, as
# most masters do. A held force lags by half a step on average, which takes damping away.

# %%
MASS, LOAD, DAMPING = 900.0, 60e3, 8e4  # kg, N, N s/m
folder = extract("wheel.fmu")
# where the load is carried: the same scene, with the force in the place of the height
content = load_scene("wheel.toml").case.model_dump(exclude_none=True, exclude_defaults=True)
content["wheelset"].pop("z")
content["wheelset"]["vertical_force"] = LOAD
rest = railpatch.solve({**content, "kind": "wheel_rail"})["z"]


def bounce(step: float, duration: float = 0.03) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and ways from rest (m) of the mass, released 1 um above."""
    fmu = FMU2Slave(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="wheel",
    )
    fmu.instantiate()
    fmu.setupExperiment(startTime=0.0)
    fmu.enterInitializationMode()
    z, speed, ways = rest - 1e-6, 0.0, []
    fmu.setReal([reference["wheelset.z"]], [z])
    fmu.exitInitializationMode()
    count = round(duration / step)
    for k in range(count):
        fmu.setReal([reference["wheelset.z"]], [z])
        fmu.doStep(k * step, step)
        (force,) = fmu.getReal([reference["force[3]"]])  # on the wheel, down
        acceleration = (LOAD + force - DAMPING * speed) / MASS
        z += step * speed + 0.5 * step**2 * acceleration
        speed += step * acceleration
        ways.append(z - rest)
    fmu.terminate()
    fmu.freeInstance()
    return step * np.arange(1, count + 1), np.array(ways)


swings = {}
figure = go.Figure(layout={"template": "plotly_white", "height": 420})
for factor in (1, 4, 8):
    times, ways = bounce(factor * advised)
    third = len(ways) // 3
    swings[factor] = first, last = np.ptp(ways[:third]), np.ptp(ways[-third:])
    print(
        f"{1e3 * factor * advised:4.2f} ms: {1e6 * first:5.2f} um, at the end {1e6 * last:5.2f} um"
    )
    figure.add_scatter(x=1e3 * times, y=1e6 * ways, name=f"{1e3 * factor * advised:g} ms")
figure.update_xaxes(title="time, ms")
figure.update_yaxes(title="mass from rest, um down")
assert swings[1][1] < swings[1][0]  # it comes to rest
assert swings[8][1] > 2 * swings[8][0]  # it does not
figure

# %% [markdown]
# ## Which step
#
# The bounce of a mass m on a contact of stiffness k has the angular frequency sqrt(k/m). A held force takes a quarter of
# step times frequency from the damping ratio. A tenth of the frequency's inverse costs 2.5 % of critical damping; no more
# than that is what the description advises, for a wheelset of usual mass.

# %%
times, ways = bounce(advised)
crossings = np.flatnonzero((ways[:-1] < 0) & (ways[1:] >= 0))
frequency = 2 * math.pi / np.diff(times[crossings]).mean()
print(f"bounces at {frequency / (2 * math.pi):.0f} Hz: a tenth is {1e3 * 0.1 / frequency:.3f} ms")
print(f"damping ratio {DAMPING / (2 * MASS * frequency):.3f}, less {advised * frequency / 4:.3f}")
assert advised < 0.1 / frequency

# %% [markdown]
# ## From here
#
# - [Co-simulation](../docs/cosimulation.md): longest steps of five masters from 0.2 to 80 m/s, and the energy they make.
# - [FMU](../docs/fmu.md): kinds, model exchange, derivatives, other systems; [who has imported it](../docs/fmu_clients.md).
# - [Every variable](../plugins/fmu/variables.toml).
