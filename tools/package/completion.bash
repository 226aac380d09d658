# Completion of hop and hopperd: asks the programs themselves what comes next. From a clone: source this file, then
# tools/hop completes, too; before anything is built only the verbs are known.
_sandhopper() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} help values i
  local -a command=("$1")
  for ((i = 1; i < COMP_CWORD; ++i)); do # the verb, and the verb of the verb
    [[ ${COMP_WORDS[i]} == [a-z]* && ${COMP_WORDS[i - 1]} != --* ]] && ((${#command[@]} < 3)) && command+=("${COMP_WORDS[i]}")
  done
  if ! help=$(SANDHOPPER_NO_BUILD=1 "${command[@]}" --help 2>/dev/null); then
    ((${#command[@]} == 1)) || return
    help=$'Verbs:\n'$(cd "$(dirname "$1")/cli" 2>/dev/null && printf '  %s  \n' verb_*.cpp | sed -n 's/verb_\(.*\)\.cpp/\1/p')
  fi
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
