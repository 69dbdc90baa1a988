#!/usr/bin/env python3
"""Plants every attack on the program and prints what became of it.

usage: run_attacks.py --cavum PATH --data DIR [--only NAME] [--share K/N] [--keep FOLDER] [--long]
Exit code 1 when there is a hole, or a promise of the pages was not kept."""
import argparse
import os
import shutil
import sys
import tempfile
import time
import traceback

import school
from kinds import ATTACKS, judge
import attacks_recordings  # noqa: F401
import attacks_insider  # noqa: F401
import attacks_endings  # noqa: F401
import attacks_claims  # noqa: F401
import attacks_files  # noqa: F401
import attacks_ledger  # noqa: F401
import attacks_tables  # noqa: F401
import attacks_history  # noqa: F401
import attacks_backup  # noqa: F401
import attacks_stations  # noqa: F401
import attacks_cosign  # noqa: F401
import attacks_text  # noqa: F401
import attacks_inputs  # noqa: F401
import attacks_flow  # noqa: F401
import attacks_fuzz  # noqa: F401
import attacks_erasable  # noqa: F401
import attacks_keys  # noqa: F401


def printable(text, width):
    text = "".join(c if c.isprintable() else "?" for c in text)
    return text if len(text) <= width else text[:width - 1] + "…"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cavum", required=True)
    parser.add_argument("--data", required=True)
    parser.add_argument("--only", default="", help="attacks whose name or family contains this")
    parser.add_argument("--keep", help="leave the folders here")
    parser.add_argument("--school", help="a school built before (with --keep), to save building one")
    parser.add_argument("--share", default="0/1", help="K/N: of each N attacks the one after K")
    parser.add_argument("--long", action="store_true", help="whole lines")
    args = parser.parse_args()
    cavum, data = os.path.abspath(args.cavum), os.path.abspath(args.data)
    work = os.path.abspath(args.keep or tempfile.mkdtemp(prefix="attacks-"))
    os.makedirs(work, exist_ok=True)
    started = time.monotonic()
    base = school.School(cavum, data, os.path.abspath(args.school)) if args.school else school.build(cavum, data, os.path.join(work, "school"))
    print(f"the school stands after {time.monotonic() - started:.0f} s\n")
    holes = broken = failed = 0
    width = 400 if args.long else 78
    chosen = [a for a in ATTACKS if (args.only in a.name or args.only in a.family)]
    at, of = map(int, args.share.split("/"))
    chosen = [a for i, a in enumerate(chosen) if i % of == at % of]
    for a in chosen:
        folder = os.path.join(work, a.name)
        shutil.rmtree(folder, ignore_errors=True)
        s = base.copy_to(folder)
        s.ask_kinds = bool(a.kinds)
        try:
            result = a.run(s)
            verdict, hole, promise = judge(a, s, result)
        except Exception as error:  # the attack itself is wrong
            result, verdict, hole, promise = None, f"ATTACK FAILED: {error!r}", False, False
            failed += 1
            if args.long:
                traceback.print_exc()
        holes += hole
        broken += promise
        last = result or (s.results[-1] if s.results else None)
        print(f"{a.family:10} {a.name:44} {last.verb[:26] if last else '':26} {str(last.rc) if last else '':>4} "
              f"{max((r.cpu for r in s.results), default=0):4.1f} {verdict:36} | {printable(last.first() if last else '', width)}", flush=True)
        if not args.keep:
            shutil.rmtree(folder, ignore_errors=True)
    if not args.keep:
        shutil.rmtree(work, ignore_errors=True)
    print(f"\n{len(chosen)} attacks and controls: {holes} holes, {broken} promises not kept, {failed} attacks that failed themselves; {time.monotonic() - started:.0f} s")
    return 1 if holes or broken or failed else 0


if __name__ == "__main__":
    sys.exit(main())
