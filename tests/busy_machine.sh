# To be sourced. On a machine too busy for the cycle hopperd ends in order with a fault of the cycle, whatever is tested.
of_a_busy_machine() { [[ $1 =~ ^(cycle_gap|cycle_overruns|watchdog_tripped)$ ]]; } # FAULT
