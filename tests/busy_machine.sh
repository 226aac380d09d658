# To be sourced. On a machine too busy for the cycle hopperd ends in order with a fault of the cycle, whatever is tested;
# where it lost many cycles in a hop, with what its checks make of the jump (`imu_implausible` after 15 ms at touchdown).
of_a_busy_machine() { # FAULT [OVERRUNS]
  [[ $1 =~ ^(cycle_gap|cycle_overruns|watchdog_tripped)$ ]] || { [[ $1 == imu_implausible ]] && ((10#${2:-0} >= 5)); }
}
