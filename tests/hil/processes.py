# SPDX-License-Identifier: Apache-2.0
"""Processes that do not outlive who started them, nor do theirs."""

import os
import signal
import subprocess
from contextlib import contextmanager

_running = set()


def _kill(process):
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def kill_all_when_stopped():
    def stop(number, _):
        for process in list(_running):
            _kill(process)
        os._exit(128 + number)

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, stop)


@contextmanager
def running(command, log, told=None, stdin=subprocess.DEVNULL, **options):
    """What it says is in the log. It is killed, with all that it has started, at the end of the block. @param told  what it reads first"""
    with open(log, "wb") as out:
        stdin = stdin if told is None else subprocess.PIPE
        process = subprocess.Popen(command, stdin=stdin, stdout=out, stderr=subprocess.STDOUT, start_new_session=True, **options)
        _running.add(process)
        try:
            if told is not None:
                process.stdin.write(told.encode())
                process.stdin.flush()
            yield process
        finally:
            _kill(process)
            process.wait()
            _running.discard(process)


def wait_for_end(process, limit_s):
    """False where it took too long."""
    try:
        process.wait(limit_s)
    except subprocess.TimeoutExpired:
        return False
    return True
