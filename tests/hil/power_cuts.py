# SPDX-License-Identifier: Apache-2.0
"""Cuts the power of a device in the middle of updates, and looks at what its slots hold at each next start.

Virtual time advances with the guest's instructions here too, so that a busy machine lets no time-out pass, but sleep takes its
time: without, waiting for the disk would make it leap. What the guest wrote through to the disk stays; what it had in memory is lost,
as on a device.
"""

import hashlib
import random
import re
import subprocess
import time

from judge import Log
from processes import running, wait_for_end

START_LIMIT_S = 600
PATIENT_TIME = ["-icount", "shift=0,sleep=on"]
# Erasing for the smaller image takes 1.8 s: 12 units of 150 ms. The rest is for a machine that does much else.
WRITING_S = 1.0
IMAGES = ("ellipsoid", "small")


def text_of(log):
    return log.read_text(errors="replace").replace("\r", "")


def wait_for(process, log, pattern):
    """Until the log has it, or the process has ended, or it takes too long."""
    give_up = time.monotonic() + START_LIMIT_S
    while time.monotonic() < give_up and process.poll() is None and not re.search(pattern, text_of(log), re.M):
        time.sleep(0.02)


def boot(machine, log, cut_after, settings):
    """Runs until cut_after(process, log) returns, or to the end."""
    with running(log=log, **machine.go_on(**settings)) as process:
        if cut_after:
            cut_after(process, log)
        else:
            wait_for_end(process, START_LIMIT_S)
    return text_of(log)


def cut_power(cuts, folder, machine_of):
    """The texts of all starts, one more than cuts. @param machine_of  of more options

    The kernel is started once: each start goes on from where it has not looked at the disk yet."""
    disk = folder / "power_cuts.disk"
    disk.unlink(missing_ok=True)
    with open(disk, "wb") as file:
        file.truncate(32 << 20)
    subprocess.run(["mkfs.ext4", "-q", "-F", disk], check=True)
    machine = machine_of([*PATIENT_TIME, "-drive", f"file={disk},format=raw,if=virtio,cache=writethrough"])
    machine.start()
    moments = random.Random(1)
    texts = []

    def cut(process, log):
        wait_for(process, log, "^WRITING")
        time.sleep(moments.uniform(0, WRITING_S))

    for start in range(cuts + 1):
        last = start == cuts
        # The image that was cut goes first, so that both slots are whole again before the next cut, which is the other one's.
        first, second = IMAGES if start == 0 or start % 2 == 1 else reversed(IMAGES)
        settings = {"scenario": "power_cut.sh", "BUS": "vhci", "FIRST": first, "SECOND": second, **({"LAST": 1} if last else {})}
        texts.append(boot(machine, folder / f"power_cuts.{start}.log", None if last else cut, settings))
    machine.forget()
    disk.unlink()
    return texts


def judge_power_cuts(texts, verdict, data):
    known = {hashlib.sha256((data / f"{name}.palp").read_bytes()).hexdigest(): name for name in IMAGES}
    known["none"] = None
    in_the_middle = 0
    flashed = None
    for start, text in enumerate(texts):
        facts = Log(text).facts
        if facts.get("looked") != "yes":
            verdict.failures.append(f"start {start} did not come so far as to read its slots")
            continue
        slots = [known.get(facts[f"slot_{n}"], "something else") for n in (0, 1)]
        if "something else" in slots:
            verdict.failures.append(f"start {start}: a slot holds what was never written: {slots}")
        if flashed and flashed not in slots:
            verdict.failures.append(f"start {start}: {flashed} was in use before the cut and is gone: {slots}")
        if start > 0:
            in_the_middle += None in slots
        done = re.findall(r"^FLASHED (\S+) 0$", text, re.M)
        flashed = done[-1] if done else flashed
    verdict.equal("cuts amid an update", in_the_middle, len(texts) - 1)
    if not verdict.failures:
        verdict.tell("the image in use stayed whole, the other slot undeclared")
