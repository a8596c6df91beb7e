#!/usr/bin/env bash
# Writes the manual pages: burr(1), a page for each command from its own --help, and burr(7).
#
#     packaging/man.sh BURR OUT        BURR: the program
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
burr=$(realpath "$1") out=$2
command -v help2man >/dev/null || { echo "man.sh: needs help2man; apt-get install help2man" >&2; exit 1; }
mkdir -p "$out"
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
export PATH=$place:$PATH
version=$("$burr" --version | sed 's/^burr \([^ ]*\).*/\1/')
# the day of the last change: the same sources give the same pages
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -c safe.directory='*' -C "$here" log -1 --format=%ct 2>/dev/null || date +%s)}

page() { # words of a command
  local name=burr line sub
  for word in "$@"; do name+=-$word; done
  printf '#!/bin/sh\nexec "%s" %s "$@"\n' "$burr" "$*" >"$place/$name"
  chmod +x "$place/$name"
  "$place/$name" --help >"$place/help"
  line=$(head -1 "$place/help")
  [ $# -gt 0 ] || line="${line#burr - }"
  {
    printf '[see also]\n.BR burr (7)'
    [ $# -eq 0 ] || printf ',\n.BR burr (1)'
    printf '\n'
  } >"$place/more"
  help2man --no-info --section=1 --version-string="$version" --name="$line" --include="$place/more" \
    --source="burr $version" --manual="burr" "$place/$name" -o "$out/$name.1"
  # headings and commands as a reader of manual pages knows them
  sed -i -e 's/^\.SS "Positionals:"/.SH ARGUMENTS/' -e 's/^\.SS "examples:"/.SH EXAMPLES/' -e 's/^\.SS "Subcommands:"/.SH COMMANDS/' "$out/$name.1"
  local below
  mapfile -t below < <(sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/\1/p' "$place/help")
  for sub in "${below[@]}"; do
    [ "$sub" = help ] || page "$@" "$sub"
  done
}
page
sed "s/@VERSION@/$version/; s/@DATE@/$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d)/" "$here/man/burr.7" >"$out/burr.7"
