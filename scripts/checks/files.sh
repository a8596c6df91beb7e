# Sourced by the other checks: changes to the root of the checkout, and lists its tracked files.
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 1

# our_files PATTERN...: tracked files; safe.directory, because in CI another user may own the
# checkout
our_files() { git -c safe.directory='*' ls-files -z -- "$@"; }
