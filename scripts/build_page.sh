#!/usr/bin/env bash
# Builds the page, burr in a browser, and says how far it is. The first time takes some minutes; what has not changed is not built again.
#
#     scripts/build_page.sh        -> build/web/published, a folder for any web server
#
# Nobody needs it who has the package burr-web or an archive burr-web-VERSION.tar.gz: `burr web` copies these.
set -euo pipefail
cd "$(dirname "$0")/.."
missing=
for tool in em++ node npm python3 cmake ninja; do command -v "$tool" >/dev/null || missing+=" $tool"; done
if [ -n "$missing" ]; then
  echo "burr: to build the page needs$missing, and that is missing. Take the page as it was built: the package burr-web, or an archive: burr web --out page --from burr-web-VERSION.tar.gz. Or build it, with 850 MB of tools: apt-get install emscripten nodejs npm python3 cmake ninja-build libfmt-dev libstb-dev libeigen3-dev nlohmann-json3-dev libtomlplusplus-dev" >&2
  exit 1
fi
echo "burr: building the page; the first time takes a quarter of an hour (build/page_build.log)" >&2
mkdir -p build
log=build/page_build.log
failed() {
  tail -n 40 "$log" >&2
  echo "burr: the page could not be built; the whole story is in $PWD/$log" >&2
  exit 1
}
export NODE_PATH=${NODE_PATH:-/usr/share/nodejs}  # where emscripten's helpers find Debian's acorn
cmake --preset web >"$log" 2>&1 || failed

# ninja's lines begin with: steps that are done, steps in all. One line every ten seconds says it, with the time that is left.
export NINJA_STATUS="@%f %t "
begun=$SECONDS said=$SECONDS
while IFS= read -r line; do
  echo "$line" >>"$log"
  [[ $line =~ ^@([0-9]+)\ ([0-9]+)\  ]] || continue
  done=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]}
  if [ $((SECONDS - said)) -ge 10 ] && [ "$done" -gt 0 ]; then
    said=$SECONDS
    echo "burr: building the page: $done of $all steps in $((SECONDS - begun)) s, about $(((SECONDS - begun) * (all - done) / done)) s more" >&2
  fi
done < <(cmake --build --preset web --target site 2>&1 && echo "@ended well")
grep -q '^@ended well$' "$log" || failed
echo "burr: the page is in $PWD/build/web/published, built in $((SECONDS - begun)) s" >&2
