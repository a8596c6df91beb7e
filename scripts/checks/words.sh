#!/usr/bin/env bash
# What must not be in a tracked file: paths of somebody's computer, unfinished work, large files.
set -euo pipefail
source "$(dirname "$0")/files.sh"
bad=0

# complain WHAT PATTERN PATHS...: prints the lines that match
complain() {
  local what=$1 pattern=$2 found
  shift 2
  found=$(our_files "$@" | xargs -0 grep -nIE -- "$pattern" || true)
  [ -n "$found" ] || return 0
  printf '%s:\n%s\n' "$what" "$(head -20 <<<"$found")"
  bad=1
}

complain "a path of somebody's own machine" "(^|[^A-Za-z0-9_.\${}/-])/(home|root|Users|work|mnt|media|srv|opt)/" . ":!tests"
complain "a path of somebody's own machine" "(^|[^A-Za-z0-9_.\${}/-])/(root|Users|work|mnt|media|srv|opt)/" tests
complain "unfinished work" "\b(TO""DO|FIX""ME|XX""X|HA""CK)\b" .
complain "a host that scripts would fetch from" "https?://" 'scripts/*' run test '.ci/*' 'cmake/*' CMakeLists.txt
complain "a temporary name that another test may share; tests/support/folder.h makes folders of their own" \
  "temp_directory_path|TempDir\(|mkdtemp" 'tests/*.cpp' 'tests/*.h' ':!tests/support/folder.h'
complain "a name of a patient in the tests' own data" "Patient(Name|ID)[^A-Za-z]{1,4}[A-Z][a-z]+\^[A-Z][a-z]+" 'docs/*' '*.md'

while IFS= read -r -d '' file; do
  [ -f "$file" ] || continue
  size=$(stat -c %s "$file")
  [ "$size" -le 1000000 ] || { echo "larger than 1 MB: $file ($size bytes)"; bad=1; }
done < <(our_files .)
exit $bad
