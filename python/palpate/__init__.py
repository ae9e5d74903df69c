# SPDX-License-Identifier: Apache-2.0
"""Contact between detailed rigid objects, inside a budget, with a certificate.

    import palpate
    scene = palpate.load_scene("scene.toml")           # what `palpate new-scene A B` writes
    result = scene.engine.tick(scene.poses, budget_us=400)
    print(result.force_N, result.contact, result.error_bound_m)

SI units: metres, newtons, newton metres, seconds. A pose is seven numbers, px py pz qw qx qy qz,
and maps body to world. Wrenches act on the tool, in world axes about the tool's origin.
What is refused raises palpate.Error, a ValueError that says what, where and how to fix it.
"""

from palpate._engine import Engine, Error, Image, Result
from palpate.scene import Scene, load_scene, read_motion
from palpate.trace import Trace, read_trace

__all__ = ["Engine", "Error", "Image", "Result", "Scene", "Trace", "load_scene", "read_motion", "read_trace"]
