#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""stack.py BUILD LIMIT ROOT...: the deepest stack below each root function, from GCC's call graphs (-fcallgraph-info=su).

Fails where a function recurses, has a stack of unbounded size, or where a path needs more than LIMIT bytes. Calls through
pointers (the clock that is handed in) and into the C library are listed and not counted.
"""
import pathlib
import re
import sys

build, limit, roots = pathlib.Path(sys.argv[1]), int(sys.argv[2]), sys.argv[3:]
frame, name, calls = {}, {}, {}
for file in sorted(build.glob("rt_core/**/*.ci")):
    text = file.read_text()
    for title, label in re.findall(r'node: \{ title: "([^"]*)" label: "([^"]*)"', text):
        name.setdefault(title, label.split("\\n")[0])
        size = re.search(r"(\d+) bytes \(([^)]*)\)", label)
        if size:
            if size[2] not in ("static", "dynamic,bounded"):
                sys.exit(f"{name[title]}: stack of {size[2]} size")
            frame[title] = max(frame.get(title, 0), int(size[1]))
            name[title] = label.split("\\n")[0]
    for source, target in re.findall(r'edge: \{ sourcename: "([^"]*)" targetname: "([^"]*)"', text):
        calls.setdefault(source, set()).add(target)

outside = set()


def deepest(function, above):
    """(bytes, path) of the deepest stack from `function` on."""
    if function in above:
        sys.exit("recursion: " + " -> ".join(name.get(f, f) for f in (*above, function)))
    if function not in frame:
        outside.add(name.get(function, function))
        return 0, []
    if function not in known:
        below = max((deepest(c, (*above, function)) for c in sorted(calls.get(function, ()))), default=(0, []), key=lambda d: d[0])
        known[function] = (frame[function] + 8 + below[0], [function, *below[1]])
    return known[function]


worst = 0
for root in roots:
    matches = [f for f in frame if re.search(rf"\b{root}\(", name[f])]
    if not matches:
        sys.exit(f"no function {root} in the call graphs below {build}")
    for function in matches:
        known = {}
        size, path = deepest(function, ())
        worst = max(worst, size)
        print(f"{size:6d} bytes below {name[function]}")
        for f in path:
            print(f"       {frame[f]:6d}  {name[f]}")
print("not counted:", ", ".join(sorted(outside)))
sys.exit(f"{worst} bytes are more than {limit}" if worst > limit else 0)
