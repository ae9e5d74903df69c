# SPDX-License-Identifier: Apache-2.0
"""Runs the scenarios and prints TAP. tools/hil calls this, and has made what it needs."""

import argparse
import os
import pathlib
import re
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from guest_machine import VIRTUAL_TIME, GuestMachine
from judge import Log, Verdict
from power_cuts import cut_power
from processes import kill_all_when_stopped, running, wait_for_end
from scenarios import SCENARIOS

HERE = pathlib.Path(__file__).resolve().parent
LIMIT_S = 600


def on_this_machine(scenario, options):
    settings = {"BUS": "real", "DEVICE": options.device, "CPU": options.cpu, "PROJECT": HERE.parents[1], "SCRATCH": options.logs, **scenario.real}
    return {
        "command": ["bash", "-c", f"bash ./{scenario.script}; echo GUEST ended $?"],
        "env": {**os.environ, "PATH": f"{options.programs}:{os.environ['PATH']}", **{name: str(value) for name, value in settings.items()}},
        "cwd": options.data,
    }


def in_guest(scenario, options):
    return options.machine.go_on(scenario=scenario.script, **scenario.settings)


def perform_once(scenario, options, verdict):
    log = options.logs / f"{scenario.name}.log"
    with running(log=log, **(on_this_machine if options.device else in_guest)(scenario, options)) as process:
        wait_for_end(process, LIMIT_S)
    result = Log(log.read_text(errors="replace"))
    if not result.ended:
        verdict.failures.append(f"it did not come to its end within {LIMIT_S} s")
    verdict.failures += [f"the kernel complained: {complaint}" for complaint in result.complaints]
    scenario.judge(result, verdict, bool(options.device))
    return log


def perform_with_cuts(scenario, options, verdict):
    texts = cut_power(options.cuts or scenario.cuts, options.logs, lambda more: GuestMachine(options.kernel, options.initramfs, options.logs, scenario.name, more))
    scenario.judge(texts, verdict, options.data)
    return options.logs / "power_cuts.*.log"


def perform(scenario, options):
    """What is to be said about it, and where its log is."""
    started = time.monotonic()
    verdict = Verdict()
    log = (perform_with_cuts if scenario.cuts else perform_once)(scenario, options, verdict)
    verdict.tell(f"{time.monotonic() - started:.0f} s")
    return verdict, log


def version_of(kernel):
    return tuple(int(number) for number in re.findall(r"\d+", kernel.name)[:2])


def reason_to_skip(scenario, options):
    if options.device and scenario.real is None:
        return "not with a real device"
    if options.device and scenario.asked_for and scenario.name not in options.only:
        return f"it writes to the device: ask for it by --only {scenario.name}"
    if not options.device and scenario.since > version_of(options.kernel):
        return f"dummy_hcd has no microframes before Linux {'.'.join(map(str, scenario.since))}"
    return None


def main():
    parser = argparse.ArgumentParser(prog="tools/hil")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", action="append", default=[], metavar="NAME")
    parser.add_argument("--device", metavar="usb:SERIAL")
    parser.add_argument("--cpu", default="", metavar="N")
    for name in ("kernel", "initramfs", "programs", "data", "logs"):
        parser.add_argument(f"--{name}", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("--cuts", type=int, metavar="N")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()

    unknown = set(options.only) - {s.name for s in SCENARIOS}
    if unknown:
        parser.error(f"--only {', '.join(sorted(unknown))}: no such scenario: see tools/hil --list")
    chosen = [s for s in SCENARIOS if not options.only or s.name in options.only]
    if options.list:
        for scenario in chosen:
            print(f"{scenario.name:18} {scenario.what}{'' if scenario.real is None else ' (also --device)'}")
        return 0

    kill_all_when_stopped()
    options.logs.mkdir(parents=True, exist_ok=True)
    print(f"TAP version 13\n1..{len(chosen)}", flush=True)
    failed = 0
    options.machine = GuestMachine(options.kernel, options.initramfs, options.logs, "virtual_time", VIRTUAL_TIME)
    reasons = {s.name: reason for s in chosen if (reason := reason_to_skip(s, options))}
    # What takes longest begins first.
    waiting = sorted((s for s in chosen if s.name not in reasons), key=lambda s: -s.cuts)
    if not options.device and any(not s.cuts for s in waiting):
        if problem := options.machine.start():
            print(f"# {problem}: each scenario starts its own", flush=True)
    with ThreadPoolExecutor(1 if options.device else options.jobs) as pool:
        futures = {s.name: pool.submit(perform, s, options) for s in waiting}
        for number, scenario in enumerate(chosen, 1):
            if scenario.name in reasons:
                print(f"ok {number} - {scenario.name} # SKIP {reasons[scenario.name]}", flush=True)
                continue
            verdict, log = futures[scenario.name].result()
            print(verdict.tap(number, scenario.name), flush=True)
            if verdict.failures:
                failed += 1
                print(f"# log: {log}", flush=True)
    options.machine.forget()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
