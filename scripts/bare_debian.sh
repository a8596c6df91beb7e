#!/usr/bin/env bash
# Proves that the two commands in README.md are enough for a newcomer: makes a bare Debian in a folder
# (debootstrap, nothing but the base system), clones this checkout into it as committed, and runs ./run
# or ./test there. Or it installs our packages there, uses them as an ordinary user, and removes them.
#
#     sudo scripts/bare_debian.sh bookworm|trixie run|test|package|all|shell [--again]
#
#     bookworm   Debian 12        trixie     Debian 13
#     package    the packages are those of build/packages (scripts/package.sh); made on the same release
#     all        ./run, ./test and scripts/package.sh, in this order, each to its end; then the packages
#                just made, in a second bare system. Says what each ended with
#     shell      a prompt in that system, in the clone
#     --again    keeps the system of the last run (with its packages); the clone is new
#
# The mirror, its keys and its proxy are those of apt on this machine, whichever of the two releases it
# has. The folder is $BURR_BARE, or /var/tmp/burr-bare-RELEASE; it needs about 10 GB and may be removed
# at any time. If there is a ../shared/data beside the checkout, the clone sees it read-only at the same
# place. BURR_REQUIRE_TOOLS=1 has the same meaning as for ./test, and BURR_CORES.
set -euo pipefail

release=${1:-} what=${2:-} again=no
[ "${3:-}" != --again ] || again=yes
case "$release:$what:$#:$again" in
  bookworm:*:2:no | trixie:*:2:no | bookworm:*:3:yes | trixie:*:3:yes) ;;
  *) what=none ;;
esac
case $what in
  run | test | package | all | shell) ;;
  *) echo "usage: sudo scripts/bare_debian.sh bookworm|trixie run|test|package|all|shell [--again]" >&2; exit 2 ;;
esac
declare -A numbers=([bookworm]=12 [trixie]=13)
name="Debian ${numbers[$release]}"
[ "$(id -u)" = 0 ] || { echo "bare_debian.sh: only root may make a system in a folder; try sudo" >&2; exit 1; }
for tool in debootstrap git unshare; do
  command -v $tool >/dev/null || { echo "bare_debian.sh: needs $tool; apt-get install $tool" >&2; exit 1; }
done
if [ ! -e "/usr/share/debootstrap/scripts/$release" ]; then
  echo "bare_debian.sh: debootstrap on this machine does not know $release; a newer one does" >&2
  exit 1
fi
# a mount namespace of our own: every mount disappears when this script ends
if [ -z "${BURR_BARE_INSIDE:-}" ]; then
  BURR_BARE_INSIDE=1 exec unshare --mount --propagation private "$0" "$@"
fi

checkout=$(cd "$(dirname "$0")/.." && pwd)
bare=${BURR_BARE:-/var/tmp/burr-bare-$release}

# "URI SUITE COMPONENT" of the release, from every archive of Debian that apt knows: they hold both releases
sources() {
  apt-get indextargets --format '$(ORIGIN)|$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    sed -nE "s/^Debian\|([^ ]+) (bookworm|trixie)(-updates|-security)? main\$/\1 $release\3 main/p" | sort -u
}
mirror=$(sources | awk -v suite="$release" '$2 == suite {print $1; exit}')
if [ -z "$mirror" ]; then
  echo "bare_debian.sh: apt on this machine knows no archive of Debian 12 or 13 (bookworm main, trixie main); try apt-get update" >&2
  exit 1
fi

make_system() {
  # removes only what it made itself
  if [ -e "$bare" ] && [ ! -f "$bare/.burr-bare" ] && [ -n "$(ls -A "$bare")" ]; then
    echo "bare_debian.sh: $bare is not empty and not ours; set BURR_BARE to another folder" >&2
    exit 1
  fi
  for place in newcomer/shared/data dev/pts dev/shm proc; do ! mountpoint -q "$bare/$place" || umount "$bare/$place"; done
  rm -rf --one-file-system "$bare"
  mkdir -p "$bare"
  echo "$release" >"$bare/.burr-bare"
  # the proxy of apt; debootstrap does its own downloads
  proxy=$(apt-config dump --format '%f=%v%n' Acquire::http::Proxy | sed -n 's/^Acquire::http::Proxy=//p')
  [ -z "$proxy" ] || export http_proxy="$proxy"
  echo "bare_debian.sh: making a bare $name in $bare ..."
  debootstrap --variant=minbase --include=ca-certificates "$release" "$bare" "$mirror" >"$bare.log" 2>&1 ||
    { tail -20 "$bare.log" >&2; exit 1; }
}

