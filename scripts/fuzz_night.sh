#!/usr/bin/env bash
# A night of fuzzing: every reader for some minutes; useful inputs are kept for the next night.
#
#     scripts/fuzz_night.sh [--minutes N] [NAME ...]      default: 10 minutes each of all targets
#
# Useful inputs are kept in build/asan/fuzz/corpus/; those that break a reader in .../found/.
set -uo pipefail
cd "$(dirname "$0")/.."
minutes=10
names=()
while [ $# -gt 0 ]; do
  case $1 in
    --minutes) minutes=${2:?--minutes needs a number}; shift ;;
    -h | --help) sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 0 ;;
    -*) echo "usage: scripts/fuzz_night.sh [--minutes N] [NAME ...]      ($1 is not known)" >&2; exit 2 ;;
    *) names+=("$1") ;;
  esac
  shift
done
case $minutes in '' | *[!0-9]*) echo "fuzz_night.sh: --minutes needs a whole number" >&2; exit 2 ;; esac
if [ ${#names[@]} -eq 0 ]; then
  for file in fuzz/*_fuzz.cpp; do
    name=${file#fuzz/}
    names+=("${name%_fuzz.cpp}")
  done
fi

cmake --preset asan >/dev/null && cmake --build --preset asan --target fuzzers && scripts/checks/fuzz.sh seeds || exit 1
export BURR_FUZZ_SEED=${BURR_FUZZ_SEED:-$(date +%j%H%M)}

bad=()
for name in "${names[@]}"; do
  corpus=build/asan/fuzz/corpus/$name
  log=build/asan/fuzz/$name.log
  touch build/asan/fuzz/began
  echo "== $name: $minutes minutes, seed $BURR_FUZZ_SEED"
  if scripts/checks/fuzz.sh "$name" $((minutes * 60)) "$corpus" >"$log" 2>&1; then
    # of the inputs that reach the same code, the smallest are kept
    mkdir -p "$corpus.small"
    if "build/asan/fuzz/fuzz_$name" -merge=1 "$corpus.small" "$corpus" "build/asan/fuzz/seeds/$name" >/dev/null 2>&1; then
      rm -rf "$corpus" && mv "$corpus.small" "$corpus"
    fi
    grep -E '^stat::(number_of_executed_units|average_exec_per_sec|peak_rss_mb)' "$log"
    grep -oE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -1
    continue
  fi
  bad+=("$name")
  tail -40 "$log"
  while IFS= read -r -d '' found; do
    echo "-- making $found smaller"
    "build/asan/fuzz/fuzz_$name" -minimize_crash=1 -max_total_time=120 "-exact_artifact_path=$found.small" "$found" >/dev/null 2>&1
    [ -s "$found.small" ] || cp "$found" "$found.small"
    echo "   see it again:  build/asan/fuzz/fuzz_$name $found.small"
  done < <(find build/asan/fuzz/found -name "$name-*" ! -name '*.small' -newer build/asan/fuzz/began -print0)
done

[ ${#bad[@]} -gt 0 ] || exit 0
cat <<'TEXT'

Something was found. For each: run it again as said above, read the stack, mend the reader so that it
refuses in one sentence, write the few bytes that matter into a test in tests/ (not the file itself),
see the test fail without the mend, and run the night again. docs/develop/fuzzing.md says more.
TEXT
echo "found in: ${bad[*]}"
exit 1
