#!/usr/bin/env bash
# Makes the pictures of the guide and of the README again, beside this script, by the commands that their pages name.
#
#   examples/guide/make_pictures.sh PROGRAM [all]      the survey's two pictures, which take minutes, with `all` only
set -euo pipefail

program=$(realpath -e "$1")
guide=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# segment NAME OPTION...: the results in a folder of that name.
segment() { "$program" segment wreck.pcd -o "$1" --quiet "${@:2}"; }

"$program" simulate wreck -o wreck.pcd --quiet
segment fitting --max-object-size 1
segment small --max-object-size 0.15
segment low --max-object-size 1 --height-tolerance 0.002
segment high --max-object-size 1 --height-tolerance 0.06
segment cells --max-object-size 1 --cell-size 0.1
segment smooth --max-object-size 1 --finest-wavelength 1.5
segment contact --max-object-size 1 --clusters contact
segment heaps --max-object-size 1 --min-object-size 0.5
segment published --max-object-size 1 --method fft-lowpass
cp fitting/elevation.png "$guide/wreck_elevation.png"
cp fitting/labels.png "$guide/wreck_labels.png"
cp fitting/segments.png "$guide/wreck_objects.png"
cp small/labels.png "$guide/tune_size_small.png"
cp low/labels.png "$guide/tune_tolerance_low.png"
cp high/labels.png "$guide/tune_tolerance_high.png"
cp fitting/ground.png "$guide/effect_none_ground.png"
cp smooth/ground.png "$guide/effect_finest_wavelength.png"
cp cells/labels.png "$guide/effect_cell_size.png"
cp published/labels.png "$guide/effect_lowpass.png"
cp contact/segments.png "$guide/effect_contact.png"
cp heaps/segments.png "$guide/effect_min_object_size.png"

if [ "${2:-}" = all ]; then
  "$program" simulate survey wreck -o survey --points 200000 --quiet
  "$program" align survey/submap_00.pcd survey/submap_01.pcd -o pair --max-object-size 1 --quiet
  cp pair/alignment.png "$guide/scan_alignment.png"
  "$program" survey survey -o site --max-object-size 1 --methods fft --quiet
  cp site/site_after.png "$guide/wreck_site.png"
fi
