#!/usr/bin/env bash
# Installs Debian packages of the project, as root, and uses them as their users do: the command with its manual page and
# completion, the consumer project by CMake and by pkg-config, the Python module where there is one.
#
#   test/package/use_packages.sh [DIR_OF_PACKAGES]     without a folder they are made first, in build/package
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
packages=${1:-$checkout/build/package}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

if [ $# -eq 0 ]; then
  cd "$checkout"
  cmake/install_dependencies.sh library tool packages
  DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends pybind11-dev python3-dev python3-numpy
  cmake --preset package && cmake --build --preset package --parallel "$(cmake/build_jobs.sh)"
  (cd build/package && cpack)
  lintian --allow-root --fail-on error build/package/*.deb
fi
packages=$(cd "$packages" && pwd)
apt-get update -q
DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "$packages"/*.deb \
  cmake make g++ pkg-config >"$work/apt.log" 2>&1 || { tail -n 30 "$work/apt.log" >&2 && exit 1; }

pcl_fft_ground simulate wreck -o "$work/wreck.pcd" --points 50000 --quiet
pcl_fft_ground segment "$work/wreck.pcd" -o "$work/result" --max-object-size 1
test -s "$work/result/labels.png"
# dpkg leaves the manual out of minimal systems: what the package has is asked for.
dpkg -L pcl-fft-ground | grep -q '/man1/pcl_fft_ground-segment.1.gz$'
bash -c '. /usr/share/bash-completion/completions/pcl_fft_ground
  COMP_WORDS=(pcl_fft_ground segment --max-obj) COMP_CWORD=2 && _pcl_fft_ground && test "${COMPREPLY[*]}" = --max-object-size'

cmake -S "$checkout/examples/consumer/voxel_clusters" -B "$work/consumer"
cmake --build "$work/consumer"
"$work/consumer/voxel_clusters"
# shellcheck disable=SC2046  # a list of options
g++ -std=c++17 "$checkout/examples/consumer/voxel_clusters/main.cpp" -o "$work/by_pkg_config" \
  $(pkg-config --cflags --libs pcl_fft_ground_filters)
"$work/by_pkg_config"

if dpkg-query -W python3-pcl-fft-ground >/dev/null 2>&1; then
  python3 -c 'import numpy, pcl_fft_ground
x, y = numpy.meshgrid(numpy.arange(0, 4, 0.02), numpy.arange(0, 4, 0.02))
z = numpy.where(numpy.hypot(x - 2, y - 2) < 0.3, 0.4, 0.0)
labels = pcl_fft_ground.segment(numpy.stack([x, y, z], -1).reshape(-1, 3), max_object_size=1.0).labels
assert (labels == (z.ravel() > 0)).mean() > 0.99'
fi
echo "The packages work: $(cd "$packages" && echo *.deb)"
