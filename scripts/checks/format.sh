#!/usr/bin/env bash
# Checks that every C++ file has the layout of .clang-format. To fix one: clang-format -i FILE
set -euo pipefail
source "$(dirname "$0")/files.sh"
our_files '*.h' '*.cpp' | xargs -0 clang-format --dry-run -Werror
