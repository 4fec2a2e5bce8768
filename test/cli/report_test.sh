#!/usr/bin/env bash
# The pages of --report: whole or not at all, for each command, and, where Chromium is, as a reader sees them: no error on
# the console, a view that shows something and turns, the tables.
# Usage: report_test.sh PROGRAM; status 77 where there is no browser to try the pages in
set -euo pipefail
program=$(realpath -e "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
  echo "FAILED: $1"
  exit 1
}

"$program" simulate wreck -o 'a <b>&.pcd' --points 40000 --quiet
"$program" segment 'a <b>&.pcd' -o result --max-object-size 1 --quiet --report result/segment.html
"$program" evaluate 'a <b>&.pcd' --methods planar,fft --max-object-size 1 --quiet --report evaluate.html >/dev/null
"$program" simulate survey wreck -o survey --points 20000 --quiet
"$program" align survey/submap_00.pcd survey/submap_01.pcd -o pair --max-object-size 1 --quiet --report align.html
mkdir site && cp survey/submap_0[0-3].pcd site
"$program" survey site -o map --max-object-size 1 --methods fft --quiet --report survey.html

# A page that cannot be written is told before the work, and nothing is left of it.
status=0
"$program" segment 'a <b>&.pcd' -o other --report nowhere/page.html 2>error || status=$?
[ "$status" -eq 1 ] || fail "a folder that is not there gave $status, not 1"
grep -q "nowhere/page.html" error || fail "a folder that is not there is not told: $(cat error)"
[ ! -e other ] || fail "a page that could not be written left results"

for page in result/segment evaluate align survey; do
  grep -q '</html>' $page.html || fail "$page.html is not whole"
  ! grep -qE 'https?:' $page.html || fail "$page.html names an address"
done
grep -q '<h1>a &lt;b&gt;&amp;.pcd' result/segment.html || fail "the name of the file is not escaped"

grep -q '<th class="number">tpr</th>' result/segment.html || fail "the scores are not in their table"

browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)
if [ -z "$browser" ]; then
  echo "SKIPPED: THE PAGES WERE NOT TRIED IN A BROWSER, AS THERE IS NO CHROMIUM"
  exit 77
fi

# Tells what a reader would see in the attributes of the page's body.
cat >probe.html <<'TEXT'
<script>
window.addEventListener("load", () => setTimeout(() => {
  const canvas = document.getElementById("view"), gl = canvas.getContext("webgl"), told = document.body.dataset;
  const coloured = () => {
    const pixels = new Uint8Array(4 * canvas.width * canvas.height);
    gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let sum = 0, count = 0;
    for (let i = 0; i < pixels.length; i += 4) if (pixels[i + 3] > 0) { ++count; sum = (sum * 31 + i + pixels[i]) % 1000003; }
    return { share: count / (pixels.length / 4), sum };
  };
  const before = coloured(), yaw = canvas.dataset.yaw;
  const send = (type, x) => canvas.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: x, clientY: 200, buttons: 1 }));
  send("pointerdown", 200); send("pointermove", 320); send("pointerup", 320);
  let patience = 60;
  const look = () => {
    if (canvas.dataset.yaw === yaw && --patience > 0) return setTimeout(look, 50);
    const after = coloured();
    told.shown = before.share > 0.02 && after.share > 0.02;
    told.turned = canvas.dataset.yaw !== yaw && before.sum !== after.sum;
    told.rows = document.querySelectorAll("tbody tr").length;
    told.pictures = [...document.images].filter(image => image.naturalWidth > 100).length;
    told.fits = document.documentElement.scrollWidth <= window.innerWidth;
  };
  look();
}, 100));
</script>
TEXT

for page in result/segment evaluate align survey; do
  for width in 1200 500; do
    cat $page.html probe.html >tried.html
    timeout 120 "$browser" --headless=new --no-sandbox --use-angle=swiftshader --enable-unsafe-swiftshader \
      --user-data-dir="$folder/browser" --window-size=$width,900 --enable-logging=stderr --virtual-time-budget=5000 --dump-dom \
      "file://$folder/tried.html" >dom 2>log || fail "the browser did not show $page.html"
    ! grep CONSOLE log || fail "$page.html spoke on the console"
    body=$(grep -o '<body[^>]*>' dom || true)
    for word in 'data-shown="true"' 'data-turned="true"' 'data-fits="true"'; do
      case "$body" in *"$word"*) ;; *) fail "$page.html at $width pixels: not $word but $body" ;; esac
    done
    case "$body" in *'data-rows="0"'* | *'data-pictures="0"'*) fail "$page.html: $body" ;; esac
    echo "$page.html, $width pixels: $body"
  done
done
echo passed
