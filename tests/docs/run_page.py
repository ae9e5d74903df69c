# SPDX-License-Identifier: Apache-2.0
"""Runs the commands of a page as they are written in it, or checks that none of any page is left out.

run_page.py SOURCES BUILD PAGE     runs the page's blocks marked `sh`, one after the other, in a folder
                                   that looks like the top of the sources beside a finished build
run_page.py SOURCES BUILD --check  every block of commands is marked, and is run or has a reason not to be
"""

import os
import re
import subprocess
import sys
import tempfile

# What a page's reader has before he reads it.
JAWS = """
cp config/scenes/jaws.toml .
for jaw in lower upper; do
  palpate make-model jaw_$jaw --triangles 2000 -o jaw_$jaw.ply --quiet
  palpate bake jaw_$jaw.ply -o jaw_$jaw.palp --quiet
done
"""
PREPARED = {
    "README.md": "python3 examples/two_parts.py\n",
    "docs/SWEEP.md": JAWS,
    "docs/REPORT.md": JAWS
    + """
palpate make-motion jaws jaws.toml --one-in 50 -o jaws.csv
palpate sweep jaws.toml --poses jaws.csv -o sweep --engine regions --quiet
mkdir replay && palpate replay jaws.toml --poses jaws.csv -o replay/ticks.csv --quiet
palpate run jaws.toml --seconds 1 -o run.trace --quiet
""",
}

EXAMPLES = [
    f"examples/{name}/README.md"
    for name in (
        "01-query-once",
        "02-loop-with-a-budget",
        "03-exact-against-budget",
        "04-own-device",
        "05-device-on-the-usb-simulator",
        "06-prediction-at-4-khz",
    )
]
# Pages that go on where another ends, in its folder.
FOLLOWING = {"examples/README.md": EXAMPLES}

# The first line of a block that no test runs, and why.
NOT_RUN = {
    "palpate run SCENE": "any scene; live_process_test and live_browser run the view",
    "./tools/demo": "builds everything; CI runs it by itself",
    "sudo tools/setup/host": "changes the machine; tools.host_setup runs it on a root of its own",
    "palpate key secret.pem": "needs a device; tests of flash and key run each command",
    "palpate-sim --flash": "needs root and vhci_hcd; usbip_process runs the simulator",
    "tools/reproduce-levels": "takes half an hour",
    "./tools/reproduce": "takes hours",
    "build/dev/tests/": "takes minutes, and is a test itself, labelled long",
}
BENCHMARK = re.compile(r"bench_\w+")  # takes minutes to hours on a quiet machine

# A block that begins so is one of commands.
COMMAND = re.compile(r"(\./)?(tools/|palpate|cmake|ctest|build/[^ :]+ |sudo|export |chrt|taskset|node |python3|PYTHONPATH|mkdir|cp |cd |git )")

# A busy machine may miss deadlines, or be too slow for any setting of a sweep; a build may have no page for reports (node) or
# no module (pybind11).
SHELL = """
palpate() {
  if [ "$1" = report ] && [ ! -e "$PALPATE_PAGE" ]; then echo "no page: $*"; return 0; fi
  local status=0 said=$(mktemp -p .)
  command palpate "$@" 2>"$said" || status=$?
  cat "$said" >&2
  if [ $status = 5 ] || grep -q "no setting's p99.9 fits" "$said"; then status=0; fi
  rm "$said"
  return $status
}
python3() {
  if [ -n "${PYTHONPATH:-}" ] && [ ! -e build/release/python ]; then echo "no module: $*"; return 0; fi
  command python3 "$@"
}
"""


def blocks(text):
    """(language, commands) of the fenced blocks."""
    return re.findall(r"^```([^\n]*)\n(.*?)^```", text, re.S | re.M)


def reason_not_to_run(commands):
    for start, reason in NOT_RUN.items():
        if commands.startswith(start):
            return reason
    return "a benchmark" if BENCHMARK.search(commands) else None


def read(sources, page):
    with open(os.path.join(sources, page), encoding="utf-8") as file:
        return file.read()


def check(sources):
    pages = ["README.md", "config/README.md", "examples/README.md"] + EXAMPLES
    pages += sorted("docs/" + name for name in os.listdir(os.path.join(sources, "docs")) if name.endswith(".md"))
    wrong, with_commands = [], []
    for page in pages:
        runs = False
        for language, commands in blocks(read(sources, page)):
            first = commands.split("\n", 1)[0]
            if language == "sh":
                runs = runs or not reason_not_to_run(commands)
            elif language == "" and COMMAND.match(commands):
                wrong.append(f"{page}: mark this block as sh: {first}")
        if runs and page not in EXAMPLES:
            with_commands.append(page)
    listed = set(sys.argv[4:])
    wrong += [f"{page}: has commands; list it in docs.cmake" for page in with_commands if page not in listed]
    wrong += [f"{page}: has no commands to run; leave it out of docs.cmake" for page in listed - set(with_commands)]
    if wrong:
        sys.exit("\n".join(wrong))
    print(f"{len(pages)} pages, {len(with_commands)} with commands that are run")


def run(sources, build, page):
    with tempfile.TemporaryDirectory() as folder:
        for name in ("config", "docs", "examples", "tests", "tools"):
            os.symlink(os.path.join(sources, name), os.path.join(folder, name))
        os.mkdir(os.path.join(folder, "build"))
        for preset in ("dev", "release"):
            os.symlink(build, os.path.join(folder, "build", preset))
        environment = dict(os.environ, PALPATE_PAGE=os.path.join(build, "tools", "report.html"))
        # Debian's Python before others: the module is for that one.
        environment["PATH"] = os.path.join(build, "tools") + ":/usr/bin:" + environment["PATH"]
        for name in ("DISPLAY", "WAYLAND_DISPLAY"):
            environment.pop(name, None)

        def shell(commands):
            print(commands, flush=True)
            done = subprocess.run(
                ["bash", "-euo", "pipefail", "-c", SHELL + commands], cwd=folder, env=environment, stdin=subprocess.DEVNULL
            )
            if done.returncode != 0:
                sys.exit(f"{page}: exit status {done.returncode} of:\n{commands}")

        shell(PREPARED.get(page, ""))
        for each in [page] + FOLLOWING.get(page, []):
            for language, commands in blocks(read(sources, each)):
                if language == "sh" and not reason_not_to_run(commands):
                    shell(commands)


if __name__ == "__main__":
    if sys.argv[3] == "--check":
        check(sys.argv[1])
    else:
        run(*sys.argv[1:4])
