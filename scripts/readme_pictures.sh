#!/usr/bin/env bash
# Makes the pictures at the top of README.md from the built-in temporal bone: the operating field, and a film of 20 s.
#
#     scripts/readme_pictures.sh [BUILD]      BUILD: folder of the program; default build/release
#
# Writes docs/pictures/temporal_bone.webp and docs/pictures/mastoidectomy.webp (animated; a browser plays it in the page).
# Needs ffmpeg. Takes about ten minutes. Work files: a folder that is removed at the end.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(cd "${1:-$root/build/release}" && pwd)
command -v ffmpeg >/dev/null || { echo "ffmpeg is missing: install the package ffmpeg" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
film_s=20 rate=12  # seconds of the film, pictures a second
shown_s=1120       # the moment of the still picture

"$root/scripts/mastoidectomy.py" > "$work/path.csv"
seconds=$(tail -1 "$work/path.csv" | cut -d, -f1)
"$build/burr" mill phantom:temporal-bone --path "$work/path.csv" --stiffness 2000 --arm rigid --undo-bricks 60000 \
    --record "$work/mastoid.mcap" --embed
"$build/burr" replay "$work/mastoid.mcap" --at $shown_s --view microscope --height-mm 50 --picture-size 1280,720 \
    --picture "$work/still.png"
ffmpeg -v error -y -i "$work/still.png" -c:v libwebp -quality 88 "$root/docs/pictures/temporal_bone.webp"
# the whole operation in `film_s`
fps=$(awk "BEGIN { printf \"%.6f\", $film_s * $rate / $seconds }")
"$build/burr" replay "$work/mastoid.mcap" --view microscope --height-mm 50 --fps "$fps" --picture-size 640,360 \
    --film "$work/film"
ffmpeg -v error -y -framerate $rate -i "$work/film/frame_%06d.png" -c:v libwebp_anim -loop 0 \
    -quality 72 -compression_level 6 "$root/docs/pictures/mastoidectomy.webp"
ls -l "$root/docs/pictures/temporal_bone.webp" "$root/docs/pictures/mastoidectomy.webp"
