#!/usr/bin/python3
"""Asks `cavum explain` about recordings that others generate, and counts its answers by family.

  score.py CAVUM GENERATOR [--draws N] [--first SEED] [--size S] [--only FAMILY,FAMILY|PREFIX*] [--jobs N] [--log F.jsonl] [--kinds clean,effect]
A generator is a program with --list, and --family F --seed N --size S --out DIR (recording.csv, rig.toml, truth.json).
Marks: found: a true mechanism is a cause or one of its aliases. Precision: causes whose set holds a truth, over all causes. False: a clean recording
with a named cause. Abstaining (`unexplained`, `not_testable`, `data_fault`) counts as neither. Gain: no named cause with an interval that holds 0.
"""
import argparse, collections, concurrent.futures, json, os, re, shlex, shutil, subprocess, sys, tempfile, time


def options_of(truth, header):
    """What a person would add to the command, from the words in which the generator says how its file counts."""
    out, words = [], " ".join(truth.get("options", []) + truth.get("options_in_words", []))
    if surface := re.search(r"surface at (-?[0-9.]+) mm", words):
        out += ["--surface-mm", surface.group(1)]
    if "compression is negative" in words:
        out += ["--negate", "f"]
    if "counted against the feed" in words or "towards smaller x" in words:
        out += ["--negate", "x"] + (["--negate", "v"] if "v_mm_s" in header else [])
    return out


def ask(task):
    cavum, generator, family, kind, seed, size = task
    folder = tempfile.mkdtemp(prefix="outside-")
    try:
        made = subprocess.run(["/usr/bin/python3", generator, "--family", family, "--seed", str(seed), "--size", str(size), "--out", folder], capture_output=True, text=True)
        if made.returncode != 0:
            return dict(family=family, kind=kind, seed=seed, size=size, error="generator: " + made.stderr[-300:])
        truth = json.load(open(folder + "/truth.json"))
        began = time.time()
        run = subprocess.run(shlex.split(cavum) + ["explain", folder + "/recording.csv", "--json", "--seed", str(seed)] + options_of(truth, open(folder + "/recording.csv").readline()), capture_output=True, text=True)
        seconds = time.time() - began
        answer = json.loads(run.stdout or "{}")
        if "verdict" not in answer:
            return dict(family=family, kind=kind, seed=seed, size=size, truth=truth, refused=run.stderr.strip()[-300:], rc=run.returncode, seconds=seconds)
        return dict(family=family, kind=kind, seed=seed, size=size, truth=truth, answer=answer, seconds=seconds)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def names(cause):
    return {cause["mechanism"], *cause["aliases"]}


def marks(case):
    """found, hidden, causes, true causes, false alarm, abstained, bad gain, parameters held, parameters"""
    m = collections.Counter(cases=1, seconds=case.get("seconds", 0))
    if "answer" not in case:
        m["refused"] = 1
        return m
    a, truth = case["answer"], case["truth"]
    accept = [set(h.get("accept", [])) | ({h["mechanism"]} if h["mechanism"] else set()) for h in truth["hidden"]]
    # causes of their own, whatever the generator calls them: a force ahead of the position is a position that comes late
    always = {"noise_hum": "interference", "mains": "interference", "noise_ring": "ringing", "force_ahead": "position_late", "position_late": "position_late", "position_filtered": "position_late"}
    allowed = {name for part, name in always.items() if part in case["family"]}.union(*accept, *(set(x if isinstance(x, list) else [x]) for x in truth.get("accept_any", [])))
    causes = a.get("causes", [])
    m["causes"] = len(causes)
    m["stated"] = sum(c.get("set_probability", 0.0) for c in causes)
    m["true"] = sum(1 for c in causes if names(c) & allowed)
    accept = [s | {name for part, name in always.items() if part in case["family"]} for s in accept if s]
    sizes = [h.get("size", case["size"]) for h in truth["hidden"] if h.get("accept") or h["mechanism"]]
    hidden = [s for s, size in zip(accept, sizes) if size >= 0.3 * case["size"]]  # of two that were hidden the lesser may be far below the size asked for
    m["hidden"] = len(hidden)
    m["found"] = sum(1 for s in hidden if any(names(c) & s for c in causes))
    m["exact"] = sum(1 for h in truth["hidden"] if any(c["mechanism"] == h["mechanism"] and not c["aliases"] for c in causes))
    m["abstained"] = int(not causes and a["verdict"] in ("unexplained", "not_testable", "data_fault"))
    m["missed"] = m["hidden"] - m["found"]
    m["missed_clean"] = m["missed"] if not causes and a["verdict"] == "clean" else 0
    if not hidden:
        m["clean"] = 1
        m["false"] = int(any(not (names(c) & allowed) for c in causes))
    if causes and not (a["gain"]["percent"] > 0 and a["gain"]["low"] > 0):
        m["bad_gain"] = 1
    for h in truth["hidden"]:
        for c in causes:
            if c["mechanism"] != h["mechanism"]:
                continue
            for name, value in h.get("parameters", {}).items():
                if name in c["parameters"] and isinstance(value, (int, float)):
                    p = c["parameters"][name]
                    m["parameters"] += 1
                    m["held"] += p["low"] is not None and p["high"] is not None and p["low"] <= value <= p["high"]
    return m


