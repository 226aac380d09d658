# Progress of a long step, for the scripts beside this file: `source` it, then pipe lines "DONE TOTAL TEXT" into
#   show_progress LABEL
# It draws a bar on a terminal; elsewhere it writes a line at the start, every ten seconds, and at the end. It writes
# nothing if no line arrives. Everything goes to standard error.
show_progress() {
  local label=$1 began=$SECONDS line finished= total= text status bar shown= next=0
  while true; do
    status=0
    IFS= read -r -t 1 line || status=$?
    if ((status == 0)); then
      read -r finished total text <<<"$line"
    elif ((status <= 128)); then
      break # end of the input; above 128: nothing arrived for a second
    fi
    [[ $finished ]] || continue
    if [[ -t 2 ]]; then
      bar=$(printf '%*s' $((30 * finished / (total > 0 ? total : 1))) '')
      printf '\r%s [%-30s] %s of %s, %d s \033[K' "$label" "${bar// /#}" "$finished" "$total" $((SECONDS - began)) >&2
    elif ((SECONDS - began >= next)); then
      printf '%s: %s of %s, %d s%s\n' "$label" "$finished" "$total" $((SECONDS - began)) "${text:+, $text}" >&2
      next=$((SECONDS - began + 10))
    fi
    shown=1
  done
  [[ $shown ]] || return 0
  if [[ -t 2 ]]; then printf '\r\033[K' >&2; fi
  printf '%s: %s of %s, %d s\n' "$label" "$finished" "$total" $((SECONDS - began)) >&2
}
