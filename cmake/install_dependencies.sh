#!/bin/sh
# Installs the packages that are missing, and only those, on Debian 12 and 13, Ubuntu 22.04 and Ubuntu 24.04.
#
#   cmake/install_dependencies.sh PURPOSE...
#
#   library tool python tests packages benchmarks fftw documentation style fuzz fresh-system
#
# Root is asked for (by sudo) only when something is missing. PCL_FFT_GROUND_SKIP_INSTALL=1 skips the whole step.
set -eu

purposes="library tool python tests packages benchmarks fftw documentation style fuzz fresh-system"

fail() {
  echo "install_dependencies.sh: $*" >&2
  exit 1
}

# commands_of PURPOSE: what must be on the PATH, as command:package, whoever put it there.
commands_of() {
  case "$1" in
    library) echo "c++:g++ cc:gcc cmake:cmake make:make pkg-config:pkg-config" ;;
    packages) echo "dpkg-shlibdeps:dpkg-dev file:file lintian:lintian" ;;
    documentation) echo "doxygen:doxygen" ;;
    style) echo "git:git clang-format:clang-format clang-tidy:clang-tidy" ;;
    fuzz) echo "clang++:clang" ;;
    fresh-system) echo "git:git debootstrap:debootstrap unshare:util-linux" ;;
  esac
}

# packages_of PURPOSE: development packages. The picture writer draws its text in the DejaVu font.
packages_of() {
  case "$1" in
    library) echo "libpcl-dev libeigen3-dev libboost-dev libflann-dev" ;;
    tool) echo "libboost-program-options-dev libcairo2-dev nlohmann-json3-dev fonts-dejavu-core" ;;
    python) echo "pybind11-dev python3-dev python3-numpy python3-matplotlib" ;;
    tests) echo "libgtest-dev xvfb xauth gdal-bin" ;;
    benchmarks) echo "libbenchmark-dev" ;;
    fftw) echo "libfftw3-dev" ;;
    packages | documentation | style | fuzz | fresh-system) ;;
    *) fail "unknown purpose '$1' (allowed: $purposes)" ;;
  esac
}

# optional_packages_of PURPOSE: installed where the system has them; Debian 12 has no LASzip, and Ubuntu 22.04 has libFuzzer in
# clang itself.
optional_packages_of() {
  case "$1" in
    tool) echo "liblaszip-dev" ;;
    fuzz) echo "libclang-rt-$(apt-cache show clang 2>/dev/null | sed -n 's/^Version: [0-9]*:\([0-9]*\)\..*/\1/p' | head -n 1)-dev" ;;
  esac
}

# missing_optional PACKAGE...: those that are not installed, as far as apt knows them.
missing_optional() {
  for package in $(missing_packages "$@"); do
    ! apt-cache show "$package" >/dev/null 2>&1 || echo "$package"
  done
}

# missing_commands COMMAND:PACKAGE...: the packages of the commands that are not on the PATH.
missing_commands() {
  for pair in "$@"; do
    command -v "${pair%%:*}" >/dev/null 2>&1 || echo "${pair#*:}"
  done
}

# missing_packages PACKAGE...: those that are not installed.
missing_packages() {
  installed=$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' "$@" 2>/dev/null || true)
  for package in "$@"; do
    echo "$installed" | grep -qxF "installed $package" || echo "$package"
  done
}

is_debian_family() {
  command -v apt-get >/dev/null 2>&1 && command -v dpkg-query >/dev/null 2>&1 && [ -r /etc/os-release ] &&
    (. /etc/os-release && case " ${ID:-} ${ID_LIKE:-} " in *" debian "* | *" ubuntu "*) true ;; *) false ;; esac)
}

explain_other_system() {
  cat >&2 <<'TEXT'
install_dependencies.sh: this system is neither Debian nor Ubuntu, so nothing was installed. Please install
  a C and a C++17 compiler, CMake >= 3.16, make, pkg-config
  PCL >= 1.12 (common, filters, sample_consensus; io for the command; search, segmentation for tests and examples; registration
  for SegmentICP)
  Eigen >= 3.4, Boost >= 1.71 (headers; program_options for the command), FLANN
  Cairo, nlohmann-json >= 3.9 and a sans-serif font for the command; GoogleTest >= 1.10 for the tests
  optional: GDAL for GeoTIFF, LASzip for LAZ
  pybind11, NumPy and Python's headers for the Python module; matplotlib for its example
and run the same command again with PCL_FFT_GROUND_SKIP_INSTALL=1 in the environment.
TEXT
  exit 1
}

# as_root COMMAND...: runs it directly, or through sudo.
as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  else
    sudo "$@"
  fi
}

install_packages() {
  echo "Missing packages, to be installed with apt-get: $*"
  [ "$(id -u)" -eq 0 ] || command -v sudo >/dev/null 2>&1 ||
    fail "root is needed to install them, and there is no sudo; as root, run: apt-get install --no-install-recommends $*"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q
  # shellcheck disable=SC2046,SC2086  # lists of words; apt may know more now
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "$@" $(missing_optional $optional) ||
    fail "apt-get could not install: $*"
}

[ $# -gt 0 ] || fail "say what for: $purposes"
commands=""
packages=""
optional=""
for purpose in "$@"; do
  commands="$commands $(commands_of "$purpose")"
  packages="$packages $(packages_of "$purpose")"
  optional="$optional $(optional_packages_of "$purpose")"
done
[ "${PCL_FFT_GROUND_SKIP_INSTALL:-0}" != 1 ] || exit 0
is_debian_family || explain_other_system

# shellcheck disable=SC2086  # lists of words
missing="$(missing_commands $commands) $(missing_packages $packages) $(missing_optional $optional)"
# shellcheck disable=SC2086
set -- $missing
[ $# -eq 0 ] || install_packages "$@"
