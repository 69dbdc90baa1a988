#!/usr/bin/python3
"""Recordings of hand-held and robot-held handpieces with a known truth, made without any code of Cavum.

A hand moves in minimum jerk, trembles at 8 to 12 Hz, drifts and hesitates. A robot strokes in joint angles. A tracker has its own filter and
clock. Size S: rms of what is left of the effect after k, c and a zero of the force for each session are fitted, over the sd of the noise.
Usage: hand.py --list | --family NAME --seed N [--size S] --out DIR | --check. Python 3 and numpy.
"""
import argparse, os, sys
try:
    import numpy as np
except ImportError:  # another python3 comes first in PATH: Debian's own has numpy
    if os.path.realpath(sys.executable) == os.path.realpath("/usr/bin/python3") or not os.path.exists("/usr/bin/python3"):
        raise
    os.execv("/usr/bin/python3", ["/usr/bin/python3"] + sys.argv)
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from families import FAMILIES
from recording import build, write


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("--list", action="store_true"); a.add_argument("--check", action="store_true")
    a.add_argument("--family"); a.add_argument("--seed", type=int, default=1); a.add_argument("--size", type=float, default=1.0); a.add_argument("--out")
    a = a.parse_args()
    if a.list:
        for f in FAMILIES.values():
            print(f"{f.name}\t{f.kind}\t{f.text}")
    elif a.check:
        import check
        sys.exit(check.run())
    else:
        if a.family not in FAMILIES or not a.out:
            sys.exit(f"no family '{a.family}', or no --out: see --list")
        recs, toml, truth, o = build(FAMILIES[a.family], a.seed, a.size)
        write(recs, toml, truth, o, a.out, np.random.default_rng(a.seed))


if __name__ == "__main__":
    main()
