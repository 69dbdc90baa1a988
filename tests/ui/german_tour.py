#!/usr/bin/env python3
"""The whole tour in German: every screen of the station, and the verbs from the first ticket to the class report. What is shown holds no English word:
none that Debian's list of American words has and its list of German ones has not, but names, identifiers and what german_tour_words.txt lists with a
reason. Deep: takes some minutes.
    CAVUM_DEEP=1 german_tour.py CAVUM SOURCE_FOLDER [FOLDER: what was shown stays there]
"""
import html.parser
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ENGLISH, GERMAN = pathlib.Path("/usr/share/dict/american-english"), pathlib.Path("/usr/share/dict/ngerman")
VERBS = "tooth scenario exam replay session grade scan rig explain ledger report cohort verify devices station manual"


class Readable(html.parser.HTMLParser):
    """What a person reads of a page: its texts and labels, and the titles of its pictures."""

    def __init__(self):
        super().__init__()
        self.words, self.hidden = [], 0

    def handle_starttag(self, tag, attrs):
        self.hidden += tag in ("style", "script")
        self.words += [value for name, value in attrs if name in ("aria-label", "title", "alt") and value]

    def handle_endtag(self, tag):
        self.hidden -= tag in ("style", "script")

    def handle_data(self, data):
        if not self.hidden:
            self.words.append(data)


def readable(page):
    reader = Readable()
    reader.feed(page)
    return "\n".join(reader.words)


def english_words(text, english, german):
    """With where they stand. What stands beside / _ \\ . or a digit is a path, a file or an identifier; what is quoted is one, too."""
    text = re.sub(r"'[^'\n]{1,60}'|„[^“\n]{1,60}“", " ", text)
    text = re.sub(r"\b(?:U?INT|FLOAT|TEXT):\S[^=\n]*?(?==|\s{2}|\n|$)", " ", text)  # what an option takes, as CLI11 writes it: FLOAT:0.2 to 600
    text = re.sub(r"^  [a-z][a-z-]+  +", " ", text, flags=re.MULTILINE)  # a verb of a list, the name of a criterion
    for m in re.finditer(r"(?<![\w/.\\<=-])[A-Za-zÄÖÜäöüß]{2,}(?![\w/\\=>]|[.-]\w)", text):
        word = m.group().lower()
        if word in english and word not in german:
            yield word, text[max(0, m.start() - 40):m.end() + 40].replace("\n", " | ")


def commands(source, folder):
    slot, s, ledger = f"{source}/data/scenarios/slot.toml", f"{folder}/A17.cavum", f"{folder}/ledger"
    yield from ([*verb, "--help"] for verb in [[]] + [[v] for v in VERBS.split()])
    yield ["exam", slot, "--candidate", "A17", "--operator", "novice", "--out", s]
    yield ["grade", s]
    yield ["grade", s, "--why", "walls"]
    yield ["replay", s, "--verify"]
    yield ["verify", s]
    yield ["report", s, "--out", f"{folder}/instructor.html"]
    yield ["report", s, "--for", "student", "--no-replay", "--compare", "expert", "--out", f"{folder}/student.html"]
    yield ["scenario", "check", slot]
    yield ["tooth", "info", f"{source}/data/teeth/block.cvt"]
    yield ["devices"]
    yield ["ledger", "init", ledger, "--school", "Zahnklinik"]
    yield ["ledger", "ticket", ledger, slot, "--candidate", "4711", "--from", "2020-01-01T00:00Z", "--until", "2190-01-01T00:00Z", "--out", f"{folder}/t"]
    yield ["exam", slot, "--ticket", f"{folder}/t", "--operator", "expert", "--out", f"{folder}/4711.cavum"]
    yield ["ledger", "add", ledger, f"{folder}/4711.cavum"]
    yield ["ledger", "add", ledger, s]
    yield ["ledger", "show", ledger]
    yield ["ledger", "release", ledger, "--all"]
    yield ["ledger", "verify", ledger]
    yield ["ledger", "tickets", ledger]
    yield ["ledger", "backup", ledger, "--out", f"{folder}/backup"]
    yield ["cohort", "simulate", slot, "--ledger", ledger, "--sessions", f"{folder}/class", "--n", "3"]
    yield ["cohort", "report", ledger, "--exam", "slot", "--out", f"{folder}/class.html"]
    yield ["ledger", "decide", ledger]
    # refused
    yield ["grade", f"{folder}/none.cavum"]
    yield ["exam", slot, "--candidate", "A17", "--operator", "nobody", "--out", f"{folder}/x.cavum"]
    yield ["exam", slot, "--candidate", "A17", "--operator", "expert", "--out", s]
    yield ["ledger", "init", ledger]
    yield ["report", s, "--out", f"{folder}/x.doc"]


def main():
    if "CAVUM_DEEP" not in os.environ:
        print("SKIPPED: takes some minutes; CAVUM_DEEP=1 runs it")
        return 0
    if not ENGLISH.exists() or not GERMAN.exists():
        print("SKIPPED: install wamerican and wngerman first")
        return 0
    cavum, source = sys.argv[1:3]
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(sys.argv[3] if len(sys.argv) > 3 else scratch)
        folder.mkdir(parents=True, exist_ok=True)
        environment = {**os.environ, "CAVUM": cavum, "CAVUM_HOME": f"{folder}/home", "LANGUAGE": "de"}
        shown = {}
        for command in commands(source, folder):
            ran = subprocess.run([cavum, "--language", "de", *command], env=environment, capture_output=True, text=True, stdin=subprocess.DEVNULL)
            # of a refusal's quotation marks none is lost
            shown[" ".join(command)] = ran.stdout + ran.stderr
        shoot = f"{source}/tests/ui/station/shoot_screens.sh"
        subprocess.run([shoot, f"{folder}/screens", "1280x800", "de"], env=environment, check=True, stdout=subprocess.DEVNULL)
        shown.update({f"screen {p.stem}": p.read_text() for p in sorted((folder / "screens").glob("*.txt"))})
        shown.update({f"page {p.name}": readable(p.read_text()) for p in sorted(folder.glob("*.html"))})
        if len(sys.argv) > 3:
            for name, text in shown.items():
                (folder / (re.sub(r"[^A-Za-z0-9-]+", "_", name.replace(str(folder), "").replace(source, ""))[:80] + ".said")).write_text(text)
    lists = [{w.strip().lower() for w in p.read_text(encoding="utf-8").split("\n")} for p in (ENGLISH, GERMAN)]
    for line in (pathlib.Path(__file__).parent / "german_tour_words.txt").read_text().split("\n"):
        lists[1].update(line.partition("#")[0].split())
    found, words = {}, 0
    for name, text in shown.items():
        words += len(text.split())
        for word, where in english_words(text, *lists):
            found.setdefault((word, where), name)
    for (word, where), name in sorted(found.items()):
        print(f"{word}: {name}: ...{where}...")
    pages, screens = (sum(n.startswith(kind) for n in shown) for kind in ("page ", "screen "))
    print(f"{len(shown) - pages - screens} commands, {screens} screens, {pages} pages, {words} words; {len(found)} places with an English word")
    return 1 if found or screens < 25 or pages < 3 else 0


sys.exit(main())
