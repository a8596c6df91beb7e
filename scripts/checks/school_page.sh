#!/usr/bin/env bash
# The instructor's page, in Chromium without a screen (tests/school/page_test.py).
#
#     scripts/checks/school_page.sh BUILD [PICTURES]      PICTURES: a folder that keeps the screenshots
#
# Chromium is large: where it is missing, the check is left out (exit 77), unless BURR_REQUIRE_TOOLS=1.
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
if ! command -v chromium >/dev/null; then
  echo "school page: chromium is missing (section [tools] of scripts/packages.txt)"
  [ "${BURR_REQUIRE_TOOLS:-0}" != 1 ] || exit 1
  exit 77
fi
python3 tests/school/page_test.py "$build/burr" ${2:+"$2"}
