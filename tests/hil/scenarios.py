# SPDX-License-Identifier: Apache-2.0
"""The scenarios: what is run in a guest, or on this machine with a real device, and what must come of it.

Bounds of time hold in the guest's virtual time, in which one instruction takes one nanosecond whatever else this machine does.
They leave room for other kernels and compilers; docs/REALTIME.md says what was measured. None of them is a promise about
hardware, where a run must miss no deadline, and the rest is only shown.
"""

from dataclasses import dataclass, field
from typing import Callable

from judge import us
from power_cuts import judge_power_cuts


@dataclass
class Scenario:
    name: str
    what: str
    script: str
    judge: Callable
    settings: dict = field(default_factory=dict)
    real: dict | None = None  # settings on a real device; None: not for one
    asked_for: bool = False  # on a real device only by --only: it writes to the device
    since: tuple = (0, 0)  # Linux in the guest
    cuts: int = 0  # of power; the guest then runs in real time, and has a disk


WAKE_UP_US = 25


def judge_doctor(log, verdict, real):
    before = {c["check"]: c for c in log.get("before") or []}
    after = {c["check"]: c for c in log.get("after") or []}
    verdict.tell(f"kernel {log.facts.get('kernel')}")
    verdict.silently("preemption", after.get("kernel_preemption", {}).get("ok"), True)
    if not real:
        verdict.silently("USB threads are complained about", before.get("usb_threads", {}).get("ok"), False)
        verdict.silently("exit status then", log.status("before"), 1)
    verdict.silently("to be fixed", [name for name, check in after.items() if not check["ok"]], [])
    verdict.equal("exit status when all is fixed" if not real else "exit status", log.status("after"), 0)
    verdict.tell(f"{sum(c['ok'] for c in after.values())} of {len(after)} checks fine")
    verdict.tell(f"USB threads: {after.get('usb_threads', {}).get('found')}")
    cyclictest = log.number("cyclictest_us")
    if real:
        verdict.tell(f"cyclictest max {cyclictest} us")
    else:
        verdict.at_most("cyclictest max", cyclictest, WAKE_UP_US, " us")


def judge_run(log, verdict, real, name="run", wake_up_us=WAKE_UP_US, age_us=None, age_p99_at_least_us=None):
    run = lambda *keys: log.get(name, *keys)
    verdict.silently("exit status", log.status(name), 0)
    verdict.silently("state", run("state"), "rendering")
    verdict.silently("faults", run("faults"), [])
    verdict.silently("scheduler", run("scheduler"), "SCHED_FIFO 80")
    verdict.silently("allocations", run("allocations"), 0)
    verdict.silently("page faults", run("page_faults"), 0)
    verdict.tell(f"{run('ticks')} ticks at {run('rate_hz'):g} Hz" if run("rate_hz") else "no run")
    verdict.equal("missed", run("missed"), 0)
    wake_up, age = us(run("latency_ns", "max")), us(run("state_age_ns", "max"))
    verdict.at_most("wake-up max", wake_up, None if real else wake_up_us, " us")
    if age_p99_at_least_us:
        verdict.at_least("age p99", us(run("state_age_ns", "p99")), age_p99_at_least_us, " us")
    else:
        verdict.at_most("age max", age, None if real else age_us, " us")


def judge_run_of(**bounds):
    return lambda log, verdict, real: judge_run(log, verdict, real, **bounds)


def judge_mock(log, verdict, real):
    for name in ("at_1k", "at_4k"):
        judge_run(log, verdict, real, name)
    verdict.at_most("cyclictest beside max", log.number("cyclictest_us"), None if real else WAKE_UP_US, " us")


def judge_falcon(log, verdict, real):
    verdict.equal("exit status without firmware", log.number("without_firmware"), 4)
    verdict.equal("with it", log.number("upload"), 0)
    judge_run(log, verdict, real, age_us=2000)


def judge_flash(log, verdict, real):
    verdict.equal("flash --verify", log.number("flash"), 0)
    verdict.equal("read back by dfu-util", log.facts.get("flash_back"), "same")
    verdict.equal("flash beside the loop", log.number("flash_beside"), 4)
    verdict.silently("the loop's state then", log.get("beside", "state"), "rendering")
    verdict.silently("the loop's misses then", log.get("beside", "missed"), 0)
    verdict.equal("dfu-util", log.number("dfu"), 0)
    verdict.equal("read back", log.facts.get("dfu_back"), "same")
    verdict.equal("another product's file", log.number("dfu_other_product"), 64)
    verdict.silently("the other slot", log.facts.get("flash_still_there"), "same")


def let_go_ms(log, name):
    """From what was done to the device until it had no force."""
    at, let_go = log.number(f"{name}_at"), log.number(f"{name}_let_go")
    return None if at is None or let_go is None else round(1000 * (let_go - at), 1)


# A command lives for 20 ms at most; then the device's period ends, and the sending and logging of both takes some time.
LET_GO_MS = 22
# From the shell's order on: until it has reached all threads of the program, which goes on commanding meanwhile.
LET_GO_FROM_ORDER_MS = 30


def judge_let_go(log, verdict, name):
    after_us = log.number(f"{name}_after_us")
    verdict.at_most("let go after the last command", None if after_us is None else after_us / 1000, LET_GO_MS, " ms")
    verdict.at_most("after the order", let_go_ms(log, name), LET_GO_FROM_ORDER_MS, " ms")


