#!/usr/bin/env bash
# Instructions of one core per frame, from frame to pose, as callgrind counts them: the same from run to run.
#   cmake --build --preset release --target bench-instructions
#   bash tests/bench/instructions.sh PROGRAM [FRAMES]   PROGRAM: bench_instructions; default 4 frames each
#   bash tests/bench/instructions.sh --check PROGRAM    fails where one is 10 % above instructions.txt; 77: cannot tell
set -euo pipefail
export LC_ALL=C
check=false
if [ "${1:-}" = --check ]; then
  check=true
  shift
fi
if [ $# -lt 1 ] || [ $# -gt 2 ]; then
  echo "usage: instructions.sh [--check] PROGRAM [FRAMES]" >&2
  exit 2
fi
program=$(realpath "$1")
frames=${2:-4}
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if ! command -v valgrind >/dev/null; then
  echo "instructions.sh: valgrind is not installed; cmake/install-dependencies.sh does it" >&2
  $check && exit 77
  exit 1
fi
if $check && ! grep -qw avx2 /proc/cpuinfo; then
  echo "instructions.sh: instructions.txt has counts with AVX2, which this processor has not" >&2
  exit 77
fi

# What code picks by the processor is pinned, so that all machines with AVX2 count alike. Valgrind 3.19 has nothing
# beyond AVX2 to offer; later ones may. glibc's copies go by the sizes of caches, too.
export OPENCV_CPU_DISABLE=AVX512-SKX
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-ERMS,-AVX512F,-AVX512VL,-AVX512BW:glibc.cpu.x86_non_temporal_threshold=0x200000

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed_with() # EXIT
{
  cat "$work/said" >&2
  [ "$1" != 132 ] || echo "instructions.sh: valgrind does not know an instruction that a library uses on this processor" >&2
  exit $(($1 == 132 ? 77 : 1))
}
kinds=(whole tracked mixed followed) # the last two: whole and tracked frames of a mixed ceiling
count() # SIZE KIND: millions of instructions per frame
{
  local how=("$2" "$frames")
  case $2 in mixed) how=(whole "$frames" mixed) ;; followed) how=(tracked "$frames" mixed) ;; esac
  valgrind -q --tool=callgrind --toggle-collect='vpCountedFrames*' --callgrind-out-file="$work/counts" \
    "$program" "$1" "${how[@]}" >"$work/said" 2>&1 || failed_with $?
  if ! grep -q "$frames frames, $frames with a position" "$work/said"; then
    cat "$work/said" >&2
    exit 1
  fi
  awk -v frames="$frames" '$1 == "summary:" { printf "%.3f", $2 / frames / 1e6 }' "$work/counts"
}

if $check; then
  failed=0
  while read -r size "${kinds[@]}"; do
    for kind in "${kinds[@]}"; do
      counted=$(count "$size" "$kind")
      awk -v counted="$counted" -v before="${!kind}" -v what="$size $kind" 'BEGIN {
        printf "%s: %.3f million instructions a frame, %.3f before (%+.1f %%)\n", what, counted, before,
               100 * (counted / before - 1)
        exit counted > 1.1 * before
      }' || failed=1
    done
  done < <(grep -v '^#' tests/bench/instructions.txt)
  [ $failed = 0 ] || echo "instructions.sh: more than 10 % above tests/bench/instructions.txt" >&2
  exit $failed
fi

echo "Millions of instructions per frame, mean of $frames:"
echo
echo "| frames | ${kinds[*]} |" | sed 's/\([a-z]\) \([a-z]\)/\1 | \2/g'
echo "|---|---|---|---|---|"
for size in 800x600 2048x1536; do
  row="| $size |"
  for kind in "${kinds[@]}"; do
    row+=" $(count "$size" "$kind") |"
  done
  echo "$row"
done
