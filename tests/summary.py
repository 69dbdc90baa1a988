"""summary.py TESTS_XML RESULTS_DIR: what `./dev test` says at its end. TESTS_XML is CTest's report, RESULTS_DIR holds one report of each GoogleTest program.

Prints how many tests there were, each one that was skipped with its reason, and the ten slowest.
"""
import pathlib
import sys
import xml.etree.ElementTree as tree

programs = {case.get("name"): float(case.get("time")) for case in tree.parse(sys.argv[1]).iter("testcase")}
times, skipped = {}, {}
for report in sorted(pathlib.Path(sys.argv[2]).glob("*.xml")):
    for case in tree.parse(report).iter("testcase"):
        name = f"{case.get('classname')}.{case.get('name')}"
        times[f"{report.stem}: {name}"] = float(case.get("time") or 0)
        for reason in case.iter("skipped"):
            skipped[name] = (reason.text or reason.get("message") or "").strip().splitlines()[-1:]
for name, seconds in programs.items():  # those that are no GoogleTest programs
    if not any(known.startswith(name.split(".")[-1]) or known.startswith(name + ":") for known in times):
        times[name] = seconds
print(f"{len(times)} tests, {len(skipped)} skipped")
for name, reason in sorted(skipped.items()):
    print(f"  skipped {name}: {' '.join(reason)}")
print("the ten slowest:")
for name, seconds in sorted(times.items(), key=lambda pair: -pair[1])[:10]:
    print(f"  {seconds:7.1f} s  {name}")
print("seconds by program:", ", ".join(f"{name} {seconds:.0f}" for name, seconds in sorted(programs.items(), key=lambda pair: -pair[1])))
