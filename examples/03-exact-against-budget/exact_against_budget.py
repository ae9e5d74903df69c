# SPDX-License-Identifier: Apache-2.0
"""exact_against_budget.py IMAGE [PLOT.png]: what a budget costs, over one motion."""

import sys

import numpy as np

import palpate

TICKS, BUDGETS = 600, (30, 100, 300, 1000)  # work units a tick: the same answer on every machine

# The first body slides over the second and turns about the vertical. (ticks, bodies, 7)
time_s = np.arange(TICKS) / 1000
turn = 0.6 * np.sin(np.pi * time_s / time_s[-1])
poses = np.zeros((TICKS, 2, 7))
poses[:, 0, 0] = 0.006 * np.sin(2 * np.pi * time_s / time_s[-1])
poses[:, 0, 2] = 0.0159
poses[:, 0, 3], poses[:, 0, 6] = np.cos(turn / 2), np.sin(turn / 2)
poses[:, 1, 3] = 1

body = palpate.Image(sys.argv[1])


def run(**budget):
    """A fresh engine each time: what one run has learned does not help the next."""
    engine = palpate.Engine([body, body], engine="regions", delta_m=0.0005, stiffness_N_per_m=600)
    return engine.ticks(poses, **budget)


def size(ticks):
    return np.linalg.norm(ticks["force_N"], axis=1)


exact = run()
print(f"exact: force at most {size(exact).max():.3f} N, {exact['units_used'].mean():.0f} units a tick")
print("units  cut short  error of the force, rms and most  no contact although there is one")
runs = {units: run(units=units) for units in BUDGETS}
for units, ticks in runs.items():
    error = np.linalg.norm(ticks["force_N"] - exact["force_N"], axis=1)
    lost = (ticks["contacts"] == 0) & (exact["contacts"] > 0)
    cut = ticks["truncated_by_units"].mean()
    print(f"{units:5}  {cut:8.0%}  {np.sqrt((error**2).mean()):14.4f} N {error.max():9.4f} N  {lost.sum():6} ticks")

print("\nforce over the motion, exact, N")
for i in range(0, TICKS, TICKS // 20):
    print(f"{time_s[i]:6.3f} s {size(exact)[i]:7.3f} " + "#" * round(50 * size(exact)[i] / max(size(exact).max(), 1e-9)))

if len(sys.argv) > 2:  # needs python3-matplotlib
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    for units, ticks in runs.items():
        pyplot.plot(time_s, size(ticks), linewidth=1, label=f"{units} units")
    pyplot.plot(time_s, size(exact), "k", label="exact")
    pyplot.xlabel("time, s")
    pyplot.ylabel("force, N")
    pyplot.legend()
    pyplot.savefig(sys.argv[2], dpi=150)
