#!/usr/bin/python3
"""Closed forms of the laws, sizes as asked, the same bytes for the same seed, the list.  check.py [--all] (one draw
of every family)"""
import os, subprocess, sys, tempfile
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy as np
import bench, channel, laws
from families import FAMILIES

DT, K, C, FAILED = 1e-4, 2.0, 0.05, []


def near(what, got, want, share=0.01):
    """One line; fails when got is further from want than the share of it."""
    bad = not abs(got - want) <= share * abs(want) + 1e-12
    FAILED.extend([what] if bad else [])
    print(f"{'FAIL' if bad else 'ok  '} {what}: {got:.6g}, expected {want:.6g}")


def run_of(x, t):
    return laws.Run(t, x, K, C)


def sine(mean, half, hz, cycles):
    t = np.arange(0, cycles / hz, DT)
    return run_of(mean + half * np.sin(2 * np.pi * hz * t), t)


def energy(run, h, hz):
    """Work in N mm of h over the last cycle, from a sine of hz."""
    n = int(round(1 / hz / run.dt))
    return float(np.sum(h[-n:] * run.v[-n:]) * run.dt)


def phasor(h, run, hz):
    """Complex amplitude of the last cycle but one against sin."""
    n = int(round(1 / hz / run.dt))
    u = h[-2 * n:-n]
    return 2j * np.mean((u - u.mean()) * np.exp(-2j * np.pi * hz * run.t[-2 * n:-n]))


def closed_forms():
    t = np.arange(0, 3, DT)
    ramp = run_of(np.where(t < 1, 2 * t, 2.0), t)
    h = laws.relaxation(ramp, 0.5, 0.4)
    near("relaxation, end of a ramp", h[10000], 0.5 * 2 * 0.4 * (1 - np.exp(-1 / 0.4)))
    near("relaxation, one tau later", h[14000] / h[10000], np.exp(-1))
    s = sine(1.0, 0.4, 2.0, 6)
    a, w = 0.4, 2 * np.pi * 2.0
    near("coulomb, energy of a cycle 4 Fc A", energy(s, laws.coulomb_friction(s, 0.3, 1e-3), 2.0), 4 * 0.3 * a)
    near("stribeck, far above vs: 4 Fc A", energy(s, laws.stribeck_friction(s, 0.3, 0.9, 1e-3, 1e-4), 2.0),
         4 * 0.3 * a)
    near("viscous, energy pi b w A^2", energy(s, laws.viscous_friction(s, 0.02), 2.0), np.pi * 0.02 * w * a * a)
    near("backlash, energy -4 k b (A - b): the law as written gives energy back",
         energy(s, laws.backlash(s, 0.05), 2.0), -4 * K * 0.05 * (a - 0.05))
    near("hysteresis, long way: alpha d", laws.hysteresis(ramp, 0.3, 0.2)[-1], 0.3 * 0.2)
    near("hysteresis, x = d: alpha d (1 - 1/e)", laws.hysteresis(ramp, 0.3, 0.2)[1000], 0.3 * 0.2 * (1 - np.exp(-1)))
    near("inertia, m A w^2", np.abs(phasor(laws.inertia(s, 0.5), s, 2.0)), 0.5 * a * w * w / 1000)
    clean = phasor(s.fsim, s, 2.0)
    near("F_sim, |k + i w c| A", np.abs(clean), a * np.hypot(K, w * C))
    late = phasor(s.fsim + laws.delay(s, 0.02), s, 2.0) / clean
    near("delay, phase -w tau", np.angle(late), -w * 0.02)
    near("position late, phase +w tau", np.angle(phasor(s.fsim + laws.position_late(s, 0.02), s, 2.0) / clean),
         w * 0.02)
    slow = phasor(s.fsim + laws.low_pass(s, 0.03), s, 2.0) / clean
    near("low pass, gain", np.abs(slow), 1 / np.hypot(1, w * 0.03))
    near("low pass, phase", np.angle(slow), -np.arctan(w * 0.03))
    near("resonance, gain at f is 1/(2 z)", np.abs(phasor(laws.resonate(s.x, 2.0, 0.2, DT), s, 2.0)) / a, 2.5, 0.02)
    step = laws.resonate(np.where(t > 0.1, 1.0, 0.0), 20.0, 0.05, DT)
    near("resonance, overshoot of a step", step.max() - 1, np.exp(-np.pi * 0.05 / np.sqrt(1 - 0.05 ** 2)), 0.02)
    near("compliance, at rest k X / (1 + k/ks)", (ramp.fsim + laws.series_compliance(ramp, ks_n_per_mm=8.0))[-1],
         K * 2 / (1 + K / 8))
    near("compliance, softening", laws.series_compliance(ramp, softening_force_n=5.0)[-1], 4 / (1 + 4 / 5) - 4)
    near("power of depth", laws.nonlinear_stiffness(ramp, 1.5)[-1], K * (2 ** 1.5 - 2))
    near("layer", laws.hidden_layer(ramp, 0.7, 0.5)[-1], 0.7 * 1.5)
    near("power of speed", laws.feed_power_law(ramp, 0.5)[5000], C * (2 ** 0.5 - 2))
    p = run_of(0.5 * (1 - np.cos(2 * np.pi * t)) + 1e-9, t)
    near("Hunt-Crossley, lambda pi D^3 w/8 a cycle", float(np.sum(0.3 * p.x * p.v ** 2)) * DT / 3,
         0.3 * np.pi * 2 * np.pi / 8)
    near("Hunt-Crossley, as made", laws.hunt_crossley(p, 0.03)[2500], 0.03 * 0.5 * np.pi)
    p.columns["spindle_rpm"] = np.full(len(t), 600.0)
    near("run-out, energy in 10 Hz", np.abs(phasor(laws.run_out(p, 0.2, 0.0), p, 10.0)), 0.2)
    u = channel.integrate(t, np.sin(2 * np.pi * 5 * t), t[1000:-1000], 0.05)
    near("converter, gain sin(x)/x", u.max(), np.sin(np.pi * 5 * 0.05) / (np.pi * 5 * 0.05))
    rng = np.random.default_rng(1)
    u = channel.ar(rng, 200000, 0.8)
    near("AR(1), lag one", float(np.corrcoef(u[1:], u[:-1])[0, 1]), 0.8, 0.02)
    power = np.abs(np.fft.rfft(channel.pink(rng, 1 << 16))) ** 2
    near("pink, power 1/f over a decade", power[100:200].mean() / power[1000:2000].mean(), 10, 0.35)


