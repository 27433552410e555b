#!/usr/bin/env bash
# check-headers.sh BUILD: each source of modules, programs and tutorials that BUILD compiles, and each public header alone,
# includes what it needs. BUILD is configured with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON; nothing in it is built.
set -euo pipefail
build="$(cd "${1:?usage: check-headers.sh BUILD}" && pwd)"
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

# CMake's commands, one a line, for Clang, and as far as the syntax only: it is faster there, and knows which template of
# Eigen is declared and nowhere defined, which otherwise a link in another place finds. JSON puts a backslash before \ and ".
clang='clang++ -fsyntax-only -Wno-everything -Werror=undefined-func-template'
commands="$(sed -n 's/^  "command": "\(.*\)",$/\1/p' "$build/compile_commands.json" | grep -E " $PWD/(modules|apps|tutorial)/[^ ]*$" |
  sed -e 's/\\\(.\)/\1/g' -e 's/ -W[a-z]*//g' -e "s|^[^ ]* |$clang |" -e 's/ -o [^ ]* -c / /' -e 's/ -isystem \([^ ]*eigen3\)/ -I\1/')"

headers() # a command for each public header but those that a source of their module includes before all else
{
  local header module command
  for header in modules/*/include/visp3/*/*.h; do
    module="$(cut -d/ -f1,2 <<<"$header")"
    if ! grep -rhm1 --include='*.cpp' '^#include' "$module/src" | grep -F "/${header##*/}>" >/dev/null; then
      command="$(grep -m1 " $PWD/$module/src/[^ ]*$" <<<"$commands")"
      echo "${command% *} -x c++ $PWD/$header"
    fi
  done
}

{ headers; echo "$commands"; } | xargs -d '\n' -P "$(nproc)" -I{} \
  bash -c '{} || { echo "check-headers.sh: ${0##* } does not compile by itself" >&2; exit 1; }' {}
