#!/usr/bin/env bash
# check-visp-tree.sh [VISP_SOURCE]: each module folder builds alone over the installed ViSP, and all of them build inside
# a ViSP 3.5.0 source tree, where their own tests pass. The tree is fetched where none is given. Not part of run.sh.
set -euo pipefail
repo="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
source_tree="${1:-}"

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache
fi
bash "$repo/cmake/install-dependencies.sh"
mapfile -t modules < <(cd "$repo/modules" && printf '%s\n' */src | sed 's|/src$||')
mapfile -t tests < <(cd "$repo/modules" && basename -s .cpp */test/*.cpp)

echo "== the whole project over the installed ViSP"
cmake -G Ninja -S "$repo" -B "$work/all" -DVLP_BUILD_TESTS=OFF
cmake --build "$work/all"

for module in "${modules[@]}"; do
  echo "== $module alone over the installed ViSP"
  cmake -G Ninja -S "$repo/modules/$module" -B "$work/$module"
  cmake --build "$work/$module" --target "visp_$module"
done

if [ -z "$source_tree" ]; then
  echo "== fetching ViSP 3.5.0" # with lists of its own: the system's apt stays as it is
  command -v dpkg-source >/dev/null || { echo "dpkg-source is missing: install dpkg-dev, or give VISP_SOURCE" >&2; exit 1; }
  echo 'deb-src http://deb.debian.org/debian bookworm main' >"$work/sources.list"
  mkdir -p "$work/lists/partial"
  apt=(apt-get -q -o "Dir::Etc::SourceList=$work/sources.list" -o Dir::Etc::SourceParts=/dev/null
       -o "Dir::State::Lists=$work/lists" -o "Dir::Cache=$work" -o APT::Sandbox::User=root)
  "${apt[@]}" update
  (cd "$work" && "${apt[@]}" source visp=3.5.0-4)
  source_tree="$work/visp-3.5.0"
fi

echo "== inside the ViSP source tree $source_tree"
unused=(ar imgproc klt mbt sensor tt tt_mi) # ViSP's modules that none of ours stands on
unused=("${unused[@]/#/-DBUILD_MODULE_visp_}")
unused=("${unused[@]/%/=OFF}")
cmake -G Ninja -S "$source_tree" -B "$work/visp" -DCMAKE_BUILD_TYPE=Release \
  -DVISP_CONTRIB_MODULES_PATH="$repo/modules" -DBUILD_TESTS=ON -DBUILD_EXAMPLES=OFF -DBUILD_DEMOS=OFF \
  -DBUILD_TUTORIALS=OFF -DBUILD_APPS=OFF -DBUILD_JAVA=OFF "${unused[@]}"
cmake --build "$work/visp" --target "${modules[@]/#/visp_}" "${tests[@]}"
ctest --test-dir "$work/visp" --output-on-failure -R "^($(IFS='|'; echo "${tests[*]}"))\$"
echo "every module builds in both worlds: ${modules[*]}"
