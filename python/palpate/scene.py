# SPDX-License-Identifier: Apache-2.0
"""Scenes (scene.toml) and motions (POSES.csv) for an Engine."""

import csv
import os
import tomllib
from dataclasses import dataclass

import numpy as np

from palpate._engine import Engine, Error, Image

# What a scene says of the engine. The rest of it is for the real-time loop.
_ENGINE = ("engine", "delta_m", "s0", "kappa", "exact", "force_tolerance_N", "bounds", "order")
_FORCE = ("stiffness_N_per_m", "cluster_radius_m", "max_force_N", "max_torque_Nm")
_LIMITS = ("nodes", "contacts", "clusters")


@dataclass
class Scene:
    """An engine and where its bodies are.

    engine     palpate.Engine
    names      [bodies] names of the bodies
    fixed      names of those that no motion moves
    poses      (bodies, 7) where they are at the start
    budget_us  of one tick, microseconds; None: unlimited
    """

    engine: Engine
    names: list
    fixed: set
    poses: np.ndarray
    budget_us: float | None


def _only(table, keys):
    return {key: table[key] for key in keys if key in table}


def load_scene(path):
    """Opens a scene and its images: a Scene.

    The contact engine alone is made of it: coupling, damping, friction, passivity and the device's
    safety belong to `palpate run`. `palpate run` also checks every key, this does not.
    """
    with open(path, "rb") as file:
        try:
            table = tomllib.load(file)
        except tomllib.TOMLDecodeError as error:
            raise Error(f"{path}: not TOML, {error}: correct it") from error
    bodies = table.get("body", [])
    names = [body.get("name") for body in bodies]
    tools = [i for i, body in enumerate(bodies) if body.get("role") == "tool"]
    if len(tools) != 1 or any("image" not in body or "name" not in body for body in bodies):
        raise Error(f"{path}: no scene: give [[body]] twice or more, each with name and image, one with role = \"tool\"")
    folder = os.path.dirname(os.path.abspath(path))
    opened = {}
    for body in bodies:
        file = os.path.join(folder, body["image"])
        if file not in opened:
            opened[file] = Image(file)
    images = [opened[os.path.join(folder, body["image"])] for body in bodies]
    pairs = None
    if table.get("pair"):
        try:
            pairs = [(names.index(pair["a"]), names.index(pair["b"])) for pair in table["pair"]]
        except (KeyError, ValueError) as error:
            raise Error(f"{path}: [[pair]]: {error}: name two bodies, a and b") from error
    # A scene may drive a device: its wrench is limited (config/README.md).
    settings = {"max_force_N": 3.0, "max_torque_Nm": 0.1}
    settings |= _only(table.get("engine", {}), _ENGINE) | _only(table.get("force", {}), _FORCE)
    engine = Engine(images, pairs, tools[0], _only(table.get("limits", {}), _LIMITS), **settings)
    poses = np.array(
        [body.get("position", [0, 0, 0]) + body.get("orientation", [1, 0, 0, 0]) for body in bodies], dtype=float
    )
    fixed = {body["name"] for body in bodies if body.get("role", "fixed") == "fixed"}
    return Scene(engine, names, fixed, poses, table.get("engine", {}).get("budget_us"))


def read_motion(path, scene):
    """Reads POSES.csv (header t,body,px,py,pz,qw,qx,qy,qz).

    returns  times (ticks,) in s, and poses (ticks, bodies, 7) for Engine.ticks(): a tick for each
             time, and a body without a row keeps its last pose
    """
    times, poses, now = [], [], scene.poses.copy()
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            try:
                time, body = float(row["t"]), scene.names.index(row["body"])
                pose = [float(row[key]) for key in ("px", "py", "pz", "qw", "qx", "qy", "qz")]
            except (KeyError, TypeError, ValueError) as error:
                raise Error(
                    f"{path}: no motion of this scene, {error}: give t,body,px,py,pz,qw,qx,qy,qz of {scene.names}"
                ) from error
            if row["body"] in scene.fixed:
                raise Error(f"{path}: body '{row['body']}' is fixed: give it role = \"moved\" in the scene")
            if times and time < times[-1]:
                raise Error(f"{path}: time runs backwards at {time} s: order the rows by t")
            now[body] = pose
            if times and time == times[-1]:
                poses[-1] = now.copy()
            else:
                times.append(time)
                poses.append(now.copy())
    return np.array(times), np.array(poses).reshape(len(times), *scene.poses.shape)
