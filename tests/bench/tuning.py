#!/usr/bin/env python3
"""tuning.py CAVUM SCENARIO [NAME...]: what each constant of engine/physics/contact/tuning.h changes when it is halved or doubled. CAVUM is built with
-DCAVUM_TUNABLE=ON; the expert and the novice sit SCENARIO (tests/replay/block_cavity.toml), once with each value. Prints a row a constant: "-" where every
force and figure is the same bits, else by how many percent time, mean and peak force and way differ, and the loss of Dice, the larger of both hands."""
import json, os, re, subprocess, sys, tempfile
from pathlib import Path

HEADER = Path(__file__).resolve().parents[2] / "engine/physics/contact/tuning.h"
CONSTANT = re.compile(r"^CAVUM_TUNING\((k_\w+), ([-+.e\d]+)\);", re.M)


def sit(cavum, scenario, given):
    """Figures of both hands; None for one whose exam did not end."""
    figures = []
    with tempfile.TemporaryDirectory() as folder:
        for hand in ("expert", "novice"):
            session = f"{folder}/{hand}.cavum"
            env = {**os.environ, **given, "CAVUM_HOME": folder}
            try:
                ran = subprocess.run([cavum, "exam", scenario, "--candidate", "tuning", "--operator", hand, "--seed", "1", "--out", session], env=env,
                                     capture_output=True, timeout=120)
                out = subprocess.run([cavum, "grade", "--json", session], env=env, capture_output=True, check=ran.returncode < 2, timeout=120).stdout
                r = json.loads(out)
                figures.append((r["time_s"], r["force"]["mean_n"], r["force"]["peak_n"], r["path_mm"], r["volumes"]["dice"], out))
            except (subprocess.SubprocessError, json.JSONDecodeError):
                figures.append(None)
    return figures


def changes(was, now):
    if was == now:
        return "-"
    if None in now:
        return "an exam did not end"
    worst = [max((100 * (b[i] / a[i] - 1) for a, b in zip(was, now)), key=abs) for i in range(4)]
    dice = max((a[4] - b[4] for a, b in zip(was, now)), key=abs)
    return " ".join(f"{name} {x:+.1f} %" for name, x in zip(("time", "mean", "peak", "way"), worst)) + f" Dice {-dice:+.3f}"


def main():
    cavum, scenario, *names = sys.argv[1:]
    plain = sit(cavum, scenario, {})
    for name, value in CONSTANT.findall(HEADER.read_text()):
        if names and name not in names:
            continue
        factors = [(f, max(1, round(float(value) * f)) if "." not in value and "e" not in value else float(value) * f) for f in (0.5, 2)]
        print(f"{name} = {value}:", "; ".join(f"x{f}: {changes(plain, sit(cavum, scenario, {name: repr(v)}))}" for f, v in factors), flush=True)


if __name__ == "__main__":
    main()
