#!/usr/bin/env bash
# Checks the format of all C++ files (clang-format) and lets clang-tidy read the sources; each finding is an error.
# The rules are in .clang-format and .clang-tidy; Debian 12's LLVM 14 is what the tree is kept clean for.
#
#   test/check_style.sh [core|all|format]    clang-tidy of src/core (the default), of the whole tree, of nothing
#   test/check_style.sh fix                  formats all files in place
#
# PCL_FFT_GROUND_JOBS   files to read at once (one per core, memory allowing)
set -euo pipefail

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$checkout/build/style
cd "$checkout"

tidy() { # REGEX OF FILES CMAKE OPTION...
  cmake -S . -B "$build" -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "${@:2}" >"$build.log" 2>&1 || {
    cat "$build.log" >&2
    exit 1
  }
  # What only GCC knows of.
  sed -i -E 's/ (-fcx-limited-range|-Wno-maybe-uninitialized)//g' "$build/compile_commands.json"
  run-clang-tidy -quiet -extra-arg=-std=c++17 -p "$build" -j "$(cmake/build_jobs.sh)" "$1" >"$build.log" 2>&1 || {
    grep -E '(error|warning): ' "$build.log" | sort -u
    echo "clang-tidy found the above; all of its words are in $build.log" >&2
    exit 1
  }
  echo "clang-tidy: $(grep -c '^clang-tidy' "$build.log") files are clean"
}

cmake/install_dependencies.sh library tool tests style
mkdir -p "$build"
format() { git ls-files -z '*.h' '*.hpp' '*.cpp' | xargs -0 clang-format "$@"; }
case "${1:-core}" in
  fix) format -i && exit ;;
  core) set -- "$checkout/src/core/" -DPCL_FFT_GROUND_BUILD_FILTERS=OFF ;;
  all) set -- "$checkout/(src|test|examples)/" -DPCL_FFT_GROUND_BUILD_FILTERS=ON ;;
  format) set -- ;;
  *) echo "check_style.sh: unknown argument '$1' (allowed: core all format fix)" >&2 && exit 2 ;;
esac
format --dry-run -Werror
echo "clang-format: all files are in the project's style"
[ $# -eq 0 ] || tidy "$@"
