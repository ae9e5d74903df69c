# SPDX-License-Identifier: Apache-2.0
"""palpate.Image and palpate.Engine: what they give, and what they refuse."""

import math
import os
import threading
import unittest

import numpy as np

import palpate

BALL = os.path.join(os.environ["PALPATE_DATA"], "bumpy_ball_regions.bin")
SETTINGS = {"engine": "regions", "delta_m": 0.05, "stiffness_N_per_m": 200.0}


def motion(ticks):
    """(ticks, 2, 7): the first ball comes down on the other, turning, and goes up again."""
    poses = np.zeros((ticks, 2, 7))
    turn = np.linspace(0, 0.4, ticks)
    poses[:, 0, 0] = 0.1
    poses[:, 0, 2] = 2.1 - 0.25 * np.sin(np.linspace(0, math.pi, ticks))
    poses[:, 0, 3], poses[:, 0, 5] = np.cos(turn), np.sin(turn)
    poses[:, 1, 3] = 1
    return poses


def engine(**settings):
    image = palpate.Image(BALL)
    return palpate.Engine([image, image], **(SETTINGS | settings))


class Images(unittest.TestCase):
    def test_file_is_mapped_and_outlives_its_name(self):
        image = palpate.Image(BALL)
        self.assertEqual(image.nbytes, os.path.getsize(BALL))
        self.assertEqual(image.name, BALL)

    def test_bytes_give_what_the_file_gives(self):
        with open(BALL, "rb") as file:
            image = palpate.Image.from_bytes(file.read())
        other = palpate.Engine([image, image], **SETTINGS)
        poses = motion(5)
        self.assertEqual(other.ticks(poses, units=200).tobytes(), engine().ticks(poses, units=200).tobytes())

    def test_aligned_bytes_are_used_in_place(self):
        size = os.path.getsize(BALL)
        room = np.empty(size + 64, np.uint8)
        start = -room.ctypes.data % 64
        aligned = room[start : start + size]
        aligned[:] = np.fromfile(BALL, np.uint8)
        image = palpate.Image.from_bytes(aligned)
        two = palpate.Engine([image, image], **SETTINGS)
        before = two.tick(motion(3)[1]).force_N.copy()
        del room, aligned  # the image keeps them
        np.testing.assert_allclose(two.tick(motion(3)[1]).force_N, before, atol=1e-9)

    def test_what_is_no_image_is_refused(self):
        with self.assertRaisesRegex(FileNotFoundError, "none.palp"):
            palpate.Image("/tmp/none.palp")
        with self.assertRaisesRegex(palpate.Error, "python/.*: image refused, not a Palpate image"):
            palpate.Image(__file__)
        with self.assertRaisesRegex(palpate.Error, "not a file"):
            palpate.Image("/tmp")
        with self.assertRaisesRegex(palpate.Error, "smaller than an image header"):
            palpate.Image.from_bytes(b"")
        damaged = bytearray(open_bytes(BALL))
        damaged[-1] ^= 1
        with self.assertRaisesRegex(palpate.Error, "damaged"):
            palpate.Image.from_bytes(damaged)
        with self.assertRaises(TypeError):
            palpate.Image(3)


def open_bytes(path):
    with open(path, "rb") as file:
        return file.read()


