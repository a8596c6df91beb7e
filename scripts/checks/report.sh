#!/usr/bin/env bash
# `burr report` and `burr compare` with the program: a page that is well formed, holds no address of
# the net and no markup from a case's text, is the same twice, and says what is unfinished.
#
#     scripts/checks/report.sh BUILD
set -uo pipefail
burr="$(realpath "$1")/burr --quiet"
page_is_sound="$(dirname "$(realpath "$0")")/page_is_sound.py"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
bad=0

complain() {
  echo "$*"
  bad=1
}
# says FILE TEXT...: the page holds each text
says() {
  local file=$1 text
  shift
  for text in "$@"; do grep -qF -- "$text" "$file" || complain "$(basename "$file") does not say: $text"; done
}
# refuses STATUS TEXT COMMAND...: fails with one sentence that holds the text
refuses() {
  local status=$1 text=$2 left
  shift 2
  "$@" >"$place/said" 2>"$place/err"
  left=$?
  [ $left = "$status" ] || complain "exits with $left in place of $status: $*"
  grep -qF -- "$text" "$place/err" || complain "$* says: $(cat "$place/err")"
}

# ---- a case whose title is markup, and a rubric for it
cat >"$place/groove.toml" <<'CASE'
format = 2
title = "<script>alert(1)</script> \"a\" & 'b'"
phantom = "block"
voxel_mm = 0.5
approach = [[0.0, 0.0, 1.0]]
[work]
at_mm = [0.0, 0.0, 15.0]
into = [0.0, 0.0, -1.0]
[burr]
diameter_mm = 6.0
rpm = 30000
[[structure]]
name = "nerve"
optional = true
[[region]]
name = "groove"
add = [{ shape = "capsule", from = [-15, 0, 15], to = [15, 0, 15], radius_mm = 2 }]
[[region]]
name = "wall"
add = [{ shape = "ball", at = [10, 10, 15], radius_mm = 4 }]
[reference]
remove = ["groove"]
CASE
cat >"$place/marks_of.toml" <<'RUBRIC'
[rubric]
name = "groove"
version = 1
case = "groove"
[[item]]
id = "groove.cut"
part = "product"
measure = "removed"
region = "groove"
say = "Cut the <i>groove</i>."
[[item]]
id = "wall.kept"
part = "product"
gate = true
measure = "kept"
region = "wall"
say = "Keep the wall."
[[item]]
id = "nerve.found"
part = "product"
measure = "identified"
structure = "nerve"
say = "Find the nerve."
[[item]]
id = "burr.choice"
part = "process"
measure = "burr_choice"
say = "Change the burr."
RUBRIC
printf '[marks]\n"groove.cut" = "met"\n"wall.kept" = "unknown"\n' >"$place/mine.toml"
for n in 2 3; do
  $burr run "$place/groove.toml" --headless --seconds "$n" --learner kestrel-27 --mode practise \
    --out "$place/out$n" >"$place/said" 2>&1 || complain "no session of $n s: $(cat "$place/said")"
  mv "$place/out$n/session.mcap" "$place/$n.mcap"
done
report="$burr report $place/2.mcap --rubric $place/marks_of.toml"

# ---- the page
$report --self "$place/mine.toml" --out "$place/a.html" >"$place/said" || complain "no report"
grep -qE 'a.html: 4 items, [4-9] pictures' "$place/said" || complain "says: $(cat "$place/said")"
$report --self "$place/mine.toml" --out "$place/b.html" >/dev/null
cmp -s "$place/a.html" "$place/b.html" || complain "two reports on one recording differ"
python3 "$page_is_sound" "$place/a.html" || bad=1
says "$place/a.html" 'Unfinished' 'No patient' 'kestrel-27' 'practise' 'uncalibrated default' 'data:image/png' \
  'The bone has no label of' 'do not know' 'Not validated' 'burr score 2.mcap --rubric marks_of.toml' \
  '&lt;script&gt;alert(1)' 'Cut the &lt;i&gt;groove'
grep -qE 'of 100 points|[Pp]assed' "$place/a.html" && complain "points, though no threshold is calibrated"
grep -qF "$place" "$place/a.html" && complain "the page holds a path of this machine"

# ---- in other languages, without pictures, beside another session
$report --language sv --pictures 0 --beside "$place/3.mcap" --out "$place/sv.html" >/dev/null || complain "no Swedish report"
python3 "$page_is_sound" "$place/sv.html" || bad=1
says "$place/sv.html" 'lang="sv"' 'Oavslutat' 'Ingen patient' 'Expert'
grep -qF 'data:image' "$place/sv.html" && complain "pictures in spite of --pictures 0"

# ---- two sessions
$burr compare "$place/2.mcap" "$place/3.mcap" --rubric "$place/marks_of.toml" --pictures 4 --out "$place/two.html" >"$place/said" ||
  complain "cannot compare"
grep -qF 'groove.cut' "$place/said" || complain "compare prints no items"
python3 "$page_is_sound" "$place/two.html" || bad=1
says "$place/two.html" 'Two sessions' 'B: 3.mcap'

# ---- mistakes
printf '[marks]\n"groove.cutt" = "met"\n' >"$place/wrong.toml"
refuses 65 'wrong.toml: line 2: groove.cutt' $report --self "$place/wrong.toml" --out "$place/c.html"
printf '[marks]\n"groove.cut" = "yes"\n' >"$place/wrong.toml"
refuses 65 'must be "met", "not met" or "unknown"' $report --self "$place/wrong.toml" --out "$place/c.html"
refuses 2 'must end in .html' $report --out "$place/c.pdf"
[ -e "$place/c.html" ] && complain "a page in spite of the mistake"
exit $bad
