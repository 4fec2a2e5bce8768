#!/usr/bin/env bash
# Installs what is missing (Debian 12 or 13, Ubuntu 22.04 or 24.04), builds everything and runs all tests.
#
#   test/run_tests.sh [CTEST OPTION...]          for example  test/run_tests.sh -L core
#
# PCL_FFT_GROUND_BUILD_DIR   where to build (build/tests in the checkout)
# PCL_FFT_GROUND_DATA        folder of real scans; tests that want them are skipped where it is not set
# PCL_FFT_GROUND_JOBS        compilers and tests to run at once (one per core, memory allowing)
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=${PCL_FFT_GROUND_BUILD_DIR:-$checkout/build/tests}

"$checkout/cmake/install_dependencies.sh" library tool python tests packages
jobs=$("$checkout/cmake/build_jobs.sh")

echo "Configuring in $build"
# For /usr, as Debian packages are; nothing is installed there.
cmake -S "$checkout" -B "$build" -DCMAKE_BUILD_TYPE=Release -DPCL_FFT_GROUND_WERROR=ON -DCMAKE_INSTALL_PREFIX=/usr \
  -DPCL_FFT_GROUND_BUILD_TOOL=ON -DPCL_FFT_GROUND_BUILD_TESTS=ON -DPCL_FFT_GROUND_BUILD_EXAMPLES=ON \
  -DPCL_FFT_GROUND_BUILD_PYTHON=ON

echo "Building with $jobs job(s); the first time this takes some minutes"
cmake --build "$build" --parallel "$jobs"

echo "Running the tests"
cd "$build"
ctest --output-on-failure --parallel "$jobs" "$@"
