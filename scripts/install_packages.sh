#!/usr/bin/env bash
# Installs the missing packages of scripts/packages.txt, and says which and why.
#
#     scripts/install_packages.sh run|test        test: everything of run as well
#
# With BURR_REQUIRE_TOOLS=1 (CI), `test` also installs the large tools of section [tools].
# Does nothing, and needs no network and no rights, if none is missing.
#
# A line of the list with a release in brackets ("name [bookworm]  # why") is for that release alone; one with a program in braces
# ("name {program}  # why") only for who does not have the program: node from elsewhere brings its own npm.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)

case "${1:-}" in
  run | test) wanted=$1 ;;
  *) echo "usage: scripts/install_packages.sh run|test" >&2; exit 2 ;;
esac

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "burr: this is not Debian; install the equivalents of scripts/packages.txt yourself, then" >&2
  echo "      cmake --preset release && cmake --build build/release" >&2
  exit 1
fi

release=$(source /etc/os-release && echo "${VERSION_CODENAME:-unknown}")
system=$(source /etc/os-release && echo "${PRETTY_NAME:-a Debian of unknown release}")
installed=$(dpkg-query -W -f '${Package} ${db:Status-Abbrev}\n' | awk '$2 ~ /^.i/ {print $1}')
missing=() elsewhere=() section=
while IFS= read -r line; do
  case $line in
    '[run]') section=run; continue ;;
    '[test]') section=test; continue ;;
    '[tools]') section=tools; continue ;;
    '' | '#'*) continue ;;
  esac
  [ "$section" = run ] || [ "$wanted" = test ] || continue
  [ "$section" != tools ] || [ "${BURR_REQUIRE_TOOLS:-0}" = 1 ] || continue
  package=${line%%[ #]*}
  if [[ $line =~ ^[^#]*\{([a-z]+)\} ]] && command -v "${BASH_REMATCH[1]}" >/dev/null; then continue; fi
  if [[ $line =~ ^[^#]*\[([a-z]+)\] && ${BASH_REMATCH[1]} != "$release" ]]; then
    elsewhere+=("$package (only on ${BASH_REMATCH[1]}: ${line#*# })")
    continue
  fi
  grep -qxF "$package" <<<"$installed" && continue
  missing+=("$package")
  [ ${#missing[@]} -gt 1 ] || echo "burr: missing Debian packages:"
  printf '  %-24s %s\n' "$package" "${line#*# }"
done <"$here/packages.txt"
[ ${#missing[@]} -gt 0 ] || exit 0
for one in "${elsewhere[@]}"; do echo "burr: left out on $system: $one"; done
case $release in
  bookworm | trixie) ;;
  *) echo "burr: this is $system. burr was tested on Debian 12, and in part on Debian 13 (docs/use/install.md); a package may have another name here" ;;
esac

root=()
if [ "$(id -u)" != 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "burr: no right to install them; ask somebody to run, as root:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  root=(sudo)
fi
echo "burr: installing ${#missing[@]} packages with ${root[*]:+sudo }apt-get ..."
apt=("${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q)
if ! "${apt[@]}" update || ! "${apt[@]}" install -y --no-install-recommends "${missing[@]}"; then
  echo "burr: apt-get could not install them; its message above says why" >&2
  exit 1
fi
