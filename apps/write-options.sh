#!/usr/bin/env bash
# Writes options.md, the options of all programs, from what their --help says.
#   bash apps/write-options.sh BIN            BIN: the folder of the programs
#   bash apps/write-options.sh BIN --check    exit code 1 where options.md is not what would be written
set -euo pipefail
export LC_ALL=C
bin=$(realpath "${1:?usage: write-options.sh BIN [--check]}")
cd "$(dirname "${BASH_SOURCE[0]}")"

table() # PROGRAM [COMMAND]: a row for each option, its explanation on one line
{
  printf '\n## %s\n' "$*"
  "$bin/$1" "${@:2}" --help | awk '
    function row() {
      if (option != "" && option !~ /--(help|version)$/) {
        if (match(option, / Needs: /)) {
          text = "with `" substr(option, RSTART + RLENGTH) "`: " text
          option = substr(option, 1, RSTART - 1)
        }
        gsub(/\|/, "\\|", option)
        gsub(/\|/, "\\|", text)
        print "| `" option "` | " text " |"
      }
      option = ""
    }
    BEGIN { print "| option | what it does |\n|---|---|" }
    /^ *(-[a-z],)?--[a-z]/ {
      row()
      sub(/^ +/, "")
      at = match($0, /  +/)
      option = at ? substr($0, 1, at - 1) : $0
      text = at ? substr($0, at + RLENGTH) : ""
      next
    }
    /^          +[^ ]/ && option != "" { sub(/^ +/, ""); text = text (text == "" ? "" : " ") $0; next }
    { row() }
    END { row() }'
}

page()
{
  echo '# Options'
  echo 'What `--help` says, as `apps/write-options.sh` copies it. [README.md](README.md) says what the programs do, and'
  echo '[data/README.md](../data/README.md) explains the files. Each program has `--help` and `--version`, too.'
  local program command
  for program in vlp-plan vlp-lamp vlp-calibrate vlp-locate vlp-servo vlp-simulate vlp-evaluate; do
    if [ "$program" = vlp-calibrate ]; then
      for command in camera shutter mount lamps; do
        table "$program" "$command"
      done
    else
      table "$program"
    fi
  done
}

if [ "${2:-}" = --check ]; then
  page | diff options.md - || { echo "apps/options.md is not what --help says: bash apps/write-options.sh build/release/bin" >&2; exit 1; }
else
  page >options.md
fi