def describe(case):
    if "answer" not in case:
        return "refused: " + str(case.get("refused", case.get("error")))
    a = case["answer"]
    said = ", ".join(c["mechanism"] + ("{" + " ".join(c["aliases"]) + "}" if c["aliases"] else "") for c in a["causes"]) or a["verdict"]
    if a.get("unexplained"):
        said += f" [unexplained {a['unexplained']['variable']}]"
    return f"{said} gain {a['gain']['percent']:.1f} ({a['gain']['low']:.1f}) p {[round(c['p_value'], 4) for c in a['causes']]} {[f['text'] for f in a['data_faults']] or ''}"


def table(cases):
    rows = collections.defaultdict(collections.Counter)
    for c in cases:
        m = marks(c)
        rows[(c["kind"], c["family"])] += m
        rows[("~", "all " + c["kind"])] += m
        rows[("~~", "all")] += m
    print(f"{'family':44} cases  found/hidden  true/causes  false/clean  abstain refused badgain held/params  s")
    for (_, family), m in sorted(rows.items()):
        print(f"{family:44} {m['cases']:5}  {m['found']:5}/{m['hidden']:<5}  {m['true']:5}/{m['causes']:<5}  {m['false']:5}/{m['clean']:<5}  {m['abstained']:5}  {m['refused']:5}"
              f"  {m['bad_gain']:5}  {m['held']:5}/{m['parameters']:<5} {m['seconds'] / m['cases']:.1f}")


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("cavum"); a.add_argument("generator"); a.add_argument("--draws", type=int, default=1); a.add_argument("--first", type=int, default=1)
    a.add_argument("--size", type=float, default=1.0); a.add_argument("--only", default=""); a.add_argument("--jobs", type=int, default=2)
    a.add_argument("--log"); a.add_argument("--kinds", default=""); a.add_argument("--quiet", action="store_true")
    a.add_argument("--must", action="store_true", help="end with 1 when anything is missed, false or without gain")
    a = a.parse_args()
    listed = [l.split("\t") for l in subprocess.run(["/usr/bin/python3", a.generator, "--list"], capture_output=True, text=True, check=True).stdout.splitlines() if l]
    kinds = set(a.kinds.split(",")) if a.kinds else None
    tasks = [(a.cavum, a.generator, f[0], f[1], seed, a.size) for seed in range(a.first, a.first + a.draws) for f in listed
             if (not a.only or (f[0] in a.only.split(",")) or (a.only.endswith("*") and f[0].startswith(a.only[:-1]))) and (kinds is None or f[1] in kinds)]
    cases, log = [], open(a.log, "a") if a.log else None
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for case in pool.map(ask, tasks):
            cases.append(case)
            if log:
                log.write(json.dumps(case) + "\n"); log.flush()
            m = marks(case)
            if not a.quiet:
                wrong = m["missed"] or m["false"] or m["causes"] > m["true"] or m["refused"] or m["bad_gain"]
                print(("!! " if wrong else "   ") + f"{case['family']} seed {case['seed']}: {describe(case)}", flush=True)
    table(cases)
    wrong = [c for c in cases if (m := marks(c))["missed_clean"] or m["false"] or m["causes"] > m["true"] or m["refused"] or m["bad_gain"]]
    for c in wrong:
        print(f"wrong: {c['family']} seed {c['seed']}: {describe(c)}")
    sys.exit(1 if a.must and (wrong or not cases) else 0)


if __name__ == "__main__":
    main()
