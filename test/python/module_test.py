"""What a user of `import pcl_fft_ground` relies on. Run by CTest with the module on PYTHONPATH."""

import os
import subprocess
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
        self.assertEqual(result.report["neither"], 2)

    def test_no_points_give_no_labels(self):
        self.assertEqual(pcl_fft_ground.segment(np.zeros((0, 3)), 1.0).labels.shape, (0,))

    def test_every_method_runs(self):
        xyz, _ = sea_floor(0.04)
        for method in ("naive", "planar", "grid", "graph-cut", "fft-lowpass", "fft"):
            with self.subTest(method=method):
                labels = pcl_fft_ground.segment(xyz, method=method).labels
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

        threads = [threading.Thread(target=work, args=(n,)) for n in range(len(results))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for labels in results:
            np.testing.assert_array_equal(labels, expected)

    @unittest.skipUnless(os.environ.get("PCL_FFT_GROUND_COMMAND"), "the command was not built")
    def test_labels_and_segments_are_those_of_the_command(self):
        xyz, _ = sea_floor()
        xyz += [500000.0, 4100000.0, 0.0]
        with tempfile.TemporaryDirectory() as folder:
            cloud = os.path.join(folder, "scan.xyz")
            np.savetxt(cloud, xyz, fmt="%.17g")
            for options in ({}, {"method": "fft-lowpass", "height_tolerance": 0.02}, {"max_slope": 0.5},
                            {"clusters": "contact"}):
                words = [w for k, v in options.items() for w in ("--" + k.replace("_", "-"), str(v))]
                out = os.path.join(folder, "out")
                subprocess.run(
                    [os.environ["PCL_FFT_GROUND_COMMAND"], "segment", cloud, "-o", out, "--quiet",
                     "--max-object-size", "1", *words], check=True)
                result = pcl_fft_ground.segment(xyz, 1.0, **options)
                labels, segments = labels_of_command(out)
                np.testing.assert_array_equal(result.labels, labels)
                np.testing.assert_array_equal(result.segments, segments)


if __name__ == "__main__":
    unittest.main()
