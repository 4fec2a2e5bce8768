#!/usr/bin/env bash
# The manual pages, the command reference and the completion say all that --help says.
# Usage: help_pages_test.sh PROGRAM MAKER VERSION, the maker being cmake/help_pages.sh
set -euo pipefail
program=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$2" "$program" "$3" "$folder"

fail() {
  echo "FAILED: $1"
  exit 1
}

# shellcheck source=/dev/null
. "$folder/pcl_fft_ground.bash"

# completed WORD...: what the completion offers for the last word.
completed() {
  COMP_WORDS=(pcl_fft_ground "$@") COMP_CWORD=$# COMPREPLY=()
  _pcl_fft_ground
  echo "${COMPREPLY[*]}"
}

for command in segment evaluate align survey simulate "simulate survey"; do
  # shellcheck disable=SC2206  # words of a command
  words=($command)
  page=$(zcat "$folder/pcl_fft_ground-${command// /-}.1.gz" | sed 's/\\-/-/g')
  reference=$(awk -v heading="## $command" '$0 == heading { on = 1; next } /^## / { on = 0 } on' "$folder/commands.md")
  count=0
  while read -r option; do
    grep -q -- "^\.B .*$option\b" <<<"$page" || fail "the manual page of $command has no $option"
    grep -q -- "^| \`.*$option\b" <<<"$reference" || fail "the reference of $command has no $option"
    [[ " $(completed "${words[@]}" "$option") " == *" $option "* ]] || fail "$command: $option is not completed"
    count=$((count + 1))
  done < <("$program" "${words[@]}" --help | grep -oE '^  (-[a-z] \[ )?--[a-z-]+' | grep -oE -- '--[a-z-]+')
  [ $count -ge 10 ] || fail "$command has $count options only"
  grep -q '^pcl_fft_ground-.* - [a-z]' <<<"$page" || fail "the manual page of $command says not what it does"
  echo "$command: $count options"
done
[ "$(completed al)" = align ] || fail "a command is completed to '$(completed al)'"
[ "$(completed simulate re)" = reef ] || fail "a scene is completed to '$(completed simulate re)'"
if command -v man >/dev/null; then
  for page in "$folder"/*.gz; do
    warnings=$(MANWIDTH=100 man --warnings -l "$page" 2>&1 >/dev/null)
    [ -z "$warnings" ] || fail "$page: $warnings"
  done
fi
echo passed
