#!/usr/bin/env bash
# `burr learner` with the program: a recording becomes a session, is handed out and forgotten to the last byte; what cannot
# be stored waits.
#
#     scripts/checks/school.sh BUILD
set -uo pipefail
burr="$(realpath "$1")/burr --quiet"
page_is_sound="$(dirname "$(realpath "$0")")/page_is_sound.py"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
export XDG_DATA_HOME="$place/data" XDG_STATE_HOME="$place/state" XDG_CACHE_HOME="$place/cache"
unset BURR_STORE
store="$place/data/burr/school.sqlite"
bad=0

complain() {
  echo "$*"
  bad=1
}
# says TEXT COMMAND...: succeeds, and prints the text
says() {
  local text=$1
  shift
  "$@" >"$place/said" 2>&1 || complain "fails: $*: $(cat "$place/said")"
  grep -qF -- "$text" "$place/said" || complain "$* does not say \"$text\": $(cat "$place/said")"
}
# refuses STATUS TEXT COMMAND...: fails with one sentence that holds the text
refuses() {
  local status=$1 text=$2 left
  shift 2
  "$@" >"$place/said" 2>"$place/err"
  left=$?
  [ $left = "$status" ] || complain "exits with $left in place of $status: $*: $(cat "$place/err")"
  grep -qF -- "$text" "$place/err" || complain "$* says: $(cat "$place/err")"
}

for n in 1 2; do
  $burr run block --headless --seconds "$n" --learner kestrel-27 --mode exam --out "$place/out$n" >"$place/said" 2>&1 ||
    complain "no session: $(cat "$place/said")"
  mv "$place/out$n/session.mcap" "$place/$n.mcap"
  rm -r "$place/out$n"
done
[ -e "$store" ] && complain "a store that nobody asked for"

# ---- learners and sessions
refuses 2 'there is no store at' $burr learner list
refuses 2 'there is no store at' $burr learner enter kestrel-27 "$place/1.mcap"
[ -e "$store" ] && complain "a list made a store"
says kestrel-27 $burr learner add --id kestrel-27 --level PGY2 --name "Ada Lovelace" --mail ada@example.org --json
$burr learner add >"$place/said" || complain "no pseudonym: $(cat "$place/said")"
other=$(head -1 "$place/said")
[[ $other =~ ^[a-z]+-[0-9]{3,4}$ ]] || complain "an odd pseudonym: $other"
refuses 2 'there is such a learner' $burr learner add --id kestrel-27
refuses 2 '' $burr learner add --id "Ada Lovelace"
refuses 2 'use a day such as' $burr learner add --retain-until soon
refuses 2 'use a day such as' $burr learner add --retain-until 2027-02-31
for file in "$store" "${store%.sqlite}-names.sqlite"; do
  [ "$(stat -c %a "$file")" = 600 ] || complain "others may read $file: $(stat -c %a "$file")"
done
says 'in the store, not sealed: its recording has no seal' $burr learner enter kestrel-27 "$place/1.mcap"
says '"stored":true' $burr learner enter kestrel-27 "$place/1.mcap" --json
refuses 2 "says that it is kestrel-27's" $burr learner enter "$other" "$place/1.mcap"
refuses 74 '' $burr learner enter kestrel-27 "$place/none.mcap"
says '"sessions":1,' $burr learner list --json
grep -q Lovelace "$place/said" && complain "a name without --names"
says 'Ada Lovelace' $burr learner list --names
says 'unfinished' $burr learner list kestrel-27
says '"part":"product"' $burr learner list kestrel-27 --json
refuses 2 'there is no such learner' $burr learner list nobody-1
says added $burr learner cohort add "autumn 2026" kestrel-27 "$other"
says "kestrel-27" $burr learner cohort list
says removed $burr learner cohort remove "autumn 2026" "$other"

# ---- stations; the audit
says 'no station is enrolled' $burr station list
says 'station station-3 is enrolled' $burr station enrol station-3
[ "$(stat -c %a "$place/data/burr/station.key")" = 600 ] || complain "others may read the station's key"
grep -q "$(tail -1 "$place/data/burr/station.key" | cut -d' ' -f2)" "$place/said" && complain "the secret of a key is printed"
refuses 2 'the store knows this name already' $burr station enrol station-3
refuses 2 'this key is of station-3' $burr station enrol station-4
chmod 640 "$place/data/burr/station.key"
refuses 2 'others can read or own this key' $burr station enrol station-3
says 'is revoked' $burr station revoke station-3
says ', revoked ' $burr station list
refuses 2 'nothing of this name is enrolled now' $burr station revoke station-3
rm "$place/data/burr/station.key"
says 'the audit is whole' $burr learner check
head=$(sed -n 's/^write down: //p' "$place/said")
says 'decider a-berg is enrolled' $burr station enrol a-berg --decides
says 'the audit is whole' $burr learner check --since "$head"
cp "$store" "$place/before.sqlite"
python3 -c 'import sqlite3, sys; s = sqlite3.connect(sys.argv[1]); s.execute("UPDATE audit SET what = ? WHERE number = 2", ("nothing",)); s.commit()' "$store"
refuses 1 'row 2 of the audit does not give its hash' $burr learner check
python3 -c 'import sqlite3, sys; a, b = (sqlite3.connect(one) for one in sys.argv[1:]); b.backup(a)' "$store" "$place/before.sqlite"
rm "$place/before.sqlite"

