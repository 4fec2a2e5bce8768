#!/usr/bin/env bash
# Makes a bare Debian, copies the checkout's tracked files into it and runs a command of the README there, as somebody
# does who has just installed that system. Prints the time, the packages and the result.
#
#   test/package/fresh_system.sh [--mirror URI] [--keep] debian:bookworm|debian:trixie [demo|tests|packages [DIR]]
#
#   demo            examples/run_demo.sh (the default)
#   tests           test/run_tests.sh
#   packages DIR    test/package/use_packages.sh: installs the .deb files of DIR, made for that system, and uses them; without
#                   a folder it makes them there
#   --mirror URI    Debian's archive; without it that of this machine's apt configuration
#   --keep          do not delete the system, and say where it is
#
# TMPDIR                 where the system is made, 5 GB (/var/tmp)
# PCL_FFT_GROUND_JOBS    compilers to run at once (one per core, memory allowing)
#
# Exit status: 0 passed; 1 failed; 2 not understood; 77 could not be tried here, as it needs root, debootstrap and the
# archive.
set -euo pipefail

failed=1 not_understood=2 not_tried=77

stop() { # STATUS WORD...
  echo "fresh_system.sh: ${*:2}" >&2
  exit "$1"
}

# machine_mirror: the archive that this machine's packages come from, if that is Debian's.
machine_mirror() {
  # shellcheck disable=SC2016  # a field of apt's
  apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 2>/dev/null | grep -E '/debian/?$' | head -n 1
}

# machine_apt_settings: how this machine reaches its archive (proxies, dates, retries).
machine_apt_settings() {
  apt-config dump | grep -E '^Acquire::(https?::|Check-)' || true
  echo 'Acquire::Retries "3";'
}

# check_possible: stops where a bare system cannot be made.
check_possible() {
  [ "$(id -u)" -eq 0 ] || stop $not_tried "a bare system can be made by root only"
  command -v debootstrap >/dev/null || stop $not_tried "debootstrap is missing (apt-get install debootstrap)"
  unshare --mount true 2>/dev/null || stop $not_tried "this machine does not let root mount file systems"
  [ -n "$mirror" ] || stop $not_tried "no mirror of Debian in this machine's apt configuration: name one with --mirror"
  timeout 60 /usr/lib/apt/apt-helper download-file "${mirror%/}/dists/$suite/InRelease" "$work/InRelease" \
    >"$work/download.log" 2>&1 || stop $not_tried "$mirror has no $suite that can be reached: $(tail -n 1 "$work/download.log")"
}

# make_base: a minimal system with the machine's way to the archive and names, and no services.
make_base() {
  local proxy=""
  eval "$(apt-config shell proxy Acquire::http::Proxy)"
  [ -z "$proxy" ] || export http_proxy=$proxy
  timeout 600 debootstrap --variant=minbase "$suite" "$root" "$mirror" >"$work/debootstrap.log" 2>&1 || {
    tail -n 20 "$work/debootstrap.log" >&2
    stop $not_tried "debootstrap could not make $suite from $mirror"
  }
  machine_apt_settings >"$root/etc/apt/apt.conf.d/90machine"
  echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/speed"
  printf '#!/bin/sh\nexit 101\n' >"$root/usr/sbin/policy-rc.d"
  chmod +x "$root/usr/sbin/policy-rc.d"
  cp /etc/hosts /etc/resolv.conf "$root/etc/"
}

copy_checkout() {
  mkdir -p "$root/pcl_fft_ground"
  git -C "$checkout" ls-files -z | tar -c -C "$checkout" --null --ignore-failed-read -T - |
    tar -x --no-same-owner -C "$root/pcl_fft_ground" || stop $failed "the checkout's files could not be copied"
  [ -z "$packages" ] || { mkdir "$root/packages" && cp "$packages"/*.deb "$root/packages/"; }
}

# run_inside COMMAND...: in name spaces of its own, so that nothing stays mounted or running whatever happens.
run_inside() {
  # shellcheck disable=SC2016  # expanded by the inner shell
  unshare --mount --pid --fork --kill-child --propagation private sh -c '
    root=$1 && shift &&
    mount -t proc proc "$root/proc" && mount --bind /dev "$root/dev" &&
    exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 PCL_FFT_GROUND_JOBS="${PCL_FFT_GROUND_JOBS:-}" \
      chroot "$root" "$@"' run_inside "$root" "$@" </dev/null
}

installed() { # [PACKAGE...]
  # shellcheck disable=SC2016  # fields of dpkg's
  chroot "$root" dpkg-query -W -f '${Package} ${Version}\n' "$@" 2>/dev/null || true
}

report() { # RESULT
  local names=(g++ cmake libpcl-dev libboost-dev libeigen3-dev libgtest-dev)
  cat <<TEXT

Fresh system $system, $command: $1
  time      $base_seconds s for the bare system, $command_seconds s for the command
  packages  $base_packages at first, $(installed | wc -l) now, among them
$(installed "${names[@]}" | sed 's/^/              /')
TEXT
}

mirror="" keep=0 arguments=()
while [ $# -gt 0 ]; do
  case "$1" in
    --mirror) mirror=${2:?--mirror needs a URI} && shift ;;
    --keep) keep=1 ;;
    -h | --help) sed -n '2,/^set /s/^# \{0,1\}//p' "$0" && exit 0 ;;
    -*) stop $not_understood "unknown option '$1'" ;;
    *) arguments+=("$1") ;;
  esac
  shift
done
system=${arguments[0]:-} task=${arguments[1]:-demo}
packages=${arguments[2]:-}
[ ${#arguments[@]} -le 2 ] || [ "$task" = packages ] || stop $not_understood "too many arguments: ${arguments[*]}"
case "$system" in
  debian:bookworm | debian:trixie) suite=${system#debian:} ;;
  *) stop $not_understood "unknown system '$system' (allowed: debian:bookworm debian:trixie)" ;;
esac
case "$task" in
  demo) command=examples/run_demo.sh ;;
  tests) command=test/run_tests.sh ;;
  packages)
    command=test/package/use_packages.sh
    [ -z "$packages" ] || ls "$packages"/*.deb >/dev/null 2>&1 || stop $not_understood "no .deb files in '$packages'"
    ;;
  *) stop $not_understood "unknown task '$task' (allowed: demo tests packages)" ;;
esac

checkout=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d -p "${TMPDIR:-/var/tmp}" fresh_system.XXXXXX)
root=$work/root
clean_up() {
  if [ $keep = 1 ]; then echo "The system is kept in $root"; else rm -rf --one-file-system "$work"; fi
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

[ -n "$mirror" ] || mirror=$(machine_mirror || true)
check_possible
echo "Making a bare $system in $root"
SECONDS=0
make_base
copy_checkout
base_seconds=$SECONDS
base_packages=$(installed | wc -l)

echo "Running $command in it"
SECONDS=0
status=0
run_inside "/pcl_fft_ground/$command" ${packages:+/packages} || status=$?
command_seconds=$SECONDS
if [ $status -ne 0 ]; then
  report "FAILED (status $status)"
  exit $failed
fi
report passed
