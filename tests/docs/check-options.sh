#!/usr/bin/env bash
# Names each option that a document has and the program has not.
#   bash tests/docs/check-options.sh BIN [FILE.md ...]   BIN: the folder of the programs; default: all documents
# Looked at are commands, in blocks ```sh and ```console and in backquotes. An option behind the name of one of our programs
# or scripts has to be one of it. An option without a name has to be one of a vlp-program, or of the tutorial that the
# document explains. Exit code: 0 all are, 1 some are not.
set -euo pipefail
export LC_ALL=C
bin=$(realpath "${1:?usage: check-options.sh BIN [FILE.md ...]}")
shift
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

documents=("$@")
[ "${#documents[@]}" -gt 0 ] ||
  mapfile -t documents < <(find . -name '*.md' -not -path './build/*' -not -path './.*/*' | sed 's|^\./||' | sort)

declare -A options # of a program, each between spaces
for program in vlp-locate vlp-servo vlp-simulate vlp-evaluate vlp-plan vlp-lamp vlp-calibrate; do
  commands=("")
  [ "$program" != vlp-calibrate ] || commands=("" camera shutter mount lamps)
  options[$program]=' --help --version '
  for command in "${commands[@]}"; do
    # shellcheck disable=SC2086 # no command, no argument
    found=$("$bin/$program" $command --help | sed -nE 's/^ *(-[a-z],)?(--[a-z-]+).*/\2/p' | tr '\n' ' ')
    [ -z "$command" ] || options["$program $command"]=" --help $found"
    options[$program]+="$found"
  done
  options[all]+=${options[$program]}
done

commands_of() # FILE: one on a line; a line that ends with a backslash goes on
{
  awk '
    /^ *```/ { command = !inside && /^ *```(sh|console)$/; inside = !inside; next }
    command { sub(/ # .*/, ""); if (sub(/\\$/, "")) line = line $0; else { print line $0; line = "" } next }
    !inside { text = $0; while (match(text, /`[^`]+`/)) { print substr(text, RSTART + 1, RLENGTH - 2); text = substr(text, RSTART + RLENGTH) } }
  ' "$1" | sed -E 's/(&&|\||;|    +)/\n/g' | grep -E -- '(^|[ [])--[a-z]' || true
}

bad=0
for document in "${documents[@]}"; do
  while read -r -a words; do
    [[ ${words[0]} == *=* && ${words[0]} != -* ]] && words=("${words[@]:1}")
    program=${words[0]##*/} source='' allowed=''
    case $program in
      vlp-calibrate) allowed=${options["vlp-calibrate ${words[1]}"]:-${options[vlp-calibrate]}} ;;
      vlp-*) allowed=${options[$program]:-} ;;
      tutorial-*) source=$(compgen -G "tutorial/*/$program.cpp") || true ;;
      bench_*) source=tests/bench/${program#bench_}.cpp ;;
      bash) source=${words[1]} ;;
      *.sh) source=${words[0]} ;;
      -*) allowed=${options[all]} source=$(compgen -G "$(dirname "$document")/*.cpp") || true ;;
      *) continue ;; # of somebody else's program, or no command at all
    esac
    for word in "${words[@]}"; do
      [[ $word =~ ^\[?(--[a-z][a-z-]*) ]] || continue
      option=${BASH_REMATCH[1]}
      [[ $allowed == *" $option "* ]] && continue
      # shellcheck disable=SC2086 # may be several files
      [ -n "$source" ] && grep -qsF -- "$option" $source && continue
      echo "$document: ${words[*]}: no option $option"
      bad=1
    done
  done < <(commands_of "$document")
done
[ "$bad" -eq 0 ] && echo "${#documents[@]} documents, all options are there"
exit "$bad"
