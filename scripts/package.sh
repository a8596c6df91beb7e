#!/usr/bin/env bash
# Makes packages of what was built: burr, libburr0, libburr-dev, python3-burr. They are for the release of Debian on which it
# was built and for no other, since the libraries that they need have other names there. Of the page for browsers, if it was built
# (scripts/build_page.sh), burr-web, for every release and processor, and an archive for any web server, burr-web-VERSION.tar.gz.
#
#     scripts/package.sh [BUILD] [OUT]        default: build/release, build/packages
#
# Install them with: sudo apt install ./build/packages/*.deb
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
out=$(realpath -m "${2:-build/packages}")
for tool in cmake dpkg-shlibdeps file help2man; do
  command -v $tool >/dev/null ||
    { echo "package.sh: needs $tool; scripts/install_packages.sh test installs it" >&2; exit 1; }
done
[ -x "$build/burr" ] || { echo "package.sh: $build/burr is not built; cmake --build $build" >&2; exit 1; }
packaging/files.sh "$build/burr" "$build/package"
mkdir -p "$out"
rm -f "$out"/*.deb "$out"/burr-web-*.tar.gz
page=$build/../web/published
# whether there is a page is asked when cmake looks at the tree
[ ! -f "$page/version.json" ] || grep -q CPACK_DEBIAN_WEB_PACKAGE_NAME "$build/CPackConfig.cmake" || cmake "$build" >/dev/null
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# the files of a package must be root's and readable, whatever this user's mask is
umask 022
SOURCE_DATE_EPOCH=$(git -c safe.directory='*' log -1 --format=%ct 2>/dev/null || date +%s)
export SOURCE_DATE_EPOCH
cpack --config "$build/CPackConfig.cmake" -B "$out" >"$log" 2>&1 || { cat "$log" >&2; exit 1; }
rm -rf "$out/_CPack_Packages"
[ ! -f "$page/version.json" ] || packaging/web_archive.sh "$page" "$out"
ls -l "$out"
