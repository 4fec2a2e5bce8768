#!/bin/sh
# What goes wrong around the program: names, pipes, devices, limits, kills, two runs at once. Each time the exit status
# and one line tell, nothing half-written stays, and what was there before is as it was.
# Usage: faults_test.sh PROGRAM
set -u
program=$(realpath -e "$1") || exit 1
folder=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0
options="--cell-size 0.05 --max-object-size 1"
escape=$(printf '\033')

fail() {
  echo "FAILED: $1"
  failures=$((failures + 1))
}

# refused STATUS PATTERN WORD...: exits so, with one line on stderr that has the pattern and no escape sequence.
refused() {
  expected=$1 pattern=$2
  shift 2
  timeout 60 "$program" "$@" > out 2> err < /dev/null
  status=$?
  [ "$status" -eq "$expected" ] || fail "'$*' gave $status, not $expected: $(head -c 300 err)"
  [ "$(wc -l < err)" -eq 1 ] || fail "'$*' gave other than one line: $(head -c 300 err)"
  grep -q "$pattern" err || fail "'$*' does not say '$pattern': $(head -c 300 err)"
  if grep -q "$escape" err; then fail "'$*' lets an escape sequence through"; fi
}

none_half_written() {
  [ -z "$(find . -name '*.part')" ] || fail "$1 left $(find . -name '*.part')"
}

"$program" simulate wreck -o scan.pcd --points 40000 --quiet || fail "no scan"

# Names and headers that a terminal would obey.
name="a${escape}[31m
b.pcd"
refused 1 'a\\x1b\[31m\\nb.pcd' segment "$name" -o result
refused 2 '\\x1b\[31m' segment scan.pcd -o result "--${escape}[31m"
refused 2 '\\x1b\[31m' "${escape}[31m"
printf 'VERSION .7\nFIELDS x y \033[31m\nSIZE 4 4 4\n' > header.pcd
refused 1 "header.pcd" segment header.pcd -o result
printf '1 2 \033[31m\n' > text.xyz
refused 1 '\\x1b\[31m' segment text.xyz -o result

# Paths of nearly 4,000 characters, and longer than the system allows.
part=$(printf '%0200d' 0)
(
  for _ in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19; do
    mkdir "$part" && cd "$part" || exit 1
  done
  cp "$folder/scan.pcd" .
)
deep=$(find . -type d -empty -o -name scan.pcd -path '*/000*' -printf '%h' | head -n 1)
# shellcheck disable=SC2086 # options are words
if [ "${#deep}" -gt 3800 ]; then
  "$program" segment "$deep/scan.pcd" -o "$deep/out" $options --quiet || fail "a path of ${#deep} characters"
  [ -s "$deep/out/report.json" ] || fail "a path of ${#deep} characters has no report"
fi
refused 1 "cannot read" segment "$deep/$part/$part/scan.pcd" -o result
rm -rf "$part"

# No files: pipes and devices, which end never or once.
mkfifo pipe
for device in pipe /dev/null /dev/zero /dev/full .; do
  [ -e "$device" ] || continue
  refused 1 "$device" segment "$device" -o result
  refused 1 "$device" simulate wreck --points 100 -o "$device"
done
for device in pipe /dev/null scan.pcd scan.pcd/below; do
  # shellcheck disable=SC2086
  refused 1 "$device" segment scan.pcd -o "$device" $options
done
[ -p pipe ] && [ -c /dev/null ] || fail "a device was replaced"
[ ! -e result ] || fail "a refusal wrote something"

# Disk full in the middle, by the limit of a file's size, at any place: the older results stay.
# shellcheck disable=SC2086
"$program" segment scan.pcd -o kept $options --quiet || fail "segment"
sha256sum kept/* > sums
for blocks in 1 40 200 1000; do
  # shellcheck disable=SC2086
  (ulimit -f $blocks && "$program" segment scan.pcd -o kept $options --max-slope 0.3 > out 2> err)
  status=$?
  [ $status -eq 1 ] || fail "a file of more than $blocks blocks gave $status: $(head -c 300 err)"
  none_half_written "a full disk"
done
sha256sum --quiet -c sums > out 2>&1 || fail "a full disk damaged older results: $(head -n 3 out)"
# shellcheck disable=SC2086
(ulimit -v 400000 && "$program" segment scan.pcd -o small --cell-size 0.0005 --max-object-size 1 > out 2> err)
[ $? -le 1 ] || fail "too little memory ended otherwise than by 0 or 1: $(head -c 300 err)"

# Two runs on one folder: both may end well, or one says why not; the files are all of one of them.
"$program" simulate wreck -o large.pcd --points 400000 --quiet || fail "no large scan"
"$program" segment large.pcd -o shared --cell-size 0.02 --max-object-size 1 --quiet 2> err.1 &
first=$!
"$program" segment large.pcd -o shared --cell-size 0.02 --max-object-size 1.1 --quiet 2> err.2 &
second=$!
wait $first
status_1=$?
wait $second
status_2=$?
[ "$status_1$status_2" = 00 ] || [ "$status_1$status_2" = 01 ] || [ "$status_1$status_2" = 10 ] ||
  fail "two runs gave $status_1 and $status_2"
for n in 1 2; do
  [ ! -s err.$n ] || grep -q "another run is writing" err.$n || fail "of two runs one said: $(cat err.$n)"
done
none_half_written "two runs"

# Killed at any time: what is there is whole, and the next run cleans up.
for wait in 0.05 0.1 0.15 0.2 0.3 0.4 0.6; do
  "$program" segment large.pcd -o killed --cell-size 0.02 --max-object-size 1 --quiet 2> err &
  process=$!
  sleep $wait
  kill -9 $process 2> /dev/null
  wait $process 2> /dev/null
done
"$program" segment large.pcd -o killed --cell-size 0.02 --max-object-size 1 --quiet || fail "a run after killed ones"
none_half_written "a run after killed ones"
"$program" segment large.pcd -o whole --cell-size 0.02 --max-object-size 1 --quiet || fail "a run of its own"
for file in labelled.pcd ground_surface.asc segments.csv labels.png; do
  cmp -s killed/$file whole/$file || fail "after killed runs $file differs"
done

# The output inside of the input: the results are no sub-maps of the next run.
"$program" simulate survey wreck -o survey --points 3000 --quiet || fail "no survey"
submaps=$(find survey -name '*.pcd' | wc -l)
refused 2 "would lie among the sub-maps" survey survey -o survey
for _ in once again; do
  "$program" survey survey -o survey/results --quiet --json > out 2> err || fail "results inside of the survey: $(cat err)"
  grep -q "\"submaps\": $submaps" out || fail "results were taken for sub-maps: $(grep submaps out)"
done

[ "$failures" -eq 0 ] && echo "passed"
exit "$failures"
