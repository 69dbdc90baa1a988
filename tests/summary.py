"""summary.py TESTS_XML RESULTS_DIR WALL_S: what `./dev test` says at its end. TESTS_XML is CTest's report, RESULTS_DIR holds one report of each GoogleTest
program, WALL_S is how long all of it took.

Prints how many tests there were, which long ones the commit drew, each one that was skipped with its reason, the ten slowest, whether the whole took
longer than it may, and last what failed: where only the end of a long output is kept, it still says which test and why.
"""
import os
import pathlib
import sys
import xml.etree.ElementTree as tree

import draw

BUDGET_S = 540  # of an everyday run on two quiet cores
LONG_S = 5.0    # a test that takes as long belongs in long_tests.txt: on a quiet core 2 s, and machines are noisy
LINES_OF_A_FAILURE = 12


def read_times(tests_xml, results):
    """Seconds by test and by program; the reason of each one skipped."""
    cases = list(tree.parse(tests_xml).iter("testcase"))
    programs = {case.get("name"): float(case.get("time")) for case in cases}
    times = {case.get("name"): float(case.get("time")) for case in cases if "[==========]" not in (case.findtext("system-out") or "")}
    skipped = {}
    for report in sorted(pathlib.Path(results).glob("*.xml")):
        for case in tree.parse(report).iter("testcase"):
            name = f"{case.get('classname')}.{case.get('name')}"
            times[f"{report.stem}: {name}"] = float(case.get("time") or 0)
            for reason in case.iter("skipped"):
                skipped[name] = (reason.text or reason.get("message") or "").strip().splitlines()[-1:]
    return programs, times, skipped


def failures(tests_xml, results):
    """(test, what it said) of each failure; of a GoogleTest program each of its tests, or that it ended without a report."""
    found = []
    for case in tree.parse(tests_xml).iter("testcase"):
        if case.get("status") != "fail":
            continue
        report = pathlib.Path(results) / f"{case.get('name')}.xml"
        output = case.findtext("system-out") or ""
        of_program = []
        if "[==========]" in output and report.exists():
            for one in tree.parse(report).iter("testcase"):
                of_program += [(f"{report.stem}: {one.get('classname')}.{one.get('name')}", f.get("message") or "") for f in one.iter("failure")]
        found += of_program or [(case.get("name"), "\n".join(output.strip().splitlines()[-LINES_OF_A_FAILURE:]))]
    return found


def say_failed(found):
    for name, said in found:
        print(f"FAILED {name}")
        for line in said.strip().splitlines()[:LINES_OF_A_FAILURE]:
            print(f"    {line[:200]}")


def say_drawn(times):
    """Which hand of the long tests ran, and what the table of them lacks."""
    table = draw.read_table(pathlib.Path(draw.__file__).with_name("long_tests.txt"))
    listed = {name for name, _ in table}
    ran = {name.split(": ")[-1]: seconds for name, seconds in times.items()}
    if "CAVUM_DEEP" not in os.environ:
        hand = int(os.environ["CAVUM_TEST_SEED"]) % draw.HANDS
        mine = draw.deal(table)[hand]
        print(f"of {len(table)} long tests the commit drew hand {hand + 1} of {draw.HANDS}: {len(mine)}; `./dev test --deep` runs all:")
        print("  " + ", ".join(sorted(mine)))
        for name in mine:
            if name not in ran:
                print(f"  {name} is in tests/long_tests.txt and was not run: mend its name there")
    for name, seconds in sorted(ran.items(), key=lambda pair: -pair[1]):
        if seconds >= LONG_S and name not in listed:
            print(f"  {name} took {seconds:.1f} s: if it takes 2 s on a quiet computer, give it a line in tests/long_tests.txt")


def say_budget(wall_s):
    if "CAVUM_DEEP" in os.environ:
        return
    said = f"the tests took {wall_s:.0f} s; on two quiet cores they may take {BUDGET_S} s (tests/README.md)"
    if wall_s <= BUDGET_S:
        print(said)
    else:
        print(f"{'!' * 100}\nWARNING: {said}: is the computer busy, or has a test become slow?\n{'!' * 100}")


if __name__ == "__main__":
    programs, times, skipped = read_times(sys.argv[1], sys.argv[2])
    print(f"{len(times)} tests, {len(skipped)} skipped")
    for name, reason in sorted(skipped.items()):
        print(f"  skipped {name}: {' '.join(reason)}")
    say_drawn(times)
    print("the ten slowest:")
    for name, seconds in sorted(times.items(), key=lambda pair: -pair[1])[:10]:
        print(f"  {seconds:7.1f} s  {name}")
    print("seconds by program:", ", ".join(f"{name} {seconds:.0f}" for name, seconds in sorted(programs.items(), key=lambda pair: -pair[1])))
    say_budget(float(sys.argv[3]))
    say_failed(failures(sys.argv[1], sys.argv[2]))
