#!/usr/bin/env bash
# Names in each document
#   - links that lead nowhere, and files that are not there;
#   - blocks of code without a language: run-commands.sh runs ```sh, and neither ```console nor ```text. Commands of
#     tests/bench are all run by hand, and need none;
#   - lines of a block ```cpp or ```cmake that the program of the tutorial has not. A line "..." stands for others.
#   bash tests/docs/check-documents.sh [FILE.md ...]   default: all documents of the repository
# A link to another host is not followed. Exit code: 0 all are there, 1 some are not.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

documents=("$@")
[ "${#documents[@]}" -gt 0 ] ||
  mapfile -t documents < <(find . -name '*.md' -not -path './build/*' -not -path './.*/*' | sed 's|^\./||' | sort)

prose() # FILE: without its blocks of code
{
  awk '/^ *```/ { code = !code; next } !code' "$1"
}

anchors() # FILE: as GitHub makes them of headings, and Doxygen's own
{
  prose "$1" | sed -n 's/^#\{1,6\} //p' |
    sed -e 's/ *{#[^}]*}$//' -e 's/`//g' | tr '[:upper:]' '[:lower:]' | sed -e 's/[^a-z0-9 _-]//g' -e 's/ /-/g'
  sed -n 's/.*{#\([^}]*\)}.*/\1/p' "$1"
}

quoted() # FILE: lines of programs
{
  awk '/^ *```/ { quoted = !inside && /^ *```(cpp|cmake)$/; inside = !inside; next } quoted' "$1" |
    sed -e 's/^ *//' -e '/^\(\.\.\.\)\{0,1\}$/d'
}

bad=0
complain() # FILE WHAT
{
  echo "$1: $2"
  bad=1
}

for document in "${documents[@]}"; do
  folder=$(dirname "$document")
  [[ $document == tests/bench/* ]] || while IFS= read -r line; do
    complain "$document" "line $line: a block without a language, expected \`\`\`sh, \`\`\`console, \`\`\`text, \`\`\`cpp ..."
  done < <(awk '/^ *```/ { inside = !inside; if (inside && /^ *``` *$/) print FNR }' "$document")
  program=$folder
  [ "$document" != README.md ] || program=tutorial/cmake-project
  [[ $program != tutorial/* ]] || while IFS= read -r line; do
    complain "$document" "quotes a line that $program has not: $line"
  done < <(quoted "$document" | grep -vxFf <(sed 's/^ *//' "$program"/*.cpp "$program"/CMakeLists.txt 2>/dev/null) || true)
  while IFS= read -r target; do
    case "$target" in http://* | https://* | mailto:*) continue ;; esac
    file=${target%%#*}
    path=$document
    [ -z "$file" ] || path=$folder/$file
    if [ ! -e "$path" ]; then
      complain "$document" "link to $target, which is not there"
    elif [[ $target == *'#'* && $path == *.md ]] && ! grep -qxF -- "${target#*#}" <<<"$(anchors "$path")"; then
      complain "$document" "link to $target, which has no such heading"
    fi
  done < <(prose "$document" | sed 's/`[^`]*`//g' | grep -oE '\]\([^) ]+' | sed 's/^](//' || true)

  # Names in backquotes that begin with a folder of ours.
  while IFS= read -r path; do
    compgen -G "${path%/}" >/dev/null || complain "$document" "names $path, which is not there"
  done < <(prose "$document" | grep -oE '`(apps|cmake|data|modules|tests|tutorial|\.ci)/[A-Za-z0-9_./*-]*' | tr -d '`' || true)

  while IFS= read -r name; do
    grep -qrF --include='*.md' "{#$name}" . || complain "$document" "\\ref $name, which is not there"
  done < <(grep -oE '\\ref [A-Za-z0-9_-]+' "$document" | sed 's/^\\ref //' || true)
done
[ "$bad" -eq 0 ] && echo "${#documents[@]} documents, all links lead somewhere, all quotations are right"
exit "$bad"
