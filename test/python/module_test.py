"""What a user of `import pcl_fft_ground` relies on. Run by CTest with the module on PYTHONPATH."""

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

import pcl_fft_ground

BOX = (2.3, 2.7, 1.3, 1.7)  # x and y of its sides [m]


def sea_floor(spacing=0.02):
    """4 m x 4 m of undulating ground with a box of 0.2 m height on it. Returns points and what is box."""
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.arange(0, 4, spacing)] * 2, indexing="ij"))
    on_box = (x > BOX[0]) & (x < BOX[1]) & (y > BOX[2]) & (y < BOX[3])
    z = 0.1 * np.sin(x) + 0.2 * on_box + np.random.default_rng(1).normal(0, 0.002, x.size)
    return np.stack([x, y, z], axis=1), on_box


def labels_of_command(folder):
    """Fields label and segment of labelled.pcd."""
    with open(os.path.join(folder, "labelled.pcd"), "rb") as file:
        header = {}
        while "DATA" not in header:
            key, *values = file.readline().decode().split()
            header[key] = values
        kinds = {"F": "f", "I": "i", "U": "u"}
        names = [f"{n}:{name}" for n, name in enumerate(header["FIELDS"])]
        formats = [kinds[t] + s for t, s in zip(header["TYPE"], header["SIZE"])]
        table = np.frombuffer(file.read(), dtype={"names": names, "formats": formats})
        column = {name.split(":")[1]: name for name in names}
        return table[column["label"]], table[column["segment"]]


