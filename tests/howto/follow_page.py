"""Usage: follow_page.py PAGE WORK_DIR [--tree SOURCE_DIR] [--bin DIR]

Does what a page of docs/howto says, in WORK_DIR. What to do with a fenced block stands in the line above it, and nothing else may stand there:

    Write `PATH`:                     the block is a new file
    In `PATH`, above `LINE`:          the block goes above the last line of the file that reads so (or `below`), in a copy taken from SOURCE_DIR
    Run:                              commands, run one after the other with DIR in front of PATH; each must succeed, unless the line is
    Run, and see it fail:             the last of them must not
    It says:                          each line stands in what was printed, in that order; … stands for anything

With --tree nothing is run: the files are made, and their names printed. Ends with 1 where a block cannot be followed.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

WRITE = re.compile(r"Write `([^`]+)`:$")
INSERT = re.compile(r"In `([^`]+)`, (above|below) `([^`]+)`:$")


class Wrong(Exception):
    """What stands in the page cannot be done."""


def blocks_of(text):
    """(line number, what the line above says, block) of each fenced block. A block may be indented as its list's item is."""
    lines, out, at = text.splitlines(), [], 0
    while at < len(lines):
        fence = re.match(r"( *)```", lines[at])
        if not fence:
            at += 1
            continue
        end = next((i for i in range(at + 1, len(lines)) if lines[i].strip() == "```"), None)
        if end is None:
            raise Wrong(f"line {at + 1}: a block without an end")
        above = next((lines[i] for i in range(at - 1, -1, -1) if lines[i].strip()), "")
        block = [line.removeprefix(fence[1]) for line in lines[at + 1:end]]
        out.append((at + 1, re.sub(r"^(\d+\. |- )", "", above.strip()), "\n".join(block) + "\n"))
        at = end + 1
    return out


def insert(path, block, where, line):
    lines = path.read_text().split("\n")
    found = [i for i, text in enumerate(lines) if text.strip() == line]
    if not found:
        raise Wrong(f"{path}: no line reads '{line}'")
    at = found[-1] + (where == "below")
    path.write_text("\n".join(lines[:at] + block.rstrip("\n").split("\n") + lines[at:]))


def run(block, work, bin_dir, fails):
    """What the commands print. The last of them must fail when `fails`."""
    env = dict(os.environ, PATH=f"{bin_dir}{os.pathsep}{os.environ['PATH']}" if bin_dir else os.environ["PATH"])
    env.pop("CAVUM_ALTER_SENTENCES", None)  # a page quotes the program
    done = subprocess.run(["bash", "-ec", block], cwd=work, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if (done.returncode != 0) != fails:
        raise Wrong(f"ended with {done.returncode}:\n{block}{done.stdout}")
    return done.stdout


def expect(block, printed):
    at = 0
    for line in block.splitlines():
        pattern = re.compile(".*?".join(re.escape(part.strip()) for part in line.split("…")))
        found = pattern.search(printed, at)
        if not found:
            raise Wrong(f"nothing reads '{line.strip()}' in\n{printed}")
        at = found.end()


def follow(page, work, tree=None, bin_dir=None):
    """Names of the files that were made or changed, in the order of the page."""
    text, made, printed = Path(page).read_text(), [], ""
    for number, says, block in blocks_of(text):
        try:
            if match := WRITE.match(says):
                path = work / match[1]
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(block)
                made.append(match[1])
            elif match := INSERT.match(says):
                path = work / match[1]
                if not path.exists():
                    path.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy(Path(tree) / match[1], path)
                insert(path, block, match[2], match[3])
                made.append(match[1])
            elif says in ("Run:", "Run, and see it fail:"):
                printed = "" if tree else run(block, work, bin_dir, says != "Run:")
            elif says == "It says:":
                if not tree:
                    expect(block, printed)
            else:
                raise Wrong(f"'{says}' does not say what to do with the block")
        except (Wrong, OSError) as e:
            raise Wrong(f"{page}:{number}: {e}") from e
    return list(dict.fromkeys(made))


def main(argv):
    parser = argparse.ArgumentParser()
    parser.add_argument("page")
    parser.add_argument("work", type=Path)
    parser.add_argument("--tree")
    parser.add_argument("--bin")
    args = parser.parse_args(argv)
    shutil.rmtree(args.work, ignore_errors=True)
    args.work.mkdir(parents=True)
    try:
        made = follow(args.page, args.work, args.tree, args.bin)
    except Wrong as e:
        print(e)
        return 1
    for name in made:
        print(name)
    if not made:
        print(f"{args.page}: nothing in it can be followed")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
