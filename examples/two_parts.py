# SPDX-License-Identifier: Apache-2.0
"""two_parts.py: writes pin.stl and plate.stl, two parts in millimetres as a CAD program would export them."""

import math
import struct


def write_stl(path, triangles):
    """Binary STL: each triangle a normal, which readers work out for themselves, and three corners."""
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(triangles)))
        for corners in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *(x for corner in corners for x in corner), 0))


def pin(around=96, rows=24, radius=3.0, length=18.0):
    """A round pin with a ball at its lower end, its axis along z."""
    profile = [(radius * math.sin(a), -radius * math.cos(a)) for a in (0.5 * math.pi * i / rows for i in range(rows + 1))]
    profile += [(radius, length * i / rows) for i in range(1, rows + 1)]
    ring = [(math.cos(t), math.sin(t)) for t in (2 * math.pi * k / around for k in range(around))]
    points = [[(r * c, r * s, z) for c, s in ring] for r, z in profile[1:]]
    tip, top = (0, 0, -radius), (0, 0, length)
    faces = []
    for k in range(around):
        n = (k + 1) % around
        faces.append((tip, points[0][n], points[0][k]))
        faces.append((top, points[-1][k], points[-1][n]))
        for low, high in zip(points, points[1:]):
            faces += [(low[k], low[n], high[n]), (low[k], high[n], high[k])]
    return faces


def plate(cells=60, side=40.0, thickness=5.0):
    """A square plate whose upper side is embossed with rows of bumps."""

    def corner(i, j, z=None):
        x, y = side * (i / cells - 0.5), side * (j / cells - 0.5)
        bump = max(0.0, math.sin(0.9 * x) * math.sin(0.9 * y))
        return (x, y, 0.8 * bump if z is None else z)

    faces = []
    for i in range(cells):
        for j in range(cells):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            faces += [(a, b, c), (a, c, d)]
            a, b, c, d = ((x, y, -thickness) for x, y, _ in (a, b, c, d))
            faces += [(a, c, b), (a, d, c)]
    for k in range(cells):
        for at in (lambda k: (k, 0), lambda k: (cells, k), lambda k: (cells - k, cells), lambda k: (0, cells - k)):
            (i, j), (m, n) = at(k), at(k + 1)
            a, b, c, d = corner(i, j, -thickness), corner(m, n, -thickness), corner(m, n), corner(i, j)
            faces += [(a, b, c), (a, c, d)]
    return faces


write_stl("pin.stl", pin())
write_stl("plate.stl", plate())
