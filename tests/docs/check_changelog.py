"""Usage: check_changelog.py SOURCE_DIR

Prints what is wrong with CHANGELOG.md and exits with 1. Versions stand newest first: `## X.Y.Z, YYYY-MM-DD`, with `## Unreleased` above them where something is
under way. The newest version is that of engine/base/version.cpp. The line below the first heading names the physics version and the format of sessions
that the sources have: a change of either that nobody wrote down is found.
"""
import datetime
import re
import sys
from pathlib import Path

HEADING = re.compile(r"^## (.+)$", re.MULTILINE)
VERSION = re.compile(r"(\d+)\.(\d+)\.(\d+), (\d{4}-\d{2}-\d{2})")
FORMATS = re.compile(r"Physics version (\d+) · session format (\d+) · tooth file version \d+\.")


def constant(root, path, name):
    found = re.search(name + r" = (\d+);", (root / path).read_text())
    if not found:
        raise SystemExit(f"{path}: {name} is not there")
    return int(found.group(1))


def problems(root):
    root = Path(root)
    text = (root / "CHANGELOG.md").read_text()
    headings = HEADING.findall(text)
    under_way = headings[:1] == ["Unreleased"]
    out, versions = [], []
    for heading in headings[1 if under_way else 0:]:
        found = VERSION.fullmatch(heading)
        try:
            versions.append((tuple(int(n) for n in found.group(1, 2, 3)), datetime.date.fromisoformat(found.group(4))))
        except (AttributeError, ValueError):
            out.append(f"CHANGELOG.md: '{heading}' is no version with its date, as in '0.1.0, 2026-11-21'")
    for newer, older in zip(versions, versions[1:]):
        if newer[0] <= older[0] or newer[1] < older[1]:
            out.append(f"CHANGELOG.md: {'.'.join(map(str, newer[0]))} stands above a version that is not older")
    built = re.search(r'return "(\d+)\.(\d+)\.(\d+)"', (root / "engine/base/version.cpp").read_text())
    if not versions or not built or tuple(int(n) for n in built.groups()) != versions[0][0]:
        out.append("CHANGELOG.md: its newest version is not that of engine/base/version.cpp")
    first = text[HEADING.search(text).end():].lstrip("\n").split("\n", 1)[0] if headings else ""
    formats = FORMATS.fullmatch(first)
    physics = constant(root, "engine/physics/servo/servo.h", "k_physics_version")
    session = constant(root, "engine/session/session.h", "k_session_format")
    if not formats or (int(formats.group(1)), int(formats.group(2))) != (physics, session):
        out.append(f"CHANGELOG.md: the line below its first heading does not say 'Physics version {physics} · session format {session} · tooth file version N.'")
    return out


def main():
    wrong = problems(sys.argv[1])
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
