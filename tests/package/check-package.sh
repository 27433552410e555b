#!/usr/bin/env bash
# check-package.sh BUILD: installs that build into an empty prefix, and builds and runs another project on it.
set -euo pipefail
here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
build="$(cd "${1:?usage: check-package.sh BUILD}" && pwd)"

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cmake -G Ninja -S "$here/consumer" -B "$work/build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$work/prefix"
cmake --build "$work/build"
"$work/build/consumer"

# The installed programs find their libraries, too, and the data that was installed with them.
for program in "$work"/prefix/bin/*; do
  [ ! -x "$program" ] || "$program" --help >/dev/null
done
(cd "$work" && prefix/bin/vlp-locate --run data/paper-room --poses poses.tum && [ "$(wc -l <poses.tum)" -ge 9 ])
