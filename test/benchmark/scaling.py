#!/usr/bin/env python3
"""Time and memory of the segmentation against the number of points, beside PCL's own filters.

    scaling.py build/test/benchmark/segment_benchmark [-o FOLDER] [--points 10000,...] [--threads 1,2]

Every figure is that of a process of its own: the median time of its repetitions, and the peak of its memory less that of
one which holds the cloud only. (Making a cloud of up to 600,000 points takes more than segmenting it: that shows as 0.)
Writes scaling.json and scaling.svg (log-log) and prints the table. Filters whose time grows faster than the points are
left out above --slow-points.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

# benchmark, what it is called, whether it is slow, whether it has threads
METHODS = [
    ("threePasses", "three plain passes", False, False),
    ("voxelGrid", "pcl::VoxelGrid", False, False),
    ("segmentLowPass", "published filter", False, True),
    ("segmentRobust", "robust", False, True),
    ("planeByMlesac", "pcl::SACSegmentation, MLESAC", False, False),
    ("progressiveMorphological", "pcl::ApproximateProgressiveMorphologicalFilter", True, False),
    ("euclideanClusters", "pcl::EuclideanClusterExtraction", True, False),
]


def run(program, method, points, threads, repetitions):
    """Median milliseconds and the peak memory of the process [bytes]."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        name = f"^{method}/{threads}$" if threads else f"^{method}$"
        process = subprocess.Popen(
            [program, "--points", str(points), "--threads", str(threads or 1), f"--benchmark_filter={name}",
             f"--benchmark_repetitions={repetitions}", "--benchmark_min_time=0.000001",
             f"--benchmark_out={out.name}", "--benchmark_out_format=json"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        if status != 0:
            raise RuntimeError(f"{method} failed on {points} points (status {status})")
        times = sorted(b["real_time"] for b in json.load(open(out.name))["benchmarks"] if b["run_type"] == "iteration")
    return times[len(times) // 2], 1024 * usage.ru_maxrss


def measure(arguments):
    results = []
    for points in arguments.points:
        base = None
        for method, name, is_slow, has_threads in METHODS:
            if is_slow and points > arguments.slow_points:
                continue
            for threads in arguments.threads if has_threads else [None]:
                repetitions = 5 if points <= 1000000 else 3 if points <= 10000000 else 1
                milliseconds, memory = run(arguments.program, method, points, threads, repetitions)
                base = base or memory  # that of the plain passes: the cloud and the program
                results.append({"method": method, "name": name, "points": points, "threads": threads or 1,
                                "milliseconds": milliseconds, "bytes_beyond_the_cloud": max(memory - base, 0)})
                print(".", end="", file=sys.stderr, flush=True)
    print(file=sys.stderr)
    return results


def series_of(results):
    series = {}
    for r in results:
        label = r["name"] + (f", {r['threads']} threads" if r["threads"] > 1 else "")
        series.setdefault(label, {})[r["points"]] = r
    return series


def print_table(results):
    sizes = sorted({r["points"] for r in results})
    print("| ms (bytes a point beyond the cloud) | " + " | ".join(f"{n:,}" for n in sizes) + " |")
    print("|---" * (len(sizes) + 1) + "|")
    for label, row in series_of(results).items():
        cells = []
        for n in sizes:
            r = row.get(n)
            cells.append(f"{r['milliseconds']:.3g} ({r['bytes_beyond_the_cloud'] / n:.0f})" if r else "")
        print(f"| {label} | " + " | ".join(cells) + " |")


def picture(results):
    """Lines over logarithmic axes as SVG."""
    width, height, left, bottom, top, legend = 860, 460, 70, 50, 20, 330
    series = series_of(results)
    xs = [math.log10(r["points"]) for r in results]
    ys = [math.log10(r["milliseconds"]) for r in results]
    x_low, x_high = math.floor(min(xs)), math.ceil(max(xs))
    y_low, y_high = math.floor(min(ys)), math.ceil(max(ys))

    def place(points, milliseconds):
        x = left + (math.log10(points) - x_low) / (x_high - x_low) * (width - left - legend)
        y = height - bottom - (math.log10(milliseconds) - y_low) / (y_high - y_low) * (height - bottom - top)
        return x, y

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
             'font-size="12">', f'<rect width="{width}" height="{height}" fill="white"/>']
    for x in range(x_low, x_high + 1):
        at = place(10**x, 10**y_low)
        parts.append(f'<line x1="{at[0]:.1f}" y1="{at[1]:.1f}" x2="{at[0]:.1f}" y2="{top}" stroke="#ddd"/>'
                     f'<text x="{at[0]:.1f}" y="{at[1] + 18:.1f}" text-anchor="middle">{10**x:,}</text>')
    for y in range(y_low, y_high + 1):
        at, end = place(10**x_low, 10**y), place(10**x_high, 10**y)
        parts.append(f'<line x1="{at[0]}" y1="{at[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}" stroke="#ddd"/>'
                     f'<text x="{at[0] - 6}" y="{at[1] + 4:.1f}" text-anchor="end">{10.0**y:g}</text>')
    parts.append(f'<text x="{left}" y="{height - 12}">points</text><text x="8" y="{top - 6}">milliseconds</text>')
    colours = ["#888888", "#000000", "#2c7fb8", "#7fcdbb", "#d95f0e", "#fec44f", "#7570b3", "#1b9e77", "#e7298a", "#66a61e"]
    for n, (label, row) in enumerate(series.items()):
        line = [place(points, r["milliseconds"]) for points, r in sorted(row.items())]
        colour = colours[n % len(colours)]
        parts.append(f'<polyline fill="none" stroke="{colour}" stroke-width="2" points="' +
                     " ".join(f"{x:.1f},{y:.1f}" for x, y in line) + '"/>')
        at = top + 12 + 20 * n
        parts.append(f'<line x1="{width - legend + 12}" y1="{at}" x2="{width - legend + 36}" y2="{at}" '
                     f'stroke="{colour}" stroke-width="2"/>'
                     f'<text x="{width - legend + 42}" y="{at + 4}">{label}</text>')
    return "\n".join(parts + ["</svg>\n"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    numbers = lambda text: [int(n) for n in text.split(",")]  # noqa: E731
    parser.add_argument("program", help="segment_benchmark of a Release build")
    parser.add_argument("-o", "--output", default=".", help="folder of scaling.json and scaling.svg")
    parser.add_argument("--points", type=numbers, default=[10000, 100000, 600000, 2400000, 6000000, 24000000])
    parser.add_argument("--threads", type=numbers, default=[1, 2])
    parser.add_argument("--slow-points", type=int, default=600000, help="slow filters see no more (600000)")
    arguments = parser.parse_args()
    results = measure(arguments)
    os.makedirs(arguments.output, exist_ok=True)
    with open(os.path.join(arguments.output, "scaling.json"), "w") as file:
        json.dump({"results": results}, file, indent=1)
    with open(os.path.join(arguments.output, "scaling.svg"), "w") as file:
        file.write(picture(results))
    print_table(results)


if __name__ == "__main__":
    main()