class Ticks(unittest.TestCase):
    def test_force_is_that_of_its_contacts(self):
        two = engine()
        for poses in motion(9):
            result = two.tick(poses)
            contacts = two.contacts()
            self.assertEqual(len(contacts), result.contacts)
            push = contacts["weight"] * 200.0 * (0.05 - contacts["distance_m"])
            np.testing.assert_allclose(push @ contacts["normal"], result.force_N, atol=1e-9)
            if len(contacts):
                self.assertEqual(contacts["distance_m"].min(), result.min_distance_m)
                self.assertGreater(result.force_N[2], 0)

    def test_certificate_says_what_is_known(self):
        two = engine(exact=True)
        far, near = motion(3)[0] + [0, 0, 1, 0, 0, 0, 0] * np.array([[1], [0]]), motion(3)[1]
        result = two.tick(far)
        self.assertEqual((result.contact, result.contacts), ("ruled_out", 0))
        self.assertTrue(math.isnan(result.min_distance_m))
        self.assertEqual(result.force_bound_N, 0)
        result = two.tick(near)
        self.assertEqual(result.contact, "found")
        self.assertFalse(result.truncated)
        result = engine().tick(near, units=1)
        self.assertTrue(result.truncated and result.truncated_by_units)
        self.assertGreater(result.force_bound_N, 0)
        result = engine().tick(near, units=1, reserve_units=10**9)
        self.assertEqual((result.contact, result.on_reserve), ("found", True))

    def test_budget_of_time_ends_refinement(self):
        result = engine().tick(motion(3)[1], budget_us=0)
        self.assertTrue(result.truncated_by_time)

    def test_motion_at_once_gives_the_bits_of_single_ticks(self):
        poses = motion(20)
        rows = engine().ticks(poses, units=300)
        one = engine()
        for row, pose in zip(rows, poses):
            result = one.tick(pose, units=300)
            np.testing.assert_array_equal(row["force_N"], result.force_N)
            np.testing.assert_array_equal(row["torque_Nm"], result.torque_Nm)
            self.assertEqual(row["contacts"], result.contacts)
            self.assertEqual(row["units_used"], result.units_used)
        self.assertEqual(rows["force_N"].shape, (20, 3))

    def test_prediction_starts_from_the_tick_and_falls_with_the_stiffness(self):
        two = engine()
        pose = motion(3)[1]
        result = two.tick(pose)
        force, torque = two.predict(pose[0])
        np.testing.assert_allclose(force, result.force_N)
        np.testing.assert_allclose(torque, result.torque_Nm)
        up = pose[0] + [0, 0, 1e-4, 0, 0, 0, 0]
        self.assertLess(two.predict(up)[0][2], force[2])

    def test_vectors_are_views_that_keep_their_result(self):
        result = engine().tick(motion(3)[1])
        force = result.force_N
        self.assertTrue(np.shares_memory(force, result.force_N))
        expected = force.copy()
        del result
        np.testing.assert_array_equal(force, expected)
        with self.assertRaises(ValueError):
            force[0] = 1

    def test_arrays_of_other_kinds_are_taken(self):
        poses = motion(3)[1]
        expected = engine().tick(poses, units=100).force_N
        np.testing.assert_array_equal(engine().tick(poses.tolist(), units=100).force_N, expected)
        np.testing.assert_array_equal(engine().tick(np.asfortranarray(poses), units=100).force_N, expected)

    def test_threads_take_turns(self):
        two, poses, found = engine(), motion(100), []
        threads = [threading.Thread(target=lambda: found.append(two.ticks(poses, units=50))) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([len(rows) for rows in found], [100] * 4)


class Settings(unittest.TestCase):
    def test_are_those_of_the_c_interface(self):
        image = palpate.Image(BALL)
        settings = palpate.Engine([image, image]).settings
        self.assertEqual(settings["engine"], "levels")
        self.assertEqual(settings["max_force_N"], math.inf)
        two = engine(exact=True, order="deviation")
        self.assertEqual(two.settings["delta_m"], 0.05)
        two.configure(stiffness_N_per_m=400)
        self.assertEqual((two.settings["stiffness_N_per_m"], two.settings["exact"]), (400, True))
        self.assertEqual((two.bodies, two.tool, two.pairs), (2, 0, [(0, 1)]))
        self.assertGreater(two.memory_bytes, 1000)

    def test_stiffness_doubled_doubles_the_force(self):
        poses = motion(3)[1]
        two = engine()
        force = two.tick(poses).force_N
        two.configure(stiffness_N_per_m=400)
        np.testing.assert_allclose(two.tick(poses).force_N, 2 * force, rtol=1e-9)

    def test_out_of_range_is_refused_and_changes_nothing(self):
        two = engine()
        for wrong, message in (
            ({"delta_m": -1}, "settings: .*config/README.md"),
            ({"engine": "levels"}, "engine: fixed"),
            ({"engine": "both"}, "give 'levels' or 'regions'"),
        ):
            with self.assertRaisesRegex(palpate.Error, message):
                two.configure(**wrong)
        with self.assertRaisesRegex(TypeError, "no such setting as 'delta': there are engine"):
            two.configure(delta=1)
        self.assertEqual(two.settings["delta_m"], 0.05)

    def test_scene_out_of_range_is_refused(self):
        image = palpate.Image(BALL)
        for images, more in (
            ([], {}),
            ([image], {}),
            ([image, image], {"tool": 2, "pairs": [(0, 1)]}),
            ([image, image], {"pairs": [(0, 2)]}),
            ([image, image], {"pairs": [(1, 1)]}),
            ([image, image], {"limits": {"nodes": 0}}),
            ([image, None], {}),
        ):
            with self.assertRaises(palpate.Error, msg=more):
                palpate.Engine(images, **more)
        with self.assertRaisesRegex(TypeError, "no such limit"):
            palpate.Engine([image, image], limits={"memory": 1})

    def test_bad_poses_are_named(self):
        two, poses = engine(), motion(4)
        with self.assertRaisesRegex(palpate.Error, r"poses: shape \(1, 7\): give \(2, 7\)"):
            two.tick(poses[0, :1])
        with self.assertRaisesRegex(palpate.Error, r"give \(ticks, 2, 7\)"):
            two.ticks(poses[0])
        poses[2, 1, 3] = 2
        with self.assertRaisesRegex(palpate.Error, r"poses\[2\]\[1\]: a quaternion of length 2"):
            two.ticks(poses)
        poses[2, 1, 0] = math.nan
        with self.assertRaisesRegex(palpate.Error, r"poses\[1\]: not finite"):
            two.tick(poses[2])
        with self.assertRaisesRegex(palpate.Error, "budget_us"):
            two.tick(poses[0], budget_us=math.nan)
        with self.assertRaisesRegex(palpate.Error, "tool: give one pose"):
            two.predict([1, 2, 3])
        self.assertEqual(two.tick(poses[1]).contact, "found")


if __name__ == "__main__":
    unittest.main()
