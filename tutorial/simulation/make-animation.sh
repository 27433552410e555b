#!/usr/bin/env bash
# Makes the moving picture of the README: simulates at-work.yaml, locates the robot in it, and joins what vlp-locate shows.
# Needs ffmpeg and gifsicle, and a build.
#   bash tutorial/simulation/make-animation.sh [BIN]   default: build/release/bin
set -euo pipefail
export LC_ALL=C
bin=$(cd "${1:-build/release/bin}" && pwd)
cd "$(dirname "${BASH_SOURCE[0]}")"
for program in ffmpeg gifsicle; do
  command -v "$program" >/dev/null || { echo "make-animation.sh: it needs $program" >&2; exit 1; }
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$bin/vlp-simulate" --scenario at-work.yaml --out "$work/run"
"$bin/vlp-locate" --run "$work/run" --odometry "$work/run/odometry.csv" --poses "$work/poses.tum" --overlay "$work/look"
"$bin/vlp-evaluate" --truth "$work/run/truth.tum" --estimate "$work/poses.tum"

# Ten frames a second, as they were taken. Few colours and no dithering: most of a frame is that of the frame before.
ffmpeg -v error -framerate 10 -pattern_type glob -i "$work/look/*.png" -filter_complex \
  "[0]scale=840:-1:flags=area,split[a][b];[a]palettegen=max_colors=48:stats_mode=full[p];[b][p]paletteuse=dither=none:diff_mode=rectangle" \
  -loop 0 "$work/look.gif"
gifsicle -O3 --lossy=30 "$work/look.gif" -o img-at-work.gif
ls -l img-at-work.gif
