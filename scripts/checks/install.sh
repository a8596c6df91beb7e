#!/usr/bin/env bash
# `cmake --install` gives a library that others can use: samples/installed builds against it alone.
#
#     scripts/checks/install.sh BUILD
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

cmake --install "$build" --prefix "$place/prefix" >"$place/log" || { cat "$place/log"; exit 1; }
# copied away, so that nothing of this checkout can be found by accident
cp -r samples/installed "$place/sample"
cmake -S "$place/sample" -B "$place/build" -DCMAKE_PREFIX_PATH="$place/prefix" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror"
cmake --build "$place/build"
"$place/build/touch"
"$place/prefix/bin/burr" --version
if grep -rlE '#include <(itk|gdcm|nlohmann|fmt|spdlog|SDL|epoxy|zstd)' "$place/prefix/include"; then
  echo "the installed headers above need more than Eigen"
  exit 1
fi
