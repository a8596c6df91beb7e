#!/usr/bin/env bash
# Checks the library with the short list of .clang-tidy.
#
#     scripts/checks/tidy.sh [BUILD]         BUILD: has compile_commands.json; default build/release
#
# Left out: files that include ITK or GDCM (a minute a file), and a kernel's copies for other
# processors.
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=${1:-build/release}

mapfile -d '' -t files < <(our_files 'src/burr/*.cpp')
for file in "${files[@]}"; do
  case $file in *_avx2.cpp | *_avx512.cpp) continue ;; esac
  # the longest first, so that no core waits at the end for the other
  grep -qE '#include <(itk|gdcm)' "$file" || echo "$(stat -c %s "$file") $file"
done | sort -rn | cut -d' ' -f2 | xargs -P "${BURR_CORES:-$(nproc)}" -n 1 clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option |&
  sed -E '/^[0-9]+ warnings? /d'
