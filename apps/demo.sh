#!/usr/bin/env bash
# From a fresh machine to the main job: installs what is missing, builds Release, and lets the simulated TurtleBot under the
# paper's four lamps drive the paper's lines and a square, once on what it sees and once on odometry alone; shows how far off
# each was, and where it went. May be run any number of times.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scenario=data/scenarios/servo.yaml
out=build/demo

main_job()
{
  local bin=build/release/bin path runs=()
  for path in line-a line-b square; do
    echo "$path, on the lamps"
    "$bin/vlp-servo" --robot sim --scenario "$scenario" --path "data/paths/$path.yaml" --speed 0.1 \
      --log "$out/$path-lamps" >"$out/$path-lamps.txt"
    echo "$path, on odometry alone"
    "$bin/vlp-servo" --robot sim --scenario "$scenario" --wheels-only --odometry-only --path "data/paths/$path.yaml" \
      --speed 0.1 --log "$out/$path-odometry" >"$out/$path-odometry.txt"
    runs+=("$out/$path-lamps" "$out/$path-odometry")
  done
  "$bin/vlp-evaluate" --runs "${runs[@]}" --out "$out/report" \
    --title "The paper's lines and a square, on the lamps and on odometry alone"
}

show() # FILE, where there is a screen and a program for it
{
  [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || return 0
  local viewer
  for viewer in xdg-open firefox chromium; do
    if command -v "$viewer" >/dev/null; then
      "$viewer" "$1" >/dev/null 2>&1 &
      return 0
    fi
  done
}

bash cmake/install-dependencies.sh
rm -rf "$out"
mkdir -p "$out"
cmake --preset release -DVLP_BUILD_TESTS=OFF >"$out/configure.log" 2>&1 || { cat "$out/configure.log" >&2; exit 1; }
quiet=()
[ -t 1 ] || quiet=(-- --quiet) # on a terminal Ninja's one line is the progress
cmake --build --preset release "${quiet[@]}"

main_job
echo
echo "The report, with its figures:       $out/report/report.html"
echo "Each run's tracks, poses, commands: $out/*-lamps, $out/*-odometry"
show "$out/report/report.html"
