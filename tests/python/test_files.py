# SPDX-License-Identifier: Apache-2.0
"""Scenes, motions and traces from files, and the code of docs/PYTHON.md."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest

import numpy as np

import palpate

DATA = os.environ["PALPATE_DATA"]
SCENE = """
[engine]
engine = "regions"
delta_m = 0.02
budget_us = 400.0
[force]
stiffness_N_per_m = 20.0
max_force_N = 2.0
[run]
rate_Hz = 500.0
[[body]]
name = "ball"
image = "ball.palp"
role = "tool"
position = [0.0, 0.0, 2.05]
[[body]]
name = "table"
image = "ball.palp"
role = "moved"
[[mock.path]]
t_s = 0.0
position = [0.0, 0.0, 2.05]
[[mock.path]]
t_s = 0.2
position = [0.0, 0.0, 1.8]
"""
MOTION = """t,body,px,py,pz,qw,qx,qy,qz
0,ball,0,0,2.05,1,0,0,0
0.1,ball,0,0,1.9,1,0,0,0
0.1,table,0.01,0,0,1,0,0,0
0.2,ball,0,0,1.8,1,0,0,0
0.3,ball,0,0,2.05,1,0,0,0
"""


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        shutil.copy(os.path.join(DATA, "bumpy_ball_regions.bin"), self.path("ball.palp"))
        self.write("scene.toml", SCENE)
        self.write("motion.csv", MOTION)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as file:
            file.write(text)
        return self.path(name)

    def run_palpate(self, *words):
        return subprocess.run([os.environ["PALPATE_EXECUTABLE"], *words], cwd=self.folder, capture_output=True, text=True)


class Scenes(Files):
    def test_replay_of_a_motion_gives_what_the_command_gives(self):
        scene = palpate.load_scene(self.path("scene.toml"))
        times, poses = palpate.read_motion(self.path("motion.csv"), scene)
        np.testing.assert_array_equal(times, [0, 0.1, 0.2, 0.3])
        np.testing.assert_array_equal(poses[:, 1, 0], [0, 0.01, 0.01, 0.01])
        rows = scene.engine.ticks(poses, units=500)
        done = self.run_palpate(
            "replay", "scene.toml", "--poses", "motion.csv", "-o", "ticks.csv", "--budget-units", "500", "--quiet"
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        table = np.genfromtxt(self.path("ticks.csv"), delimiter=",", names=True)
        np.testing.assert_allclose(rows["force_N"][:, 2], table["fz"], rtol=1e-12)
        np.testing.assert_array_equal(rows["contacts"], table["contacts"])
        self.assertGreater(table["fz"].max(), 0.1)

    def test_scene_says_what_it_is(self):
        scene = palpate.load_scene(self.path("scene.toml"))
        self.assertEqual((scene.names, scene.budget_us, scene.engine.tool), (["ball", "table"], 400, 0))
        self.assertEqual(scene.engine.settings["max_force_N"], 2)
        self.assertEqual(scene.engine.settings["max_torque_Nm"], 0.1)
        np.testing.assert_array_equal(scene.poses[0], [0, 0, 2.05, 1, 0, 0, 0])

    def test_pairs_are_taken_from_the_scene(self):
        self.write("scene.toml", SCENE + '[[pair]]\na = "table"\nb = "ball"\n')
        self.assertEqual(palpate.load_scene(self.path("scene.toml")).engine.pairs, [(1, 0)])
        self.write("scene.toml", SCENE + '[[pair]]\na = "table"\nb = "chair"\n')
        with self.assertRaisesRegex(palpate.Error, r"\[\[pair\]\]"):
            palpate.load_scene(self.path("scene.toml"))

    def test_what_is_no_scene_is_refused(self):
        with self.assertRaises(FileNotFoundError):
            palpate.load_scene(self.path("none.toml"))
        for text, message in (("a = ", "not TOML"), ("", "no scene"), (SCENE.replace('"tool"', '"fixed"'), "no scene")):
            with self.assertRaisesRegex(palpate.Error, message):
                palpate.load_scene(self.write("bad.toml", text))

    def test_motion_of_a_fixed_body_is_refused(self):
        self.write("scene.toml", SCENE.replace('"moved"', '"fixed"'))
        with self.assertRaisesRegex(palpate.Error, "'table' is fixed: .*role = \"moved\""):
            palpate.read_motion(self.path("motion.csv"), palpate.load_scene(self.path("scene.toml")))

    def test_motion_of_another_scene_is_refused(self):
        scene = palpate.load_scene(self.path("scene.toml"))
        for text, message in (
            (MOTION.replace("table", "chair"), "chair"),
            (MOTION.replace("qz", "q"), "qz"),
            (MOTION + "0.1,ball,0,0,2,1,0,0,0\n", "backwards"),
            (MOTION.replace("1.9,1,", "wide,1,"), "wide"),
        ):
            with self.assertRaisesRegex(palpate.Error, message):
                palpate.read_motion(self.write("bad.csv", text), scene)


class Traces(Files):
    def trace(self):
        done = self.run_palpate("run", "scene.toml", "--seconds", "0.4", "-o", "run.trace", "--quiet")
        self.assertIn(done.returncode, (0, 5), done.stderr)  # 5: this machine is busy
        return self.path("run.trace")

    def test_tells_the_run(self):
        trace = palpate.read_trace(self.trace())
        self.assertEqual((trace.rate_Hz, trace.dropped), (500, 0))
        self.assertTrue(os.path.samefile(trace.scene, self.path("scene.toml")))
        self.assertIsInstance(trace.records, np.memmap)
        self.assertGreater(len(trace.records), 10)
        time_s = trace.time_s
        self.assertTrue((np.diff(time_s) > 0).all() and time_s[-1] < 0.41)
        lengths = np.linalg.norm(trace.records["orientation"], axis=1)
        np.testing.assert_allclose(lengths, 1, atol=1e-3)
        self.assertLess(trace.records["position_m"][:, 2].min(), 2.05)
        self.assertTrue((np.linalg.norm(trace.records["sent_force_N"], axis=1) <= 2.001).all())

    def test_what_is_no_trace_is_refused(self):
        with open(self.trace(), "rb") as file:
            whole = file.read()
        for name, text, message in (
            ("short", whole[:-1], "cut short"),
            ("long", whole + b"1", "cut short"),
            ("head", whole[:40], "not a trace"),
            ("other", b"NOTTRACE" + whole[8:], "not a trace"),
            ("version", whole[:8] + b"\1" + whole[9:], "another version"),
        ):
            with open(self.path(name), "wb") as file:
                file.write(text)
            with self.assertRaisesRegex(palpate.Error, message):
                palpate.read_trace(self.path(name))


class Documentation(Files):
    def test_code_of_the_page_runs(self):
        with open(os.path.join(os.environ["PALPATE_DOCS"], "PYTHON.md")) as file:
            blocks = re.findall(r"```python\n(.*?)```", file.read(), re.S)
        self.assertGreater(len(blocks), 1)
        done = self.run_palpate("run", "scene.toml", "--seconds", "0.2", "-o", "run.trace", "--quiet")
        self.assertIn(done.returncode, (0, 5), done.stderr)
        before = os.getcwd()
        self.addCleanup(os.chdir, before)
        os.chdir(self.folder)
        names = {}
        for block in blocks:
            exec(compile(block, "PYTHON.md", "exec"), names)  # noqa: S102

    def test_everything_public_is_documented(self):
        for name in palpate.__all__:
            public = getattr(palpate, name)
            self.assertTrue(public.__doc__, name)
            for member, value in vars(public).items():
                if not member.startswith("_") and isinstance(public, type) and public is not palpate.Error:
                    documented = getattr(value, "__doc__", None) or member in public.__doc__
                    self.assertTrue(documented, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
