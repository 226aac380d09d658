# Sourced by the tests of the live view with the build folder as first argument and, as second, a folder that keeps screens:
# a terminal (tmux) in which a command runs, keys, the text on the screen, and the files of a trial.
build=$(cd "$1" && pwd)/bin
hop=$build/hop
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
command -v tmux >/dev/null || { echo "skipped: no tmux here"; exit 77; }
work=$(mktemp -d)
screens=${2:-$work/screens}
mkdir -p "$screens"
export LANG=C.UTF-8 LC_ALL=C.UTF-8
terminals=0 # each on a server of its own
tmux() { command tmux -S "$work/tmux$terminals" -f /dev/null "$@"; }
trap 'tmux kill-server 2>/dev/null || true; rm -rf "$work"' EXIT
failed=0
wrong() { echo "FAILED  $1"; tmux capture-pane -p -t hop 2>/dev/null | sed 's/^/        |/' || true; failed=1; }
ok() { echo "ok      $1"; }

# terminal COLUMNS ROWS COMMAND: runs it in a shell that prints a line when it is done and stays open.
terminal() {
  tmux kill-server 2>/dev/null || true
  terminals=$((terminals + 1))
  rm -f "$work/status"
  tmux new-session -d -s hop -x "$1" -y "$2" "bash --norc --noprofile"
  tmux send-keys -t hop "cd $work; clear; $3; echo \$? >$work/status" Enter
}
keys() { tmux send-keys -t hop "$@"; }
# until_shown TEXT: waits until the text is on the screen, at most 20 s.
until_shown() {
  for _ in {1..200}; do
    [[ $(tmux capture-pane -p -t hop) == *"$1"* ]] && return 0
    sleep 0.1
  done
  wrong "does not show: $1"
  return 1
}
shown() { [[ $(tmux capture-pane -p -t hop) == *"$1"* ]] || wrong "$2: does not show: $1"; }
keep() { tmux capture-pane -p -t hop >"$screens/$1.txt"; }
status() {
  for _ in {1..200}; do [[ -s $work/status ]] && break; sleep 0.1; done
  cat "$work/status" 2>/dev/null || echo none
}
whole() { rm -f "${1%.mcap}.recovered.mcap"; [[ $("$hop" recover "$1" --json 2>/dev/null) == *'"whole": true'* ]]; }
# closed WHAT LOG: within 10 s; events get what it says happened.
closed() {
  for _ in {1..100}; do whole "$2" && break; sleep 0.1; done
  whole "$2" || wrong "$1: the log was not closed"
  "$hop" report "$2" --output "$work/closed.html" >/dev/null
  events=$(grep -o '"name":"[^"]*","reason":"[^"]*"' "$work/closed.html" | sed 's/"name":"\([^"]*\)","reason":"\([^"]*\)"/\1 (\2)/; s/ ()//')
}
# softly_stopped WHAT LOG: closed, and the trial was stopped on purpose.
softly_stopped() {
  closed "$@"
  grep -q '^stop requested' <<<"$events" && grep -q '^stopped' <<<"$events" || wrong "$1: no soft stop in the log"
}
