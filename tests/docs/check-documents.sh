#!/usr/bin/env bash
# Names each link of a document that leads nowhere, and each file that a document names and that is not there.
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

bad=0
complain() # FILE WHAT
{
  echo "$1: $2"
  bad=1
}

for document in "${documents[@]}"; do
  folder=$(dirname "$document")
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
[ "$bad" -eq 0 ] && echo "${#documents[@]} documents, all links lead somewhere"
exit "$bad"
