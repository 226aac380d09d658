# Sourced by the bench's tests: `check WHAT COMMAND…` runs a condition and prints its result; `finish` ends the test.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
bench=("$root/tools/bench" --time-limit 600) # in case it hangs; a slow machine takes minutes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

check() { # WHAT COMMAND…
  local what=$1
  shift
  if "$@"; then
    echo "ok      $what"
  else
    echo "FAILED  $what"
    failures=$((failures + 1))
  fi
}

same() { # EXPECTED GOT
  [[ $1 == "$2" ]] || { printf '  expected: %q\n  got:      %q\n' "$1" "$2"; return 1; }
}

matches() { # REGULAR-EXPRESSION GOT
  [[ $2 =~ $1 ]] || { printf '  expected: %s\n  got:      %q\n' "$1" "$2"; return 1; }
}

finish() {
  echo "$failures failed"
  ((failures == 0))
  exit
}
