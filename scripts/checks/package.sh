#!/usr/bin/env bash
# Checks the packages of scripts/package.sh without installing them: what they hold, what they need, lintian, manual pages,
# menu entries, and that the program in them runs. scripts/bare_debian.sh package installs them in a bare Debian.
#
#     scripts/checks/package.sh BUILD
#
# With BURR_REQUIRE_TOOLS=1 a missing lintian, desktop-file-validate, appstreamcli or update-mime-database is a failure.
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
wrong() { echo "$*"; exit 1; }
has() { command -v "$1" >/dev/null || { [ "${BURR_REQUIRE_TOOLS:-0}" != 1 ] || wrong "$1 is not installed"; echo "left out: $1 is not installed"; return 1; }; }

scripts/package.sh "$build" "$place/out"
version=$(dpkg-deb -f "$place"/out/burr_*.deb Version)
for package in burr libburr0 libburr-dev; do
  [ -f "$place/out/${package}_${version}_$(dpkg --print-architecture).deb" ] || wrong "there is no package $package"
done
grep -q "libburr0 (= $version)" <(dpkg-deb -f "$place"/out/burr_*.deb Depends) || wrong "burr does not need libburr0 of the same version"
grep -q "libsdl2-2.0-0" <(dpkg-deb -f "$place"/out/burr_*.deb Depends) || wrong "burr does not need SDL"
for deb in "$place"/out/*.deb; do dpkg-deb -x "$deb" "$place/root"; done
root=$place/root
if [ -d "$build/python/burr" ]; then
  [ -f "$place/out/python3-burr_${version}_$(dpkg --print-architecture).deb" ] || wrong "there is no package python3-burr"
fi
libraries=$(dirname "$(find "$root" -name libburr.so.0)")

page=$build/../web/published
if [ -f "$page/version.json" ]; then
  web=$place/out/burr-web_${version}_all.deb
  [ -f "$web" ] || wrong "there is no package burr-web for all processors"
  [ "$(dpkg-deb -f "$web" Architecture)" = all ] || wrong "burr-web is not for all processors"
  [ -z "$(dpkg-deb -f "$web" Depends)" ] || wrong "burr-web needs something: $(dpkg-deb -f "$web" Depends)"
  diff -r "$page" "$root/usr/share/burr/web" || wrong "burr-web holds another page"
  while read -r pattern; do
    compgen -G "$root/$pattern" >/dev/null || wrong "packaging/copyright: $pattern is not in burr-web"
  done < <(grep -oE 'usr/share/burr/web/[^ ]+' packaging/copyright)
  archive=$place/out/burr-web-${version%-*}.tar.gz
  tar -xzf "$archive" -C "$place"
  diff -r "$page" "$place/burr-web-${version%-*}" || wrong "$archive holds another page"
fi

# no path of this computer, neither where libraries are looked for nor in a text
while read -r -d '' file; do
  ! readelf -d "$file" 2>/dev/null | grep -E 'R(UN)?PATH' || wrong "$file: has a path of its own to libraries"
done < <(find "$root" -type f -print0)
! grep -rlI -- "$PWD" "$root" || wrong "the files above name this checkout"

run() { LD_LIBRARY_PATH=$libraries "$root/usr/bin/burr" "$@"; }
run --version
run --quiet phantom ball --voxel-mm 1 --out "$place/ball.nrrd"
run --quiet info "$place/ball.nrrd" >/dev/null
run --quiet mill tooth --motion plunge --json >/dev/null # its bone comes from the package

if [ -f "$page/version.json" ]; then # without what could build it
  PATH=/usr/sbin run web --out "$place/page"
  diff -r "$page" "$place/page" || wrong "burr web wrote another page than that of burr-web"
fi

if [ -d "$root/usr/lib/python3" ]; then
  LD_LIBRARY_PATH=$libraries PYTHONPATH=$root/usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c '
import burr
assert burr.__file__.startswith("'"$root"'"), burr.__file__
with burr.Scene("tooth").session(burr.Hand.motion("plunge", seconds=1)) as session:
    assert session.step(1000) == 1000'
fi

# a manual page for each command, without warnings
pages() { # words of a command
  local name=burr sub below
  for word in "$@"; do name+=-$word; done
  local page=$root/usr/share/man/man1/$name.1.gz
  [ -f "$page" ] || wrong "there is no manual page $name(1)"
  zcat "$page" | grep -q '^\.SH EXAMPLES' || wrong "$name(1) has no examples"
  mapfile -t below < <(run "$@" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z0-9-]*\) .*/\1/p')
  for sub in "${below[@]}"; do [ "$sub" = help ] || pages "$@" "$sub"; done
}
pages
if has man; then
  for page in "$root"/usr/share/man/man?/*; do
    said=$(MANROFFSEQ='' MANWIDTH=80 man --warnings -E UTF-8 -l -Tutf8 -Z "$page" 2>&1 >/dev/null)
    [ -z "$said" ] || wrong "$page: $said"
  done
fi

rules=$root/usr/lib/udev/rules.d/70-burr.rules
[ "$(cat "$rules")" = "$(run doctor --print-rule)" ] || wrong "the udev rule is not that of burr doctor"
if has desktop-file-validate; then
  said=$(desktop-file-validate "$root"/usr/share/applications/*)
  [ -z "$said" ] || wrong "$said"
fi
if has appstreamcli; then appstreamcli validate --no-net "$root"/usr/share/metainfo/*.xml; fi
if has update-mime-database; then
  XDG_DATA_DIRS=$root/usr/share update-mime-database "$root/usr/share/mime"
  grep -q 'application/x-burr-recording' "$root/usr/share/mime/globs2" || wrong "recordings have no type"
fi
if has lintian; then
  # no upload to Debian's archive closes a report, and CPack's own scripts call ldconfig
  lintian --allow-root --tag-display-limit 0 --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs,maintscript-calls-ldconfig "$place"/out/*.deb
fi
echo "packages: as they should be"
