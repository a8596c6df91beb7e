#!/usr/bin/env bash
# The whole program under ThreadSanitizer for minutes: the window's loop draws off-screen, the servo
# mills, workers mesh, the recorder writes, and a simulated user mills, undoes, redoes and resets
# without pause. The test passes if ThreadSanitizer reports nothing. ./test does the same for 15
# seconds.
#
#     scripts/tsan_long.sh [SECONDS]      default: 300
set -euo pipefail
cd "$(dirname "$0")/.."
seconds=${1:-300}
[[ $seconds =~ ^[0-9]+$ ]] || { echo "usage: scripts/tsan_long.sh [SECONDS]" >&2; exit 2; }
cmake --preset tsan -DBURR_READER=ON >/dev/null
cmake --build build/tsan --target test_window
export TSAN_OPTIONS="halt_on_error=1 second_deadlock_stack=1 suppressions=$PWD/scripts/checks/tsan_suppressions.txt"
BURR_WINDOW_SECONDS=$seconds exec build/tsan/test_window
