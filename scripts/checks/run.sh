#!/usr/bin/env bash
# `burr run`: with a screen the window opens and closes by itself; without a screen it mills alone
# and writes the files that it names, and the recording replays to the bit.
set -euo pipefail
burr=$(realpath "$1")/burr
folder=$(mktemp -d)
screen=
trap '[ -z "$screen" ] || kill "$screen" 2>/dev/null || true; rm -rf "$folder"' EXIT
fail() { echo "$*"; exit 1; }
has() { for file in "${@:2}"; do [ -s "$1/$file" ] || fail "$1: no $file"; done; }

# without a screen
(cd "$folder" && env -u DISPLAY -u WAYLAND_DISPLAY "$burr" run block --voxel-mm 0.5 --seconds 2 --out alone >alone.txt)
has "$folder/alone" before.png working.png after.png session.mcap summary.html
grep -q "^removed " "$folder/alone.txt" || fail "the figures are not told"
cmp -s "$folder/alone/before.png" "$folder/alone/after.png" && fail "nothing is seen to be removed"
"$burr" replay "$folder/alone/session.mcap" --check || fail "the session does not replay"
for name in one two; do "$burr" replay "$folder/alone/session.mcap" --sound "$folder/$name.wav" >/dev/null || fail "no sound of it"; done
cmp "$folder/one.wav" "$folder/two.wav" || fail "the same recording sounds differently"
[ "$(stat -c %s "$folder/one.wav")" = $((44 + 2 * 48000 * 2)) ] || fail "two seconds of sound have another length"
grep -q "$folder" "$folder/alone/summary.html" && fail "the summary names a folder"

# with one
if ! command -v Xvfb >/dev/null; then
  [ "${BURR_REQUIRE_DATA:-}" != 1 ] || fail "needs xvfb"
  echo "without xvfb the window is not tested"
  exit 77
fi
Xvfb -noreset -displayfd 3 -screen 0 1300x800x24 3>"$folder/display" 2>/dev/null &
screen=$!
for _ in $(seq 100); do [ -s "$folder/display" ] && break; sleep 0.1; done
[ -s "$folder/display" ] || fail "Xvfb does not start"
export XDG_CONFIG_HOME="$folder/config" XDG_STATE_HOME="$folder/state" XDG_CACHE_HOME="$folder/cache"
DISPLAY=:$(cat "$folder/display") SDL_VIDEODRIVER=x11 "$burr" run block --voxel-mm 0.5 --seconds 2 --out "$folder/window" >/dev/null
has "$folder/window" before.png after.png session.mcap summary.html
DISPLAY=:$(cat "$folder/display") "$burr" run block --voxel-mm 0.5 --seconds 1 || fail "without --out"
DISPLAY=:$(cat "$folder/display") "$burr" run --seconds 2 --screenshot "$folder/start.png" || fail "the start page"
has "$folder" start.png

# a display that burr cannot draw on: a sentence, the way without a window, and 74
refused() { # SENTENCE VARIABLE=VALUE...
  local sentence=$1 code=0
  shift
  env "$@" "$burr" run block --voxel-mm 0.5 --seconds 1 >/dev/null 2>"$folder/refused.txt" || code=$?
  [ $code = 74 ] || fail "$*: exit code $code"
  grep -q "^burr: $sentence.*burr run --headless, burr mill or burr picture" "$folder/refused.txt" || fail "$*: does not say what to do: $(cat "$folder/refused.txt")"
  grep -q "X Error" "$folder/refused.txt" && fail "$*: the X server's own error is shown"
  return 0
}
refused 'no window can be opened' DISPLAY=:987
# too old a driver; where its drivers lie differs from one Mesa to the next
refused 'OpenGL 3.3 or OpenGL ES 3.0 is not available' DISPLAY=":$(cat "$folder/display")" MESA_GL_VERSION_OVERRIDE=2.1 MESA_GLES_VERSION_OVERRIDE=2.0
# over ssh -X, GLX often makes no context; EGL does
DISPLAY=:$(cat "$folder/display") LIBGL_ALWAYS_INDIRECT=1 "$burr" run block --voxel-mm 0.5 --seconds 1 || fail "no window without a context of GLX"
# the display ends during a session: 74, and the recording is there
DISPLAY=:$(cat "$folder/display") "$burr" run block --voxel-mm 0.5 --out "$folder/lost" >/dev/null 2>"$folder/lost.txt" &
session=$!
for _ in $(seq 300); do [ -s "$folder/lost/session.mcap" ] && break; sleep 0.1; done
sleep 1
kill "$screen"
code=0
wait $session || code=$?
[ $code = 74 ] || fail "the display is lost: exit code $code: $(cat "$folder/lost.txt")"
grep -q '^burr: the connection to the display has ended' "$folder/lost.txt" || fail "the display is lost, and burr does not say so"
"$burr" replay "$folder/lost/session.mcap" --check >/dev/null || fail "what was recorded until the display was lost does not replay"
