"""Usage: check_facts.py SOURCE_DIR. Facts are values: nothing is decided by a text that was made for people, and a kind has its name in one place.

Prints each place of the product that searches or cuts a rendered text (what(), english_text(), tr(), a message, a finding), or compares the kind of an
event or of a ledger's entry with a text outside its codec, and exits with 1 when there is any. What a file says is no rendered text.
"""
import re
import sys
from pathlib import Path

SEARCH = r"\.(?:find|rfind|find_first_of|find_last_of|starts_with|ends_with|contains|compare|substr)\("
RENDERED = [
    re.compile(r"what\(\)\)?" + SEARCH),
    re.compile(r"\b(?:english_text|tr|trn|shown)\((?:[^()]|\([^()]*\))*\)" + SEARCH),
    re.compile(r"\b(?:finding|reason|remark|refusal|trouble|problem|advice)s?(?:\(\))?(?:\[\w+\])?" + SEARCH + r'(?:"|k_)'),
    re.compile(r'rfind\("; "\)'),
]
HOLDS = re.compile(r"\b(\w+)(?: = |\{|\()(?:(?:english_text|tr|trn)\(|[^;{}\n]*\bwhat\(\)\)?[;)}])")
KIND = re.compile(r'\b(?:e|event|entry)(?:\.|->)kind\s*[!=]=\s*(?:"|k_)')


# The pages: a text of tr(), of an element, or of a field that the server fills with words.
SCRIPT_SEARCH = r"(?:\.(?:includes|indexOf|lastIndexOf|startsWith|endsWith|match|matchAll|search|split|slice|replace|replaceAll)\(| [!=]==? [\"'`]\w)"
SCRIPT_WORDS = r"(?:textContent|innerText|(?:problem|error|message|finding|reason|remark|trouble|advice|refusal|wrong|what|text)s?)"
SCRIPT = [
    re.compile(r"\btrn?\((?:[^()]|\([^()]*\))*\)" + SCRIPT_SEARCH),
    re.compile(r"\." + SCRIPT_WORDS + r"(?:\[\w+\]|[!?])?" + SCRIPT_SEARCH),
    re.compile(r"/[^/ ]+/\w*\.(?:test|exec)\([^()]*\b(?:kind|" + SCRIPT_WORDS + r")\)"),
]
SCRIPT_HOLDS = re.compile(r"\b(?:const|let) (\w+)(?:: string)? = trn?\(")


def script_places(text):
    names = {m[1] for m in SCRIPT_HOLDS.finditer(text)}
    held = [re.compile(r"(?<![.\w])(?:" + "|".join(sorted(names)) + r")" + SCRIPT_SEARCH)] if names else []
    for number, line in enumerate(text.splitlines(), 1):
        code = re.sub(r"//.*|^\s*/?\*.*", "", line)
        if any(p.search(code) for p in SCRIPT + held):
            yield number, "searches or compares a text made for people: decide by a kind that the server tells", line


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
            find = {".h": places, ".cpp": places, ".ts": script_places}.get(path.suffix)
            if find is None or name.startswith("ui/language/") or "node_modules" in path.parts:
                continue
            for number, why, line in find(path.read_text(encoding="utf-8")):
                print(f"{name}:{number}: {why}: {line.strip()[:120]}")
                wrong += 1
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
