# Sourced by the other checks: goes to the root of the checkout, and lists its own files.
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1

# our_files PATTERN...: tracked files; safe.directory, because CI may not own the checkout
our_files() { git -c safe.directory='*' ls-files -z -- "$@"; }
