#!/usr/bin/env bash
# Every C++ file is laid out as .clang-format says.  Cure: clang-format -i FILE
set -euo pipefail
source "$(dirname "$0")/files.sh"
our_files '*.h' '*.cpp' | xargs -0 clang-format --dry-run -Werror
