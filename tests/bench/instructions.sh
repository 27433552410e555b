#!/usr/bin/env bash
# Instructions of one core per frame, from frame to pose, as callgrind counts them: the same from run to run.
#   cmake --build --preset release --target bench-instructions
#   bash tests/bench/instructions.sh PROGRAM [FRAMES]   PROGRAM: bench_instructions; default 4 frames each
set -euo pipefail
export LC_ALL=C
if [ $# -lt 1 ] || [ $# -gt 2 ]; then
  echo "usage: instructions.sh PROGRAM [FRAMES]" >&2
  exit 2
fi
program=$(realpath "$1")
frames=${2:-4}
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if ! command -v valgrind >/dev/null; then
  echo "instructions.sh: valgrind is not installed; cmake/install-dependencies.sh does it" >&2
  exit 1
fi

# What code picks by the processor is pinned, so that all machines with AVX2 count alike. Valgrind 3.19 has nothing
# beyond AVX2 to offer; later ones may. glibc's copies go by the sizes of caches, too.
export OPENCV_CPU_DISABLE=AVX512-SKX
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-ERMS,-AVX512F,-AVX512VL,-AVX512BW:glibc.cpu.x86_non_temporal_threshold=0x200000

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
count() # SIZE whole|tracked: millions of instructions per frame
{
  valgrind -q --tool=callgrind --toggle-collect='vpCountedFrames*' --callgrind-out-file="$work/counts" \
    "$program" "$1" "$2" "$frames" >"$work/said" 2>&1 || { cat "$work/said" >&2; exit 1; }
  if ! grep -q "$frames frames, $frames with a position" "$work/said"; then
    cat "$work/said" >&2
    exit 1
  fi
  awk -v frames="$frames" '$1 == "summary:" { printf "%.3f", $2 / frames / 1e6 }' "$work/counts"
}

echo "Millions of instructions per frame, mean of $frames:"
echo
echo "| frames | whole frame | tracked |"
echo "|---|---|---|"
for size in 800x600 2048x1536; do
  whole=$(count "$size" whole)
  tracked=$(count "$size" tracked)
  echo "| $size | $whole | $tracked |"
done
