#!/usr/bin/env bash
# Makes the files of the packages that come from the program itself: manual pages, the udev rule, metainfo, changelog.
#
#     packaging/files.sh BURR OUT        BURR: the program
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
burr=$(realpath "$1") out=$2
rm -rf "$out"
mkdir -p "$out/man1" "$out/man7"
# the day of the last change: the same sources give the same packages
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(git -c safe.directory='*' -C "$here" log -1 --format=%ct 2>/dev/null || date +%s)}
"$here/man.sh" "$burr" "$out/man1"
mv "$out/man1/burr.7" "$out/man7/"
gzip -9n "$out"/man?/*
"$burr" doctor --print-rule >"$out/70-burr.rules"
version=$("$burr" --version | sed 's/^burr \([^ ]*\).*/\1/')
sed "s/@VERSION@/$version/; s/@DATE@/$(date -u -d "@$SOURCE_DATE_EPOCH" +%Y-%m-%d)/" "$here/desktop/org.burr.Burr.metainfo.xml" >"$out/org.burr.Burr.metainfo.xml"
release=$(source /etc/os-release && echo "${VERSION_CODENAME:-unstable}")
gzip -9n >"$out/changelog.Debian.gz" <<X
burr ($version-1) $release; urgency=medium

  * What changed: CHANGELOG.md of burr.

 -- The burr authors <burr@burr.invalid>  $(date -u -R -d "@$SOURCE_DATE_EPOCH")
X
