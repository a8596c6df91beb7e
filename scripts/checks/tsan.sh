#!/usr/bin/env bash
# Runs a test under ThreadSanitizer, and once more if the sanitizer itself failed.
#
#     scripts/checks/tsan.sh TEST [ARGUMENT...]
#
# Its runtime sometimes asks for half a petabyte and ends the program (seen with test_device in some
# runs): "ThreadSanitizer failed to allocate". That says nothing about the program. A race, a failed
# test or a crash is never run again.
set -uo pipefail
said=$(mktemp)
trap 'rm -f "$said"' EXIT
for try in 1 2 3; do
  "$@" 2>&1 | tee "$said"
  code=${PIPESTATUS[0]}
  [ "$code" != 0 ] || exit 0
  grep -q 'ThreadSanitizer failed to allocate' "$said" || exit "$code"
  if grep -q 'WARNING: ThreadSanitizer\|  FAILED  \|: Failure' "$said"; then exit "$code"; fi
  echo "tsan.sh: the sanitizer itself gave up (try $try)"
done
exit "$code"
