"""Tasks on teeth that nobody tuned them for: each tooth is made from a drawn seed, each task is written by `scenario new`, tried with wrong work and
taken by the built-in expert.

campaign.py --cavum build/release/cavum --work DIR [--seed N] [--molars 2] [--premolars 2] [--incisors 2] [--leaf-mm 0.05] [--tasks WORD,WORD] [--jobs 1]
campaign.py ... --teeth molar:2,premolar:2 --tasks slot_mesial

Prints a row for each pair of tooth and task, and a table of all of them. Files stay in DIR; a pair that DIR holds an answer for is not run again.
Ends with 1 when a task that a tooth is offered is not written, when the expert has less than 90 % or does not pass, or when wrong work passes.
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

LEAST_PERCENT = 90
NOT_TUNED_ON = range(100, 100000)  # seeds below were looked at while the tasks were written
Done = collections.namedtuple("Done", "returncode stdout stderr")
PREMOLAR_BESIDE = 4  # seed of the neighbour
ROW_LEAF_MM = "0.06"  # a molar beside a neighbour has more leaves of 0.05 mm than the program reads


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
    base = os.path.join(work, "%s-%d" % (kind, seed))
    bare = make(base + ".cvt", cavum, "make", kind, "--seed", str(seed), "--leaf-mm", leaf)
    offered = json.loads(must(cavum, "scenario", "new", "--tooth", bare, "--list", "--json"))["tasks"]
    words = [t["task"] for t in offered if t["offered"]]
    yield bare, words
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
    return {"took_s": took, "refused": "" if done.returncode == 0 else done.stderr}


def solve(cavum, scenario):
    """The expert's exam, and wrong work; `check` says more where the answer is no although the expert passes."""
    done, took = run(cavum, "scenario", "solve", scenario, "--battery", "--json")
    solved = json.loads(done.stdout)
    score = solved.get("score", {"points": 0, "max": 1})
    found = {"took_s": took, "verdict": solved.get("verdict", "none"), "percent": 100 * score["points"] / score["max"],
             "expert_s": solved.get("time_s", 0), "reasons": solved["reasons"], "pieces": len(solved["battery"]),
             "passing": ["%s passes, %.0f points" % (w["name"], w["points"]) for w in solved["battery"] if w["verdict"] == "pass"], "mistakes": []}
    if done.returncode != 0 and solved["passed"]:
        problems = json.loads(run(cavum, "scenario", "check", scenario, "--json")[0].stdout)["problems"]
        found["mistakes"] = [p["what"] for p in problems if p["severity"] == "error"]
    return found


def try_pair(cavum, tooth, task):
    base = "%s.%s" % (os.path.splitext(tooth)[0], task)
    row = {"tooth": os.path.splitext(os.path.basename(tooth))[0], "task": task}
    row["new"] = answered(base + ".new.json", lambda: write(cavum, tooth, task, base + ".toml"))
    if not row["new"]["refused"]:
        row["solve"] = answered(base + ".solve.json", lambda: solve(cavum, base + ".toml"))
    return row


def good(row):
    if row["new"]["refused"]:
        return False
    found = row["solve"]
    return found["verdict"] == "pass" and found["percent"] >= LEAST_PERCENT and not found["passing"] and not found["mistakes"]


def words_of(row):
    if row["new"]["refused"]:
        return "refused: " + row["new"]["refused"]
    return "; ".join(["expert: " + r for r in row["solve"]["reasons"]] + row["solve"]["passing"] + row["solve"]["mistakes"])


def table_row(row):
    if row["new"]["refused"]:
        return "| %s | %s | %.0f | | | | | %s |" % (row["tooth"], row["task"], row["new"]["took_s"], words_of(row))
    found = row["solve"]
    return "| %s | %s | %.0f | %.0f | %.1f, %s | %.0f | %d of %d | %s |" % (
        row["tooth"], row["task"], row["new"]["took_s"], found["took_s"], found["percent"], found["verdict"], found["expert_s"],
        len(found["passing"]), found["pieces"], words_of(row))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--cavum", required=True)
    parser.add_argument("--work", required=True)
    parser.add_argument("--seed", type=int, default=1, help="by which the teeth's seeds are drawn")
    for kind in ("molar", "premolar", "incisor"):
        parser.add_argument("--%ss" % kind, type=int, default=2)
    parser.add_argument("--teeth", default="", help="these instead, as kind:seed,kind:seed")
    parser.add_argument("--tasks", default="", help="only these")
    parser.add_argument("--leaf-mm", default="0.05")
    parser.add_argument("--jobs", type=int, default=1, help="pairs side by side")
    o = parser.parse_args()
    os.makedirs(o.work, exist_ok=True)
    drawn = random.Random(o.seed)
    if o.teeth:
        teeth = [(t.split(":")[0], int(t.split(":")[1])) for t in o.teeth.split(",")]
    else:
        teeth = [(kind, drawn.choice(NOT_TUNED_ON)) for kind in ("molar", "premolar", "incisor") for _ in range(getattr(o, kind + "s"))]
    print("teeth: " + ",".join("%s:%d" % t for t in teeth), flush=True)
    listed = pairs(o.cavum, teeth, o.work, o.leaf_mm, [t for t in o.tasks.split(",") if t])
    drawn.shuffle(listed)  # whoever stops it early has seen some of each
    rows = []
    with concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
        for done in concurrent.futures.as_completed(pool.submit(try_pair, o.cavum, tooth, task) for tooth, task in listed):
            rows.append(done.result())
            print(("      " if good(rows[-1]) else "FAULT ") + table_row(rows[-1]), flush=True)
    rows.sort(key=lambda r: (r["tooth"], r["task"]))
    print("\n| tooth | task | written, s | solved and tried, s | expert, %, verdict | his time, s | wrong work that passes | |\n| - | - | - | - | - | - | - | - |")
    for row in rows:
        print(table_row(row))
    bad = [r for r in rows if not good(r)]
    print("\n%d pairs, %d without a fault" % (len(rows), len(rows) - len(bad)))
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
