#!/usr/bin/env bash
# The disk refuses, or somebody removes the file: burr says so at once in one sentence, mills on to
# the end, says it again, and exits with 74; what was written until then opens and replays.
#
#     scripts/checks/recording_trouble.sh BUILD
#
# As root, two small disks (tmpfs) are mounted: one full, one read-only. Otherwise a limit on the
# size of files replaces the full disk, and a folder without permission the other.
set -uo pipefail
burr=$(realpath "$1")/burr
place=$(mktemp -d)
mounted=()
children=()
leave() {
  for child in "${children[@]}"; do kill "$child" 2>/dev/null; done
  for disk in "${mounted[@]}"; do umount "$disk" 2>/dev/null; done
  rm -rf "$place"
}
trap leave EXIT
bad=0
fail() {
  echo "$*"
  bad=1
}
block=(phantom:block --voxel-mm 0.5 --burr-mm 4 --motion pocket)
goes_on='the session continues without recording'

# check NAME CODE SENTENCE: the exit code and messages of the last burr, in NAME.err and NAME.out
check() {
  local name=$1 code=$2 sentence=$3
  [ "$code" = 74 ] || fail "$name: exit code $code instead of 74"
  [ "$(grep -c "$goes_on" "$place/$name.err")" = 1 ] || fail "$name: does not say once that it goes on"
  grep -q "$sentence" "$place/$name.err" || fail "$name: does not say '$sentence'"
  grep -q 'the session ended normally, but its recording is incomplete' "$place/$name.err" ||
    fail "$name: does not say it at the end"
  [ $bad = 0 ] || cat "$place/$name.err"
}
# account NAME SECONDS KEPT: the JSON says that everything was milled, and whether a file was kept
account() {
  python3 - "$place/$1.out" "$2" "$3" <<'END' || fail "$1: its figures are wrong"
import json, sys
said = json.loads(open(sys.argv[1]).read().splitlines()[-1])
recording = said["recording"]
print(sys.argv[1].split("/")[-1], recording)
assert abs(said["seconds"] - float(sys.argv[2])) < 0.002, said["seconds"]
assert recording["whole"] is False and recording["trouble"], recording
if recording["bytes"] > 0:  # the recording has a beginning
    assert recording["ticks"] + recording["dropped_ticks"] == said["ticks"], (recording, said["ticks"])
assert (recording["ticks"] > 0) == (sys.argv[3] == "kept"), recording
END
}
# replays NAME FILE: opens, and replays with the same result as far as it goes
replays() {
  "$burr" replay "$2" --check >"$place/replay.txt" 2>&1 || {
    fail "$1: what was kept does not replay"
    cat "$place/replay.txt"
  }
}

# ---- the disk is full
if [ "$(id -u)" = 0 ] && mkdir "$place/small" && mount -t tmpfs -o size=1m tmpfs "$place/small" 2>/dev/null; then
  mounted+=("$place/small")
  "$burr" --quiet mill "${block[@]}" --seconds 12 --record "$place/small/s.mcap" --json >"$place/full.out" 2>"$place/full.err"
  check full $? 'No space left on device; free some space'
  account full 12 kept
  replays full "$place/small/s.mcap"
fi
(
  ulimit -f 900 # KiB
  exec "$burr" --quiet mill "${block[@]}" --seconds 12 --record "$place/limit.mcap" --json >"$place/limit.out" 2>"$place/limit.err"
)
check limit $? 'limit.mcap: cannot be written further: File too large; raise the limit'
account limit 12 kept
replays limit "$place/limit.mcap"

# ---- nobody may write there
if [ "$(id -u)" = 0 ]; then
  if mkdir "$place/sealed" && mount -t tmpfs -o ro tmpfs "$place/sealed" 2>/dev/null; then
    mounted+=("$place/sealed")
  fi
else
  mkdir -m 555 "$place/sealed"
fi
if [ -d "$place/sealed" ] && ! touch "$place/sealed/probe" 2>/dev/null; then
  "$burr" --quiet mill "${block[@]}" --seconds 2 --record "$place/sealed/s.mcap" --json >"$place/sealed.out" 2>"$place/sealed.err"
  check sealed $? 's.mcap: cannot be written: .*; choose a folder'
  account sealed 2 nothing
fi

# ---- somebody removes the file, or its folder, during the recording
for what in file folder; do
  mkdir "$place/$what"
  "$burr" --quiet mill "${block[@]}" --seconds 3 --realtime --record "$place/$what/s.mcap" --json \
    >"$place/$what.out" 2>"$place/$what.err" &
  child=$!
  children+=("$child")
  for _ in $(seq 600); do [ -s "$place/$what/s.mcap" ] && break; sleep 0.05; done
  [ "$what" = file ] && rm "$place/$what/s.mcap"
  [ "$what" = folder ] && rm -r "${place:?}/$what"
  wait "$child"
  check "$what" $? 'was removed while it was being recorded'
  python3 - "$place/$what.out" <<'END' || fail "$what: it did not mill to the end"
import json, sys
said = json.loads(open(sys.argv[1]).read().splitlines()[-1])
assert said["removed_mm3"] > 0 and not said["recording"]["whole"], said
END
done

# ---- an impossible file name is refused before anything is milled
"$burr" --quiet mill "${block[@]}" --seconds 2 --record "$place/no/such/s.mcap" >"$place/typo.out" 2>"$place/typo.err"
[ $? = 74 ] || fail "a folder that is not there: not refused"
grep -q 'no/such/s.mcap' "$place/typo.err" || fail "a folder that is not there is not named"
[ -s "$place/typo.out" ] && fail "a folder that is not there: milled all the same"

# ---- the page of figures: `burr run --headless`, whose recording becomes too large
(
  ulimit -f 600 # KiB: enough for the pictures
  exec "$burr" --quiet run block --headless --voxel-mm 0.5 --seconds 30 --out "$place/run" >"$place/run.out" 2>"$place/run.err"
)
check run $? 'session.mcap: cannot be written further: File too large'
grep -q '^removed ' "$place/run.out" || fail "run: the figures are not told"
replays run "$place/run/session.mcap"
exit $bad