def judge_unplug(*ways, unseen=()):
    def judge(log, verdict, real):
        for way in ways:
            verdict.equal(f"{way}: exit status", log.status(way), 4)
            verdict.silently(f"{way}: fault", "device_error" in (log.get(way, "faults") or []), True)
            verdict.equal("device", (log.get(way, "device_faults") or [None])[0], "unplugged")
            if way not in unseen:
                judge_let_go(log, verdict, way)
            verdict.silently(f"{way}: the next run", log.get(f"{way}_again", "state"), "rendering")

    return judge


def judge_silent(log, verdict, real):
    verdict.equal("exit status", log.status("silent"), 4)
    verdict.equal("first fault", log.get("silent", "fault_details", 0, "fault"), "stale_state")
    verdict.equal("the next run", log.get("again", "state"), "rendering")


# A period from the last command but one to the last tick, two after it.
ENDED_US = 3000


def judge_host(log, verdict, real):
    if not real:
        verdict.silently("the run that ends: exit status", log.status("ended"), 0)
        verdict.at_most("end of a run: no force after the last command with one", log.number("ended_after_us"), ENDED_US, " us")
    for name in ("stopped", "killed"):
        if not real:
            judge_let_go(log, verdict, name)
        verdict.equal(f"{name}: the next run", log.get(f"{name}_again", "state"), "rendering")
    verdict.silently("the stopped run's state", log.get("stopped", "state"), "fault")
    verdict.tell(f"the stopped run: {' '.join(log.get('stopped', 'faults') or [])}, exit status {log.status('stopped')}")


def judge_udev(log, verdict, real):
    first = lambda name: log.get(name, 0, "state")
    verdict.equal("without the rule", first("before"), "not usable")
    verdict.equal("with it", first("member"), "ready")
    verdict.equal("for who is not in plugdev", first("stranger"), "not usable")
    verdict.equal("mode and group", log.facts.get("node"), "660 46")
    verdict.equal("power/control", log.facts.get("power"), "on")
    verdict.silently("without limits: state", log.get("without_limits", "state"), "rendering")
    verdict.silently("without limits: notes", bool(log.get("without_limits", "notes")), True)
    judge_run(log, verdict, real, "with_limits", age_us=1250)


VHCI, FUNCTIONFS = {"BUS": "vhci"}, {"BUS": "functionfs"}

SCENARIOS = [
    Scenario("doctor", "the kernel, and what doctor says about it; cyclictest beside", "doctor.sh", judge_doctor, VHCI, real={}),
    Scenario("mock", "the loop alone, 1 and 4 kHz beside hogs", "mock.sh", judge_mock, {"DEVICE": "mock"}, real={"DEVICE": "mock"}),
    Scenario("rate_1k", "a device by vhci_hcd, 1 kHz beside hogs", "run.sh", judge_run_of(age_us=250),
             {**VHCI, "RATE": 1000, "DURATION": 1}, real={"RATE": 1000, "DURATION": 20}),
    Scenario("rate_2k", "the same at 2 kHz", "run.sh", judge_run_of(age_us=250),
             {**VHCI, "RATE": 2000, "DURATION": 1}, real={"RATE": 2000, "DURATION": 20}),
    Scenario("inversion", "the same at 1 kHz with the USB threads left at ordinary priority, which must show", "run.sh",
             judge_run_of(wake_up_us=None, age_p99_at_least_us=800), {**VHCI, "RATE": 1000, "DURATION": 1, "THREADS": "ordinary"}),
    # Contacts at a rate of their own: the guest's one processor is the device's and its controller's too. Those of `mock` are at 4 kHz.
    Scenario("rate_4k", "a device by dummy_hcd and FunctionFS, 4 kHz beside hogs, contacts at 1 kHz", "run.sh", judge_run_of(age_us=400),
             {**FUNCTIONFS, "RATE": 4000, "DURATION": 1, "CONTACTS": 1000}, real={"RATE": 4000, "DURATION": 20}, since=(6, 12)),
    Scenario("falcon", "a Falcon: firmware, homing, 1 kHz beside hogs", "falcon.sh", judge_falcon, {**VHCI, "DEVICE": "falcon"}),
    Scenario("flash", "images by palpate flash and by dfu-util, beside the loop too", "flash.sh", judge_flash, VHCI, real={}, asked_for=True),
    Scenario("unplug", "the device goes in a run: detached, deauthorised, unconfigured, killed", "unplug.sh",
             judge_unplug("detached", "deauthorised", "unconfigured", "killed", unseen=["killed"]), VHCI),
    Scenario("unplug_functionfs", "the same by the gadget's pull-up", "unplug.sh", judge_unplug("disconnected"), FUNCTIONFS),
    Scenario("silent", "the device stays and says nothing", "silent.sh", judge_silent, VHCI),
    Scenario("host", "the host's program ends, is stopped, and killed", "host.sh", judge_host, VHCI, real={}),
    Scenario("udev", "an ordinary user, without and with the udev rule and the limits", "udev.sh", judge_udev, VHCI),
    Scenario("power_cuts", "power cuts in the middle of updates", "power_cut.sh", judge_power_cuts, cuts=10),
]