class Segment(unittest.TestCase):
    def test_finds_the_box_and_nothing_else(self):
        xyz, on_box = sea_floor()
        result = pcl_fft_ground.segment(xyz, 1.0)
        self.assertEqual(result.labels.dtype, np.int32)
        self.assertGreater(np.mean(result.labels == on_box), 0.999)
        self.assertEqual(result.segments.max(), 1)
        self.assertTrue(np.all((result.segments > 0) <= (result.labels == 1)))
        np.testing.assert_allclose(np.median(result.height[on_box]), 0.2, atol=0.01)
        self.assertTrue(np.all(result.p_ground[on_box & (result.height > 0.1)] == 0))
        self.assertGreater(np.mean(result.p_ground[~on_box]), 0.99)
        self.assertEqual(result.report["ground"], np.count_nonzero(result.labels == 0))
        self.assertEqual(result.report["objects"], np.count_nonzero(result.labels == 1))
        self.assertIn("cell_size", result.report["chosen"])

    def test_surface_tells_the_height_in_the_coordinates_given(self):
        xyz, on_box = sea_floor()
        far = xyz + [500000.0, 4100000.0, -30.0]
        result = pcl_fft_ground.segment(far, 1.0)
        surface = result.surface
        level = far @ surface.frame_from_input[:3, :3].T + surface.frame_from_input[:3, 3]
        cells = np.floor((level[:, :2] - surface.lower_corner) / surface.cell_size).astype(int)
        i, j = np.clip(cells, 0, np.array(surface.height.shape) - 1).T
        ground = ~on_box
        np.testing.assert_allclose(level[ground, 2] - surface.height[i, j][ground], 0, atol=0.03)
        np.testing.assert_array_equal(result.labels, pcl_fft_ground.segment(xyz, 1.0).labels)
        self.assertEqual(surface.supported.shape, surface.height.shape)
        self.assertEqual(surface.uncertainty.shape, surface.height.shape)

    def test_strides_and_types_make_no_difference(self):
        xyz, _ = sea_floor()
        single = xyz.astype(np.float32)
        expected = pcl_fft_ground.segment(single, 1.0).labels
        wide = np.zeros((len(xyz), 5), dtype=np.float32)
        wide[:, 1:4] = single
        for view in (single.astype(np.float64), np.asfortranarray(single), wide[:, 1:4], single[::-1][::-1]):
            np.testing.assert_array_equal(pcl_fft_ground.segment(view, 1.0).labels, expected)

    def test_points_that_are_not_finite_are_neither(self):
        xyz, _ = sea_floor()
        xyz[10] = np.nan
        xyz[20, 2] = np.inf
        result = pcl_fft_ground.segment(xyz, 1.0)
        np.testing.assert_array_equal(np.flatnonzero(result.labels == 2), [10, 20])
        np.testing.assert_array_equal(np.flatnonzero(np.isnan(result.height)), [10, 20])
        np.testing.assert_array_equal(np.flatnonzero(np.isnan(result.p_ground)), [10, 20])
        self.assertEqual(result.report["neither"], 2)

    def test_objects_without_a_segment_are_warned_of(self):
        xyz, _ = sea_floor()
        report = pcl_fft_ground.segment(xyz, 1.0, leaf_size=1e-4).report
        self.assertEqual(report["segments"], 0)
        self.assertIn("leaf_size", report["warnings"][-1])
        self.assertEqual(pcl_fft_ground.segment(xyz, 1.0).report["warnings"], [])

    def test_no_points_give_no_labels(self):
        self.assertEqual(pcl_fft_ground.segment(np.zeros((0, 3)), 1.0).labels.shape, (0,))

    def test_every_method_runs(self):
        xyz, _ = sea_floor(0.04)
        for method in ("naive", "planar", "grid", "graph-cut", "fft-lowpass", "fft"):
            with self.subTest(method=method):
                result = pcl_fft_ground.segment(xyz, method=method)
                labels = result.labels
                self.assertEqual(result.p_ground.size, labels.size if method == "fft" else 0)
                self.assertTrue(set(np.unique(labels)) <= {0, 1})

    def test_wrong_values_name_the_parameter(self):
        xyz, _ = sea_floor(0.1)
        for options, named in (
            ({"max_object_size": -1.0}, "max_object_size = -1.0: must be a finite number of metres above 0"),
            ({"filter_order": 0}, "filter_order = 0: must be in"),
            ({"up_estimation": "sideways"}, "up_estimation = 'sideways', allowed is one of auto"),
            ({"up_direction": (0, 0)}, "up_direction"),
            ({"cell_size": "large"}, "cell_size = 'large': not of the right type"),
            ({"method": "magic"}, "method 'magic': allowed is one of"),
            ({"voxel_height": 0.1}, "voxel_height: the method 'fft' has no such option"),
            ({"leaf_size": 0.0}, "leaf_size"),
            ({"clusters": "heaps"}, "clusters = 'heaps': must be"),
            ({"threads": -1}, "threads = -1: not of the right type"),
        ):
            with self.subTest(options=options), self.assertRaisesRegex(ValueError, named):
                pcl_fft_ground.segment(xyz, **options)
        for wrong in (xyz[:, :2], xyz[0], xyz.astype(int), np.zeros((2, 3), dtype=complex)):
            with self.assertRaisesRegex(ValueError, "xyz"):
                pcl_fft_ground.segment(wrong)
        with self.assertRaisesRegex(TypeError, "max_objct_size"):
            pcl_fft_ground.segment(xyz, max_objct_size=1.0)

    def test_threads_do_not_disturb_each_other(self):
        xyz, _ = sea_floor(0.04)
        expected = pcl_fft_ground.segment(xyz, 1.0).labels
        results = [None] * 4

        def work(n):
            results[n] = pcl_fft_ground.segment(xyz, 1.0).labels

        one, two = (pcl_fft_ground.segment(xyz, 1.0, threads=n).labels for n in (1, 2))
        np.testing.assert_array_equal(one, expected)
        np.testing.assert_array_equal(two, expected)
        threads = [threading.Thread(target=work, args=(n,)) for n in range(len(results))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for labels in results:
            np.testing.assert_array_equal(labels, expected)

    def test_other_threads_run_on_meanwhile(self):
        xyz, _ = sea_floor()
        ticks, stop = [], threading.Event()

        def tick():
            while not stop.wait(0.001):
                ticks.append(None)

        interval = sys.getswitchinterval()
        ticker = threading.Thread(target=tick)
        ticker.start()
        try:
            sys.setswitchinterval(1000)  # the interpreter's lock changes hands only where it is given up
            before = len(ticks)
            pcl_fft_ground.segment(xyz, 1.0)
            during = len(ticks) - before
        finally:
            sys.setswitchinterval(interval)
            stop.set()
            ticker.join()
        self.assertGreater(during, 0)

    @unittest.skipUnless(os.environ.get("PCL_FFT_GROUND_COMMAND"), "the command was not built")
    def test_labels_and_segments_are_those_of_the_command(self):
        xyz, _ = sea_floor()
        xyz += [500000.0, 4100000.0, 0.0]
        with tempfile.TemporaryDirectory() as folder:
            cloud = os.path.join(folder, "scan.xyz")
            np.savetxt(cloud, xyz, fmt="%.17g")
            for options in ({}, {"method": "fft-lowpass", "height_tolerance": 0.02}, {"max_slope": 0.5},
                            {"clusters": "contact"}):
                words = [w for k, v in options.items() for w in ("--" + k.replace("_", "-"), *np.ravel(v).astype(str))]
                out = os.path.join(folder, "out")
                subprocess.run(
                    [os.environ["PCL_FFT_GROUND_COMMAND"], "segment", cloud, "-o", out, "--quiet",
                     "--max-object-size", "1", *words], check=True)
                result = pcl_fft_ground.segment(xyz, 1.0, **options)
                labels, segments = labels_of_command(out)
                np.testing.assert_array_equal(result.labels, labels)
                np.testing.assert_array_equal(result.segments, segments)


def stones(seed):
    """Where stones of 0.2 to 0.5 m lie on a site of 6 m x 5 m, told as (x, y, half sides, height)."""
    random = np.random.default_rng(seed)
    cells = [(0.6 + 1.2 * i, 0.6 + 1.2 * j) for i in range(5) for j in range(4)]
    return [(x + random.uniform(-0.3, 0.3), y + random.uniform(-0.3, 0.3), *random.uniform(0.1, 0.25, 2),
             random.uniform(0.15, 0.4)) for x, y in cells]


def side_of(stone, random, spacing):
    """Points on the sides of a stone that stands on level ground."""
    x, y, half_x, half_y, height = stone
    count = int(8 * (half_x + half_y) * height / spacing ** 2)
    along, across = random.uniform(-1, 1, count), random.choice([-1.0, 1.0], count)
    is_x = random.random(count) < half_x / (half_x + half_y)
    return np.stack([x + half_x * np.where(is_x, along, across), y + half_y * np.where(is_x, across, along),
                     random.uniform(0, height, count)], axis=1)


def scan_of(site, low, high, seed, spacing=0.02):
    """A scan of the site between two x, in its own places; the coordinates are those of the site.

    Without the sides of the stones little would tell where they lie horizontally.
    """
    random = np.random.default_rng(seed)
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(low, high, spacing), np.arange(0, 5, spacing)))
    x, y = x + random.uniform(0, spacing, x.size), y + random.uniform(0, spacing, x.size)
    z = np.zeros_like(x)
    for sx, sy, half_x, half_y, height in site:
        z[(abs(x - sx) < half_x) & (abs(y - sy) < half_y)] += height
    xyz = np.concatenate([np.stack([x, y, z], axis=1), *(side_of(stone, random, spacing) for stone in site)])
    xyz[:, 2] += 0.05 * np.sin(2 * xyz[:, 0]) + random.normal(0, 0.002, len(xyz))
    return xyz[(xyz[:, 0] >= low) & (xyz[:, 0] < high)]


