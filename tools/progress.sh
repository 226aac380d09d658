# Progress of a long step, for the scripts beside this file, which `source` it. Everything goes to standard error.
#
#   … | show_progress LABEL          lines "DONE TOTAL TEXT" on standard input; TOTAL is ? if nobody knows it
#   with_progress LABEL COMMAND…     a command that says nothing itself; returns its exit status
#
# On a terminal a bar overwrites itself. Elsewhere a line appears at the start, every ten seconds, and at the end.
# show_progress writes nothing if no line arrives, with_progress nothing in the first ten seconds; a redirection of its
# standard error holds for COMMAND only.
exec {progress_messages}>&2
show_progress() {
  local label=$1 began=$SECONDS line finished= total= text status bar of shown= next=0
  while true; do
    status=0
    IFS= read -r -t 1 line || status=$?
    if ((status == 0)); then
      read -r finished total text <<<"$line"
    elif ((status <= 128)); then
      break # end of the input; above 128: nothing arrived for a second
    fi
    [[ $finished ]] || continue
    of= bar=
    if [[ $total != '?' ]]; then
      of=" of $total"
      bar=$(printf '%*s' $((30 * finished / (total > 0 ? total : 1))) '')
      bar=$(printf '[%-30s] ' "${bar// /#}")
    fi
    if [[ -t 2 ]]; then
      printf '\r%s %s%s%s, %d s \033[K' "$label" "$bar" "$finished" "$of" $((SECONDS - began)) >&2
    elif ((SECONDS - began >= next)); then
      printf '%s: %s%s, %d s%s\n' "$label" "$finished" "$of" $((SECONDS - began)) "${text:+, $text}" >&2
      next=$((SECONDS - began + 10))
    fi
    shown=1
  done
  [[ $shown ]] || return 0
  if [[ -t 2 ]]; then printf '\r\033[K' >&2; fi
  printf '%s: %s%s, %d s\n' "$label" "$finished" "$of" $((SECONDS - began)) >&2
}

with_progress() {
  local label=$1 began=$SECONDS ticker status=0
  shift
  { while sleep 10; do printf '%s: %d s\n' "$label" $((SECONDS - began)) >&"$progress_messages"; done; } \
    </dev/null >/dev/null 2>&1 &
  ticker=$!
  "$@" || status=$?
  kill "$ticker" 2>/dev/null || true
  wait "$ticker" 2>/dev/null || true
  return "$status"
}