# ---- a locked store
python3 - "$store" "$place/locked" <<'LOCK' &
import pathlib, sqlite3, sys, time
store = sqlite3.connect(sys.argv[1], isolation_level=None)
store.execute("BEGIN IMMEDIATE")
pathlib.Path(sys.argv[2]).touch()
while pathlib.Path(sys.argv[2]).exists():
    time.sleep(0.02)
LOCK
until [ -e "$place/locked" ]; do sleep 0.02; done
says 'the session waits' $burr learner enter kestrel-27 "$place/2.mcap"
rm "$place/locked"
wait
says '1 session that waited came into the store' $burr learner list
says '"sessions":2,' $burr learner list --json
says '0 sessions came into the store, 0 still waiting' $burr learner take-in

# ---- handed out
refuses 2 'must end in .zip' $burr learner export kestrel-27 --out "$place/k.tar"
says 'all that is known of kestrel-27' $burr learner export kestrel-27 --out "$place/k.zip"
python3 - "$place/k.zip" "$place" <<'ZIP' || bad=1
import csv, io, json, sys, zipfile
with zipfile.ZipFile(sys.argv[1]) as file:
    assert file.testzip() is None
    text = {name: file.read(name).decode() for name in file.namelist()}
rows = {name: list(csv.DictReader(io.StringIO(text[name], newline=""))) for name in text if name.endswith(".csv")}
assert [row["name"] for row in rows["person.csv"]] == ["Ada Lovelace"], rows["person.csv"]
assert len(rows["session.csv"]) == 2 and all(row["finished"] == "0" and row["guided"] == "0" for row in rows["session.csv"])
table = json.loads(text["learner.json"])
assert len(table["session"]) == 2 and len(table["item"]) == len(rows["item.csv"]) > 4
assert all(row["recording_uri"].startswith("file://") for row in table["session"])
reports = [name for name in text if name.endswith(".html")]
assert len(reports) == 2, list(text)
open(sys.argv[2] + "/report.html", "w").write(text[reports[0]])
ZIP
python3 "$page_is_sound" "$place/report.html" || bad=1
says 'pseudonyms only' $burr learner export --all --csv "$place/tables"
grep -qF 'kestrel-27,' "$place/tables/learner.csv" || complain "the tables hold no learner"
grep -rqE 'Lovelace|ada@|file://' "$place/tables" && complain "the tables hold a name or a place"
says 'learner exported' $burr learner audit

# another file has the name of a recording now: no report of it
cp "$place/1.mcap" "$place/kept.mcap"
cp "$place/2.mcap" "$place/1.mcap"
says 'another file has its name now' $burr learner export kestrel-27 --out "$place/again.zip"
mv "$place/kept.mcap" "$place/1.mcap"

# ---- the time to keep
says kestrel-28 $burr learner add --id kestrel-28 --retain-until 2020-01-01
says 'the time to keep is over for kestrel-28' $burr learner list
says '1 learner whose time to keep was over' $burr learner forget --overdue
says forgotten $burr learner audit

# ---- forgotten
mv "$place/2.mcap" "$place/moved.mcap"
rm -r "$place/k.zip" "$place/again.zip" "$place/tables"
mkdir -p "$place/state/burr/sessions"
echo torn >"$place/state/burr/sessions/x.mcap"
says 'not reached, delete it yourself' $burr learner forget kestrel-27
grep -qF 'x.mcap (it cannot be read' "$place/said" || complain "a torn recording is not named: $(cat "$place/said")"
grep -qF "deleted: $place/1.mcap" "$place/said" || complain "what was deleted is not named: $(cat "$place/said")"
[ -e "$place/1.mcap" ] && complain "its recording is still there"
[ -e "$place/moved.mcap" ] || complain "a recording of another name is gone"
rm "$place/moved.mcap" "$place/said" "$place/err" "$place/report.html"
found=$(grep -rlE 'kestrel-27|Lovelace|ada@example' "$place")
[ -z "$found" ] || complain "still of the learner: $found"
says "$other" $burr learner list
refuses 2 'there is no such learner' $burr learner forget kestrel-27
says 'of people who were forgotten' $burr learner check --since "$head"
grep -q ' 0 of people' "$place/said" && complain "nobody was forgotten in the audit"

# ---- a store of a newer burr; a server that is not there
python3 -c 'import sqlite3, sys; s = sqlite3.connect(sys.argv[1]); s.execute("INSERT INTO schema_version VALUES (99, 0)"); s.commit()' "$store"
says 'a newer burr made this store' $burr learner list
refuses 74 'a newer burr made this store' $burr learner add
refuses 74 'no connection' $burr learner list --store "postgresql://ada:secret@127.0.0.1:1/school"
grep -qE 'secret|ada' "$place/err" && complain "a password in a message: $(cat "$place/err")"
refuses 74 'the address cannot be read' $burr learner list --store "postgresql://ada:secret%@127.0.0.1:1/school"
grep -qE 'secret|ada' "$place/err" && complain "a password in a message: $(cat "$place/err")"
printf 'a list of names and other text that is no database at all\n%.0s' 1 2 3 4 5 6 7 8 9 10 >"$place/list.txt"
refuses 65 'it is no store of learners' $burr learner list --store "$place/list.txt"
grep -q 'no database at all' "$place/list.txt" || complain "a file that is no store was written"
exit $bad
