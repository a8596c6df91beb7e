#!/usr/bin/env bash
# Proves that the two commands in README.md are enough for a newcomer: makes a bare Debian 12 in a
# folder (debootstrap, nothing but the base system), clones this checkout into it as committed, and
# runs ./run or ./test there. Or it installs our packages there, uses them as an ordinary user, and removes them.
#
#     sudo scripts/bare_debian.sh run|test|package|shell [--again]
#
#     package    the packages are those of build/packages (scripts/package.sh)
#     shell      a prompt in that system, in the clone
#     --again    keeps the system of the last run (with its packages); the clone is new
#
# The mirror, its keys and its proxy are those of apt on this machine. The folder is $BURR_BARE, or
# /var/tmp/burr-bare-debian; it needs about 5 GB and may be removed at any time. If there is a
# ../shared/data beside the checkout, the clone sees it read-only at the same place.
set -euo pipefail

what=${1:-} again=no
[ "${2:-}" != --again ] || again=yes
case "$what:$#:$again" in
  run:1:no | test:1:no | package:1:no | shell:1:no | run:2:yes | test:2:yes | package:2:yes | shell:2:yes) ;;
  *) echo "usage: sudo scripts/bare_debian.sh run|test|package|shell [--again]" >&2; exit 2 ;;
esac
[ "$(id -u)" = 0 ] || { echo "bare_debian.sh: only root may make a system in a folder; try sudo" >&2; exit 1; }
for tool in debootstrap git unshare; do
  command -v $tool >/dev/null || { echo "bare_debian.sh: needs $tool; apt-get install $tool" >&2; exit 1; }
done
# a mount namespace of our own: every mount disappears when this script ends
if [ -z "${BURR_BARE_INSIDE:-}" ]; then
  BURR_BARE_INSIDE=1 exec unshare --mount --propagation private "$0" "$@"
fi

checkout=$(cd "$(dirname "$0")/.." && pwd)
bare=${BURR_BARE:-/var/tmp/burr-bare-debian}

# "URI CODENAME COMPONENT" of every Debian 12 archive that apt knows
sources() {
  apt-get indextargets --format '$(ORIGIN)|$(REPO_URI) $(CODENAME) $(COMPONENT)' 'Created-By: Packages' |
    sed -n 's/^Debian|\(.* bookworm[a-z-]* main\)$/\1/p' | sort -u
}
mirror=$(sources | awk '$2 == "bookworm" {print $1; exit}')
if [ -z "$mirror" ]; then
  echo "bare_debian.sh: apt on this machine knows no archive of Debian 12 (bookworm main); try apt-get update" >&2
  exit 1
fi

if [ $again = no ] || [ ! -f "$bare/.burr-bare" ]; then
  # removes only what it made itself
  if [ -e "$bare" ] && [ ! -f "$bare/.burr-bare" ] && [ -n "$(ls -A "$bare")" ]; then
    echo "bare_debian.sh: $bare is not empty and not ours; set BURR_BARE to another folder" >&2
    exit 1
  fi
  rm -rf --one-file-system "$bare"
  mkdir -p "$bare"
  touch "$bare/.burr-bare"
  # the proxy of apt; debootstrap does its own downloads
  proxy=$(apt-config dump --format '%f=%v%n' Acquire::http::Proxy | sed -n 's/^Acquire::http::Proxy=//p')
  [ -z "$proxy" ] || export http_proxy="$proxy"
  echo "bare_debian.sh: making a bare Debian 12 in $bare ..."
  debootstrap --variant=minbase --include=ca-certificates bookworm "$bare" "$mirror" >"$bare.log" 2>&1 ||
    { tail -20 "$bare.log" >&2; exit 1; }
fi

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

inside=(chroot "$bare" env -i HOME=/newcomer TERM="${TERM:-dumb}" PATH=/usr/sbin:/usr/bin:/sbin:/bin BURR_REQUIRE_DATA=$required)
echo "bare_debian.sh: $(git -c safe.directory='*' -C "$checkout" log -1 --format='%h %s')"
started=$SECONDS
case $what in
  shell) "${inside[@]}" bash -c 'cd /newcomer/burr && exec bash' ;;
  package)
    rm -rf --one-file-system "$bare/packages"
    mkdir "$bare/packages"
    cp "$checkout"/build/packages/*.deb "$bare/packages/" ||
      { echo "bare_debian.sh: there are no packages; scripts/package.sh makes them" >&2; exit 1; }
    "${inside[@]}" bash /newcomer/burr/packaging/try_in_debian.sh /packages
    ;;
  *)
    code=0
    "${inside[@]}" bash -c "cd /newcomer/burr && ./$what" || code=$?
    echo "bare_debian.sh: ./$what ended with $code after $((SECONDS - started)) s"
    exit $code
    ;;
esac
