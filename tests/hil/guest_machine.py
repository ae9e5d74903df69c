# SPDX-License-Identifier: Apache-2.0
"""The machine that QEMU shows to a guest. It is started once: what it is then is kept, and each scenario goes on from there."""

import json
import subprocess
import time

from processes import running

# One instruction is one nanosecond, and sleep takes no time: what else this machine does has no influence.
VIRTUAL_TIME = ("-icount", "shift=0,sleep=off")
START_LIMIT_S = 180


class GuestMachine:
    """@param name, folder  of what is kept  @param more  QEMU's options beside those that every guest has"""

    def __init__(self, kernel, initramfs, folder, name, more):
        self._options = ["-machine", "q35", "-accel", "tcg,thread=single,tb-size=256", "-cpu", "max", "-smp", "1", "-m", "512",
                         "-nographic", "-no-reboot", "-nodefaults", "-monitor", "none", *more, "-kernel", str(kernel), "-initrd", str(initramfs)]
        self._kept = folder / f"{name}.started"
        self._log = folder / f"{name}.start.log"
        self._serial = folder / f"{name}.start.serial"

    def _command(self, settings, *more):
        return ["qemu-system-x86_64", *self._options, *more, "-append", f"console=ttyS0 quiet panic=-1 {settings}"]

    def start(self):
        """Where it does not succeed each scenario starts anew. @return the reason, or None"""
        for old in (self._kept, self._serial):
            old.unlink(missing_ok=True)
        command = self._command("scenario=later", "-serial", f"file:{self._serial}", "-qmp", "stdio")
        with running(command, self._log, stdin=subprocess.PIPE) as process:
            give_up = time.monotonic() + START_LIMIT_S
            while not (self._serial.exists() and b"GUEST waits" in self._serial.read_bytes()):
                if time.monotonic() > give_up or process.poll() is not None:
                    return f"the guest did not start: {self._log}, {self._serial}"
                time.sleep(0.1)
            partial = self._kept.with_suffix(".partial")
            for order in ({"execute": "qmp_capabilities"}, {"execute": "migrate", "arguments": {"uri": f"exec:cat >'{partial}'"}}):
                process.stdin.write(json.dumps(order).encode() + b"\n")
            while b'"completed"' not in self._log.read_bytes():
                if time.monotonic() > give_up or process.poll() is not None:
                    return f"a started guest cannot be kept: {self._log}"
                process.stdin.write(b'{"execute": "query-migrate"}\n')
                process.stdin.flush()
                time.sleep(0.1)
        partial.rename(self._kept)
        return None

    def go_on(self, **settings):
        """What is to be run, and what it is to be told. @param settings  what the guest's scripts find as variables"""
        words = " ".join(f"{name}={value}" for name, value in settings.items())
        if not self._kept.exists():
            return {"command": self._command(words, "-serial", "stdio")}
        return {"command": self._command("scenario=later", "-serial", "stdio", "-incoming", f"exec:cat '{self._kept}'"), "told": f"\nRUN {words}\n"}

    def forget(self):
        self._kept.unlink(missing_ok=True)
