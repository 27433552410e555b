#!/usr/bin/env bash
# From a fresh machine to a robot's positions: installs what is missing, builds Release, locates the robot in each frame
# of the recorded run data/paper-room and shows what came out. May be run any number of times.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/.."

run=data/paper-room
out=build/demo

main_job()
{
  build/release/bin/vlp-locate --run "$run" --poses "$out/poses.tum" --fixes "$out/fixes.csv" --seen "$out/seen.csv" \
    --overlay "$out/overlay"
}

# The fixes, each with its distance from where the robot truly was.
table()
{
  awk '
    BEGIN { degrees = 45 / atan2(1, 1); FS = "[ ,]"
            printf "%8s %9s %9s %9s %10s %9s  %s\n", "time s", "x m", "y m", "yaw deg", "sigma mm", "error mm", "lamps" }
    FNR == 1 || /^#/ { next }
    NR == FNR        { x[$1 + 0] = $2; y[$1 + 0] = $3; next }
    $14 == "none"    { printf "%8.2f  no position\n", $1; next }
    { printf "%8.2f %9.4f %9.4f %9.3f %10.2f %9.2f  %s\n", $1, $2, $3, $7 * degrees,
             1000 * sqrt($8 ^ 2 + $9 ^ 2), 1000 * sqrt(($2 - x[$1 + 0]) ^ 2 + ($3 - y[$1 + 0]) ^ 2), $13 }
  ' "$run/truth.tum" "$out/fixes.csv"
}

show() # PICTURE, where there is a screen and a program for it
{
  [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] || return 0
  local viewer
  for viewer in xdg-open eog feh display; do
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
table
echo
echo "What was seen in each frame: $out/overlay/*.png"
echo "Poses (TUM), fixes and lamps seen (CSV): $out"
pictures=("$out"/overlay/*.png)
show "${pictures[0]}"
