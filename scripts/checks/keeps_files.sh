#!/usr/bin/env bash
# No command destroys a file of the user: not what it reads, not a file of another kind, not a recording or a volume
# without --force. And nothing that happens to stdout, stderr or the process ends a session without its recording.
#
#     scripts/checks/keeps_files.sh BUILD
set -uo pipefail
burr="$(realpath "$1")/burr --quiet"
place=$(mktemp -d)
trap 'chmod -R u+w "$place"; rm -rf "$place"' EXIT
cd "$place" || exit 1
bad=0
complain() { echo "$1"; bad=1; }

# refused WORDS COMMAND...: exits with 2 or 74, prints WORDS, and leaves every file as it is
refused() {
  local words=$1 before after code
  shift
  before=$(find . -type f -exec sha256sum {} + | sort)
  "$@" >.out 2>.err </dev/null
  code=$?
  rm -f .out.old
  after=$(find . -type f ! -name .out ! -name .err -exec sha256sum {} + | sort)
  before=$(grep -v ' \./\.\(out\|err\)$' <<<"$before")
  [ "$code" = 2 ] || [ "$code" = 74 ] || complain "exit code $code: $*: $(head -2 .err)"
  grep -qE "$words" .err || complain "does not say '$words': $*: $(head -2 .err)"
  [ "$before" = "$after" ] || complain "changed a file: $*"
}
# allowed COMMAND...
allowed() { "$@" >.out 2>.err </dev/null || complain "exit code $?: $*: $(head -2 .err)"; }

allowed $burr export phantom:ball --out scan.nrrd
allowed $burr phantom block --voxel-mm 1 --out other.nrrd
ln -s scan.nrrd link.nrrd
ln scan.nrrd hard.nrrd
mkdir ct && cp scan.nrrd ct/scan.nrrd && cp scan.nrrd ct/005.png
printf 't,x_mm,y_mm,z_mm\n0,0,0,60\n0.05,0,0,60\n' >path.csv

# what is read
refused 'reads' $burr export scan.nrrd --out scan.nrrd
refused 'reads' $burr export scan.nrrd --out link.nrrd
refused 'reads' $burr export link.nrrd --out ./ct/../scan.nrrd
refused 'reads' $burr export scan.nrrd --out hard.nrrd --force
refused 'reads' $burr picture ct/scan.nrrd --out ct/scan.nrrd.png --out ct/005.png
refused 'must end in .png' $burr picture scan.nrrd --out scan.nrrd
refused 'must end in .png' $burr picture scan.nrrd --out picture.jpg
refused 'must end in .mcap' $burr mill scan.nrrd --motion plunge --seconds 1 --record scan.nrrd
refused 'must end in .png' $burr mill scan.nrrd --motion plunge --seconds 1 --picture scan.nrrd
cp path.csv path.png
refused 'reads' $burr mill scan.nrrd --path path.png --picture path.png
# files of another kind, and files of the same kind that may be the only copy
cp path.csv notes.stl
refused 'not a .stl file' $burr export scan.nrrd --out notes.stl
cp scan.nrrd session.mcap
refused 'not a .mcap file' $burr mill scan.nrrd --motion plunge --seconds 1 --record session.mcap
refused 'force' $burr export scan.nrrd --out other.nrrd
allowed $burr export scan.nrrd --out other.nrrd --force
refused 'same file' $burr replay none.mcap --picture a.png --screenshot a.png
allowed $burr mill scan.nrrd --motion plunge --seconds 1 --record a.mcap --picture a.png
refused 'force' $burr mill scan.nrrd --motion plunge --seconds 1 --record a.mcap
refused 'must end in' $burr replay a.mcap --picture a.mcap
allowed $burr mill scan.nrrd --motion plunge --seconds 1 --record a.mcap --picture a.png --force
allowed $burr export a.mcap --volume scan.nrrd --out a.stl
allowed $burr export a.mcap --volume scan.nrrd --out a.stl
refused 'reads' $burr export a.mcap --volume scan.nrrd --out scan.nrrd --force
# places that cannot hold a result
mkfifo pipe.mcap
ln -s /dev/null null.mcap
mkdir folder.mcap
refused 'pipe or a device' $burr mill scan.nrrd --motion plunge --seconds 1 --record pipe.mcap
refused 'pipe or a device' $burr mill scan.nrrd --motion plunge --seconds 1 --record null.mcap
refused 'is a folder' $burr mill scan.nrrd --motion plunge --seconds 1 --record folder.mcap
refused 'does not exist' $burr mill scan.nrrd --motion plunge --seconds 1 --record none/a.mcap
odd=$'odd\xff.mcap'
"${burr% --quiet}" --quiet mill scan.nrrd --motion plunge --seconds 1 --record "$odd" --json >.out 2>.err </dev/null
[ $? = 0 ] && python3 -c 'import json; json.loads(open(".out").read().splitlines()[-1])' && [ -s "$odd" ] ||
  complain "a recording whose name is not UTF-8: $(head -2 .err)"

