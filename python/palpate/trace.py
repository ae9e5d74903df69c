# SPDX-License-Identifier: Apache-2.0
"""Traces of runs (palpate run -o TRACE), mapped, not copied."""

import os
from dataclasses import dataclass

import numpy as np

from palpate._engine import Error

_HEADER = np.dtype(
    [
        ("magic", "S8"),
        ("version", "<u4"),
        ("record_bytes", "<u4"),
        ("header_bytes", "<u4"),
        ("scene_bytes", "<u4"),
        ("records", "<u8"),
        ("dropped", "<u8"),
        ("rate_Hz", "<f8"),
        ("reserved", "V16"),
    ]
)

# docs/REALTIME.md, "Trace format".
RECORD = np.dtype(
    [
        ("tick", "<u8"),
        ("time_ns", "<u8"),
        ("position_m", "<f8", 3),
        ("orientation", "<f8", 4),
        ("rendered_force_N", "<f8", 3),
        ("rendered_torque_Nm", "<f8", 3),
        ("sent_force_N", "<f4", 3),
        ("sent_torque_Nm", "<f4", 3),
        ("min_distance_m", "<f8"),
        ("error_bound_m", "<f8"),
        ("s_worst", "<f8"),
        ("energy_J", "<f8"),
        ("latency_ns", "<u4"),
        ("tick_ns", "<u4"),
        ("state_age_ns", "<u4"),
        ("contacts", "<u4"),
        ("clusters", "<u4"),
        ("queries", "<u4"),
        ("front_nodes", "<u4"),
        ("state", "u1"),
        ("truncated", "u1"),
        ("faults", "<u2"),
        ("force_bound_N", "<f8"),
    ]
)
assert _HEADER.itemsize == 64 and RECORD.itemsize == 216


@dataclass
class Trace:
    """A run, tick by tick. World axes, SI units.

    records  (ticks,) structured array, mapped from the file: tick; time_ns since the start; the
             tool's position_m (3,) and orientation (4,), w x y z; rendered_force_N and
             rendered_torque_Nm (3,), the engine's; sent_force_N and sent_torque_Nm (3,), the
             device's, about the tool's origin; min_distance_m; error_bound_m, force_bound_N and s_worst,
             the certificate; energy_J; latency_ns, tick_ns, state_age_ns; contacts; ...
    rate_Hz  of the loop
    dropped  ticks that left no record
    scene    path of the scene
    """

    records: np.ndarray
    rate_Hz: float
    dropped: int
    scene: str

    @property
    def time_s(self):
        """(ticks,) when each tick was due, s since the start."""
        return self.records["time_ns"] * 1e-9


def read_trace(path):
    """Opens what `palpate run -o` wrote: a Trace."""
    size = os.path.getsize(path)
    with open(path, "rb") as file:
        start = file.read(_HEADER.itemsize)
        if len(start) < _HEADER.itemsize or not start.startswith(b"PALTRACE"):
            raise Error(f"{path}: not a trace: give a file of 'palpate run -o'")
        header = np.frombuffer(start, _HEADER)[0]
        if header["version"] != 2 or header["record_bytes"] != RECORD.itemsize:
            raise Error(f"{path}: a trace of another version: make it with this version's 'palpate run -o'")
        scene = file.read(int(header["scene_bytes"])).decode(errors="replace")
    offset, count = int(header["header_bytes"]), int(header["records"])
    if size != offset + count * RECORD.itemsize:
        raise Error(f"{path}: a trace cut short: copy it again")
    records = np.memmap(path, RECORD, "r", offset, (count,)) if count else np.empty(0, RECORD)
    return Trace(records, float(header["rate_Hz"]), int(header["dropped"]), scene)
