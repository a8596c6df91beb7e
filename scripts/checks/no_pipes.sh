#!/usr/bin/env bash
# no_pipes.sh BURR: names that are pipes, sockets, devices or folders where burr needs a file, read or written, for every command. Each is
# refused at once, with a sentence that says what it is, and none is waited for: nobody ever writes to these pipes.
set -uo pipefail
burr=${1:?which burr?}
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cd "$place" || exit 2
bad=0
patience=20  # [s]; the first tools of a machine take some
for name in scan.nrrd seg.nrrd a.mcap path.csv tools.toml case.toml rubric.toml marks.csv force.csv table.toml labels.toml m.csv store.sqlite books.toml law.so key.txt self.json a.bone \
  out.mcap out.stl out.nrrd out.png out.html out.toml out.zip out.csv out.hdf5 out.wav out.mp4 out.sqlite; do
  mkfifo "$name"
done
mkdir tools meshes
for form in stl obj ply; do
  mkfifo "meshes/pipe.$form"
  printf '[[tool]]\nname = "x"\ntitle = "X"\ndrive = "pushed"\nway = [0, 0, -1]\n[[tool.part]]\nshape = "mesh"\nrole = "cuts"\nfile = "meshes/pipe.%s"\n' "$form" >"$form.toml"
done

# refused COMMAND...: within 20 s, not with 0, and the last sentence names a pipe (or what WHAT says)
refused() {
  local got said
  timeout -k 2 "$patience" "$burr" "$@" >out.txt 2>err.txt </dev/null
  got=$?
  said=$(cat err.txt)
  if [ $got = 124 ]; then
    echo "waits for a pipe: $*"
  elif [ $got = 0 ] || [ $got -gt 128 ]; then
    echo "exit code $got: $*: $(tail -1 <<<"$said")"
  elif ! grep -qE "${what:-is a pipe}" <<<"$said"; then
    echo "does not say that it is a pipe: $*: $(tail -1 <<<"$said")"
  else
    return 0
  fi
  bad=1
}

block=(mill phantom:block --motion slot --seconds 1)
# what is read
refused info scan.nrrd
refused info a.mcap
refused info a.bone
refused mill scan.nrrd --motion slot --seconds 1
refused mill a.bone --motion slot --seconds 1
refused mill case.toml --motion slot --seconds 1
refused mill phantom:block --path path.csv
refused "${block[@]}" --tools tools.toml --tool x
for form in stl obj ply; do refused "${block[@]}" --tools "$form.toml" --tool x; done
refused "${block[@]}" --materials table.toml
refused "${block[@]}" --law law.so
refused mill seg.nrrd --labels seg.nrrd --motion slot --seconds 1
refused replay a.mcap
refused pieces a.mcap
refused replay a.mcap --check
refused repair a.mcap
refused score a.mcap
refused report a.mcap --out r.html
refused compare a.mcap a.mcap --out c.html
refused export scan.nrrd --out a.stl
refused export a.mcap --out a.stl
refused picture scan.nrrd --out a.png
refused case check case.toml
refused rubric check rubric.toml
refused tools --tools tools.toml
refused materials --materials table.toml
refused fit force.csv --out fitted.toml
refused study reliability marks.csv
refused learner list --store store.sqlite
refused serve --store store.sqlite
refused batch --manifest m.csv --out results
refused surgeon case.toml --seconds 1 --record s.mcap
refused arm scan.nrrd --seconds 1
refused run scan.nrrd --headless
# what is written
what='is a pipe|pipe or a device' refused "${block[@]}" --record out.mcap
what='is a pipe|pipe or a device' refused "${block[@]}" --picture out.png
what='is a pipe|pipe or a device' refused picture phantom:block --out out.png
what='is a pipe|pipe or a device' refused phantom block --out out.nrrd
what='is a pipe|pipe or a device' refused export phantom:block --out out.stl
what='is a pipe|pipe or a device' refused surgeon block --seconds 1 --record out.mcap
what='is a pipe|pipe or a device' refused case new phantom:block --out out.toml
# the others of their kind, once
ln -s /dev/zero endless.nrrd
mkdir folder.csv
python3 -c 'import socket; socket.socket(socket.AF_UNIX).bind("socket.toml")'
what='is a device' refused info endless.nrrd
what='is a device' refused mill endless.nrrd --motion slot --seconds 1
what='is a folder' refused mill phantom:block --path folder.csv
what='is a socket' refused tools --tools socket.toml
what='is a socket' refused case check socket.toml
exit $bad
