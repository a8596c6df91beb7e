#!/usr/bin/env bash
# ./run, ./test and the program refuse what they cannot do: the right exit code, one sentence, no core.
#
#     scripts/checks/refuses.sh BUILD
set -uo pipefail
source "$(dirname "$0")/files.sh"
burr=$(realpath "$1")/burr
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
bad=0

# expect CODE WORDS COMMAND...: exits with CODE and prints WORDS (a regular expression) on stderr
expect() {
  local code=$1 words=$2 got
  shift 2
  "$@" >"$place/out" 2>"$place/err" </dev/null
  got=$?
  if [ $got != "$code" ]; then
    echo "exit code $got instead of $code: $*"
    head -5 "$place/err"
    bad=1
  elif [ -n "$words" ] && ! cat "$place/err" "$place/out" | grep -qiE "$words"; then
    echo "does not say '$words': $*"
    head -5 "$place/err"
    bad=1
  fi
}

printf 'not a volume\n' >"$place/rubbish.nrrd"
: >"$place/empty.nii.gz"

expect 0 '^burr [0-9]+\.[0-9]+\.[0-9]+' "$burr" --version
expect 0 'examples' "$burr" help
expect 0 'usage' "$burr" --help
expect 2 'needs a window' "$burr" run block --headless --device touch
expect 2 'needs a window' env -u DISPLAY -u WAYLAND_DISPLAY "$burr" run block --suction touch
all=$("$burr" --help)  # once: grep -q goes away early
expect 2 '' "$burr" no-such-command
expect 2 '' "$burr" --no-such-option
for command in info mill export replay repair phantom run psychophysics; do
  grep -qE "^  $command( |$)" <<<"$all" || continue
  expect 2 '' "$burr" $command --no-such-option
  expect 0 '' "$burr" $command --help
done
expect 2 'usage' ./test --no-such-option
expect 2 'usage' scripts/install_packages.sh nonsense
expect 2 'bookworm.trixie' scripts/bare_debian.sh run # without the release
expect 2 'bookworm.trixie' scripts/bare_debian.sh sid run
expect 2 '' scripts/rooms.py --no-such-option

if grep -qE '^  info' <<<"$all"; then
  expect 2 '' "$burr" info
  expect 74 'file.nrrd' "$burr" info "$place/no/such/file.nrrd"
  expect 65 'rubbish' "$burr" info "$place/rubbish.nrrd"
  expect 65 'empty' "$burr" info "$place/empty.nii.gz"
fi
if grep -qE '^  mill' <<<"$all"; then
  expect 65 'no-such-tool.*fissure-bur' "$burr" mill phantom:block --motion slot --tool no-such-tool
  expect 2 '[-][-]tool' "$burr" mill phantom:block --motion slot --tools tools/tools.toml
fi
if grep -qE '^  replay' <<<"$all"; then
  expect 74 'no/such' "$burr" replay "$place/no/such.mcap"
  expect 65 'rubbish' "$burr" replay "$place/rubbish.nrrd"
fi
if grep -qE '^  psychophysics' <<<"$all"; then
  expect 2 'stiffness' "$burr" psychophysics
  expect 2 '' "$burr" psychophysics colour
  expect 2 'trials' "$burr" psychophysics stiffness --trials 3
  expect 2 'standard' "$burr" psychophysics friction --standard 0
  expect 2 'largest' "$burr" psychophysics stiffness --standard 900
  expect 2 'largest' "$burr" psychophysics vibration --largest 0.5
  expect 2 'smallest' "$burr" psychophysics stiffness --smallest 0.9
  expect 2 'seconds' "$burr" psychophysics stiffness --seconds 0.5
  expect 2 'until' "$burr" psychophysics stiffness --until 0.001
  expect 2 'code' "$burr" psychophysics stiffness --subject 'Jane Doe'
  expect 2 'code' "$burr" psychophysics stiffness --subject abcdefghijklmnopq
  expect 2 'threshold' "$burr" psychophysics stiffness --observer slope=2
  expect 2 'threshold' "$burr" psychophysics stiffness --observer threshold=-1
  expect 2 'slope' "$burr" psychophysics stiffness --observer threshold=0.1,slope=2,feels=yes
  expect 74 'continue' "$burr" psychophysics --continue "$place/none"
fi

# When the reader of burr's output ends early, burr ends quietly like other programs; a full disk is
# reported.
reader_gone() {
  local got
  mkfifo "$place/pipe"
  exec 7<>"$place/pipe" 8>"$place/pipe" 7<&-  # 8 is a pipe that nobody reads
  "$@" >&8 2>"$place/err" </dev/null
  got=$?
  exec 8>&-
  rm "$place/pipe"
  if [ $got != 141 ] || [ -s "$place/err" ]; then
    echo "exit code $got and '$(head -1 "$place/err")' instead of 141 and silence when nobody reads: $*"
    bad=1
  fi
}
reader_gone "$burr" materials
reader_gone "$burr" --help
reader_gone "$burr" help
reader_gone "$burr"
full() {
  "$@" >/dev/full 2>"$place/err" </dev/null
  local got=$?
  if [ $got != 74 ] || ! grep -q 'standard output' "$place/err"; then
    echo "exit code $got instead of 74 on a full disk: $*"
    bad=1
  fi
}
full "$burr" materials
full "$burr" help

# What a case says of a session is checked by all who read the case, with one sentence.
printf 'title = "x"\nphantom = "block"\n[burr]\ndiameter_mm = 5\nrpm = 1000\n[session]\ntorque_mnm = -1\n' >"$place/session.toml"
said='session.toml: line 7: session.torque_mnm: must be a number from'
expect 65 "$said" "$burr" rubric check block --case "$place/session.toml"
expect 65 "$said" "$burr" case check "$place/session.toml"
expect 65 "$said" "$burr" mill "$place/session.toml" --motion slot --seconds 1

# A sentence of the library names its fields; the program says what can be typed, and only what this command has.
expect 2 'a phantom is a formula: only --voxel-mm and --materials apply' "$burr" mill phantom:block --motion slot --roi 1,2,3,4,5,6
expect 2 '^--roi: "1,2" is not six whole numbers' "$burr" info phantom:block --roi 1,2
expect 2 '^burr: --motion nowhere is not known' "$burr" mill phantom:block --motion nowhere

exit $bad
