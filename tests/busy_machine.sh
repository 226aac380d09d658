# To be sourced. On a machine that is too busy for the cycle, hopperd ends in order with a fault of the cycle in any test.
of_a_busy_machine() { [[ $1 =~ ^(cycle_gap|cycle_overruns|watchdog_tripped)$ ]]; } # FAULT
