# SPDX-License-Identifier: Apache-2.0
"""`palpate report --mcap`, read back by a reader of its own."""

import json
import math
import os
import shutil
import struct
import subprocess
import tempfile
import unittest

from reader import Mcap

SCENE = """
[engine]
engine = "regions"
delta_m = 0.02
budget_us = 400.0
[force]
stiffness_N_per_m = 20.0
[[body]]
name = "ball"
image = "ball.palp"
role = "tool"
position = [0.0, 0.0, 2.0]
[[body]]
name = "table"
image = "ball.palp"
[[mock.path]]
t_s = 0.0
position = [0.0, 0.0, 2.0]
[[mock.path]]
t_s = 0.5
position = [0.0, 0.0, 1.8]
"""
HEADER, RECORD = struct.Struct("<8sIIIIQQd16x"), struct.Struct("<QQ3d4d3d3d3f3f4d7IBBHd")


class Report(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(os.path.join(os.environ["PALPATE_DATA"], "bumpy_ball_regions.bin"), self.path("ball.palp"))
        self.write("scene.toml", SCENE.encode())

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def palpate(self, *words):
        return subprocess.run([os.environ["PALPATE_EXECUTABLE"], *words], cwd=self.folder, capture_output=True, text=True)

    def trace(self, rows, scene="scene.toml"):
        """A trace as docs/REALTIME.md has it; rows of (time_ns, z, sent fz, state, faults)."""
        path = self.path(scene).encode()
        padded = path + bytes(-len(path) % 8)
        data = HEADER.pack(b"PALTRACE", 2, RECORD.size, HEADER.size + len(padded), len(path), len(rows), 0, 1000.0) + padded
        for tick, (time, z, force, state, faults) in enumerate(rows):
            pose = (0, 0, z, 1, 0, 0, 0)
            wrench = (0, 0, force, 0, 0, 0)
            certificate = (math.nan if force == 0 else -0.01, 1e-6, 0, 2e-3)
            counts = (1500, 200_000, 250_000, 3, 1, 40, 7)
            data += RECORD.pack(tick, time, *pose, *wrench, *wrench, *certificate, *counts, state, 1, faults, 0.5)
        self.write("run.trace", data)

    def mcap(self, *words):
        done = self.palpate("report", "run.trace", "--mcap", "run.mcap", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path("run.mcap"), "rb") as file:
            return Mcap(file.read()), done.stderr

    def messages(self, mcap, topic):
        return [(time, json.loads(data)) for name, _, time, data in mcap.messages if name == topic]


class Written(Report):
    rows = [(i * 1_000_000, 2.0 - i * 1e-4, i * 1e-3, 2, 0) for i in range(3000)]

    def test_every_tick_is_there_in_indexed_chunks(self):
        self.trace(self.rows)
        mcap, said = self.mcap()
        self.assertEqual(said, "")
        self.assertTrue(mcap.library.startswith("palpate "))
        self.assertGreater(len(mcap.chunks), 2)
        ticks = self.messages(mcap, "/tick")
        self.assertEqual([time for time, _ in ticks], [row[0] for row in self.rows])
        time, last = ticks[-1]
        self.assertAlmostEqual(last["sent_force_N"]["z"], 2.999, 5)
        self.assertAlmostEqual(last["sent_force_size_N"], 2.999, 5)
        self.assertEqual((last["tick_us"], last["latency_us"], last["contacts"]), (200, 1.5, 3))
        self.assertEqual((last["state"], last["cut_by_budget"], last["faults"]), ("rendering", True, 0))
        self.assertIsNone(ticks[0][1]["min_distance_m"])
        self.assertEqual([s for t, s, _, _ in mcap.messages if t == "/tick"], list(range(3000)))

    def test_poses_and_bodies_are_what_foxglove_shows(self):
        self.trace(self.rows)
        mcap, _ = self.mcap()
        schemas = {topic: mcap.schemas[schema][0] for schema, topic, _ in mcap.channels.values()}
        self.assertEqual(schemas["/tf"], "foxglove.FrameTransform")
        self.assertEqual(schemas["/scene"], "foxglove.SceneUpdate")
        for _, encoding, text in mcap.schemas.values():
            self.assertEqual((encoding, json.loads(text)["type"]), ("jsonschema", "object"))
        time, frame = self.messages(mcap, "/tf")[2500]
        self.assertEqual((frame["parent_frame_id"], frame["child_frame_id"]), ("world", "tool"))
        self.assertEqual(frame["timestamp"], {"sec": 2, "nsec": 500_000_000})
        self.assertAlmostEqual(frame["translation"]["z"], 1.75)
        self.assertEqual(frame["rotation"], {"x": 0, "y": 0, "z": 0, "w": 1})
        (_, bodies), *arrows = self.messages(mcap, "/scene")
        self.assertEqual([(e["id"], e["frame_id"]) for e in bodies["entities"]], [("ball", "tool"), ("table", "world")])
        for entity in bodies["entities"]:
            (mesh,) = entity["triangles"]
            self.assertGreater(len(mesh["indices"]), 300)
            self.assertEqual(len(mesh["indices"]) % 3, 0)
            self.assertLess(max(mesh["indices"]), len(mesh["points"]))
            radii = [math.hypot(*p.values()) for p in mesh["points"]]
            self.assertTrue(0.5 < min(radii) and max(radii) < 1.5)
        self.assertEqual(len(arrows), 150)  # 50 a second
        _, arrow = arrows[-1]
        (arrow,) = arrow["entities"][0]["arrows"]
        turn = arrow["pose"]["orientation"]  # +x becomes +z
        self.assertAlmostEqual(2 * (turn["x"] * turn["z"] - turn["w"] * turn["y"]), 1)
        self.assertGreater(arrow["shaft_length"], 0)

    def test_changes_of_state_and_faults_are_told(self):
        self.trace([(0, 2, 0, 1, 0), (1, 2, 0, 2, 0), (2, 2, 0, 2, 0), (3, 2, 0, 3, 0b101)])
        mcap, _ = self.mcap()
        log = [(time, entry["level"], entry["message"]) for time, entry in self.messages(mcap, "/log")]
        self.assertEqual(
            log, [(0, 2, "armed"), (1, 2, "rendering"), (3, 4, "fault: stale_state: missed_deadlines")]
        )

    def test_run_becomes_a_file(self):
        done = self.palpate("run", "scene.toml", "--seconds", "0.5", "-o", "run.trace", "--quiet")
        self.assertIn(done.returncode, (0, 5), done.stderr)
        mcap, _ = self.mcap()
        self.assertGreater(len(self.messages(mcap, "/tick")), 50)

    def test_reader_sees_what_is_wrong(self):
        self.trace(self.rows[:100])
        self.mcap()
        with open(self.path("run.mcap"), "rb") as file:
            whole = file.read()
        for place in range(0, len(whole), max(1, len(whole) // 300)):
            damaged = bytearray(whole)
            damaged[place] ^= 1
            with self.assertRaises(Exception, msg=f"byte {place}"):
                Mcap(bytes(damaged))


class Refused(Report):
    def test_without_its_scene_the_rest_is_written(self):
        self.trace([(0, 2, 1, 2, 0)], scene="none.toml")
        mcap, said = self.mcap()
        self.assertIn("no bodies in the MCAP file", said)
        self.assertEqual(len(self.messages(mcap, "/tick")), 1)
        done = self.palpate("report", "run.trace", "--mcap", "x.mcap", "--scene", "none.toml")
        self.assertEqual(done.returncode, 2)
        self.assertFalse(os.path.exists(self.path("x.mcap")))

    def test_what_cannot_be_written_is_refused(self):
        self.trace([(0, 2, 1, 2, 0)])
        for words, status, message in (
            (("run.trace",), 2, "give -o REPORT.html or --mcap FILE.mcap"),
            ((".", "--mcap", "run.mcap"), 2, "only the trace of a run becomes MCAP"),
            (("run.trace", "--mcap", "run.csv"), 2, "run.mcap"),
            (("scene.toml", "--mcap", "run.mcap"), 3, "not a trace"),
            (("none.trace", "--mcap", "run.mcap"), 3, "none.trace"),
            (("run.trace", "--mcap", "none/run.mcap"), 1, "none/run.mcap"),
        ):
            done = self.palpate("report", *words)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertIn(message, done.stderr)
            self.assertFalse(os.path.exists(self.path("run.mcap")))


if __name__ == "__main__":
    unittest.main()
