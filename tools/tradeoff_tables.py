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
# Motions of the observer: folder below 0.02, title.
OBSERVERS = (("ellipsoid-observer-1", "ellipsoid, 1"), ("ellipsoid-observer-2", "ellipsoid, 2"), ("ellipsoid-observer-3", "ellipsoid, 3"),
             ("jaws-observer-1", "jaws"))
VOTES = {0.1: "0 (10 % and more)", 0.05: "4", 0.025: "7", 0.01: "1", 0.005: "0 (0.5 % and less)"}


def rows(path):
    if not path.exists():
        return []
    with open(path, newline="") as f:
        return list(csv.DictReader(f))


def number(row, key):
    return float(row[key]) if row[key] else None


def show(value, form):
    text = "" if value is None else format(value, form)
    return f"{float(text):.0f}" if "e+" in text else text


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
    if row["exact"] == "true" and float(row["truncated"]) > 0:
        name += " (short of memory)"
    return name


def line(*cells):
    return "| " + " | ".join(cells) + " |"


def head(*cells):
    return [line(*cells), line(*["---"] * len(cells))]


def exact_of(table, bounds):
    return next((r for r in table if r["engine"] == "levels" and r["exact"] == "true" and r["bounds"] == bounds), None)


def ratio(a, b, key):
    if a is None:
        return None
    x, y = number(a, key), number(b, key)
    return x / y if x and y else None


def sweeps(folder):
    """Title, delta in words and table of each sweep there is."""
    for name, title in SCENES:
        for delta in DELTAS:
            table = rows(folder / delta / name / "sweep.csv")
            if table:
                yield title, f"{100 * float(delta):g} %", table


def is_kappa(row):
    return bool(row["kappa"]) and float(row["s0"] or 0) >= 1e6


def span(values, form):
    """Least and largest of what there is."""
    there = [v for v in values if v is not None]
    if not there:
        return ""
    low, high = show(min(there), form), show(max(there), form)
    return low if low == high else f"{low} to {high}"


def simplified(table, bounds):
    """Settings of simplification alone, s0 up to 5 %."""
    return [r for r in table if r["engine"] == "levels" and r["exact"] != "true" and r["bounds"] == bounds
            and not r["budget_us"] and not is_kappa(r)]


def summary(folder):
    """A line a sweep: what s0 from 0.5 to 5 % buys and loses, as in the paper and with what is ours, beside regions."""
    out = head("scene", "delta", "ticks", "paper's exact us", "as in the paper: times faster", "front times smaller", "force error %",
               "tight bounds: times faster", "regions exact us", "times faster")
    reached, fastest = [], (0, "")
    for title, delta, table in sweeps(folder):
        paper = exact_of(table, "paper")
        regions = next(r for r in table if r["engine"] == "regions" and r["exact"] == "true")
        as_in_paper, ours = simplified(table, "paper"), simplified(table, "tight")
        faster = lambda some: span([number(r, "speedup_median") for r in some], ".2g")
        out.append(line(title, delta, regions["ticks"], show(us(paper, "median_ns"), ".0f") if paper else "not run",
                        faster(as_in_paper), span([number(r, "front_ratio") for r in as_in_paper], ".2g"),
                        span([percent(r, "force_nrmse") for r in as_in_paper], ".0f"), faster(ours),
                        show(us(regions, "median_ns"), ".0f"), show(number(regions, "speedup_median"), ".2g")))
        for r in as_in_paper + ours:
            gain = number(r, "speedup_median") or 0
            where = f"{title} at delta {delta}, {label(r)} ({show(gain, '.2g')} times, force error {percent(r, 'force_nrmse'):.0f} %)"
            fastest = max(fastest, (gain, where))
            if gain >= 100:
                reached.append(where)
    out += ["", f"Two orders of magnitude between the paper's exact query and s0 up to 5 % are reached by: {'; '.join(reached) or 'none'}."]
    if not reached and fastest[1]:
        out[-1] += f" The largest ratio is that of {fastest[1]}."
    return out


def motions(folder):
    out = head("scene", "delta", "delta mm", "ticks swept", "nearer than delta, % of ticks", "overlapping, % of ticks", "contacts of levels", "of regions")
    for name, title in SCENES:
        for delta in DELTAS:
            table = rows(folder / delta / name / "sweep.csv")
            regions = next((r for r in table if r["engine"] == "regions" and r["exact"] == "true"), None)
            if regions is None:
                continue
            tight = exact_of(table, "tight")
            at = folder / delta / name / "ticks"
            ticks = rows(at / f"{regions['id']}.csv")
            pieces = rows(at / f"{tight['id']}.csv") if tight else []
            near = [t for t in ticks if t["min_distance"]]
            mean = lambda table: sum(int(t["contacts"]) for t in table) / len(table)
            out.append(line(title, f"{100 * float(delta):g} %", f"{1e3 * float(regions['delta_m']):.3g}", str(len(ticks)),
                            f"{100 * len(near) / len(ticks):.0f}", f"{100 * sum(float(t['min_distance']) <= 0 for t in near) / len(ticks):.0f}",
                            f"{mean(pieces):.0f}" if pieces else "", f"{mean(ticks):.0f}"))
    return out


