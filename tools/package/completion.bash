# Completion of hop and hopperd: asks the programs themselves what comes next.
_sandhopper() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} help values i
  local -a command=("$1")
  for ((i = 1; i < COMP_CWORD; ++i)); do # the verb, and the verb of the verb
    [[ ${COMP_WORDS[i]} == [a-z]* && ${COMP_WORDS[i - 1]} != --* ]] && ((${#command[@]} < 3)) && command+=("${COMP_WORDS[i]}")
  done
  help=$("${command[@]}" --help 2>/dev/null) || return
  if [[ $previous == --* ]]; then
    values=$(sed -n "s/^ *$previous [A-Z]*:{\([^}]*\)}.*/\1/p" <<<"$help")
    if [[ -n $values ]]; then
      mapfile -t COMPREPLY < <(compgen -W "${values//,/ }" -- "$word")
      return
    fi
    # An option that takes something else: files.
    ! grep -qE "^ *$previous [A-Z]" <<<"$help" || return
  fi
  if [[ $word == -* ]]; then
    values=$(grep -oE '^ +(-[a-z],)?--[a-zA-Z-]+' <<<"$help" | grep -oE -- '--.*')
  else
    values=$(sed -n '/^Verbs:/,/^$/s/^  \([a-z-]*\)  .*/\1/p' <<<"$help")
  fi
  mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")
}
complete -o default -F _sandhopper hop hopperd
