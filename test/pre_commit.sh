#!/usr/bin/env bash
# What to run before each commit: the format of the files that were changed, shell scripts that parse, and the fast tests of
# the core, which take less than a minute. As a hook: ln -s ../../test/pre_commit.sh .git/hooks/pre-commit
#
#   test/pre_commit.sh [fix]       fix: formats the changed files in place
#
# PCL_FFT_GROUND_BUILD_DIR   a build that is configured (build/dev); without one the tests are left out, and it is said
set -euo pipefail

checkout=$(git -C "$(dirname "$(realpath "${BASH_SOURCE[0]}")")" rev-parse --show-toplevel)
cd "$checkout"
build=${PCL_FFT_GROUND_BUILD_DIR:-build/dev}

# changed PATTERN...: files of the commit to come, and such that are not added yet, by name.
changed() {
  { git diff --name-only --diff-filter=d HEAD -- "$@" && git ls-files --others --exclude-standard -- "$@"; } | sort -u
}

mapfile -t sources < <(changed '*.h' '*.hpp' '*.cpp')
if [ ${#sources[@]} -gt 0 ]; then
  if [ "${1:-}" = fix ]; then clang-format -i "${sources[@]}"; fi
  clang-format --dry-run -Werror "${sources[@]}"
fi
mapfile -t scripts < <(changed '*.sh' .ci/run)
for script in "${scripts[@]}"; do bash -n "$script"; done
echo "format: ${#sources[@]} sources and ${#scripts[@]} scripts are in order"

if [ ! -f "$build/CMakeCache.txt" ]; then
  echo "THE TESTS WERE NOT RUN: $build is no build (cmake --preset dev)"
  exit 0
fi
cmake --build "$build" --target core_tests --parallel "$(cmake/build_jobs.sh)" | tail -n 1
# Without the ones that align or segment whole scans, nine tenths of the time of all.
timeout 60 "$build/test/core_tests" --gtest_brief=1 \
  --gtest_filter='-*Alignment*:*Relief*:*Survey*:*Land*:*Icp*:*Dense*:*Robust*'
