"""draw.py TURN: which of the long tests a commit runs. `./dev test` leaves out the others, `./dev test --all` runs all.

long_tests.txt lists them with their seconds on one quiet core: tests of GoogleTest programs by suite and name, other programs by their name in CTest.
They are dealt out, longest first, to hands of about equal length; TURN, which counts commits, names the hand. Prints two lines for the shell, the patterns that leave out the
rest: GTEST_FILTER of all GoogleTest programs, and `ctest --exclude-regex`.
"""
import pathlib
import re
import sys

HANDS = 8


def read_table(path):
    """(name, seconds) of each line; a line that begins with # says something to the reader."""
    rows = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        parts = line.split()
        if len(parts) != 2 or not re.fullmatch(r"[0-9]+(\.[0-9]+)?", parts[0]):
            sys.exit(f"{path}:{number}: not `SECONDS NAME`; write the seconds of a test and its name")
        rows.append((parts[1], float(parts[0])))
    if len({name for name, _ in rows}) != len(rows):
        sys.exit(f"{path}: a test is named twice; keep one of its lines")
    return rows


def deal(rows, hands=HANDS):
    """Lists of names: each name in one of them, their sums of seconds about equal, the same whatever the order of the rows."""
    dealt, sums = [[] for _ in range(hands)], [0.0] * hands
    for name, seconds in sorted(rows, key=lambda row: (-row[1], row[0])):
        shortest = sums.index(min(sums))
        dealt[shortest].append(name)
        sums[shortest] += seconds
    return dealt


def is_whole_program(name):
    """Names in CTest have lower-case parts; suites of GoogleTest begin with a capital."""
    return name[0].islower()


def left_out(rows, turn, hands=HANDS):
    """(GTEST_FILTER, regular expression for ctest --exclude-regex) of all but the hand whose turn it is."""
    mine = set(deal(rows, hands)[turn % hands])
    others = [name for name, _ in rows if name not in mine]
    programs = [re.escape(name).replace(r"\-", "-") for name in others if is_whole_program(name)]
    return "-" + ":".join(n for n in others if not is_whole_program(n)), f"^({'|'.join(programs)})$" if programs else "^$"


if __name__ == "__main__":
    for line in left_out(read_table(pathlib.Path(__file__).with_name("long_tests.txt")), int(sys.argv[1])):
        print(line)