# Everything of this machine that the system needs, and a new clone.
set_up() {
  sources | sed 's/^/deb /' >"$bare/etc/apt/sources.list"
  apt-config dump | grep -E '^Acquire::(http|https|Check-|Retries|ForceIPv)' >"$bare/etc/apt/apt.conf.d/99as-outside" || true
  cp /etc/resolv.conf /etc/hosts "$bare/etc/"
  # an archive over https may need a certificate that only this machine has
  if [ -f /etc/ssl/certs/ca-certificates.crt ]; then
    mkdir -p "$bare/etc/ssl/certs"
    cp /etc/ssl/certs/ca-certificates.crt "$bare/etc/ssl/certs/"
  fi
  printf '#!/bin/sh\nexit 101\n' >"$bare/usr/sbin/policy-rc.d" # no services
  chmod +x "$bare/usr/sbin/policy-rc.d"

  mount -t proc proc "$bare/proc"
  mkdir -p "$bare/dev/shm" "$bare/dev/pts"
  mount -t tmpfs tmpfs "$bare/dev/shm"
  mount -t devpts -o newinstance,ptmxmode=0666 devpts "$bare/dev/pts"

  rm -rf --one-file-system "$bare/newcomer/burr"
  mkdir -p "$bare/newcomer"
  git -c safe.directory='*' clone -q --no-hardlinks "$checkout" "$bare/newcomer/burr"
  data=$checkout/../shared/data
  required=0
  if [ -d "$data" ]; then
    mkdir -p "$bare/newcomer/shared/data"
    mount --bind "$data" "$bare/newcomer/shared/data"
    mount -o remount,bind,ro "$bare/newcomer/shared/data"
    required=1
  fi
  inside=(chroot "$bare" env -i HOME=/newcomer TERM="${TERM:-dumb}" PATH=/usr/sbin:/usr/bin:/sbin:/bin BURR_REQUIRE_DATA=$required
    BURR_REQUIRE_TOOLS="${BURR_REQUIRE_TOOLS:-0}" ${BURR_CORES:+BURR_CORES="$BURR_CORES"})
}

results=() worst=0
# a command in the clone; says what it ended with
in_clone() {
  local started=$SECONDS code=0
  "${inside[@]}" bash -c "cd /newcomer/burr && $1" || code=$?
  results+=("$1 ended with $code after $((SECONDS - started)) s")
  [ $code = 0 ] || worst=$code
  echo "bare_debian.sh: $name: ${results[-1]}"
}

# FOLDER of packages: the release on which they were made
made_on() {
  dpkg-deb --fsys-tarfile "$1"/burr_*.deb | tar -xO ./usr/share/doc/burr/changelog.Debian.gz | zcat | sed -n '1s/.*) \([a-z]*\);.*/\1/p'
}

# FOLDER of packages
try_packages() {
  local started=$SECONDS code=0
  rm -rf --one-file-system "$bare/packages"
  mkdir "$bare/packages"
  cp "$1"/*.deb "$bare/packages/"
  "${inside[@]}" bash /newcomer/burr/packaging/try_in_debian.sh /packages || code=$?
  results+=("packages installed, used and removed: ended with $code after $((SECONDS - started)) s")
  [ $code = 0 ] || worst=$code
  echo "bare_debian.sh: $name: ${results[-1]}"
}

if [ $again = yes ] && [ -f "$bare/.burr-bare" ] && [ "$(cat "$bare/.burr-bare")" != "$release" ]; then
  echo "bare_debian.sh: the system in $bare is not $release; leave out --again, or set BURR_BARE" >&2
  exit 1
fi
if [ $what = package ]; then
  if ! compgen -G "$checkout/build/packages/burr_*.deb" >/dev/null; then
    echo "bare_debian.sh: there are no packages in build/packages; scripts/package.sh makes them" >&2
    exit 1
  fi
  made=$(made_on "$checkout/build/packages")
  if [ "$made" != "$release" ]; then
    echo "bare_debian.sh: the packages in build/packages were made on ${made:-an unknown release}, and this is $release;" \
      "scripts/package.sh makes them on $release, or: bare_debian.sh $release all" >&2
    exit 1
  fi
fi
[ $again = yes ] && [ -f "$bare/.burr-bare" ] || make_system
set_up
echo "bare_debian.sh: $name: $(git -c safe.directory='*' -C "$checkout" log -1 --format='%h %s')"
case $what in
  shell) "${inside[@]}" bash -c 'cd /newcomer/burr && exec bash' ;;
  package) try_packages "$checkout/build/packages" ;;
  run | test) in_clone "./$what" ;;
  all)
    in_clone ./run
    in_clone ./test
    in_clone scripts/package.sh
    if compgen -G "$bare/newcomer/burr/build/packages/burr_*.deb" >/dev/null; then
      kept=$(mktemp -d)
      trap 'rm -rf "$kept"' EXIT
      cp "$bare"/newcomer/burr/build/packages/*.deb "$kept/"
      make_system # so that the packages meet nothing that ./test has installed
      set_up
      try_packages "$kept"
    fi
    echo "bare_debian.sh: $name, $(git -c safe.directory='*' -C "$checkout" log -1 --format=%h):"
    printf '  %s\n' "${results[@]}"
    ;;
esac
exit $worst
