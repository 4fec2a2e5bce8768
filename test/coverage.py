#!/usr/bin/env python3
"""Which lines of the libraries and the command ran in the tests of a build with PCL_FFT_GROUND_COVERAGE=ON (GCC).

    test/coverage.py BUILD [PREFIX...]    a table of folders; of files that begin with a PREFIX also the lines that never ran
"""
import collections
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent


def counts(build):
    """For each file of src/ and include/ the lines that hold code, and how often each ran."""
    data = [str(path.resolve()) for path in pathlib.Path(build).rglob("*.gcda")]
    lines = collections.defaultdict(lambda: collections.defaultdict(int))
    with tempfile.TemporaryDirectory() as folder:
        for first in range(0, len(data), 50):
            gcov = subprocess.run(["gcov", "--json-format", "--preserve-paths", *data[first:first + 50]], cwd=folder,
                                  capture_output=True, text=True)
            if gcov.returncode != 0:  # a file was compiled anew since it was run
                sys.exit(f"{gcov.stderr.strip()}\nDelete all *.gcda in {build} and run the tests again")
        for path in pathlib.Path(folder).glob("*.gcov.json.gz"):
            report = json.loads(gzip.open(path).read())
            for file in report["files"]:
                source = pathlib.Path(report["current_working_directory"], file["file"]).resolve()
                if CHECKOUT not in source.parents or source.is_relative_to(CHECKOUT / "build"):
                    continue
                for line in file["lines"]:
                    lines[str(source.relative_to(CHECKOUT))][line["line_number"]] += line["count"]
    return lines


def room(file):
    """The folder that a file counts for: src/core/grid, include/pcl_fft_ground/impl ..."""
    return "/".join(file.split("/")[:-1][:3])


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    lines = counts(sys.argv[1])
    if not lines:
        sys.exit(f"{sys.argv[1]}: no test has run there, or it was built without PCL_FFT_GROUND_COVERAGE=ON")
    table = collections.defaultdict(lambda: [0, 0])
    for file, of_file in lines.items():
        for place in (room(file), "the core" if "/core/" in file else "all but the core"):
            table[place][0] += sum(count > 0 for count in of_file.values())
            table[place][1] += len(of_file)
    for place, (ran, total) in sorted(table.items()):
        print(f"{place:40} {ran:6} of {total:6} lines {100 * ran / total:6.2f} %")
    for file in sorted(lines):
        never = sorted(line for line, count in lines[file].items() if count == 0)
        if never and any(file.startswith(prefix) for prefix in sys.argv[2:]):
            print(f"{file}: {' '.join(map(str, never))}")


if __name__ == "__main__":
    main()
