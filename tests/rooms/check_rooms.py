"""Usage: check_rooms.py ROOMS SOURCE_DIR. ROOMS has a line for each room: name|folder|rooms below|sources.

Prints what is wrong and exits with 1: a source that includes a header of a room that is not below its own; a room that is above itself; a source that no
room compiles; a header or source in a folder that is no room; a header that is not there; a namespace that is not the folder's; headers that include each
other in a circle; a header that includes what is slow to compile.
"""
import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)
NAMESPACE = re.compile(r"^namespace(?: ([\w:]+))? \{$|^\}  // namespace", re.MULTILINE)
# another room's types, named ahead
FORWARD = re.compile(r"^namespace [\w:]+ \{\n((class|struct) \w+;\n)+\}(  // namespace [\w:]+)?$", re.MULTILINE)
TOPS = ("engine", "scenarios", "grading", "ui")
# what stands in a folder and below it, unless a folder further down says otherwise
NAMESPACES = {
    "engine": "cavum", "engine/lab/explain": "cavum::explain", "scenarios": "cavum::scenarios", "grading": "cavum::grading", "grading/records": "cavum::records",
    "grading/cohort": "cavum::cohort", "grading/pool": "cavum::pool", "ui": "cavum::ui", "ui/language": "cavum", "ui/report": "cavum::report", "ui/station": "cavum::station", "ui/office": "cavum::office",
}
PROGRAMS = {"ui/cli/main.cpp", "ui/office/routes_ts.cpp", "engine/tooth/volume/itk/cavum_read_volume.cpp"}
# slow to compile: a header names their types ahead, by json_fwd.hpp and ui/parts/option_checks.h, except those that have them for templates or as members
HEAVY = re.compile(r"^#include <(nlohmann/json\.hpp|CLI/.*)>", re.MULTILINE)
HEAVY_HEADERS = {
    "engine/base/json_struct.h", "grading/marking/school_mark.h", "grading/records/opening.h", "grading/records/passback.h", "ui/office/station_client.h",
    "ui/office/lti/client.h", "ui/office/lti/keys.h", "ui/office/lti/launch.h",
}
# rooms that some builds leave out; their sources are then nobody's
OPTIONAL = {"engine/tooth/volume", "engine/tooth/volume/itk", "engine/tooth/import"}


def read_rooms(text):
    rooms = {}
    for line in text.splitlines():
        name, folder, below, sources = line.split("|")
        rooms[name] = (folder, below.split(), sources.split())
    return rooms


def all_below(rooms, name, seen):
    for room in rooms[name][1]:
        if room not in seen:
            seen.add(room)
            all_below(rooms, room, seen)
    return seen


def circles(includes):
    """The shortest circle through each file that is in one, from its first name in the alphabet; each circle once."""
    out = set()
    for begin in sorted(includes):
        ways, seen = [[begin]], set()
        while ways:
            way = ways.pop(0)
            if begin in includes.get(way[-1], ()):
                at = way.index(min(way))
                out.add(tuple(way[at:] + way[:at]))
                break
            for there in sorted(includes.get(way[-1], ())):
                if there not in seen:
                    seen.add(there)
                    ways.append(way + [there])
    return sorted(out)


def namespace_of(folder):
    while folder not in NAMESPACES:
        folder = str(Path(folder).parent)
    return NAMESPACES[folder]


def outermost_namespaces(text):
    opened, inside = set(), []
    for found in NAMESPACE.finditer(FORWARD.sub("", text)):
        if found[0].startswith("}"):
            inside = inside[:-1]
            continue
        if found[1] and not any(inside):
            opened.add(found[1])
        inside.append(found[1])
    return opened


def wrong_namespaces(file, folder, text):
    right, opened = namespace_of(folder), outermost_namespaces(text)
    if not opened and file not in PROGRAMS:
        return [f"{file}: opens no namespace {right}"]
    return [f"{file}: opens namespace {name}; this folder's is {right}" for name in sorted(opened - {right})]


def problems(rooms, root):
    out = []
    root = Path(root)
    room_of = {folder: name for name, (folder, _, _) in rooms.items()}
    compiled = {str(Path(s).relative_to(root)) for _, _, sources in rooms.values() for s in sources} | PROGRAMS
    for name in rooms:
        if name in all_below(rooms, name, set()):
            out.append(f"room {name} is above itself")
    includes = {}
    for top in TOPS:
        for path in sorted([*(root / top).rglob("*.h"), *(root / top).rglob("*.cpp")]):
            file, folder = str(path.relative_to(root)), str(path.parent.relative_to(root))
            if folder not in room_of:
                if folder not in OPTIONAL:
                    out.append(f"{file}: {folder} is no room")
                continue
            if path.suffix == ".cpp" and file not in compiled:
                out.append(f"{file}: no room compiles it")
            allowed = all_below(rooms, room_of[folder], {room_of[folder]})
            text = path.read_text(errors="replace")
            out += wrong_namespaces(file, folder, text)
            if path.suffix == ".h" and file not in HEAVY_HEADERS:
                out += [f"{file}: includes <{heavy}>, which sources alone do" for heavy in HEAVY.findall(text)]
            includes[file] = INCLUDE.findall(text)
            for included in includes[file]:
                if not (root / included).is_file():
                    out.append(f"{file}: includes {included}, which is not there")
                    continue
                other = room_of.get(str(Path(included).parent))
                if other is None and str(Path(included).parent) in OPTIONAL:
                    continue
                if other not in allowed:
                    out.append(f"{file}: includes {included} of {other}, which is not below {room_of[folder]}")
    return out + [" includes ".join([*circle, circle[0]]) for circle in circles(includes)]


def main():
    rooms = read_rooms(Path(sys.argv[1]).read_text())
    wrong = problems(rooms, sys.argv[2])
    for line in wrong:
        print(line)
    print(f"{len(rooms)} rooms, {len(wrong)} wrong")
    return 1 if wrong or not rooms else 0


if __name__ == "__main__":
    sys.exit(main())
