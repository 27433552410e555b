#!/usr/bin/env bash
# From a fresh machine to a robot's positions: installs what is missing, builds Release, simulates the paper's run A under
# four blinking lamps, locates the robot in each frame, holds it against the truth and shows the report. May be run any
# number of times.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scenario=data/scenarios/paper-a.yaml
out=build/demo

main_job()
{
  local bin=build/release/bin
  "$bin/vlp-simulate" --scenario "$scenario" --every 6 --out "$out/run"
  "$bin/vlp-locate" --run "$out/run" --poses "$out/poses.tum" --fixes "$out/fixes.csv" --seen "$out/seen.csv" \
    --overlay "$out/overlay"
  "$bin/vlp-evaluate" --truth "$out/run/truth.tum" --fixes "$out/fixes.csv" --out "$out/report" \
    --title "Run A of the paper, simulated"
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
echo "The report, with its figures:    $out/report/report.html"
echo "What was seen in each frame:     $out/overlay/*.png"
echo "Frames and truth:                $out/run"
echo "Poses (TUM), fixes, lamps (CSV): $out"
show "$out/report/report.html"