def size_of(made):
    """From the recording's own force: what the law added, less k and c, over what was random. For one law alone, in
    all sessions."""
    x, v, h, m, random = [], [], [], [], []
    for rec, run in zip(made["table"], made["runs"]):
        i = np.minimum(np.rint(rec["t"] / run.dt).astype(int), len(run.t) - 1)
        x.append(run.x[i]); v.append(run.v[i]); m.append(run.contact[i])
        bias = made["truth"]["bias_by_session_n"]
        h.append(rec["f"] - rec["noise"] - rec["base"] - (bias[run.number - 1] if bias else 0))
        random.append(rec["noise"] + run.k * rec["x_error"])
    x, v, h, m, random = map(np.concatenate, (x, v, h, m, random))
    if made["family"]["rows"] == "air":
        return float(np.sqrt(np.mean(h[~m] ** 2)) / random.std())
    basis = np.stack([x[m], v[m]], 1)
    left = h[m] - basis @ np.linalg.solve(basis.T @ basis, basis.T @ h[m])
    return float(np.sqrt(np.mean(left ** 2)) / random.std())


def sizes():
    for family in ("effect.coulomb_slow", "effect.relaxation_slow", "effect.delay_5ms", "effect.backlash_large",
                   "effect.saturation_often",
                   "effect.hysteresis_short",
                   "effect.coolant", "effect.stiffening", "interference.mains_50", "air.inertia_shake"):
        for size in (1.0, 0.35):
            made = bench.make(family, 5, size)
            near(f"size of {family}", size_of(made), size, 0.06)


def same_bytes():
    with tempfile.TemporaryDirectory() as folder:
        read, files = [], ("recording.csv", "rig.toml", "truth.json")
        for seed, place in ((3, "a"), (3, "b"), (4, "c")):
            me = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bench.py")
            subprocess.run([sys.executable, me, "--family", "pair.relaxation_friction", "--seed", str(seed), "--out",
                            f"{folder}/{place}"], check=True)
            read.append([open(f"{folder}/{place}/{n}", "rb").read() for n in files])
        near("same seed, same bytes", float(read[0] == read[1]), 1.0)
        near("another seed, other bytes", float(read[0][0] != read[2][0]), 1.0)
        want = [[n, f["kind"]] for n, f in FAMILIES.items()]
        lines = subprocess.run([sys.executable, me, "--list"], capture_output=True, text=True,
                               check=True).stdout.splitlines()
        near("--list names every family with its kind", float([l.split("\t") for l in lines] == want), 1.0)


def every_family():
    """One small draw of each: finite numbers, sizes as asked, rows within bounds."""
    for family in FAMILIES:
        made = bench.make(family, 2, 1.0)
        rows = sum(len(r["t"]) for r in made["table"])
        finite = all(np.isfinite(r[n]).all() for r in made["table"] for n in ("x", "f")) and 10000 < rows < 65000
        held = all(abs(h["size"] - 1) < 0.02 for h in made["truth"]["hidden"])
        if not (finite and held):
            FAILED.append(family)
            print(f"FAIL {family}: rows {rows}, sizes {[h['size'] for h in made['truth']['hidden']]}")
    print(f"ok   {len(FAMILIES)} families drawn" if not FAILED else "")


if __name__ == "__main__":
    closed_forms()
    sizes()
    same_bytes()
    if "--all" in sys.argv:
        every_family()
    print(f"{len(FAILED)} failed" if FAILED else "all checks passed")
    sys.exit(1 if FAILED else 0)
