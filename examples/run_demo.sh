#!/usr/bin/env bash
# Installs what is missing (Debian 12 or 13, Ubuntu 22.04 or 24.04), builds the command, simulates a scan of a wreck site and
# takes the ground out of it. The results go to demo_output in the checkout.
#
# PCL_FFT_GROUND_BUILD_DIR   where to build (build/demo in the checkout)
# PCL_FFT_GROUND_JOBS        compilers to run at once (one per core, memory allowing)
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${PCL_FFT_GROUND_BUILD_DIR:-$checkout/build/demo}
output=$checkout/demo_output

"$checkout/cmake/install_dependencies.sh" library tool
jobs=$("$checkout/cmake/build_jobs.sh")

echo "Configuring in $build"
cmake -S "$checkout" -B "$build" -DCMAKE_BUILD_TYPE=Release -DPCL_FFT_GROUND_BUILD_TOOL=ON \
  -DPCL_FFT_GROUND_BUILD_TESTS=OFF -DPCL_FFT_GROUND_BUILD_EXAMPLES=OFF

echo "Building with $jobs job(s); the first time this takes some minutes"
cmake --build "$build" --parallel "$jobs"
tool=$build/bin/pcl_fft_ground

echo "Simulating a scan of a wreck site"
mkdir -p "$output"
"$tool" simulate wreck -o "$output/wreck.pcd"

echo "Taking the ground out of it"
"$tool" segment "$output/wreck.pcd" -o "$output" --max-object-size 1

cat <<TEXT

Done. Look at the pictures in $output:
  elevation.png   the scan from above, coloured by height
  ground.png      the ground surface found under the objects
  spectrum.png    the spectra of the terrain and of its ground
  labels.png      what is ground and what is object
  segments.png    the objects, one colour each
TEXT
