"""Usage: check_names.py SOURCE_DIR

Prints what is wrong and exits with 1: a link of a page that leads nowhere, or to a heading that is not there; a file that a page or a comment names and
that is not there; a README of more than 60 lines; a paragraph of more than five lines of 160 characters. Looks at *.md, and at the comments of *.h,
*.cpp, *.toml, CMakeLists.txt and `dev`.
"""
import fnmatch
import re
import subprocess
import sys
from pathlib import Path

MOST_LINES = 60
MOST_CHARACTERS = 5 * 160
ENDINGS = "md|h|cpp|py|toml|csv|cvt|svg|cmake|ts|css|mjs|sh|supp|dict|json|txt|html"
NAME = re.compile(r"(?<![\w/.~$*<>{}…-])(?:[\w.*-]+/)+[\w.*-]+\.(?:" + ENDINGS + r")(?![\w/])|(?<![\w/.~$*<>{}…-])[A-Za-z][\w-]*\.md(?![\w/])")
LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
CODE = re.compile(r"`[^`]*`")

# Names that are no files of the project, each with its reason. A star stands for anything.
EXCEPTIONS = {
    "build/*": "made by the build",
    "s/*": "the folder for sessions that the tour makes",
    "receipts/*": "written by the ledger's verbs, in examples",
    "tickets/*": "written by the ledger's verbs, in examples",
    "data/*/NAME.toml": "stands for any of that folder",
    "data/scenarios/mine.toml": "written by the reader of the tour",
    "data/scenarios/x.toml": "an example of a path",
    "tests/engine/lab/explain/model/suction_test.cpp": "written by the reader of a recipe",
    "tests/grading/result/removal_rate_test.cpp": "written by the reader of a recipe",
    "folder/recording.csv": "written by the generator of recordings",
}
# Pages whose words are history: they name what was there then.
HISTORY = {"CHANGELOG.md"}
# Sources that name files of their own making.
OWN_NAMES = {"tests/docs/check_names.py", "tests/docs/check_names_test.py"}


def files_of(root):
    """Paths relative to `root` of what is kept, or will be, in the repository; all files where there is no git."""
    try:
        listed = subprocess.run(["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                                capture_output=True, check=True).stdout.decode().split("\0")
    except (OSError, subprocess.CalledProcessError):
        listed = [str(p.relative_to(root)) for p in root.rglob("*") if p.is_file() and not {"build", ".git"} & set(p.relative_to(root).parts)]
    return sorted({f for f in listed if f and (root / f).is_file()})


def slugs_of(text):
    """The anchors of a page's headings."""
    out, inside = set(), False
    for line in text.splitlines():
        if line.startswith("```"):
            inside = not inside
        if inside or not re.match(r"#+ ", line):
            continue
        words = re.sub(r"[^\w\- ]", "", line.lstrip("#").strip().replace("`", "").lower())
        out.add(words.replace(" ", "-"))
    return out


def comments_of(path, text):
    """Lines of comments with their numbers; of a page all lines."""
    for number, line in enumerate(text.splitlines(), 1):
        if path.endswith(".md"):
            yield number, line
        elif path.endswith((".h", ".cpp")):
            at = line.find("//")
            while at >= 0 and (line.count('"', 0, at) - line.count('\\"', 0, at)) % 2 == 1:
                at = line.find("//", at + 2)
            if at >= 0:
                yield number, line[at + 2:]
        else:
            at = line.find("#")
            if at >= 0:
                yield number, line[at + 1:]


def paragraphs_of(text):
    """First line and text of each paragraph: no headings, tables, commands. An item of a list is one of its own."""
    begun, words, inside = 0, [], False
    for number, line in enumerate(text.splitlines() + [""], 1):
        if line.startswith("```"):
            inside = not inside
        item = re.match(r"\s*(?:[-*]|\d+\.) ", line)
        apart = inside or not line.strip() or line.lstrip().startswith(("#", "|", "```")) or (line.startswith("    ") and not words)
        if (apart or item) and words:
            yield begun, " ".join(words)
            words = []
        if apart:
            continue
        if not words:
            begun = number
        words.append(line.strip())


def there(name, folder, files, folders):
    """Whether a kept file has this name from the top, from the folder that names it, or as the end of its path."""
    if any(fnmatch.fnmatch(name, pattern) for pattern in EXCEPTIONS):
        return True
    parts = []
    for part in (folder + "/" + name if name.startswith("..") else name).split("/"):
        if part == ".." and parts:
            parts.pop()
        elif part not in ("", "."):
            parts.append(part)
    plain = "/".join(parts)
    if "*" in plain:
        return any(fnmatch.fnmatch("/" + f, "*/" + plain) for f in files)
    return plain in files or plain in folders or any(f.endswith("/" + plain) for f in files)


def problems(root):
    root = Path(root)
    files = files_of(root)
    kept = set(files)
    folders = {str(parent) for f in files for parent in Path(f).parents}
    texts = {}
    for f in files:
        if f.endswith((".md", ".h", ".cpp", ".toml")) or Path(f).name == "CMakeLists.txt" or f == "dev":
            texts[f] = (root / f).read_text(errors="replace")
    out = []
    for f, text in texts.items():
        folder = str(Path(f).parent)
        page = f.endswith(".md")
        if f in HISTORY or f in OWN_NAMES:
            continue
        for number, line in comments_of(f, text):
            links = LINK.findall(CODE.sub("``", line)) if page else []
            for target in links:
                if re.match(r"[a-z]+:", target):
                    continue
                path, _, anchor = target.partition("#")
                where = str((root / folder / path).resolve().relative_to(root.resolve())) if path else f
                if where not in kept and where not in folders:
                    if where not in EXCEPTIONS:
                        out.append(f"{f}:{number}: links to {target}, which is not there")
                elif anchor and where in texts and anchor not in slugs_of(texts[where]):
                    out.append(f"{f}:{number}: links to {target}, which has no such heading")
            for name in NAME.findall(LINK.sub("", line)):
                if not there(name, folder, files, folders):
                    out.append(f"{f}:{number}: names {name}, which is not there")
        if not page:
            continue
        lines = text.count("\n")
        if Path(f).name == "README.md" and lines > MOST_LINES:
            out.append(f"{f}: has {lines} lines, {MOST_LINES} are allowed")
        for number, words in paragraphs_of(text):
            if len(words) > MOST_CHARACTERS:
                out.append(f"{f}:{number}: a paragraph of {len(words)} characters, {MOST_CHARACTERS} are allowed")
    return out, len(texts)


def main():
    wrong, looked_at = problems(sys.argv[1])
    for line in wrong:
        print(line)
    print(f"{looked_at} files, {len(wrong)} wrong")
    return 1 if wrong or not looked_at else 0


if __name__ == "__main__":
    sys.exit(main())
