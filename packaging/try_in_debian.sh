#!/usr/bin/env bash
# Inside a bare Debian, as root: installs the packages, uses burr as an ordinary user, removes it, and looks for what is
# left. scripts/bare_debian.sh package starts it.
#
#     packaging/try_in_debian.sh FOLDER        of the .deb files
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
packages=$1
names=$(for one in "$packages"/*.deb; do dpkg-deb -f "$one" Package; done)
say() { printf '\n-- %s\n' "$*"; }

# every file of the system but what apt and dpkg keep for themselves
files() {
  find / -xdev \( -path /proc -o -path /sys -o -path /dev -o -path /tmp -o -path /var/lib/dpkg -o -path /var/lib/apt -o -path /var/cache \
    -o -path /var/log -o -path /newcomer -o -path /home -o -path "$packages" \) -prune -o -print | sort
}

say "what they need, from Debian"
apt-get -q update
# the needs alone first, so that what burr itself brings can be told from them
apt-get -q install -y --no-install-recommends man-db python3 bash-completion $(for one in "$packages"/*.deb; do
  dpkg-deb -f "$one" Depends | tr ',' '\n' | sed 's/ *(.*)//; s/ //g' | grep -vE '^(libburr|burr)'; done | sort -u)
for one in $names; do ! dpkg-query -W "$one" >/dev/null 2>&1 || apt-get -q purge -y "$one"; done # of an earlier try
id user >/dev/null 2>&1 || useradd --create-home user
files >/tmp/before

say "install"
apt-get -q install -y --no-install-recommends "$packages"/*.deb
dpkg --verify $names

say "use, as an ordinary user"
cat >/tmp/use.sh <<'X'
set -euo pipefail
cd "$(mktemp -d)"
burr --version
if ldd "$(command -v burr)" | grep "not found"; then exit 1; fi
burr --quiet phantom tooth --voxel-mm 0.3 --out tooth.seg.nrrd
burr --quiet info tooth.seg.nrrd | head -3
burr --quiet mill temporal-bone --motion pocket --record s.mcap --json
burr replay s.mcap --check
burr --quiet export s.mcap --part bone --out bone.stl
burr --quiet score s.mcap | head -5 || true
burr __complete mill phantom:t
man -w burr burr-mill burr-learner-xapi-on 7 burr
source /usr/share/bash-completion/bash_completion
_completion_loader burr || [ $? = 124 ] # it was loaded: try again
complete -p burr
if dpkg-query -W burr-web >/dev/null 2>&1; then burr web --out page && test -f page/mill/index.html; fi
if dpkg-query -W python3-burr >/dev/null 2>&1; then python3 -c 'import burr; print("import burr:", burr.__version__)'; fi
X
su user -s /bin/bash /tmp/use.sh

if dpkg-query -W libburr-dev >/dev/null 2>&1 && command -v cmake >/dev/null && command -v g++ >/dev/null; then
  say "a program of your own"
  su user -s /bin/bash -c 'cp -r /newcomer/burr/samples ~/samples && cmake -S ~/samples/installed -B ~/build && cmake --build ~/build'
fi

say "remove"
apt-get -q purge -y $names
files >/tmp/after
if ! diff /tmp/before /tmp/after; then
  echo "try_in_debian.sh: the lines above are left, or gone" >&2
  exit 1
fi
echo "installed, used, removed: nothing is left"
