#!/usr/bin/env bash
# Builds the programs of libFuzzer (preset fuzz, clang) and runs them one after the other.
#   bash tests/fuzz/run.sh [SECONDS] [TARGET...]   default: 60 s, shared by all targets
# Corpora grow in build/fuzz/corpus/<target>. What breaks a target is left in build/fuzz/found/<target>: mend the code,
# and move the file to tests/fuzz/findings/<target>. Exit code: 0 nothing was found, 1 something was.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

seconds=${1:-60}
targets=("${@:2}")
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz
if [ "${#targets[@]}" -eq 0 ]; then
  mapfile -t targets < <(find build/fuzz/bin -name 'fuzz_*' -printf '%f\n' | sed 's/^fuzz_//' | sort)
fi
[ -d build/fuzz/seeds ] || build/fuzz/bin/makeFuzzSeeds build/fuzz/seeds

dictionary() # TARGET
{
  case $1 in
    lamps | path | rig | scenario | cameraInfo | places) echo yaml ;;
    cameraXml) echo xml ;;
    trajectory | frames | odometry | commands | fixes) echo table ;;
  esac
}

status=0
each=$((seconds / ${#targets[@]}))
for target in "${targets[@]}"; do
  corpus=build/fuzz/corpus/$target
  found=build/fuzz/found/$target
  mkdir -p "$corpus" "$found"
  words=$(dictionary "$target")
  echo "== $target, $each s"
  build/fuzz/bin/"fuzz_$target" -max_total_time="$((each > 0 ? each : 1))" -timeout=20 -rss_limit_mb=2048 -max_len=4096 \
    -print_final_stats=1 ${words:+-dict=tests/fuzz/dictionaries/$words.dict} -artifact_prefix="$found/" \
    "$corpus" "build/fuzz/seeds/$target" >"$found/log.txt" 2>&1 || { tail -n 40 "$found/log.txt" >&2; status=1; }
  grep -E 'cov: ' "$found/log.txt" | tail -n 1 || true
done
exit $status
