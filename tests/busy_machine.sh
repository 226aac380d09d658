# To be sourced. On a machine that is too busy for the cycle, hopperd ends in order with a fault of the cycle in any test.
of_a_busy_machine() { [[ $1 =~ ^(cycle_gap|cycle_overruns|watchdog_tripped)$ ]]; } # FAULT
# A copy of the configuration in which any number of late cycles is allowed, for tests of something else than the cycle's time.
allow_late_cycles() { # CONFIG COPY
  cp -r "$1" "$2"
  sed -i 's/^overruns_per_s = .*/overruns_per_s = 1000/' "$2/robot.toml"
  grep -q '^overruns_per_s = 1000$' "$2/robot.toml"
}
# Waits before each attempt but the first, each time twice as long: other work on a shared machine often takes seconds.
wait_for_quiet() { (($1 == 1)) || sleep $((2 ** ($1 - 2))); } # NUMBER of the attempt
