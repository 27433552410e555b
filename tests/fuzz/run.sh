#!/usr/bin/env bash
# Builds the programs of libFuzzer (preset fuzz, clang) and runs them in rounds, at most half an hour of each at a time.
#   bash tests/fuzz/run.sh [SECONDS] [TARGET...]   default: 60 s, shared by all targets
#   bash tests/fuzz/run.sh 0                       only the table: what all runs so far took and reached
# VLP_FUZZ_BUILT=1 runs them as they are built, beside work on the code, which may stop them for minutes. Corpora grow in
# build/fuzz/corpus/<target>, and each run adds a line to build/fuzz/runs.csv. What breaks a target is left in
# build/fuzz/found/<target>: mend the code, and move the file to tests/fuzz/findings/<target>.
# Exit code: 0 nothing was found, 1 something was.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
export OPENCV_IO_MAX_IMAGE_PIXELS=$((1 << 26)) # or a header of a few bytes makes it ask for 8 GB, more than -rss_limit_mb

seconds=${1:-60}
longest=20 # s by the clock, of one input
[ -z "${VLP_FUZZ_BUILT:-}" ] || longest=600
targets=("${@:2}")
runs=build/fuzz/runs.csv

# Edges are counters of all instrumented code, of which a target links its module and those below.
table()
{
  echo '| target | CPU s | runs | edges | of | corpus |'
  echo '|---|---|---|---|---|---|'
  LC_ALL=C sort -t, -k1,1 -s "$runs" | awk -F, '
    function row() { if (name != "") printf "| `%s` | %.0f | %.0f | %d | %d | %d |\n", name, cpu, count, edges, all, corpus }
    $1 != name { row(); name = $1; cpu = count = 0 }
    { cpu += $2; count += $3; edges = $4; all = $5; corpus = $6; total += $2 }
    END { row(); printf "%.2f CPU-hours in all\n", total / 3600 }'
}

dictionary() # TARGET
{
  case $1 in
    lamps | path | rig | scenario | cameraInfo | places) echo yaml ;;
    cameraXml) echo xml ;;
    trajectory | frames | odometry | commands | fixes) echo table ;;
  esac
}

run() # TARGET SECONDS
{
  local target=$1 found=build/fuzz/found/$1 corpus=build/fuzz/corpus/$1 words log status=0 options=()
  words=$(dictionary "$target")
  [[ ! $target =~ ^(observations|pictures)$ ]] || options+=(-use_counters=0) # how often loops of numbers turn is no news
  log=$found/log.txt
  mkdir -p "$corpus" "$found"
  TIMEFORMAT='%U %S'
  { time TMPDIR=$scratch build/fuzz/bin/"fuzz_$target" -max_total_time="$2" -timeout="$longest" -rss_limit_mb=2048 -max_len=4096 \
      -print_final_stats=1 "${options[@]}" ${words:+-dict=tests/fuzz/dictionaries/$words.dict} -artifact_prefix="$found/" \
      "$corpus" "build/fuzz/seeds/$target" >"$log" 2>&1; } 2>"$scratch/cpu" || status=1
  local cpu executed edges all
  cpu=$(awk 'END { print $1 + $2 }' "$scratch/cpu")
  executed=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(grep -oE 'cov: [0-9]+' "$log" | tail -n 1 | cut -d ' ' -f 2 || true)
  all=$(sed -n 's/.*(\([0-9]*\) inline 8-bit counters).*/\1/p' "$log")
  echo "$target,$cpu,${executed:-0},${edges:-0},${all:-0},$(find "$corpus" -type f | wc -l)" >>"$runs"
  echo "$target: $cpu s, ${executed:-0} runs, ${edges:-0} edges"
  [ $status -eq 0 ] || tail -n 40 "$log" >&2
  return $status
}

if [ "$seconds" -eq 0 ]; then
  table
  exit
fi
if [ -z "${VLP_FUZZ_BUILT:-}" ]; then
  cmake --preset fuzz >/dev/null
  cmake --build --preset fuzz
fi
if [ "${#targets[@]}" -eq 0 ]; then
  mapfile -t targets < <(find build/fuzz/bin -name 'fuzz_*' -printf '%f\n' | sed 's/^fuzz_//' | sort)
fi
[ -d build/fuzz/seeds ] || build/fuzz/bin/makeFuzzSeeds build/fuzz/seeds

scratch=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo /tmp)") # targets write a file for each input
trap 'rm -rf "$scratch"' EXIT
status=0
each=$((seconds / ${#targets[@]} > 0 ? seconds / ${#targets[@]} : 1))
rounds=$(((each + 1799) / 1800))
for ((round = 0; round < rounds; ++round)); do
  for target in "${targets[@]}"; do
    run "$target" $((each / rounds)) || status=1
  done
done
table
exit $status
