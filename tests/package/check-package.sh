#!/usr/bin/env bash
# check-package.sh BUILD: installs that build into an empty prefix. Every installed header compiles and every module links in
# another project, and the programs run from there. tutorial/cmake-project is such a project, which its tutorial's test builds.
set -euo pipefail
build="$(cd "${1:?usage: check-package.sh BUILD}" && pwd)"

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null

mkdir "$work/all"
cd "$work/prefix/include"
printf '#include <%s>\n' visp3/vlp_*/vp*.h >"$work/all/all.cpp"
echo 'int main() { return vpVlpFix().valid ? 1 : 0; }' >>"$work/all/all.cpp"
modules=(visp3/vlp_*)
cat >"$work/all/CMakeLists.txt" <<EOF
cmake_minimum_required(VERSION 3.21)
project(all LANGUAGES CXX)
find_package(visp_vlp 0.1 REQUIRED)
add_executable(all_of_it all.cpp)
target_link_libraries(all_of_it PRIVATE ${modules[*]/#visp3\//visp_vlp::})
EOF
cmake -G Ninja -S "$work/all" -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix"
cmake --build "$work/build"
"$work/build/all_of_it"

# The installed programs find their libraries, too, and the data that was installed with them.
for program in "$work"/prefix/bin/*; do
  [ ! -x "$program" ] || "$program" --help >/dev/null
done
(cd "$work" && prefix/bin/vlp-locate --run data/paper-room --poses poses.tum && [ "$(wc -l <poses.tum)" -ge 9 ])
