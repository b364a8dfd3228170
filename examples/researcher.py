# %% [markdown]
# # Researcher: creep curves, fields, derivatives
#
# One contact patch, its creep curve by the exact theory and by two fast ones, what happens inside it, and
# derivatives that a Newton method or an identification can use. Ten minutes; nothing but `pip install railpatch`.

# %%
import numpy as np
import plotly.graph_objects as go
import railpatch

case = {
    "kind": "patch",
    "material": {"shear_modulus": 82e9, "poisson_ratio": 0.28},
    "geometry": {"semi_axes": [0.006, 0.004]},  # m, along rolling and lateral
    "load": {"normal_force": 80e3},  # N
    "grid": {"elements": [24, 16]},
    "motion": {"regime": "steady_rolling", "creepage": [1e-3, 0.0], "rolling_speed": 20.0},
    "friction": {"coefficient": 0.35},
}
result = railpatch.solve(case)
print(result.status, f"creep force {result['creep_force'][0] / 1e3:.2f} kN")
print(f"peak pressure {result['max_pressure'] / 1e6:.0f} MPa")

# %% [markdown]
# Forces act on the wheel and creepages are wheel minus rail: a positive creepage gives a negative force.
#
# ## Creep curves
#
# `solve_many` takes arrays and gives arrays. Each theory is one word in `[method]`.

# %%
creepages = np.linspace(0.0, 8e-3, 17)
theories = {"full": "exact", "fastsim": "FASTSIM", "polach": "Polach"}
bound = 0.35 * 80e3  # N, friction times load
curves = {}
for theory in theories:
    own = {**case, "method": {"normal": "hertz", "tangential": theory}}
    states = railpatch.solve_many(
        own, {"creepage": np.column_stack([creepages, np.zeros_like(creepages)])}
    )
    curves[theory] = -states["creep_force"][:, 0] / bound
    half = np.interp(1e-3, creepages, curves[theory])
    print(
        f"{theories[theory]:8} {half:.3f} of the bound at 0.1 %, {curves[theory][-1]:.3f} at 0.8 %"
    )

figure = go.Figure(layout={"template": "plotly_white", "height": 420})
for theory, force in curves.items():
    figure.add_scatter(x=100 * creepages, y=force, name=theories[theory])
figure.update_xaxes(title="longitudinal creepage, %")
figure.update_yaxes(title="creep force over friction times load")
figure

# %% [markdown]
# ## Inside the patch
#
# `solve(..., fields=True)` keeps pressure, traction, micro-slip and which elements stick; `plot()` shows them.

# %%
inside = railpatch.solve(case, fields=True)
elements = inside["elements"]
print({name: count for name, count in elements.items() if count})
traction = np.hypot(*inside["traction"])
print(
    f"greatest traction {traction.max() / 1e6:.0f} MPa of {inside['pressure'].max() / 1e6:.0f} MPa"
)
inside.plot()

# %% [markdown]
# ## Derivatives
#
# With `derivatives = true` the rates of the whole result follow from the solved conditions, without a second solution;
# a difference of two steps says the same.

# %%
contact = railpatch.Contact({**case, "method": {"derivatives": True, "tolerance": 1e-10}})
contact.step()
rate = contact.differentiate(creepage=[1.0, 0.0])
high = contact.step(creepage=[1e-3 + 1e-7, 0.0])["creep_force"][0]
low = contact.step(creepage=[1e-3 - 1e-7, 0.0])["creep_force"][0]
difference = (high - low) / 2e-7
print(f"{rate['kind']}: {rate['creep_force'][0] / 1e6:.4f} MN per unit of creepage")
print(f"by difference: {difference / 1e6:.4f} MN")
assert abs(rate["creep_force"][0] / difference - 1) < 1e-3

# %% [markdown]
# ## From here
#
# - [Theories](../docs/theories.md): what each one gives; [accuracy](../docs/accuracy.md): its error and its run time.
# - [Physics](../docs/physics.md): falling friction, layers that yield, temperature, transient rolling, with sources.
# - [Many states](../docs/many_states.md) on several threads, [sweeps](../docs/sweeps.md) on a cluster.
# - [Parameters from points](../docs/matching.md): a creep curve that was measured, and what it tells.
