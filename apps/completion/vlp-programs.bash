# Completion of the vlp-* programs: options as --help lists them (bash-completion's _longopt), then names of files.
_vlp_calibrate()
{
  if [ "$COMP_CWORD" -eq 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W "camera shutter mount lamps --help --version" -- "${COMP_WORDS[1]}")
  elif [[ ${COMP_WORDS[COMP_CWORD]} == -* ]]; then
    local options
    options=$("$1" "${COMP_WORDS[1]}" --help 2>/dev/null | grep -oE '^ +(-h,)?--[a-z-]+' | sed -E 's/.*(--)/\1/')
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "${COMP_WORDS[COMP_CWORD]}")
  else
    _filedir
  fi
}
complete -F _vlp_calibrate vlp-calibrate
complete -F _longopt vlp-locate vlp-simulate vlp-evaluate vlp-servo vlp-plan vlp-lamp
