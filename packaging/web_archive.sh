#!/usr/bin/env bash
# Packs the page for any web server: OUT/burr-web-VERSION.tar.gz. The same page gives the same archive to the byte.
#
#     packaging/web_archive.sh PAGE OUT        PAGE: build/web/published
set -euo pipefail
page=$1 out=$2
version=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["burr"])' "$page/version.json")
tar --create --directory "$page" --sort=name --mtime="@${SOURCE_DATE_EPOCH:-0}" --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX \
  --transform="s,^\.,burr-web-$version," . | gzip -9n >"$out/burr-web-$version.tar.gz"
