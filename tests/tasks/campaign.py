"""Tasks on teeth that nobody tuned them for: each tooth is made from a drawn seed, or is a file, each task is written by `scenario new`, which lets the
built-in expert take it and tries faulty preparations, and refuses what does not hold.

campaign.py --cavum build/release/cavum --work DIR [--seed N] [--molars 2] [--premolars 2] [--incisors 2] [--leaf-mm 0.05] [--tasks WORD,WORD] [--jobs 1]
campaign.py ... --teeth molar:2,premolar:2,scanned.cvt --tasks slot_mesial

Prints a row for each pair of tooth and task, and a table of all of them. Files stay in DIR; a pair that DIR holds an answer for is not run again.
Ends with 1 when a task that a tooth is offered is refused.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import random
import subprocess
import sys
import tempfile

NOT_TUNED_ON = range(100, 100000)  # seeds below were looked at while the tasks were written
Done = collections.namedtuple("Done", "returncode stdout stderr")
PREMOLAR_BESIDE = 4  # seed of the neighbour
ROW_LEAF_MM = "0.06"  # a molar beside a neighbour


def run(cavum, *arguments):
    """Exit code, what it printed, and the seconds of the processor it took: those of the clock say more of what else runs."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        child = subprocess.Popen([cavum, *arguments], stdout=out, stderr=err)
        _, status, used = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        return Done(child.returncode, out.read(), err.read().strip()), used.ru_utime + used.ru_stime


def must(cavum, *arguments):
    done, _ = run(cavum, *arguments)
    if done.returncode != 0:
        sys.exit("cavum %s: %s" % (" ".join(arguments), done.stderr))
    return done.stdout


def make(path, cavum, *arguments):
    """The tooth file of that name, made where it is missing."""
    if not os.path.exists(path):
        must(cavum, "tooth", *arguments, "--out", path)
    return path


def teeth_of(cavum, kind, seed, work, leaf):
    """(file, tasks) of the bare tooth, of it with a lesion, and of it beside a neighbour: what `--list` offers."""
    if kind.endswith(".cvt"):
        bare = kind
    else:
        base = os.path.join(work, "%s-%d" % (kind, seed))
        bare = make(base + ".cvt", cavum, "make", kind, "--seed", str(seed), "--leaf-mm", leaf)
    offered = json.loads(must(cavum, "scenario", "new", "--tooth", bare, "--list", "--json"))["tasks"]
    words = [t["task"] for t in offered if t["offered"]]
    yield bare, words
    if kind.endswith(".cvt"):
        return
    yield make(base + "-lesion.cvt", cavum, "lesion", bare, "--site", "occlusal" if "class_1" in words else "mesial"), ["lesion"]
    if "class_2_mesial" in words:
        coarse = leaf if kind == "premolar" else ROW_LEAF_MM
        own = make("%s-%s.cvt" % (base, coarse), cavum, "make", kind, "--seed", str(seed), "--leaf-mm", coarse)
        beside = make(os.path.join(work, "beside-%s.cvt" % coarse), cavum, "make", "premolar", "--seed", str(PREMOLAR_BESIDE), "--leaf-mm", coarse)
        yield make(base + "-row.cvt", cavum, "neighbour", own, "--mesial", beside, "--gum"), ["class_2_mesial"]


def pairs(cavum, teeth, work, leaf, wanted):
    list_of = []
    for kind, seed in teeth:
        for tooth, words in teeth_of(cavum, kind, seed, work, leaf):
            list_of += [(tooth, w) for w in words if not wanted or w in wanted]
    return list_of


def answered(path, find):
    """What `find()` gives, kept in that file: who starts again goes on where it stopped."""
    if not os.path.exists(path):
        found = find()
        with open(path, "w") as file:
            json.dump(found, file, indent=1)
    with open(path) as file:
        return json.load(file)


def write(cavum, tooth, task, scenario):
    done, took = run(cavum, "scenario", "new", "--tooth", tooth, "--task", task, "--out", scenario, "--force", "--json")
    if done.returncode != 0:
        return {"took_s": took, "refused": done.stderr}
    said = json.loads(done.stdout)
    return {"took_s": took, "refused": "", "chosen": said["chosen"], **said["tried"]}


def try_pair(cavum, work, tooth, task):
    name = os.path.splitext(os.path.basename(tooth))[0]
    base = os.path.join(work, "%s.%s" % (name, task))
    return {"tooth": name, "task": task, **answered(base + ".new.json", lambda: write(cavum, tooth, task, base + ".toml"))}


def table_row(row):
    if row["refused"]:
        return "| %s | %s | %.0f | | | refused: %s |" % (row["tooth"], row["task"], row["took_s"], row["refused"])
    return "| %s | %s | %.0f | %.1f | 0 of %d | %s |" % (
        row["tooth"], row["task"], row["took_s"], row["expert_percent"], row["faulty_preparations"], row["chosen"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--cavum", required=True)
    parser.add_argument("--work", required=True)
    parser.add_argument("--seed", type=int, default=1, help="by which the teeth's seeds are drawn")
    for kind in ("molar", "premolar", "incisor"):
        parser.add_argument("--%ss" % kind, type=int, default=2)
    parser.add_argument("--teeth", default="", help="these instead: kind:seed or a file, with commas")
    parser.add_argument("--tasks", default="", help="only these")
    parser.add_argument("--leaf-mm", default="0.05")
    parser.add_argument("--jobs", type=int, default=1, help="pairs side by side")
    o = parser.parse_args()
    os.makedirs(o.work, exist_ok=True)
    drawn = random.Random(o.seed)
    if o.teeth:
        teeth = [(t, 0) if t.endswith(".cvt") else (t.split(":")[0], int(t.split(":")[1])) for t in o.teeth.split(",")]
    else:
        teeth = [(kind, drawn.choice(NOT_TUNED_ON)) for kind in ("molar", "premolar", "incisor") for _ in range(getattr(o, kind + "s"))]
    print("teeth: " + ",".join("%s:%d" % t for t in teeth), flush=True)
    listed = pairs(o.cavum, teeth, o.work, o.leaf_mm, [t for t in o.tasks.split(",") if t])
    drawn.shuffle(listed)  # whoever stops it early has seen some of each
    rows = []
    with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
        for done in concurrent.futures.as_completed(pool.submit(try_pair, o.cavum, o.work, tooth, task) for tooth, task in listed):
            rows.append(done.result())
            print(table_row(rows[-1]), flush=True)
    rows.sort(key=lambda r: (r["tooth"], r["task"]))
    print("\n| tooth | task | written and tried, s | expert, % | faulty preparations that pass | chosen |\n| - | - | - | - | - | - |")
    for row in rows:
        print(table_row(row))
    refused = [r for r in rows if r["refused"]]
    print("\n%d pairs, %d refused" % (len(rows), len(refused)))
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main())
