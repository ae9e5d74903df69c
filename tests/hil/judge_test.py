# SPDX-License-Identifier: Apache-2.0
"""A figure beyond its bound fails a scenario, and so does one that is missing."""

import json
import unittest

from judge import Log, Verdict
from power_cuts import judge_power_cuts
from scenarios import SCENARIOS, judge_run

RUN = {
    "ticks": 1000, "rate_hz": 1000.0, "missed": 0, "state": "rendering", "faults": [], "scheduler": "SCHED_FIFO 80", "allocations": 0,
    "page_faults": 0, "latency_ns": {"max": 5000}, "state_age_ns": {"p99": 140000, "max": 150000},
}


def verdict_of(run, **bounds):
    verdict = Verdict()
    judge_run(Log(f"JSON run 0 {json.dumps(run)}\r\n"), verdict, False, **bounds)
    return verdict


class Judge(unittest.TestCase):
    def test_run_within_its_bounds_is_ok(self):
        verdict = verdict_of(RUN, age_us=250)
        self.assertEqual(verdict.failures, [])
        self.assertEqual(verdict.tap(3, "x"), "ok 3 - x: 1000 ticks at 1000 Hz, missed 0, wake-up max 5 us, age max 150 us")

    def test_each_broken_promise_is_not_ok(self):
        for broken in ({"missed": 1}, {"state": "fault"}, {"allocations": 2}, {"page_faults": 1}, {"latency_ns": {"max": 26000}},
                       {"state_age_ns": {"max": 251000}}, {"scheduler": "SCHED_OTHER"}, {"faults": ["stale_state"]}):
            with self.subTest(broken):
                verdict = verdict_of({**RUN, **broken}, age_us=250)
                self.assertEqual(len(verdict.failures), 1)
                self.assertTrue(verdict.tap(1, "x").startswith("not ok 1 - x: "))

    def test_negative_case_fails_where_nothing_is_late(self):
        self.assertEqual(len(verdict_of(RUN, wake_up_us=None, age_p99_at_least_us=800).failures), 1)

    def test_silence_fails_every_scenario(self):
        for scenario in SCENARIOS:
            if not scenario.cuts:
                with self.subTest(scenario.name):
                    verdict = Verdict()
                    scenario.judge(Log(""), verdict, False)
                    self.assertNotEqual(verdict.failures, [])

    def test_slot_with_something_else_fails_the_power_cuts(self):
        verdict = Verdict()
        judge_power_cuts(["FACT slot_0 none\nFACT slot_1 none\nFACT looked yes\n", "FACT slot_0 abc\nFACT slot_1 none\nFACT looked yes\n", ""], verdict, IMAGES)
        self.assertIn("start 1: a slot holds what was never written: ['something else', None]", verdict.failures)
        self.assertIn("start 2 did not come so far as to read its slots", verdict.failures)


class Images:
    """Stands for the folder of images."""

    def __truediv__(self, name):
        return self

    def read_bytes(self):
        return b""


IMAGES = Images()

if __name__ == "__main__":
    unittest.main()
