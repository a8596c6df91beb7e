#!/usr/bin/env bash
# The page, burr in a browser: opens, mills, records, in Chromium without a screen (web/tests/page_test.py), and
# has the course of a session: steps, score, report, sound (web/tests/course_test.py). The page is the one that scripts/checks/portable.sh
# web has built. First its codecs, by node (tests/web/page_codecs.h); at the end the page as it is shipped (web/tests/shipped_test.py).
# more: no work is lost (web/tests/loss_test.py), any screen (web/tests/screens_test.py); a test of its own, because all of it in one
# takes too long. framed: in another page, and as a course (web/tests/embed_test.py); npm: the package burr-core (web/tests/npm_test.py).
# firefox: the whole course in another browser (web/tests/firefox_test.py).
#
#     scripts/checks/page.sh BUILD [more|framed|npm|firefox] [PICTURES]      PICTURES: a folder that keeps the screenshots
#
# The tools are large: where one is missing, the check is left out (exit 77), unless BURR_REQUIRE_TOOLS=1.
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
shift
part=
case ${1:-} in more | framed | npm | firefox) part=$1 && shift ;; esac
for tool in em++ node npm chromium; do
  if ! command -v "$tool" >/dev/null; then
    echo "page: $tool is missing (section [tools] of scripts/packages.txt)"
    [ "${BURR_REQUIRE_TOOLS:-0}" != 1 ] || exit 1
    exit 77
  fi
done
[ -f build/web/published/version.json ] || { echo "page: is not built; run scripts/checks/portable.sh web $build first"; exit 1; }

case $part in
  more)
    python3 web/tests/loss_test.py build/web/site "$build/burr" ${1:+"$1"}
    exec python3 web/tests/screens_test.py build/web/site build/web/axe ${1:+"$1"}
    ;;
  framed) exec python3 web/tests/embed_test.py build/web/site build/web/burr-cmi5.zip "$build/burr" ${1:+"$1"} ;;
  firefox) exec python3 -B web/tests/firefox_test.py build/web/site "$build/burr" ;;
  npm) exec python3 web/tests/npm_test.py build/web/burr-core "$build" ${1:+"$1"} ;;
esac

# the modules and pages as they were built; then the folder that a user gets, which is these in another order
BURR_SITE=build/web/site "$build/test_web" --gtest_brief=1 --gtest_filter='PageCodecs*'
python3 web/tests/page_test.py build/web/site "$build/burr" ${1:+"$1"}
python3 web/tests/course_test.py build/web/site "$build/burr" ${1:+"$1"}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$build/burr" web --out "$out/page"
diff -r build/web/published "$out/page"
diff -r build/web/site "$out/page"/v-* | grep -vE '^Only in .*(\.(gz|br|html)|: offline\.js)$' && { echo "page: other parts than those that were built"; exit 1; }
python3 web/tests/shipped_test.py "$out/page" ${1:+"$1"}
