#!/usr/bin/env bash
# A recording finds its scan wherever it is moved on this computer, and holds no path.
#
#     scripts/checks/finds_scans.sh BUILD
set -uo pipefail
burr=$(realpath "$1")/burr
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
export XDG_STATE_HOME=$place/state XDG_CONFIG_HOME=$place/config
unset BURR_VOLUME_PATH BURR_REMEMBER_SCANS
bad=0
fail() {
  echo "$*"
  bad=1
}
list=$place/state/burr/scans.txt
mkdir -p "$place/Svensson Karin" "$place/work" "$place/elsewhere" "$place/config/burr"
cd "$place/work" || exit 1
scan="$place/Svensson Karin/ct.seg.nrrd"
"$burr" --quiet phantom block --voxel-mm 0.5 --out "$scan" || fail "no scan"
record() { # FILE
  "$burr" --quiet mill "$scan" --burr-mm 4 --motion pocket --seconds 1 --record "$1" >/dev/null || fail "not recorded"
}
replays() { "$burr" --quiet replay "$1" --check >"$place/said" 2>&1; }

# ---- off by the environment, and by the setting: no list
BURR_REMEMBER_SCANS=0 record off.mcap
echo 'remember_scans = false' >"$place/config/burr/settings.toml"
record off2.mcap
[ -e "$place/state" ] && fail "off, and something was written: $(find "$place/state")"
rm "$place/config/burr/settings.toml" off.mcap off2.mcap

# ---- the recording moves, the scan stays
record s.mcap
[ "$(stat -c %a "$list")" = 600 ] || fail "the list can be read by others"
[ "$(stat -c %a "$place/state/burr")" = 700 ] || fail "the folder can be read by others"
grep -qF "$scan" "$list" || fail "the list lacks the scan"
grep -aqF "Svensson" s.mcap && fail "the recording holds the path"
mv s.mcap "$place/elsewhere/"
cd "$place/elsewhere" || exit 1
replays s.mcap || fail "moved, it does not replay: $(cat "$place/said")"
"$burr" --quiet export s.mcap --part bone --out bone.stl >"$place/said" 2>&1 || fail "no export: $(cat "$place/said")"
BURR_REMEMBER_SCANS=0 replays s.mcap && fail "the list is used although it is off"

# ---- the scan moves: not found, and the entry is forgotten; beside the recording it is found
mkdir "$place/new"
mv "$scan" "$place/new/ct.seg.nrrd"
replays s.mcap
[ $? = 74 ] || fail "the scan is gone, and the exit code is not 74"
grep -q "was not found; put its scan beside the recording, give the scan with --volume" "$place/said" ||
  fail "does not say what to do: $(cat "$place/said")"
grep -q "Svensson" "$list" && fail "the entry of a scan that is gone was kept"
mv "$place/new/ct.seg.nrrd" .
replays s.mcap || fail "beside the recording it is not found: $(cat "$place/said")"

# ---- a folder of scans, packed; a state folder that cannot be written
scan=$place/new/ct.zip
python3 -c "import sys, zipfile; zipfile.ZipFile(sys.argv[1], 'w').write(sys.argv[2], 'ct.seg.nrrd')" "$scan" ct.seg.nrrd
rm ct.seg.nrrd
record z.mcap
mv z.mcap "$place/work/"
replays "$place/work/z.mcap" || fail "a zip archive is not found: $(cat "$place/said")"
XDG_STATE_HOME=$scan record y.mcap

# ---- the setting also deletes the list
echo 'remember_scans = false' >"$place/config/burr/settings.toml"
record x.mcap
[ -e "$list" ] && fail "the list stays although the setting is off"
exit $bad