def motion(yaw, shift):
    c, s = np.cos(np.radians(yaw)), np.sin(np.radians(yaw))
    result = np.eye(4)
    result[:2, :2] = [[c, -s], [s, c]]
    result[:3, 3] = shift
    return result


def moved(transform, xyz):
    return xyz @ transform[:3, :3].T + transform[:3, 3]


@unittest.skipUnless(hasattr(pcl_fft_ground, "align"), "built without the component registration")
class Align(unittest.TestCase):
    def setUp(self):
        site = stones(1)
        self.reference = scan_of(site, 0, 4.2, 2)
        self.truth = motion(3, (0.2, -0.1, 0.02))  # reference_from_moving
        self.moving = moved(np.linalg.inv(self.truth), scan_of(site, 1.4, 6, 3))

    def assert_right(self, found, truth, moving):
        self.assertTrue(found.accepted, found.refusal)
        error = moved(found.reference_from_moving, moving) - moved(truth, moving)
        self.assertLess(np.abs(error).max(), 0.02)

    def test_finds_the_motion_between_two_scans(self):
        found = pcl_fft_ground.align(self.reference, self.moving, max_object_size=1.0)
        self.assert_right(found, self.truth, self.moving)
        self.assertEqual(found.refusal, "")
        self.assertGreater(found.score, 0.8)
        self.assertEqual(found.covariance.shape, (6, 6))
        self.assertTrue(np.all(np.linalg.eigvalsh(found.covariance) > 0))
        self.assertEqual(found.method, "segments")

    def test_takes_strided_float32_with_nan_and_a_guess(self):
        away = motion(0, (40.0, -7.0, 1.0))
        guess = (motion(2, (0.15, -0.1, 0.0)) @ np.linalg.inv(away)).tolist()
        wide = np.full((2 * len(self.moving), 6), np.nan, dtype=np.float32)
        wide[::2, :3] = moved(away, self.moving)
        found = pcl_fft_ground.align(self.reference.astype(np.float32), wide[:, :3], guess, 1.0)
        self.assert_right(found, self.truth @ np.linalg.inv(away), moved(away, self.moving))

    def test_large_coordinates_keep_their_precision(self):
        there, elsewhere = motion(0, (500000.0, 6000000.0, 0.0)), motion(0, (300000.0, 5000000.0, -20.0))
        found = pcl_fft_ground.align(moved(there, self.reference), moved(elsewhere, self.moving),
                                     there @ np.linalg.inv(elsewhere), 1.0)
        truth = there @ self.truth @ np.linalg.inv(elsewhere)
        self.assert_right(found, truth, moved(elsewhere, self.moving))
        self.assertGreater(found.origin[0], 499000)

    def test_a_refusal_is_a_result(self):
        guess = motion(1, (0.1, 0.0, 0.0))
        other_site = scan_of(stones(7), 1.4, 6, 3)
        found = pcl_fft_ground.align(self.reference, other_site, guess, 1.0)
        self.assertFalse(found.accepted)
        self.assertNotEqual(found.refusal, "")
        np.testing.assert_allclose(found.reference_from_moving, guess, atol=1e-9)

    def test_errors_name_the_parameter(self):
        small = self.reference[:100]
        for words, name in [
            (dict(guess=np.eye(3)), "guess"), (dict(guess=2 * np.eye(4)), "guess"), (dict(guess="no"), "guess"),
            (dict(guess=np.full((4, 4), np.nan)), "guess"), (dict(search="far"), "search"),
            (dict(fallback="any"), "fallback"), (dict(relief="on"), "relief"), (dict(max_sigma=0.0), "sigma"),
            (dict(min_score=2.0), "score"), (dict(min_matches=0), "match"), (dict(max_shift=-1.0), "shift"),
            (dict(max_turn=500.0), "turn"), (dict(max_object_size=-1.0), "max_object_size"),
            (dict(sensor=(0.0, np.nan, 1.0)), "sensor"),
            (dict(moving=small[:, :2]), "moving"), (dict(reference=small.astype(int)), "reference"),
        ]:
            arguments = dict(reference=small, moving=small)
            arguments.update(words)
            with self.subTest(words=list(words)), self.assertRaisesRegex(ValueError, name):
                pcl_fft_ground.align(**arguments)
        with self.assertRaisesRegex(TypeError, "sigma_max"):
            pcl_fft_ground.align(small, small, sigma_max=1)

    def test_no_point_is_an_error_naming_the_scan(self):
        with self.assertRaisesRegex(RuntimeError, "moving|reference"):
            pcl_fft_ground.align(np.full((10, 3), np.nan), self.moving)

    @unittest.skipUnless(os.environ.get("PCL_FFT_GROUND_COMMAND"), "the command was not built")
    def test_verdict_and_pose_are_those_of_the_command(self):
        other_site = scan_of(stones(7), 1.4, 6, 3)
        with tempfile.TemporaryDirectory() as folder:
            for moving, options in ((self.moving, {}), (self.moving, {"max_shift": 0.05}),
                                    (self.moving, {"matching": "plain", "search": "wide", "voxel_size": 0.03}),
                                    (self.moving, {"min_matches": 1000, "relief": "off"}),
                                    (self.moving, {"min_matches": 1000, "sensor": (0.0, 0.5, 4.0)}),
                                    (self.moving, {"sensor": ((0.0, 0.5, 4.0), (1.0, 0.0, -5.0))}),
                                    (other_site, {"fallback": "none"}), (other_site, {})):
                files = [os.path.join(folder, name) for name in ("reference.xyz", "moving.xyz")]
                for file, xyz in zip(files, (self.reference, moving)):
                    np.savetxt(file, xyz, fmt="%.17g")
                words = [w for k, v in options.items() for w in ("--" + k.replace("_", "-"), *np.ravel(v).astype(str))]
                out = os.path.join(folder, "out")
                subprocess.run([os.environ["PCL_FFT_GROUND_COMMAND"], "align", *files, "-o", out, "--quiet",
                                "--max-object-size", "1", *words], check=True)
                with open(os.path.join(out, "alignment.json"), encoding="utf-8") as file:
                    command = json.load(file)
                found = pcl_fft_ground.align(self.reference, moving, None, 1.0, **options)
                with self.subTest(options=options, refusal=found.refusal):
                    self.assertEqual(found.accepted, command["accepted"])
                    self.assertEqual(found.refusal, command.get("refusal", ""))
                    self.assertEqual(found.score, command["score"])
                    np.testing.assert_array_equal(found.reference_from_moving, command["reference_from_moving"])


