"""Usage: check_facts.py SOURCE_DIR. Facts are values: nothing is decided by a text that was made for people, and a kind has its name in one place.

Prints each place of the product that searches or cuts a rendered text (what(), english_text(), tr(), a message, a finding), or compares the kind of an
event or of a ledger's entry with a text outside its codec, and exits with 1 when there is any. What a file says is no rendered text.
"""
import re
import sys
from pathlib import Path

SEARCH = r"\.(?:find|rfind|find_first_of|starts_with|ends_with)\("
RENDERED = [
    re.compile(r"what\(\)\)?" + SEARCH),
    re.compile(r"\b(?:english_text|tr|trn|shown)\((?:[^()]|\([^()]*\))*\)" + SEARCH),
    re.compile(r"\b(?:finding|reason|remark|refusal|trouble|problem|advice)s?(?:\(\))?(?:\[\w+\])?" + SEARCH + r'(?:"|k_)'),
    re.compile(r'rfind\("; "\)'),
]
HOLDS = re.compile(r"\b(\w+)(?: = |\{|\()(?:english_text|tr|trn)\(")
KIND = re.compile(r'\b(?:e|event|entry)(?:\.|->)kind\s*[!=]=\s*(?:"|k_)')


def places(text):
    names = {m[1] for m in HOLDS.finditer(text)} - {"return", "push_back", "emplace_back", "append", "string"}
    held = re.compile(r"\b(?:" + "|".join(sorted(names)) + r")" + SEARCH) if names else None
    for number, line in enumerate(text.splitlines(), 1):
        code = line.split("//")[0]
        if any(p.search(code) for p in RENDERED) or (held and held.search(code)):
            yield number, "searches a text made for people: decide by the error's code or the finding's kind", line
        elif KIND.search(code):
            yield number, "compares a kind with a text: use std::visit or as<Kind>()", line


def main():
    root, wrong = Path(sys.argv[1]), 0
    for top in ("engine", "scenarios", "grading", "ui"):
        for path in sorted((root / top).rglob("*")):
            name = path.relative_to(root).as_posix()
            if path.suffix not in (".h", ".cpp") or name.startswith("ui/language/"):
                continue
            for number, why, line in places(path.read_text(encoding="utf-8")):
                print(f"{name}:{number}: {why}: {line.strip()[:120]}")
                wrong += 1
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
