# %% [markdown]
# # Analyst: from a log to a table, and to viewers
#
# Runs write MCAP logs: every channel and field with its unit. This page makes a short one, reads it into pandas, and hands it to
# other programs. `pip install 'railpatch[export,pinocchio]'`.

# %%
from pathlib import Path

import plotly.graph_objects as go
from railpatch.export import write_table
from railpatch.layout import layout_text
from railpatch.log import read_run

from wheelset_demo.scene import load_wheelset_scene
from wheelset_demo.simulation import run_scene

# %% [markdown]
# ## A log
#
# The same as `railpatch wheelset -o run.mcap --distance 8`: a wheelset on track, released 4 mm beside its middle.

# %%
scene = load_wheelset_scene(None, {"distance": 8.0, "log_every": 4})
print(run_scene(scene, Path("run.mcap"), lambda *_: None).text())

# %% [markdown]
# ## Into pandas
#
# `read_run` gives arrays by channel; `to_pandas` one frame over the time, with units beside. Columns are called by channel and
# field; `*` and `?` stand for the rest.

# %%
run = read_run("run.mcap")
frame = run.to_pandas(channels=["/wheelset/state", "/left/contact", "/right/contact"])
print(f"{len(frame)} moments, {len(frame.columns)} columns")
short = run.to_pandas(signals=["/wheelset/state.y", "force.y", "force.z"])
print(short.attrs["units"])
print(short.describe().loc[["mean", "min", "max"]].T.to_string(float_format="%.4g"))

# %% [markdown]
# L/V of both wheels, and what friction takes per metre: the wear number, creep power over the speed.

# %%
ratios = {
    side: frame[f"/{side}/contact.force.y"] / -frame[f"/{side}/contact.force.z"]
    for side in ("left", "right")
}
powers = frame["/left/contact.creep_power"] + frame["/right/contact.creep_power"]
wear = powers / frame["/wheelset/state.speed"]
print(f"greatest L/V {max(ratio.abs().max() for ratio in ratios.values()):.3f}")
print(f"wear number {wear.mean():.1f} N on average, at most {wear.max():.1f} N")
figure = go.Figure(layout={"template": "plotly_white", "height": 420})
for side, ratio in ratios.items():
    figure.add_scatter(x=frame.index, y=ratio, name=side)
figure.update_xaxes(title="time, s")
figure.update_yaxes(title="lateral over vertical force on the wheel")
figure

# %% [markdown]
# ## For other programs
#
# The ending chooses the format: CSV, Excel, MATLAB, Parquet. On the command line `railpatch export run.mcap -o run.xlsx`.

# %%
write_table(run.table(signals=["y", "yaw", "force.?"]), "run.csv")
write_table(run.table(), "run.parquet")
print(Path("run.csv").read_text().splitlines()[0])

# %% [markdown]
# ## In viewers
#
# Foxglove and Lichtblick open the log without a plug-in: bodies, patches and forces in 3D. A layout has panels for this kind
# of run. `railpatch report run.mcap -o run.html` makes a page that needs no viewer.

# %%
Path("layout.json").write_text(layout_text("rail", topics=run.counts))
print(", ".join(sorted(run.counts)))

# %% [markdown]
# ## From here
#
# - [Logs, reports, viewers](../docs/logs.md): every option of `report`, `export` and `layout`.
# - [Channels](../docs/log_channels.md): every field with its unit and frame.
