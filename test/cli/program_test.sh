#!/bin/sh
# What only the program itself shows: exit codes, its two streams, and outputs that stay whole.
# Usage: program_test.sh PROGRAM VERSION
set -u
program=$(realpath -e "$1") || exit 1
version=$2
folder=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

fail() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# expect STATUS WORD...: runs the program into the files out and err and checks its exit status.
expect() {
  expected=$1
  shift
  "$program" "$@" > out 2> err
  status=$?
  [ "$status" -eq "$expected" ] || fail "'$*' gave $status, not $expected: $(head -c 300 err)"
}

silent() { [ ! -s "$1" ] || fail "$2 printed to $1: $(head -c 300 "$1")"; }

# refused STATUS PATTERN WORD...: one line on stderr that has the pattern, nothing on stdout, nothing written.
refused() {
  status_of_refusal=$1
  pattern=$2
  shift 2
  expect "$status_of_refusal" "$@"
  silent out "'$*'"
  [ "$(wc -l < err)" -eq 1 ] || fail "'$*' gave other than one line: $(cat err)"
  grep -q "^pcl_fft_ground: .*$pattern" err || fail "'$*' does not say '$pattern': $(cat err)"
  [ ! -e result ] || fail "'$*' wrote something"
}

# Help and version.
expect 0 --version
[ "$(cat out)" = "pcl_fft_ground $version" ] || fail "the version is '$(cat out)', not $version"
for words in "--help" "-h" "help" "segment --help" "segment -h" "segment --help --cell-size 0" "simulate --help" \
  "simulate survey --help" "evaluate --help" "align --help" "survey --help"; do
  # shellcheck disable=SC2086 # words are words
  expect 0 $words
  silent err "'$words'"
  grep -q '^Usage: pcl_fft_ground ' out || fail "'$words' shows no usage"
  [ "$(wc -L < out)" -le 120 ] || fail "'$words' has long lines"
done

# Results: a summary on stdout; JSON and nothing else with --json; nothing with --quiet.
expect 0 simulate wreck -o scan.pcd --points 40000
silent err simulate
grep -q scan.pcd out || fail "simulate does not name its file"
expect 0 segment scan.pcd -o result --cell-size 0.05 --max-object-size 1
silent err segment
grep -q '^ground ' out || fail "segment prints no summary"
expect 0 segment scan.pcd -o result --cell-size 0.05 --max-object-size 1 --json
silent err "segment --json"
cmp -s out result/report.json || fail "--json is not report.json"
expect 0 segment scan.pcd -o result --cell-size 0.05 --max-object-size 1 --quiet
silent out "segment --quiet"
silent err "segment --quiet"
expect 0 simulate wreck -o scan.pcd --points 40000 --quiet
silent out "simulate --quiet"

# Warnings are lines on stderr; they are no errors.
rm -r result
expect 0 segment scan.pcd -o result --cell-size 0.05 --max-object-size 50
if grep -qv '^pcl_fft_ground: warning: ' err || [ ! -s err ]; then fail "the warning is: $(cat err)"; fi
rm -r result

# Wrong usage: 2.
refused 2 "no command"
refused 2 "'divide'.*segment" divide
refused 2 "no cloud" segment
refused 2 "unrecognised option '--cell'" segment scan.pcd -o result --cell 1
refused 2 "--cell-size.*above 0" segment scan.pcd -o result --cell-size 0
refused 2 "--cell-size.*above 0" segment scan.pcd -o result --cell-size -1
refused 2 "--relative-max-object-size.*(0, 1]" segment scan.pcd -o result --relative-max-object-size 2
refused 2 "'moon'" simulate moon -o moon.pcd

# Failed work: 1.
: > empty.pcd
head -c 20000 scan.pcd > truncated.pcd
refused 1 "'missing.pcd'" segment missing.pcd -o result
refused 1 "'\.'" segment . -o result
refused 1 "'empty.pcd'" segment empty.pcd -o result
refused 1 "'truncated.pcd'.*truncated" segment truncated.pcd -o result
refused 1 "scan.pcd.*cells" segment scan.pcd -o result --cell-size 1e-9
refused 1 "'scan.pcd'" segment scan.pcd -o scan.pcd
refused 1 "nowhere" simulate wreck -o nowhere/scan.pcd --points 100
name="one
line.pcd"
refused 1 'one\\nline.pcd' segment "$name" -o result

# A folder that may not be written, and a disk that is full.
mkdir locked
chmod a-w locked
if [ ! -w locked ]; then
  refused 1 "locked" segment scan.pcd -o locked --cell-size 0.05
  [ -z "$(ls -A locked)" ] || fail "files in a locked folder"
fi
(ulimit -f 100 && trap '' XFSZ && "$program" segment scan.pcd -o full --cell-size 0.05 > out 2> err)
[ $? -eq 1 ] || fail "a full disk gave other than 1"
grep -q "^pcl_fft_ground: .*full/labelled.pcd" err || fail "a full disk is not told: $(cat err)"
[ -z "$(ls -A full)" ] || fail "a full disk left $(ls -A full)"
if [ -c /dev/full ]; then
  "$program" segment scan.pcd -o result --cell-size 0.05 --json > /dev/full 2> err
  [ $? -eq 1 ] || fail "a standard output that is full gave other than 1"
  grep -q "standard output" err || fail "a standard output that is full is not told: $(cat err)"
fi

[ "$failures" -eq 0 ] && echo "passed"
exit "$failures"
