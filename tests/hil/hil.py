# SPDX-License-Identifier: Apache-2.0
"""Runs the scenarios and prints TAP. tools/hil calls this, and has made what it needs."""

import argparse
import os
import pathlib
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from judge import Log, Verdict
from power_cuts import cut_power
from scenarios import SCENARIOS

HERE = pathlib.Path(__file__).resolve().parent
# One instruction is one nanosecond, and sleep takes no time: what else this machine does has no influence.
VIRTUAL_TIME = ["-icount", "shift=0,sleep=off"]
LIMIT_S = 600


def qemu(options, settings, more=()):
    words = " ".join(f"{name}={value}" for name, value in settings.items())
    return ["qemu-system-x86_64", "-machine", "q35", "-accel", "tcg,thread=single,tb-size=256", "-cpu", "max", "-smp", "1", "-m", "512",
            "-nographic", "-no-reboot", "-nodefaults", "-serial", "stdio", "-monitor", "none", *more,
            "-kernel", str(options.kernel), "-initrd", str(options.initramfs), "-append", f"console=ttyS0 quiet panic=-1 {words}"]


def run_to_end(command, log, env=None, cwd=None):
    """Its output is in the log; none of its processes outlives this."""
    with open(log, "wb") as out:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.STDOUT, env=env, cwd=cwd)
        try:
            process.wait(LIMIT_S)
        except subprocess.TimeoutExpired:
            out.write(f"\nHIL: stopped after {LIMIT_S} s\n".encode())
        finally:
            process.kill()
            process.wait()


def perform(scenario, options):
    log = options.logs / f"{scenario.name}.log"
    started = time.monotonic()
    verdict = Verdict()
    if options.device:
        settings = {"BUS": "real", "DEVICE": options.device, "CPU": options.cpu, "SCENE": str(options.data / "scene.toml"), "PROJECT": str(HERE.parents[1]),
                    "SCRATCH": str(options.logs), **scenario.real}
        env = {**os.environ, "PATH": f"{options.programs}:{os.environ['PATH']}", **{k: str(v) for k, v in settings.items()}}
        run_to_end(["bash", "-c", f"./{scenario.script}; echo GUEST ended $?"], log, env, HERE / "guest")
    elif scenario.cuts:
        texts = cut_power(scenario.cuts, options.logs, lambda settings, more: qemu(options, settings, more))
        scenario.judge(texts, verdict, options.data)
        verdict.tell(f"{time.monotonic() - started:.0f} s")
        return verdict, options.logs / "power_cuts.*.log"
    else:
        run_to_end(qemu(options, {"scenario": scenario.script, **scenario.settings}, VIRTUAL_TIME), log)
    result = Log(log.read_text(errors="replace"))
    if not result.ended:
        verdict.failures.append("it did not come to its end")
    verdict.failures += [f"the kernel complained: {complaint}" for complaint in result.complaints]
    scenario.judge(result, verdict, bool(options.device))
    verdict.tell(f"{time.monotonic() - started:.0f} s")
    return verdict, log


def reason_to_skip(scenario, options):
    if options.device and scenario.real is None:
        return "not with a real device"
    if options.device and scenario.asked_for and scenario.name not in options.only:
        return f"it writes to the device: ask for it by --only {scenario.name}"
    return None


def main():
    parser = argparse.ArgumentParser(prog="tools/hil")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--only", action="append", default=[], metavar="NAME")
    parser.add_argument("--device", metavar="usb:SERIAL")
    parser.add_argument("--cpu", default="", metavar="N")
    for name in ("kernel", "initramfs", "programs", "data", "logs"):
        parser.add_argument(f"--{name}", type=pathlib.Path)
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

    options.logs.mkdir(parents=True, exist_ok=True)
    print(f"TAP version 13\n1..{len(chosen)}", flush=True)
    failed = 0
    reasons = {s.name: reason for s in chosen if (reason := reason_to_skip(s, options))}
    with ThreadPoolExecutor(1 if options.device else options.jobs) as pool:
        # What takes longest begins first.
        waiting = sorted((s for s in chosen if s.name not in reasons), key=lambda s: -s.cuts)
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
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
