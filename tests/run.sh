#!/usr/bin/env bash
# Installs what is missing, builds Release as far as tests use it and runs every test but those with a label that ends in -slow.
# VLP_INPUT_IMAGE_PATH: the folder of real pictures that tests/real looks at; without it those tests are skipped.
set -euo pipefail

if [ -n "${VLP_INPUT_IMAGE_PATH:-}" ]; then
  export VLP_INPUT_IMAGE_PATH="$(realpath "$VLP_INPUT_IMAGE_PATH")"
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."
if [ -z "${VLP_INPUT_IMAGE_PATH:-}" ] && [ -d ../shared/real ]; then
  export VLP_INPUT_IMAGE_PATH="$(realpath ../shared/real)"
  echo "VLP_INPUT_IMAGE_PATH is not set: taking $VLP_INPUT_IMAGE_PATH"
fi

bash cmake/install-dependencies.sh
cmake --preset release
cmake --build --preset release --target tested
status=0
ctest --preset release -LE '-slow$' "$@" || status=$?
# Every test names each picture that it uses; several use the same.
used=$(sed -n 's/.*real pictures used: 1 //p' build/release/Testing/Temporary/LastTest.log | sort -u | wc -l)
echo "real pictures used: $used"
exit $status
