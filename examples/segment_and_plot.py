#!/usr/bin/env python3
"""Reads a cloud, draws its ground and objects, and writes a table of the segments.

    segment_and_plot.py CLOUD LARGEST_OBJECT [FOLDER]

CLOUD is text (x y z and more columns) or a NumPy array (.npy), in metres; LARGEST_OBJECT is the size [m] of
what is still an object. FOLDER (the present one) receives segments.csv and segments.png.
"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import pcl_fft_ground


def read_cloud(path):
    table = np.load(path) if path.endswith(".npy") else np.loadtxt(path, ndmin=2)
    return np.ascontiguousarray(table[:, :3], dtype=float)


def write_table(path, xyz, result):
    with open(path, "w", encoding="utf-8") as table:
        table.write("segment,points,x,y,z,height\n")
        for number in range(1, result.segments.max(initial=0) + 1):
            chosen = result.segments == number
            x, y, z = xyz[chosen].mean(axis=0)
            table.write(f"{number},{chosen.sum()},{x:.3f},{y:.3f},{z:.3f},{result.height[chosen].max():.3f}\n")


def draw(path, xyz, result):
    figure, axes = plt.subplots(figsize=(8, 8))
    ground = result.labels == 0
    axes.scatter(*xyz[ground, :2].T, s=0.5, c="lightgrey", label="ground")
    axes.scatter(*xyz[result.labels == 1, :2].T, s=0.5, c=result.segments[result.labels == 1], cmap="tab20")
    axes.set_aspect("equal")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    axes.set_title(f"{result.segments.max(initial=0)} segments above {ground.sum()} ground points")
    figure.savefig(path, dpi=120)


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    folder = sys.argv[3] if len(sys.argv) == 4 else "."
    xyz = read_cloud(sys.argv[1])
    result = pcl_fft_ground.segment(xyz, float(sys.argv[2]))
    for warning in result.report["warnings"]:
        print("warning:", warning, file=sys.stderr)
    write_table(os.path.join(folder, "segments.csv"), xyz, result)
    draw(os.path.join(folder, "segments.png"), xyz, result)
    print(f"{result.segments.max(initial=0)} segments; see segments.csv and segments.png in {folder}")


if __name__ == "__main__":
    main()
