#!/usr/bin/env bash
# Searches for inputs that break one reader. Needs the build of `cmake --preset asan`.
#
#     scripts/checks/fuzz.sh NAME [SECONDS [CORPUS]]     NAME: of a target, as in fuzz/NAME_fuzz.cpp
#     scripts/checks/fuzz.sh seeds                       makes the first inputs
#
# CORPUS keeps the inputs found useful. Without it each run begins with the seeds alone, and
# BURR_FUZZ_SEED (default 1) seeds the random numbers. Inputs that break a reader are in
# build/asan/fuzz/found/.
set -euo pipefail
cd "$(dirname "$0")/../.."
name=${1:?which target?}
seconds=${2:-20}
build=build/asan/fuzz

if [ "$name" = seeds ]; then
  collection=()
  if [ -d ../shared/data/corpus ]; then collection=(../shared/data/corpus); fi
  exec "$build/fuzz_seeds" "$build/seeds" . "${collection[@]}"
fi

[ -x "$build/fuzz_$name" ] || { echo "fuzz.sh: there is no fuzz_$name; build it: cmake --build --preset asan --target fuzzers" >&2; exit 2; }
corpus=${3:-}
if [ -z "$corpus" ]; then
  corpus=$(mktemp -d)
  trap 'rm -rf "$corpus"' EXIT
fi
mkdir -p "$corpus" "$build/found"
words=()
if [ -f "fuzz/${name#seg_}.dict" ]; then words=("-dict=fuzz/${name#seg_}.dict"); fi

export UBSAN_OPTIONS=print_stacktrace=1
code=0
log=$(mktemp)
touch "$log.began"
"$build/fuzz_$name" "-seed=${BURR_FUZZ_SEED:-1}" "-max_total_time=$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
  -max_len=16384 -print_final_stats=1 "-artifact_prefix=$build/found/$name-" "${words[@]}" "$corpus" "$build/seeds/$name" >"$log" 2>&1 || code=$?
if [ "$code" -eq 0 ]; then
  grep -E '^#[0-9]+' "$log" | tail -n 1
  grep -E '^(Done|stat::)' "$log"
else
  # not the thousand lines about progress: only what went wrong, and the input itself
  grep -vE '^(#[0-9]+|INFO:)' "$log" | cut -c1-400 | tail -n 120
  find "$build/found" -name "$name-*" -newer "$log.began" -size -16k -exec sh -c 'echo "-- $1 in base64:"; base64 "$1"' sh {} \;
  echo "fuzz.sh: $name cannot bear an input; see docs/develop/fuzzing.md, \"Something was found\"" >&2
fi
rm -f "$log" "$log.began"
exit "$code"
