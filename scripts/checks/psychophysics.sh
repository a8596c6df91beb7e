#!/usr/bin/env bash
# A whole experiment with the program: run, interrupted and continued, answered by keys, no
# threshold.
#
#     scripts/checks/psychophysics.sh BUILD
set -uo pipefail
burr="$(realpath "$1")/burr --quiet psychophysics"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
bad=0

complain() {
  echo "$*"
  bad=1
}
# field FILE NAME
field() { python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))[sys.argv[2]])' "$1" "$2"; }
# near FILE TRUTH SHARE: the threshold in the file is near TRUTH
near() {
  python3 -c 'import json, sys; r = json.load(open(sys.argv[1])); t = float(sys.argv[2])
sys.exit(not (r["found"] and abs(r["threshold"] / t - 1) < float(sys.argv[3]) and r["low"] < t < r["high"]))' "$@"
}

# ---- observers by formula and by feeling
$burr stiffness --observer threshold=0.12 --trials 400 --seed 4 --subject P-01 --out "$place/known" >"$place/said" || complain "fails"
near "$place/known/result.json" 0.12 0.15 || complain "a known observer is not found: $(cat "$place/said")"
[ "$(wc -l <"$place/known/trials.csv")" = 401 ] || complain "trials.csv has not 401 lines"
[ "$(field "$place/known/result.json" comparison_first)" = 200 ] || complain "orders are not balanced"
grep -q "<svg" "$place/known/result.html" || complain "no plot"
$burr friction --observer threshold=0.3,feels=yes,lapse=0 --trials 60 --seconds 1.5 --out "$place/felt" >/dev/null || complain "feeling fails"
near "$place/felt/result.json" 0.3 0.7 || complain "one that feels is not found"

# ---- answered by keys; standard input ends half-way
printf '1\n%.0s' {1..20} | $burr vibration --trials 40 --seconds 1.5 --out "$place/keys" >"$place/said" 2>"$place/err"
[ ${PIPESTATUS[1]} = 130 ] || complain "a closed standard input is no end with 130"
grep -q -- "--continue $place/keys" "$place/err" || complain "does not say how to go on"
[ "$(wc -l <"$place/keys/trials.csv")" = 21 ] || complain "answers are lost"
[ "$(field "$place/keys/result.json" finished)" = False ] || complain "says it is finished"
printf '2\n%.0s' {1..20} | $burr --continue "$place/keys" >"$place/said" 2>/dev/null || complain "does not go on"
[ "$(wc -l <"$place/keys/trials.csv")" = 41 ] || complain "continued answers are lost"
[ "$(field "$place/keys/result.json" said_first)" = 20 ] || complain "other answers than were given"

# ---- with a device: a fake Touch, whose hand moves by itself
export BURR_OPENHAPTICS="$(realpath "$1")/fakes/libHD.so" FAKE_HD_MOTION=1 XDG_CONFIG_HOME="$place"
printf '1\n%.0s' {1..3} | $burr stiffness --device touch --standard 200 --largest 0.9 --trials 40 --seconds 1.5 --out "$place/hand" 2>"$place/err" >/dev/null
[ ${PIPESTATUS[1]} = 130 ] || complain "no end with 130 at a device: $(cat "$place/err")"
[ "$(wc -l <"$place/hand/trials.csv")" = 4 ] || complain "answers at a device are lost"
grep -q '"device_id": "Touch T-0001"' "$place/hand/result.json" || complain "the device is not named"
$burr stiffness --device touch 2>"$place/err" && complain "shows 800 N/m on a Touch"
grep -q "at most 400 N/m" "$place/err" || complain "does not say what a Touch can show: $(cat "$place/err")"
$burr stiffness --device touch --observer threshold=0.1,feels=yes 2>"$place/err" && complain "an observer at a device"
grep -q "simulated hand" "$place/err" || complain "does not say where an observer feels: $(cat "$place/err")"
$burr stiffness --device nosuch 2>"$place/err" && complain "takes any device"
grep -q "touch" "$place/err" || complain "does not say which devices there are: $(cat "$place/err")"

# ---- an interrupted run of a simulated observer gives the same result as one without interruption
cp -r "$place/known" "$place/again"
head -151 "$place/known/trials.csv" >"$place/again/trials.csv"
$burr --continue "$place/again" >/dev/null || complain "does not go on"
cmp "$place/known/trials.csv" "$place/again/trials.csv" || complain "goes on otherwise"
cmp "$place/known/result.json" "$place/again/result.json" || complain "comes to another result"
sed -i '5s/,[0-9.]*,400,/,0.5,400,/' "$place/again/trials.csv"
$burr --continue "$place/again" >/dev/null 2>"$place/err" && complain "believes a changed file"
grep -q "trial 4" "$place/err" || complain "does not name the trial: $(cat "$place/err")"

# ---- an observer who guesses has no threshold
$burr stiffness --observer threshold=inf --trials 200 --out "$place/guess" >"$place/said" || complain "a guesser fails"
grep -q "no threshold found" "$place/said" || complain "a guesser has a threshold: $(cat "$place/said")"
[ "$(field "$place/guess/result.json" threshold)" = None ] || complain "a number in the file"
exit $bad
