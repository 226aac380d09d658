"""A trial as `hop export TRIAL.mcap` writes it, with nothing but Python's standard library.

    from load_trial import load_trial
    trial = load_trial("trial_001.csv")
    trial["t_s"], trial["load_cell_force_N"]     # lists of float; NaN: no fresh sample in that cycle

With numpy, numpy.asarray(trial["t_s"]). From a shell: python3 load_trial.py trial_001.csv prints a summary.
"""
import csv
import math
import sys


PHASES = {"flight": 0.0, "compression": 1.0, "extension": 2.0}


def number(cell):
    return PHASES[cell] if cell in PHASES else float(cell) if cell else math.nan


def load_trial(path):
    """Columns by name, in SI units; the unit is the end of the name. `phase`: 0 flight, 1 compression, 2 extension."""
    with open(path, newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        columns = {name: [] for name in names}
        for row in rows:
            for name, cell in zip(names, row):
                columns[name].append(number(cell))
    return columns


if __name__ == "__main__":
    trial = load_trial(sys.argv[1])
    print(f"{len(trial['t_s'])} cycles, {trial['t_s'][-1] - trial['t_s'][0]:.3f} s")
    for name, values in trial.items():
        known = [value for value in values if not math.isnan(value)]
        if known:
            print(f"{name:32} {min(known):12.5g} … {max(known):12.5g}   {len(known)} samples")
