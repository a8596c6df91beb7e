#!/usr/bin/env bash
# The library in parts (cmake/library.cmake), each as light as it says:
# libburr_core.so needs the C++ library and the C library alone, and starts threads in rt/thread.cpp alone;
# no part needs a function of a part above it.
#
#     scripts/checks/core_is_light.sh BUILD
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
wrong=0
complain() { echo "$1"; wrong=1; }

while read -r needed _; do
  case $(basename "$needed") in
    linux-vdso.so.* | libstdc++.so.* | libm.so.* | libgcc_s.so.* | libc.so.* | ld-linux-*) ;;
    *) complain "libburr_core.so needs $needed" ;;
  esac
done < <(ldd "$build/libburr_core.so")

# libraries of file formats stay in burr-read and burr-seg
while read -r needed _; do
  case $(basename "$needed") in libdcm* | libofstd* | libgdcm*) complain "libburr.so loads $needed" ;; esac
done < <(ldd "$build/libburr.so")

objects() { find "$build/CMakeFiles/$1.dir" -name '*.o' | sort; }
[ -n "$(objects burr_core)" ] || complain "no objects of burr_core in $build"
while read -r object; do
  # what std::thread and std::jthread begin with, and what std::async ends at
  if nm -u "$object" | grep -qE 'pthread_create|_M_start_thread' && [[ $object != */rt/thread.cpp.o ]]; then
    complain "$object starts a thread; call rt::on_threads or rt::Thread (rt/thread.h)"
  fi
done < <(objects burr_core)

# names that a part defines for others, and that it needs of others; no templates and inline functions (W, V)
names() { objects "$1" | xargs nm -g "$2" | awk -v kinds="$3" 'NF >= 2 && index(kinds, $(NF-1)) {print $NF}' | sort -u; }
leaves=(burr_render_gl burr_sound burr_device_crtk burr_device_forcedimension burr_device_haply burr_device_openhaptics
  burr_device_polhem)
top=(burr_workshop burr_front)  # may need all others, and the second the first; nothing needs them
not_above() {  # PART ABOVE...
  local part=$1 above found
  shift
  for above in "$@"; do
    found=$(comm -12 <(names "$part" -u U) <(names "$above" --defined-only TBDR) | head -3)
    [ -z "$found" ] || complain "$part needs of $above: $(c++filt <<<"$found" | tr '\n' ' ')"
  done
}
not_above burr_core burr_files burr_session "${leaves[@]}" "${top[@]}"
not_above burr_files burr_session "${leaves[@]}" "${top[@]}"
not_above burr_session "${leaves[@]}" "${top[@]}"
for leaf in "${leaves[@]}"; do
  others=()
  for other in "${leaves[@]}"; do [ "$other" = "$leaf" ] || others+=("$other"); done
  not_above "$leaf" "${others[@]}" "${top[@]}"
done
not_above burr_workshop burr_front
exit $wrong
