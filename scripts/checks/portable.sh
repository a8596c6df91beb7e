#!/usr/bin/env bash
# burr_core on another processor or system gives the bits of this one: compiles it, replays 3000 ticks each of touch, slide
# and slot there, and compares the hashes of ticks and bone with those of the native build.
#
#     scripts/checks/portable.sh aarch64|windows|web BUILD [tests]
#
# aarch64: Debian's cross compiler and qemu-user. windows: Debian's mingw-w64 and wine; then also the unit tests. web:
# Debian's emscripten, node and npm. These are large: where they are missing, the check is left out (exit 77), unless
# BURR_REQUIRE_TOOLS=1. `tests` compiles and compares nothing: it runs the unit tests of the core's rooms that
# `portable.sh aarch64` has compiled.
set -euo pipefail
source "$(dirname "$0")/files.sh"
where=$1
build=$(realpath "$2")
tests=${3:-}
case $where in
  aarch64) tools=(aarch64-linux-gnu-g++ qemu-aarch64) ;;
  windows) tools=(x86_64-w64-mingw32-g++-posix wine64) PATH=$PATH:/usr/lib/wine ;;  # where Debian's wine64 lies
  web) tools=(em++ node npm) ;;
  *) tests=unknown ;;
esac
case $where:$tests in
  aarch64: | windows: | web: | aarch64:tests) ;;
  *) echo "usage: scripts/checks/portable.sh aarch64|windows|web BUILD [tests]      (tests: of aarch64 only)" >&2; exit 2 ;;
esac
for tool in "${tools[@]}"; do
  if ! command -v "$tool" >/dev/null; then
    echo "portable.$where: $tool is missing (section [tools] of scripts/packages.txt)"
    [ "${BURR_REQUIRE_TOOLS:-0}" != 1 ] || exit 1
    exit 77
  fi
done

case $where in
  aarch64) there() { qemu-aarch64 -L /usr/aarch64-linux-gnu "build/aarch64/$1" "${@:2}"; } ;;
  windows)
    # a Windows of this check alone, 0.7 GB; no windows about programs of .NET or HTML that are not there
    export WINEPREFIX=$build/portable_wine WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml,winemenubuilder.exe="
    remove_wine() { wineserver64 -k || true; rm -rf "$WINEPREFIX"; }
    trap remove_wine EXIT
    rm -rf "$WINEPREFIX"  # one that a killed run has left
    wine64 wineboot --init >"$build/portable_wine.log" 2>&1 || { cat "$build/portable_wine.log"; exit 1; }
    # its C library ends a line with two characters
    there() { wine64 "build/windows/$1.exe" "${@:2}" | tr -d '\r'; }
    ;;
  # emscripten 3.1.6 takes a node that has `fetch` for a browser
  web) there() { node --no-experimental-fetch "build/web/$1.js" "${@:2}"; } ;;
esac
if [ "$tests" = tests ]; then
  # not the longest: a hundred thousand ticks under qemu take minutes, and the bits of 9000 are compared
  there test_core --gtest_brief=1 --gtest_filter='-*OverAHundredThousandTicks*:Mirror.MoreBricks*:Smooth.*'
  exit
fi

export NODE_PATH=/usr/share/nodejs  # where emscripten's helpers find Debian's acorn
cmake --preset "$where" >"$build/portable_$where.log" || { cat "$build/portable_$where.log"; exit 1; }
cmake --build "build/$where" >"$build/portable_$where.log" || { tail -n 60 "$build/portable_$where.log"; exit 1; }

paths=tests/bits/portable_paths.txt
"$build/portable_bits" $paths >"$build/portable_native.txt"
there portable_bits $paths >"$build/portable_$where.txt"
cat "$build/portable_$where.txt"
[ "$(wc -l <"$build/portable_native.txt")" = 11 ] || { echo "three paths, seven tools and the functions were expected"; exit 1; }
if ! diff "$build/portable_native.txt" "$build/portable_$where.txt"; then
  echo "portable.$where: other bits than here (<: here, >: there); docs/develop/architecture.md, section 5, says where they may part"
  exit 1
fi
# here and not by `tests`: to make a Windows takes longer than they do
if [ "$where" = windows ]; then there test_core --gtest_brief=1; fi
