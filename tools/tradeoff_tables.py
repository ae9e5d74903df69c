#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the tables of docs/TRADEOFF.md from what tools/reproduce has measured: tradeoff_tables.py FOLDER TICKS VERSION PAGE"""
import csv
import os
import sys
from pathlib import Path

DELTAS = ("0.01", "0.02", "0.05")
SCENES = (("jaws", "jaws"), ("golf", "club on ball"), ("golf_balls", "ball on ball"), ("ball_joint", "ball joint"),
          ("ellipsoid", "ellipsoid on ball"), ("screw_nut", "screw in nut"), ("ball_shell", "ball in shell"))
VOTES = {0.1: "0 (10 % and more)", 0.05: "4", 0.025: "7", 0.01: "1", 0.005: "0 (0.5 % and less)"}


def rows(path):
    if not path.exists():
        return []
    with open(path, newline="") as f:
        return list(csv.DictReader(f))


def number(row, key):
    return float(row[key]) if row[key] else None


def show(value, form):
    return "" if value is None else format(value, form)


def us(row, key):
    value = number(row, key)
    return None if value is None else value * 1e-3


def percent(row, key):
    value = number(row, key)
    return None if value is None else value * 100


def label(row):
    """A setting in words."""
    name = row["engine"]
    if row["exact"] == "true":
        name += " exact"
    elif row["engine"] == "regions":
        name += f", tolerance {float(row['force_tolerance_N']):g} N"
    elif row["kappa"] and float(row["s0"]) >= 1e6:
        name += f", kappa {float(row['kappa']):g}"
    else:
        name += f", s0 {100 * float(row['s0']):g} %"
    if row["bounds"] == "paper":
        name += ", paper's bounds"
    if row["budget_us"]:
        name += f", {float(row['budget_us']):g} us"
    return name


def line(*cells):
    return "| " + " | ".join(cells) + " |"


def head(*cells):
    return [line(*cells), line(*["---"] * len(cells))]


def exact_of(table, bounds):
    return next((r for r in table if r["engine"] == "levels" and r["exact"] == "true" and r["bounds"] == bounds), None)


def ratio(a, b, key):
    x, y = number(a, key), number(b, key)
    return x / y if x and y else None


def headline(folder):
    """What s0 buys: against the exact query with either bounds."""
    out = head("scene", "delta", "setting", "median us", "p99.9 us", "front", "time: paper's exact over this", "our exact over this",
               "front: paper's exact over this", "force error %", "torque error %", "noticeable %", "bound over error")
    for name, title in SCENES:
        for delta in DELTAS:
            table = rows(folder / delta / name / "sweep.csv")
            tight = exact_of(table, "tight")
            for r in table:
                if r["budget_us"] or (r["kappa"] and float(r["s0"] or 0) >= 1e6):
                    continue
                out.append(line(title, f"{100 * float(delta):g} %", label(r), show(us(r, "median_ns"), ".0f"), show(us(r, "p999_ns"), ".0f"),
                                show(number(r, "front_mean"), ".0f") if r["engine"] == "levels" else "",
                                show(number(r, "speedup_median"), ".2g"), show(ratio(tight, r, "median_ns"), ".2g"),
                                show(number(r, "front_ratio"), ".2g"), show(percent(r, "force_nrmse"), ".1f"),
                                show(percent(r, "torque_nrmse"), ".1f"), show(percent(r, "noticeable"), ".1f"),
                                show(number(r, "bound_over_error_median"), ".2g")))
    return out


def cheapest(folder):
    """The fastest setting of each engine whose force error is within a limit."""
    out = head("scene", "delta", "force error at most", "engine", "setting", "median us", "p99.9 us", "front", "paper's exact over this",
               "our exact over this", "force error %", "noticeable %")
    for name, title in SCENES:
        for delta in DELTAS:
            table = rows(folder / delta / name / "sweep.csv")
            tight = exact_of(table, "tight")
            for limit in (0.10, 0.05):
                for engine in ("levels", "regions"):
                    good = [r for r in table if r["engine"] == engine and r["force_nrmse"] and float(r["force_nrmse"]) <= limit]
                    if not good:
                        continue
                    r = min(good, key=lambda x: float(x["median_ns"]))
                    out.append(line(title, f"{100 * float(delta):g} %", f"{100 * limit:g} %", engine, label(r),
                                    show(us(r, "median_ns"), ".0f"), show(us(r, "p999_ns"), ".0f"),
                                    show(number(r, "front_mean"), ".0f") if engine == "levels" else "",
                                    show(number(r, "speedup_median"), ".2g"), show(ratio(tight, r, "median_ns"), ".2g"),
                                    show(percent(r, "force_nrmse"), ".1f"), show(percent(r, "noticeable"), ".1f")))
    return out