# a session that is stopped says so, in its JSON and in its recording
$burr mill phantom:block --motion pocket --seconds 600 --realtime --record stopped.mcap --json >.out 2>.err </dev/null &
child=$!
for _ in $(seq 100); do [ -s stopped.mcap ] && break; sleep 0.1; done
sleep 0.5
kill -TERM $child
wait $child
grep -q '"finished":false' .out || complain "a stopped session says in its JSON that it was finished: $(head -c 300 .out)"
$burr info stopped.mcap --json 2>/dev/null | grep -q '"finished":false' || complain "a stopped session's recording says it was finished"
$burr info a.mcap --json 2>/dev/null | grep -q '"finished":true' || complain "a finished session's recording says it was stopped"

# words that nobody can hear end nothing
record_with() {
  rm -f quiet.mcap
  "${burr% --quiet}" mill phantom:block --motion plunge --seconds 1 --record quiet.mcap "$@"
}
record_with >.out 2>/dev/full || complain "a full stderr ends burr with $?"
[ -s quiet.mcap ] || complain "a full stderr loses the recording"
record_with >.out 2>&- || complain "a closed stderr ends burr with $?"
$burr replay quiet.mcap --check >.out 2>.err || complain "a closed stderr spoils the recording: $(head -2 .err)"
record_with 2>&1 >.out | head -c 1 >/dev/null
[ "${PIPESTATUS[0]}" = 0 ] && [ -s quiet.mcap ] || complain "a reader that leaves ends burr with ${PIPESTATUS[0]}"
record_with --json >&- 2>.err <&-
[ $? = 74 ] && [ -s quiet.mcap ] || complain "a closed stdout: $(head -2 .err)"

# a hand path that cannot do what was meant is named at once and in the result
printf '\xef\xbb\xbft,x,y,z\r\n0,0,0,0.2\r\n0.05,0,0,0.2\r\n' >mark.csv
allowed $burr mill phantom:block --path mark.csv --json
printf 't,x,y,z\n0,0,0,60\n0.05,0,0,60\n' >metres.csv
allowed $burr mill phantom:block --path metres.csv --json
grep -q 'x_mm,y_mm,z_mm' .err && grep -q 'x_mm,y_mm,z_mm' .out || complain "a path in the wrong unit is not named"
printf 't,x,y,z\n0,0,0,-0.004\n0.05,0,0,-0.004\n' >inside.csv
allowed $burr mill phantom:block --path inside.csv --json
grep -q 'inside the bone' .err && grep -q 'inside the bone' .out || complain "a path that begins in bone is not named: $(cat .out)"

refused 'seconds' $burr mill none.nrrd --motion plunge --seconds -1
allowed $burr help mill
grep -q -- '--motion' .out || complain "burr help mill shows something else"
exit $bad
