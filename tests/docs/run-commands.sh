#!/usr/bin/env bash
# Runs what a document tells its reader to type: its blocks ```sh as they stand, one after the other, in one shell.
#   bash tests/docs/run-commands.sh BUILD FILE.md
# Not run: ```console, which needs a device, root, the network or much time, and ```text, what programs print. The shell
# starts in a scratch folder that looks like the top of the repository, with BUILD as build/release; data/ and tutorial/
# are copies, since a program may write beside them. Exit code: that of the first command that fails, or 0.
set -euo pipefail
[ $# -eq 2 ] || { echo "usage: run-commands.sh BUILD FILE.md" >&2; exit 2; }
build=$(realpath "$1")
document=$(realpath "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r data tutorial "$scratch"
ln -s "$PWD"/{apps,cmake,modules,tests,CMakeLists.txt,CMakePresets.json,README.md} "$scratch"
mkdir "$scratch/build"
ln -s "$build" "$scratch/build/release"

commands=$(awk '/^ *```/ { run = !inside && /^ *```sh$/; inside = !inside; next } run' "$document")
[ -n "$commands" ] || { echo "$2: no block of commands" >&2; exit 2; }

cd "$scratch"
unset DISPLAY WAYLAND_DISPLAY # a window would wait for a click
PATH=$build/bin:$PATH bash -exo pipefail -c "$commands" </dev/null
