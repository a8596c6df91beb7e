#!/usr/bin/env bash
# `burr web` copies the page that came with the program, or that of a folder or an archive, whole or not at all, and needs no
# emscripten. With the small page of web/tests/small_site.py, so no page must be built; node packs it.
#
#     scripts/checks/web.sh BUILD
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
if ! command -v node >/dev/null; then
  echo "web: node is missing (section [tools] of scripts/packages.txt)"
  [ "${BURR_REQUIRE_TOOLS:-0}" != 1 ] || exit 1
  exit 77
fi
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
wrong() { echo "web: $*"; exit 1; }
make() { # FOLDER VERSION
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=web/tests python3 -c 'import sys, small_site; small_site.make(*sys.argv[1:])' "$1" "$2"
}
# an installation of this program alone; a link would lead back to its build
mkdir -p "$place/usr/bin"
cp "$build/burr" "$place/usr/bin/"
burr=$place/usr/bin/burr
refuses() { # CODE PART WORDS...: exits with the code and says one sentence with the part; nothing is written
  local code=$1 part=$2 got=0
  shift 2
  rm -rf "$place/none"
  "$burr" web --out "$place/none" "$@" >"$place/out" 2>"$place/said" || got=$?
  [ $got = "$code" ] || wrong "$*: exit code $got instead of $code: $(cat "$place/said")"
  grep -q -- "$part" "$place/said" || wrong "$*: does not say '$part': $(cat "$place/said")"
  [ "$(wc -l <"$place/said")" = 1 ] || wrong "$*: says more than one line: $(cat "$place/said")"
  [ ! -e "$place/none" ] || wrong "$*: wrote something"
}

refuses 2 "install the package burr-web"
make "$place/page" 1
mkdir -p "$place/usr/share/burr"
cp -r "$place/page" "$place/usr/share/burr/web"

# what is installed, with nothing in PATH that could build
PATH=/nowhere "$burr" web --out "$place/mine"
diff -r "$place/page" "$place/mine"
# a folder, an archive
"$burr" web --out "$place/of_folder" --from "$place/page"
diff -r "$place/page" "$place/of_folder"
packaging/web_archive.sh "$place/page" "$place"
"$burr" web --out "$place/of_archive" --from "$place/burr-web-1.0.tar.gz"
diff -r "$place/page" "$place/of_archive"
mkdir "$place/again"
packaging/web_archive.sh "$place/of_archive" "$place/again"
cmp "$place/burr-web-1.0.tar.gz" "$place/again/burr-web-1.0.tar.gz" || wrong "the same page gives another archive"

# a new version: the one before stays for pages that are open, older ones go
parts() { (cd "$place/mine" && echo v-*); }
make "$place/page2" 2
make "$place/page3" 3
one=$(parts)
"$burr" web --out "$place/mine" --from "$place/page2"
[ "$(parts | wc -w)" = 2 ] || wrong "the version before is gone, or another one is there: $(parts)"
"$burr" web --out "$place/mine" --from "$place/page3"
"$burr" web --out "$place/mine" --from "$place/page3" # twice: nothing more goes
[ "$(parts | wc -w)" = 2 ] || wrong "two versions were expected: $(parts)"
[[ " $(parts) " != *" $one "* ]] || wrong "the oldest version is still there"
diff <(cd "$place/page3" && find . -type f | sort) <(cd "$place/mine" && find . -type f | grep -v "$(cd "$place/page2" && echo v-*)" | sort)

# what is damaged is not copied
first=$(cd "$place/page" && ls -d v-*/mill/mill.js)
cp -r "$place/page" "$place/bad"
echo "// more" >>"$place/bad/$first"
refuses 65 "$first: has changed since the page was made" --from "$place/bad"
rm "$place/bad/$first"
refuses 74 "$first: is no file that can be read" --from "$place/bad"
ln -s /etc/passwd "$place/bad/$first"
refuses 74 "$first: is no file that can be read" --from "$place/bad"
for damage in 's,"parts": "v-.*",parts": "v-../..",' 's,"files": {,"files": [,' 's,"mill/index.html","../index.html",' 's,"mill/index.html","/tmp/index.html",'; do
  rm -rf "$place/bad"
  cp -r "$place/page" "$place/bad"
  sed -i "$damage" "$place/bad/version.json"
  ! cmp -s "$place/page/version.json" "$place/bad/version.json" || wrong "$damage changes nothing"
  refuses 65 "is not that of a page of burr" --from "$place/bad"
done
head -c 3000 "$place/burr-web-1.0.tar.gz" >"$place/cut.tar.gz"
refuses 65 "is no whole archive of the page" --from "$place/cut.tar.gz"
tar -C "$place/mine" -czf "$place/other.tar.gz" sw.js
refuses 65 "holds no page of burr" --from "$place/other.tar.gz"
mkdir "$place/empty"
refuses 65 "is no page of burr" --from "$place/empty"
refuses 2 "there is nothing of this name" --from "$place/nowhere"
[ -z "$(find "${TMPDIR:-/tmp}" -maxdepth 1 -name 'burr_web_*' -newer "$place/usr/bin/burr" -user "$(id -u)")" ] || wrong "what was unpacked is left"

# nothing of the user's is overwritten
touch "$place/empty/mine"
if "$burr" web --out "$place/empty" 2>"$place/said"; then wrong "burr web wrote into a folder with other files"; fi
grep -q "holds other files" "$place/said" || wrong "$(cat "$place/said")"
if "$burr" web --out "$place/usr/share/burr/web" 2>"$place/said"; then wrong "burr web wrote over the page itself"; fi
grep -q "is the page itself" "$place/said" || wrong "$(cat "$place/said")"
echo "web: copied, replaced, refused as they should be"