def headline(folder):
    """What s0 buys: against the exact query with either bounds."""
    out = head("scene", "delta", "setting", "median us", "p99.9 us", "front", "time: paper's exact over this", "our exact over this",
               "front: paper's exact over this", "force error %", "torque error %", "noticeable %", "bound over error")
    for title, delta, table in sweeps(folder):
        tight = exact_of(table, "tight")
        for r in table:
            if r["budget_us"] or is_kappa(r):
                continue
            out.append(line(title, delta, label(r), show(us(r, "median_ns"), ".0f"), show(us(r, "p999_ns"), ".0f"),
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
    for title, delta, table in sweeps(folder):
        tight = exact_of(table, "tight")
        for limit in (0.10, 0.05):
            for engine in ("levels", "regions"):
                good = [r for r in table if r["engine"] == engine and r["force_nrmse"] and float(r["force_nrmse"]) <= limit]
                if not good:
                    continue
                r = min(good, key=lambda x: float(x["median_ns"]))
                out.append(line(title, delta, f"{100 * limit:g} %", engine, label(r),
                                show(us(r, "median_ns"), ".0f"), show(us(r, "p999_ns"), ".0f"),
                                show(number(r, "front_mean"), ".0f") if engine == "levels" else "",
                                show(number(r, "speedup_median"), ".2g"), show(ratio(tight, r, "median_ns"), ".2g"),
                                show(percent(r, "force_nrmse"), ".1f"), show(percent(r, "noticeable"), ".1f")))
    return out


def budgets(folder):
    out = head("scene", "delta", "setting", "p99.9 us", "truncated %", "force error %", "noticeable %")
    for title, delta, table in sweeps(folder):
        for r in table:
            if r["budget_us"]:
                out.append(line(title, delta, label(r), show(us(r, "p999_ns"), ".0f"), show(percent(r, "truncated"), ".0f"),
                                show(percent(r, "force_nrmse"), ".1f"), show(percent(r, "noticeable"), ".1f")))
    return out


def crossing(points, share):
    """s0 at which the share of noticeable ticks first reaches this one, by linear interpolation."""
    for (s0, a), (s1, b) in zip(points, points[1:]):
        if a < share <= b:
            return s0 + (s1 - s0) * (share - a) / (b - a)
    return None


def observer(folder):
    """A column a motion: noticeable share of the ticks, and the error of the force."""
    curves = {}
    for name, title in OBSERVERS:
        table = [r for r in rows(folder / "0.02" / name / "sweep.csv") if r["exact"] != "true"]
        if table:
            curves[title] = sorted(table, key=lambda r: float(r["s0"]))
    out = head("s0", *(f"{title}: noticeable % (force error %)" for title in curves), "users who began to notice (of 12)")
    for points in zip(*curves.values()):
        s0 = float(points[0]["s0"])
        out.append(line(f"{100 * s0:g} %", *(f"{percent(r, 'noticeable'):.1f} ({percent(r, 'force_nrmse'):.1f})" for r in points), VOTES.get(s0, "")))
    for share in (0.25, 0.5, 0.75):
        where = []
        for title, table in curves.items():
            at = crossing([(float(r["s0"]), float(r["noticeable"])) for r in table], share)
            where.append(f"{title} at s0 = {100 * at:.2g} %" if at else f"{title} not crossed")
        out += ["", f"{100 * share:g} % of the ticks noticeable: {', '.join(where)}."]
    return out


def peers(folder):
    out = head("scene", "delta", "query", "returns", "median us", "p99 us", "results", "least distance off from FCL's by at most, m")
    for name, title in SCENES:
        for delta in DELTAS:
            for r in rows(folder / delta / f"{name}.peers.csv"):
                out.append(line(title, f"{100 * float(delta):g} %", r["query"], r["returns"], r["median_us"], r["p99_us"], r["results_mean"],
                                r["distance_off_max_m"]))
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
    tables = {"machine": machine(folder, ticks, version), "certificates": certificates(folder), "summary": summary(folder), "motions": motions(folder),
              "headline": headline(folder), "cheapest": cheapest(folder), "budgets": budgets(folder), "observer": observer(folder), "peers": peers(folder)}
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
