#!/usr/bin/env bash
# The paper's section 3, number by number: simulates its experiments under an ideal and under typical rigs, locates, evaluates,
# and prints the table of tests/bench/paper.md. Takes about half an hour on two cores; needs 3 GB for a while.
#   bash tests/bench/paper.sh [FOLDER]   default build/benchmark; what is done there already is not done again
# RIGS=50: number of typical rigs.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${1:-build/benchmark}
rigs=${RIGS:-50}
bin=$PWD/build/release/bin

bash cmake/install-dependencies.sh
cmake --preset release >/dev/null
cmake --build --preset release --target vlp-simulate vlp-locate vlp-evaluate -- --quiet
mkdir -p "$out"

# NAME SCENARIO SOLVER OPTIONS...: statistics in $out/NAME/statistics.csv
run()
{
  local name=$1 scenario=$2 solver=$3 frames
  shift 3
  [ -f "$out/$name/statistics.csv" ] && return
  frames=$(mktemp -d)
  "$bin/vlp-simulate" --scenario "data/scenarios/$scenario.yaml" --out "$frames/run" --format pgm "$@" 2>/dev/null
  "$bin/vlp-locate" --run "$frames/run" --solver "$solver" --no-track --fixes "$frames/fixes.csv" 2>/dev/null
  "$bin/vlp-evaluate" --truth "$frames/run/truth.tum" --fixes "$frames/fixes.csv" --out "$out/$name" \
    --title "$name" >"$frames/table.txt" 2>/dev/null
  mv "$frames/table.txt" "$out/$name/table.txt"
  rm -rf "$frames"
}
export -f run
export out bin

jobs()
{
  local scenario seed
  for scenario in paper-still paper-points paper-points-200us paper-points-full paper-points-full-200us; do
    echo "$scenario $scenario all"
    echo "$scenario-two $scenario two"
  done
  seed=0
  for scenario in paper-a paper-b paper-c paper-d paper-e paper-f; do
    seed=$((seed + 1))
    echo "$scenario $scenario all --seed $seed"
  done
  for seed in $(seq "$rigs"); do
    echo "typical-paper-still-$seed paper-still all --typical --seed $seed --every 4"
    echo "typical-paper-points-$seed paper-points all --typical --seed $seed --every 4"
    echo "typical-paper-points-two-$seed paper-points two --typical --seed $seed --every 12"
    for scenario in paper-a paper-b paper-e paper-f; do
      echo "typical-$scenario-$seed $scenario all --typical --seed $seed --every 60"
    done
  done
}
jobs | xargs -P "$(nproc)" -I{} bash -c 'set -e; run {}'

value() # NAME KEY UNIT-FACTOR
{
  awk -F, -v key="$2" -v factor="$3" '$1 == key { printf "%.3f", factor * $3; found = 1 } END { if (!found) printf "-" }' \
    "$out/$1/statistics.csv"
}
over_rigs() # NAME KEY UNIT-FACTOR: median and 90 % over the typical rigs
{
  local seed
  for seed in $(seq "$rigs"); do value "typical-$1-$seed" "$2" "$3"; echo; done | sort -g |
    awk '{ x[NR] = $1 } END { printf "%.2f / %.2f", (x[int((NR + 1) / 2)] + x[int((NR + 2) / 2)]) / 2, x[int(0.9 * NR + 0.5)] }'
}
line() # LABEL PAPER IDEAL TYPICAL
{
  printf '| %s | %s | %s | %s |\n' "$@"
}

echo "| | the paper | ideal rig | $rigs typical rigs: median / 90 % |"
echo "|---|---|---|---|"
line "standing still, dispersion radius, mm" "4.28 (6.58 uncorrected)" "$(value paper-still dispersion_radius 1000)" \
  "$(over_rigs paper-still dispersion_radius 1000)"
line "standing still, mean error, mm" "8 (middle of the circle)" "$(value paper-still horizontal_mean 1000)" \
  "$(over_rigs paper-still horizontal_mean 1000)"
line "36 points x 12, 800x600, all lamps: mean, mm" "8.2" "$(value paper-points horizontal_mean 1000)" \
  "$(over_rigs paper-points horizontal_mean 1000)"
line "the same, 90 %, mm" "14.17" "$(value paper-points horizontal_p90 1000)" "$(over_rigs paper-points horizontal_p90 1000)"
line "the same, two lamps: mean, mm" "8.2" "$(value paper-points-two horizontal_mean 1000)" \
  "$(over_rigs paper-points-two horizontal_mean 1000)"
line "the same, exposed for 215 us, all lamps; two: mean, mm" "" \
  "$(value paper-points-200us horizontal_mean 1000); $(value paper-points-200us-two horizontal_mean 1000)" ""
line "36 points x 12, 2048x1536, all lamps; two: mean, mm" "" \
  "$(value paper-points-full horizontal_mean 1000); $(value paper-points-full-two horizontal_mean 1000)" ""
line "the same, exposed for 215 us, all lamps; two: mean, mm" "" \
  "$(value paper-points-full-200us horizontal_mean 1000); $(value paper-points-full-200us-two horizontal_mean 1000)" ""
for row in 'a A -' 'b B -' 'c C 19.44' 'd D 20.29' 'e E 24.45 (96 %)' 'f F 18.29 (96 %)'; do
  read -r scenario label paper <<<"$row"
  typical=
  case $scenario in a | b | e | f) typical=$(over_rigs "paper-$scenario" horizontal_p95 1000) ;; esac
  line "run $label at 0.4 cm/s, 95 % of the error, mm" "${paper}" "$(value "paper-$scenario" horizontal_p95 1000)" "$typical"
done
for row in 'a A -' 'b B -' 'c C 19.44' 'd D 20.29' 'e E 24.45 (96 %)' 'f F 18.29 (96 %)'; do
  read -r scenario label paper <<<"$row"
  line "run $label, 95 % of the distance to the line, as the paper measures, mm" "${paper}" \
    "$(value "paper-$scenario" line_p95 1000)" ""
done
for row in 'a A y=0.0051x+1.0714' 'b B x=-0.0171y-1.2286' 'c C y=-0.01058x+0.8293' 'd D x=-0.0275y-1.5530' \
  'e E y=0.0187x-1.9313' 'f F x=0.0445y-0.9643'; do
  read -r scenario label paper <<<"$row"
  line "run $label, fitted line, cm" "$paper" "$(grep -o '[xy] = .*' "$out/paper-$scenario/table.txt" | head -1)" ""
done
line "share of frames with a fix, %: points 800x600 at 43 us, two lamps, at 215 us, two lamps" "" \
  "$(value paper-points fix_share 100); $(value paper-points-two fix_share 100); $(value paper-points-200us fix_share 100); $(value paper-points-200us-two fix_share 100)" \
  "$(over_rigs paper-points fix_share 100)"
line "the same at 2048x1536" "" \
  "$(value paper-points-full fix_share 100); $(value paper-points-full-two fix_share 100); $(value paper-points-full-200us fix_share 100); $(value paper-points-full-200us-two fix_share 100)" ""
for row in 'a A 361.9' 'b B 353.8' 'c C 120.7' 'd D 122.1' 'e E 797.0' 'f F 808.5'; do
  read -r scenario label paper <<<"$row"
  line "run $label, mean time of a fix, ms (other machines)" "$paper" "$(value "paper-$scenario" compute_mean 1000)" ""
done
line "consistency: mean NEES in x, y (2 is right)" "" "$(value paper-points nees_xy_mean 1)" "$(over_rigs paper-points nees_xy_mean 1)"
