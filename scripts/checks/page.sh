#!/usr/bin/env bash
# The page, burr in a browser: opens, mills, records, in Chromium without a screen (web/tests/page_test.py), and
# has the course of a session: steps, score, report, sound (web/tests/course_test.py); no work is lost (web/tests/loss_test.py), and it is
# right on any screen (web/tests/screens_test.py). The page is the one that scripts/checks/portable.sh web has built. First its codecs, by
# node (tests/web/page_codecs.h).
#
#     scripts/checks/page.sh BUILD [PICTURES]      PICTURES: a folder that keeps the screenshots
#
# The tools are large: where one is missing, the check is left out (exit 77), unless BURR_REQUIRE_TOOLS=1.
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
for tool in em++ node npm chromium; do
  if ! command -v "$tool" >/dev/null; then
    echo "page: $tool is missing (section [tools] of scripts/packages.txt)"
    [ "${BURR_REQUIRE_TOOLS:-0}" != 1 ] || exit 1
    exit 77
  fi
done
[ -f build/web/site/burr_page.wasm ] || { echo "page: is not built; run scripts/checks/portable.sh web $1 first"; exit 1; }

# the folder that a user gets is what is tested
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$build/burr" web --out "$out/page"
diff -r build/web/site "$out/page"
"$build/burr" web --out "$out/page" >"$out/again"  # an older page is replaced
touch "$out/mine"
if "$build/burr" web --out "$out" 2>"$out/said"; then echo "page: burr web wrote into a folder with other files"; exit 1; fi
grep -q "holds other files" "$out/said"
BURR_SITE=$out/page "$build/test_web" --gtest_brief=1 --gtest_filter='PageCodecs*'
python3 web/tests/page_test.py "$out/page" "$build/burr" ${2:+"$2"}
python3 web/tests/course_test.py "$out/page" "$build/burr" ${2:+"$2"}
python3 web/tests/loss_test.py "$out/page" "$build/burr" ${2:+"$2"}
python3 web/tests/screens_test.py "$out/page" build/web/axe ${2:+"$2"}