class Example(unittest.TestCase):
    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "SKIPPED: matplotlib is missing")
    def test_reads_a_cloud_and_writes_a_table_and_a_picture(self):
        program = os.path.join(os.path.dirname(__file__), "..", "..", "examples", "segment_and_plot.py")
        xyz, on_box = sea_floor()
        with tempfile.TemporaryDirectory() as folder:
            for name, save in (("scan.npy", np.save), ("scan.xyz", np.savetxt)):
                cloud, out = os.path.join(folder, name), os.path.join(folder, name + "_out")
                save(cloud, xyz)
                os.mkdir(out)
                said = subprocess.run([sys.executable, program, cloud, "1.0", out], check=True, text=True,
                                      stdout=subprocess.PIPE, env={**os.environ, "MPLBACKEND": "Agg"}).stdout
                self.assertIn("1 segments", said)
                table = np.genfromtxt(os.path.join(out, "segments.csv"), delimiter=",", names=True)
                self.assertEqual(table.shape, ())
                self.assertLessEqual(table["points"], on_box.sum())
                np.testing.assert_allclose([table["x"], table["y"], table["height"]], [2.5, 1.5, 0.2], atol=0.02)
                with open(os.path.join(out, "segments.png"), "rb") as picture:
                    content = picture.read()
                self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
                self.assertGreater(len(content), 20000)  # one of nothing is smaller


if __name__ == "__main__":
    unittest.main()
