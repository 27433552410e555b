#!/usr/bin/env bash
# What a frame, from frame to pose, would cost on one core of a Raspberry Pi 3 (Cortex-A53, 1.2 GHz): qemu-user counts which
# blocks of code run how often (arm64/countBlocks.cpp), LLVM's models of that core and of the next one (Cortex-A55) say how
# long each takes, and what caches and branch prediction miss is added. tests/bench/robot-computer.md says how far to rely on it.
#   cmake --build --preset arm64 --target bench-instructions
#   bash tests/bench/arm64.sh PROGRAM SYSROOT [FRAMES]   PROGRAM: bench_instructions for arm64; default 4 frames each
set -euo pipefail
export LC_ALL=C
if [ $# -lt 2 ] || [ $# -gt 3 ]; then
  echo "usage: arm64.sh PROGRAM SYSROOT [FRAMES]" >&2
  exit 2
fi
program=$(realpath "$1")
sysroot=$(realpath "$2")
frames=${3:-4}
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
for tool in qemu-aarch64 llvm-mc llvm-mca c++; do
  if ! command -v "$tool" >/dev/null; then
    echo "arm64.sh: $tool is not installed; cmake/install-dependencies.sh cmake/apt-packages-arm64.txt does it" >&2
    exit 1
  fi
done

# Cycles that a miss costs where nothing hides it: a line from the second level, a line from memory (150 ns), a branch
# that went elsewhere (the length of the pipeline).
level2=13
memory=180
branch=8
clock=1200 # MHz

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
c++ -std=c++17 -O2 -shared -fPIC -fvisibility=hidden -o "$work/libcountBlocks.so" tests/bench/arm64/countBlocks.cpp

# The blocks that make 99 % of all instructions, the same code taken together: "instructions times code..."
common_blocks()
{
  awk 'NR > 1 { times = $1; $1 = ""; often[$0] += times; size[$0] = NF - 1 }
    END { for (code in often) print often[code] * size[code], often[code] code }' "$work/blocks" | sort -rn |
    awk -v all="$1" 'seen < 0.99 * all { seen += $1; print }'
}

# The common blocks as regions for llvm-mca. Calls and returns are jumps to it.
regions()
{
  awk '{ for (k = 3; k <= NF; ++k)
           print "0x" substr($k, 7, 2) ",0x" substr($k, 5, 2) ",0x" substr($k, 3, 2) ",0x" substr($k, 1, 2) }' "$work/common" |
    llvm-mc --disassemble -triple=aarch64 -mcpu=cortex-a53 2>"$work/complaints" |
    sed -E '/^\t\.text/d; /^$/d; s/^\tbl\t/\tb\t/; s/^\tblr\t/\tbr\t/; s/^\tret$/\tbr\tx30/' >"$work/code"
  if [ "$(wc -l <"$work/code")" -ne "$(awk '{ n += NF - 2 } END { print n }' "$work/common")" ]; then
    cat "$work/complaints" >&2
    echo "arm64.sh: llvm-mc does not know all instructions" >&2
    exit 1
  fi
  awk -v code="$work/code" '{ print "# LLVM-MCA-BEGIN"
    for (k = 3; k <= NF; ++k) { getline line <code; print line }
    print "# LLVM-MCA-END" }' "$work/common" >"$work/regions"
}

model() # CORE: cycles that one run through each block takes, one line each, with everything in the caches and foreseen
{
  llvm-mca -mtriple=aarch64 -mcpu="$1" -iterations=100 -all-views=false -summary-view "$work/regions" 2>"$work/complaints" |
    awk '/^Total Cycles:/ { print $3 / 100 }'
}

count() # SIZE whole|tracked CEILING: a row of the table
{
  qemu-aarch64 -cpu cortex-a53 -L "$sysroot" -plugin "$work/libcountBlocks.so,out=$work/blocks" \
    "$program" "$1" "$2" "$frames" "$3" >"$work/said" 2>&1 || { cat "$work/said" >&2; exit 1; }
  if ! grep -q "$frames frames, $frames with a position" "$work/said" || ! grep -q '^entries 1 returns 1 ' "$work/blocks"; then
    cat "$work/said" >&2
    head -n 1 "$work/blocks" >&2
    exit 1
  fi
  local instructions
  instructions=$(awk 'NR > 1 { n += $1 * (NF - 1) } END { printf "%.0f", n }' "$work/blocks")
  common_blocks "$instructions" >"$work/common"
  regions
  model cortex-a53 >"$work/cycles53"
  model cortex-a55 >"$work/cycles55"
  if ! paste "$work/cycles53" "$work/cycles55" "$work/common" | awk 'NF < 5 { exit 1 }'; then
    cat "$work/complaints" >&2
    exit 1
  fi
  local conditions mispredicted missed1 missed2
  read -r _ _ _ _ _ conditions _ mispredicted _ missed1 _ missed2 < <(head -n 1 "$work/blocks")
  paste "$work/cycles53" "$work/cycles55" "$work/common" |
    awk -v frames="$frames" -v all="$instructions" -v conditions="$conditions" -v mispredicted="$mispredicted" \
      -v missed1="$missed1" -v missed2="$missed2" -v level2=$level2 -v memory=$memory -v branch=$branch -v clock=$clock \
      -v what="$1, $([ "$2" = whole ] && echo "whole frame" || echo tracked)$([ "$3" = plain ] || echo ", $3 ceiling")" '
      { instructions += $3; a53 += $1 * $4; a55 += $2 * $4 }
      END {
        a53 *= all / instructions
        a55 *= all / instructions
        missed = mispredicted * branch + missed1 * level2 + missed2 * memory
        best = a53 < a55 ? a53 : a55
        worst = (a53 < a55 ? a55 : a53) + missed
        printf "| %s | %.2f | %.1f | %.1f | %.1f of %.0f | %.0f, %.0f | %.1f | %.2f to %.2f | **%.0f to %.0f** |\n", what,
          all / frames / 1e6, a55 / frames / 1e6, a53 / frames / 1e6, mispredicted / frames / 1e3, conditions / frames / 1e3,
          missed1 / frames / 1e3, missed2 / frames / 1e3, missed / frames / 1e6,
          all / worst, all / best, best / frames / clock / 1e3, worst / frames / clock / 1e3
      }'
}

echo "One core at $clock MHz; per frame, mean of $frames; instructions and cycles in millions, events in thousands:"
echo
echo "| frames | instructions | cycles, A55 | cycles, A53 | branches mispredicted | lines missed in L1, L2 | cycles of all that | instructions a cycle | ms |"
echo "|---|---|---|---|---|---|---|---|---|"
for size in 800x600 2048x1536; do
  for ceiling in plain mixed; do
    count "$size" whole "$ceiling"
    count "$size" tracked "$ceiling"
  done
done