def budgets(folder):
    out = head("scene", "delta", "setting", "p99.9 us", "truncated %", "force error %", "noticeable %")
    for name, title in SCENES:
        for delta in DELTAS:
            for r in rows(folder / delta / name / "sweep.csv"):
                if r["budget_us"]:
                    out.append(line(title, f"{100 * float(delta):g} %", label(r), show(us(r, "p999_ns"), ".0f"),
                                    show(percent(r, "truncated"), ".0f"), show(percent(r, "force_nrmse"), ".1f"),
                                    show(percent(r, "noticeable"), ".1f")))
    return out


def crossing(points, share):
    """s0 at which the share of noticeable ticks first reaches this one, by linear interpolation."""
    for (s0, a), (s1, b) in zip(points, points[1:]):
        if a < share <= b:
            return s0 + (s1 - s0) * (share - a) / (b - a)
    return None


def observer(folder):
    table = [r for r in rows(folder / "0.02" / "ellipsoid-observer" / "sweep.csv") if r["exact"] != "true"]
    table.sort(key=lambda r: float(r["s0"]))
    out = head("s0", "noticeable %", "force error %", "users who began to notice (of 12)")
    for r in table:
        s0 = float(r["s0"])
        out.append(line(f"{100 * s0:g} %", show(percent(r, "noticeable"), ".1f"), show(percent(r, "force_nrmse"), ".1f"), VOTES.get(s0, "")))
    points = [(float(r["s0"]), float(r["noticeable"])) for r in table]
    for share in (0.25, 0.5, 0.75):
        at = crossing(points, share)
        where = f"at s0 = {100 * at:.2g} %" if at else "not crossed"
        out += ["", f"{100 * share:g} % of the ticks noticeable: {where}."]
    return out


def peers(folder):
    out = head("scene", "query", "returns", "median us", "p99 us", "results", "least distance off from FCL's by at most, m")
    for name, title in SCENES:
        for r in rows(folder / "0.02" / f"{name}.peers.csv"):
            out.append(line(title, r["query"], r["returns"], r["median_us"], r["p99_us"], r["results_mean"], r["distance_off_max_m"]))
    return out


def certificates(folder):
    ticks = broken = sweeps = 0
    for path in sorted(folder.glob("*/*/sweep.csv")):
        sweeps += 1
        for r in rows(path):
            ticks += int(r["ticks"])
            broken += int(r["certificates_broken"])
    return [f"{broken} of {ticks} certificates are broken, over {sweeps} sweeps."]


def machine(folder, ticks, version):
    model = next((l.split(":", 1)[1].strip() for l in open("/proc/cpuinfo") if l.startswith("model name")), "unknown processor")
    load = os.getloadavg()[2]
    return [f"{ticks} ticks a motion; {os.cpu_count()} cores of {model}; {version}; load of the machine over the last quarter of an hour: {load:.1f}."]


def main():
    folder, ticks, version, page = Path(sys.argv[1]), sys.argv[2], sys.argv[3], Path(sys.argv[4])
    tables = {"machine": machine(folder, ticks, version), "certificates": certificates(folder), "headline": headline(folder),
              "cheapest": cheapest(folder), "budgets": budgets(folder), "observer": observer(folder), "peers": peers(folder)}
    out, skip = [], False
    for text in page.read_text().splitlines():
        if text.startswith("<!-- end"):
            skip = False
        if not skip:
            out.append(text)
        if text.startswith("<!-- table "):
            out += tables[text.split()[2]]
            skip = True
    new = page.with_suffix(".new")
    new.write_text("\n".join(out) + "\n")
    new.replace(page)


main()
