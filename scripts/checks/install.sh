#!/usr/bin/env bash
# Checks that `cmake --install` gives a usable library: all samples build and run against it alone.
#
#     scripts/checks/install.sh BUILD
set -euo pipefail
source "$(dirname "$0")/files.sh"
build=$(realpath "$1")
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT

cmake --install "$build" --prefix "$place/prefix" >"$place/log" || { cat "$place/log"; exit 1; }
# copied to another place, so that nothing of this checkout can be found by accident
cp -r samples "$place/samples"
cmake -S "$place/samples/installed" -B "$place/build" -DCMAKE_PREFIX_PATH="$place/prefix" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="-O1 -Wall -Wextra -Werror"
cmake --build "$place/build"
ctest --test-dir "$place/build" --output-on-failure --no-tests=error
if ldd "$place/build/core" | grep -vE '(linux-vdso|libburr_core|libstdc\+\+|libm|libgcc_s|libc)\.so|/ld-linux-'; then
  echo "a program of burr::core loads the libraries above"
  exit 1
fi
# the public headers are complete: all of them in one program, with what was installed alone
(cd "$place/prefix/include" && find burr -name '*.h' | sort | sed 's/.*/#include <&>/') >"$place/all.cpp"
echo "int main() {}" >>"$place/all.cpp"
c++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror -I"$place/prefix/include" -isystem /usr/include/eigen3 "$place/all.cpp"
while read -r file name; do
  [ -f "$place/prefix/include/$name" ] || { echo "$file includes $name, which is not installed"; exit 1; }
done < <(cd "$place/prefix/include" && grep -rhoE --with-filename '^#include "burr/[^"]+"' burr | sed 's/:#include "\(.*\)"/ \1/')
"$place/prefix/bin/burr" --version
# the installed burr-read reads a scan
"$place/prefix/bin/burr" --quiet phantom ball --voxel-mm 1 --out "$place/ball.nrrd" >"$place/log"
"$place/prefix/bin/burr" --quiet phantom ball --voxel-mm 1 --out "$place/ball.seg.nrrd" >"$place/log"
"$place/prefix/bin/burr" --quiet info "$place/ball.nrrd"
# the installed burr-seg writes DICOM
"$place/prefix/bin/burr" --quiet export "$place/ball.seg.nrrd" --part labels --out "$place/ball.dcm" >"$place/log" 2>&1
"$place/prefix/bin/burr" --quiet info "$place/ball.dcm" >"$place/log"
grep -q "DICOM segmentation" "$place/log"
mv "$place/prefix/libexec/burr/burr-read" "$place/burr-read"
if "$place/prefix/bin/burr" --quiet info "$place/ball.nrrd" 2>"$place/log"; then
  echo "the installed burr reads scans with a helper that is not its own"
  exit 1
fi
grep -q "install burr again" "$place/log"
BURR_READ="$place/burr-read" "$place/prefix/bin/burr" --quiet info "$place/ball.nrrd"
# the installed module for Python, without the folder of the build: it finds the library, the bones and burr-read
if [ -d "$place"/prefix/lib/python3*/site-packages/burr ]; then
  (cd "$place" && env -u LD_LIBRARY_PATH PYTHONPATH="$(echo "$place"/prefix/lib/python3*/site-packages)" /usr/bin/python3 - <<'END'
import burr
import burr.env
bone = burr.Bone.load("ball.nrrd")
session = burr.Scene(bone, burr_mm=5).session(burr.Hand.motion("pocket", seconds=2))
assert session.step(500) == 500
assert "/prefix/" in burr.__file__
loaded = {line.split()[-1] for line in open("/proc/self/maps") if "libburr" in line}
assert loaded and all("/prefix/" in name for name in loaded), loaded
END
  )
fi
if grep -rlE '#include <(itk|gdcm|dcmtk|nlohmann|fmt|spdlog|SDL|epoxy|zstd)' "$place/prefix/include"; then
  echo "the installed headers above need more than Eigen"
  exit 1
fi
