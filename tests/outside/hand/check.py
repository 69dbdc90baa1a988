"""The generator against closed forms. Each line prints what was found and what it should be; the count of failures is the answer."""
import filecmp, os, tempfile
from types import SimpleNamespace as NS
import numpy as np
from families import FAMILIES
from laws import PAR, VARIABLE, force
from motion import DT, SHAPE, band, bouc_wen, lag, motion, play
from recording import alpha_beta, build, noise, speed, write

BAD = []
def close(what, got, want, tol=0.01):
    ok = abs(got - want) <= tol * max(abs(want), 1e-9) if want else abs(got) <= tol
    BAD.append(what) if not ok else None
    print(f"{'ok  ' if ok else 'FAIL'} {what}: {got:.6g}, should be {want:.6g}")

def rig(X, k=2.0, c=0.05, **more):
    X = np.asarray(X, float)
    V = np.gradient(X, DT)
    s = NS(id=1, t=np.arange(len(X)) * DT, X=X, V=V, A=np.gradient(V, DT), k=k, c=c, phase=0.0, t0_c=20.0)
    s.__dict__.update({n: np.full(len(X), v) for n, v in more.items()})
    return s
def added(s, law, at=-1, **p):
    return (force(s, [(law, p, None)]) - force(s, []))[at]

def laws():
    t = np.arange(0, 2, DT)
    ramp, at1, air = rig(0.5 * t), int(1 / DT), rig(-50 + 4 * np.sin(2 * np.pi * 3 * t))
    close("plain law, k X + c V", force(ramp, [])[at1], 2 * 0.5 + 0.05 * 0.5, 1e-6)
    close("no pull when leaving fast", force(rig(0.5 - 30 * t), [])[100:].max(), 0, 1e-9)
    close("nothing in air", np.abs(force(air, [])).max(), 0, 1e-9)
    close("coulomb in air", np.abs(added(air, "coulomb_friction", slice(None), fc_n=0.1, v0_mm_s=0.01)).max(), 0.1)
    close("stick over 15 um: after 15 um, 1 - 1/e", (bouc_wen(np.linspace(0, 0.015, 60), 0.015) / 0.015)[-1], 1 - np.exp(-1))
    sb = dict(fc_n=0.1, fs_n=0.3, vs_mm_s=1.0, v0_mm_s=1e-4)
    close("stribeck at vs: Fc + (Fs - Fc)/e", added(rig(-90 + 1.0 * t), "stribeck_friction", **sb), 0.1 + 0.2 / np.e)
    close("stribeck fast: Fc", added(rig(-90 + 30.0 * t), "stribeck_friction", **sb), 0.1)
    close("viscous", added(rig(-90 + 8.0 * t), "viscous_friction", b_n_s_per_mm=0.02), 0.16)
    close("inertia of a sine, m A w^2", np.abs(added(air, "inertia", slice(99, -99), mass_kg=0.2)).max(), 0.2 * 4e-3 * (2 * np.pi * 3) ** 2)
    close("weight from 0 to 30 deg", added(rig(-1 + 0 * t, posture_deg=30.0), "gravity_posture", weight_n=2.0, theta0_deg=0.0), 1.0)
    close("cross talk", added(rig(-1 + 0 * t, fy_n=3.0, fz_n=-1.0), "cross_talk", a=0.1, b=0.2), 0.1)
    close("delay on a ramp, -k v tau", added(ramp, "delay", tau_s=0.01), -2 * 0.5 * 0.01)
    close("delay below 0: force ahead", added(ramp, "delay", at1, tau_s=-0.01), 2 * 0.5 * 0.01)
    close("low pass on a ramp, -k v tau", added(ramp, "low_pass", tau_s=0.02), -2 * 0.5 * 0.02)
    y = lag(np.ones(5001), 0.05); y0 = lag(np.r_[0, np.ones(5000)], 0.05)
    close("lag of a step after tau", y0[int(0.05 / DT)], 1 - np.exp(-1), 0.005)
    close("saturation", force(ramp, [("saturation", dict(f_max_n=0.7), None)]).max(), 0.7)
    tri = np.r_[np.linspace(0, 1, 2000), np.linspace(1, 0.2, 2000)]
    close("play: tip half a play behind", tri[1500] - play(tri, 0.1)[1500], 0.05)
    close("play: going back, half a play ahead", play(tri, 0.1)[3500] - tri[3500], 0.05)
    close("play adds k (play - X)", added(rig(0.5 * t), "backlash", b_mm=0.04), -2 * 0.02)
    close("Bouc-Wen saturates at alpha d", added(ramp, "hysteresis", alpha_n_per_mm=1.5, d_mm=0.05), 1.5 * 0.05)
    loop = 0.5 + 0.4 * np.sin(2 * np.pi * np.arange(0, 3, DT)); z = bouc_wen(loop, 0.02)
    close("loop area, 4 A d - 4 d^2", np.sum(z[1:][10000:] * np.diff(loop)[10000:]), 4 * 0.4 * 0.02 - 4 * 0.02**2, 0.002)
    close("softening: F solves F = k X (1 - F/Fs)", (F := 2.0 / (1 + 2.0 / 9)) - 2.0 * (1 - F / 9), 0, 1e-9)
    hold = rig(np.minimum(10 * t, 1.0), c=0.0)
    close("softening at 1 mm", added(hold, "series_compliance", softening_force_n=9.0), F - 2.0)
    close("series spring, held: k ks/(k + ks)", force(rig(np.minimum(10 * t, 1.0), c=0.4), [("series_compliance", dict(ks_n_per_mm=6.0), None)])[-1], 2 * 6 / 8)
    st = rig(5.0 * t, c=0.4); G = force(st, [("series_compliance", dict(ks_n_per_mm=6.0), None)]); i = at1 // 4  # by hand: explicit Euler of F (1 + k/ks) + c/ks F' = k X + c V
    f = 0.0
    for x in st.X[1:i + 1]:
        f += DT * 6 / 0.4 * (2 * x + 0.4 * 5 - f * (1 + 2 / 6))
    close("series spring, a ramp, by Euler", G[i], f, 0.005)
    close("power of depth", added(rig(np.minimum(10 * t, 0.5)), "nonlinear_stiffness", m=2.0), 2 * (0.25 - 0.5))
    close("layer", added(hold, "hidden_layer", dk_n_per_mm=0.6, d0_mm=0.4), 0.36)
    close("graded", added(hold, "graded_stiffness", alpha_per_mm=0.1), -0.2)
    close("relaxation: ramp, k1 tau v (1 - e^-t/tau)", added(rig(0.5 * t), "relaxation", at1, k1_n_per_mm=0.8, tau1_s=0.4), 0.8 * 0.4 * 0.5 * (1 - np.exp(-2.5)))
    close("relaxation: decay while held", added(hold, "relaxation", at1, k1_n_per_mm=0.8, tau1_s=0.4) / added(hold, "relaxation", at1 // 2, k1_n_per_mm=0.8, tau1_s=0.4), np.exp(-0.5 / 0.4))
    close("power of speed", added(rig(4.0 * t), "feed_power_law", n=0.5), 0.05 * (2 - 4))
    spun = rig(0.5 * t, rpm=3000.0)
    r = added(spun, "run_out", slice(at1, 2 * at1), amplitude_n=0.1, phase_turns=0.0)
    close("run out: 50 turns a second", np.argmax(np.abs(np.fft.rfft(r))), 50, 0)
    close("edge, spinning and not", added(spun, "edge_force", edge_n=0.2) - added(rig(0.5 * t, rpm=0.0), "edge_force", edge_n=0.2), 0.2)
    ch = added(ramp, "chatter", slice(at1, 2 * at1), amplitude_n=0.1, frequency_hz=37.0, phase_turns=0.25)
    close("chatter: first row A cos 0", ch[0], 0.1 * np.sin(2 * np.pi * (37.0 + 0.25)), 1e-3)
    close("anisotropy: nothing at 45 deg from phi0", added(rig(0.5 * t, approach_deg=70.0), "anisotropy", epsilon=0.3, phi0_deg=25.0), 0, 1e-9)
    F2 = 2 * 0.5 * t[-1] + 0.05 * 0.5
    for m, col, v, p, want in (("wear", "removed_mm3", 5.0, dict(per_mm3=0.02), 0.1), ("coolant", "wet", 1.0, dict(fraction=-0.1), -0.1), ("thermal_softening", "temperature_c", 30.0, dict(per_k=0.01), -0.1)):
        close(f"{m}: F_sim times", added(rig(0.5 * t, **{col: v}), m, **p) / F2, want)
    close("gain", added(ramp, "gain_error", gain=0.03) / F2, 0.03)
    close("offset of contact, k delta", added(ramp, "contact_offset", delta_1_mm=0.03), 0.06)
    close("bias", added(air, "bias", bias_n=-0.02), -0.02); close("drift", added(air, "drift", rate_n_per_s=0.01), 0.02)
    close("warming up, A (1 - 1/e) after tau", added(air, "drift", at1, amplitude_n=0.2, tau_s=1.0), 0.2 * (1 - np.exp(-1)))

def motions():
    q = np.linspace(0, 1, 20001)
    for n, want in (("hand", 1.875), ("joint", 2.0), ("scurve", 1 / 0.85)):
        v = np.gradient(SHAPE[n](q), q)
        close(f"peak speed of shape {n}", v.max(), want, 1e-3); close(f"end of shape {n}", SHAPE[n](q)[-1], 1, 1e-9)
    y = band(np.random.default_rng(1), 50000, DT, 8, 12); f = np.fft.rfftfreq(50000, DT); P = np.abs(np.fft.rfft(y * np.hanning(50000))) ** 2
    close("tremor: power between 8 and 12 Hz", P[(f > 7.5) & (f < 12.5)].sum() / P.sum(), 1, 0.01)
    x = motion(np.random.default_rng(2), 60000, NS(depth=1.5, vtop=15.0, reach=0.6, tremor=0.01, drift=0.03), ["pecks", "wander", "robot"], True)
    v = np.gradient(x, DT)
    close("no step of speed (greatest change in 0.2 ms, mm/s)", np.abs(np.diff(v)).max(), 0, 0.6)

def instruments():
    h, t = 0.004, np.arange(0, 4, 0.004)
    mid, quad = slice(100, -100), 3 * t + 0.7 * t**2
    for n in ("savgol", "gauss"):
        close(f"{n}: slope of a parabola", np.abs(speed(quad, t, h, n) - 3 - 1.4 * t)[mid].max(), 0, 1e-6)
    close("one pole lags 15 ms, the difference half a row", (3 + 1.4 * t - speed(quad, t, h, "onepole"))[mid].mean() / 1.4, 0.015 + h / 2, 0.02)
    close("mean of 8 differences lags 4 rows", (3 + 1.4 * t - speed(quad, t, h, "backward"))[mid].mean() / 1.4, 4 * h, 0.01)
    close("alpha-beta: no error on a ramp", alpha_beta(3 * t, 0.25, 0.04)[-1] / h, 3, 1e-3)
    s = NS(ts=np.arange(40000) / 100.0); g = np.random.default_rng(3)
    P = lambda y: np.abs(np.fft.rfft(y)) ** 2
    f = np.fft.rfftfreq(40000, 0.01)
    close("60 Hz at 100 Hz rows stands at 40 Hz", f[np.argmax(P(noise(g, s, "hum60", 100)))], 40, 0.01)
    p = P(noise(g, s, "pink", 100)); a, b = p[(f > 0.2) & (f < 0.8)].mean(), p[(f > 5) & (f < 20)].mean()
    close("pink: 14 dB from 0.5 to 12 Hz (f^-1, band means)", a / b, (np.log(4) / 0.6) / (np.log(4) / 15), 0.15)
    for n in ("white", "ar1", "pink", "walk", "two", "hum50", "adc", "bursts", "heavy"):
        close(f"noise {n} has unit sd", noise(g, s, n, 250).std(), 1, 0.12)

def sizes():
    """The size again, from the columns of the recording alone; files; units read back."""
    for name in ("effect.coulomb_friction", "effect.graded_stiffness", "effect.viscous_friction", "effect.hidden_layer"):
        for want in (0.5, 3.0):
            recs, _, truth, _ = build(FAMILIES[name], 4, want)
            own, x, v = (np.concatenate([r[n] for r in recs]) for n in ("session", "x_mm", "v_mm_s"))
            p, k = truth["hidden"][0]["parameters"], truth["k_n_per_mm"][0]
            on = (x > 0) & (k * x + truth["c_n_s_per_mm"][0] * v > 0)
            E = {"coulomb_friction": lambda: p["fc_n"] * np.tanh(v / p["v0_mm_s"]), "graded_stiffness": lambda: on * -k * p["alpha_per_mm"] * x**2,
                 "viscous_friction": lambda: p["b_n_s_per_mm"] * v, "hidden_layer": lambda: on * p["dk_n_per_mm"] * np.maximum(x - p["d0_mm"], 0)}[name.split(".")[1]]()
            B = np.stack([on * x, on * v] + [(own == i) * 1.0 for i in np.unique(own)], 1)
            close(f"size of {name}, from the columns", np.std(E - B @ np.linalg.lstsq(B, E, rcond=None)[0]) / truth["noise_sd_n"], want, 0.03)
    with tempfile.TemporaryDirectory() as d:
        for n, col, back in (("um_ms", 2, lambda y: y / 1000), ("gf", 3, lambda y: y * 9.80665e-3), ("lbf", 3, lambda y: y * 4.4482216), ("inch", 2, lambda y: y * 25.4),
                             ("machine_position", 2, lambda y: y - 37.4), ("machine_downwards", 2, lambda y: 37.4 - y), ("decimal_comma", 3, lambda y: y)):
            r, toml, truth, o = build(FAMILIES["unit." + n], 3, 1.0); write(r, toml, truth, o, d, np.random.default_rng(3))
            text = open(f"{d}/recording.csv").read().replace(",", ".").replace(";", ",") if n == "decimal_comma" else open(f"{d}/recording.csv").read()
            y = np.genfromtxt(text.splitlines()[1:], delimiter=",")[:, col]
            close(f"unit {n} read back, greatest difference", np.abs(back(y) - np.concatenate([q["f_n" if col == 3 else "x_mm"] for q in r])).max(), 0, 1e-4)
    for m in PAR:
        BAD.append(m) if m not in VARIABLE and m not in ("backlash", "hysteresis", "hidden_layer", "nonlinear_stiffness", "graded_stiffness", "series_compliance", "gain_error", "spring_arm") else None
    with tempfile.TemporaryDirectory() as d:
        for i in (1, 2):
            f = FAMILIES["effect.delay.v_causal"]; r, toml, truth, o = build(f, 7, 1.0); write(r, toml, truth, o, f"{d}/{i}", np.random.default_rng(7))
        same = all(filecmp.cmp(f"{d}/1/{n}", f"{d}/2/{n}", False) for n in ("recording.csv", "rig.toml", "truth.json"))
        close("twice the same bytes", float(same), 1)
        rows = np.genfromtxt(f"{d}/1/recording.csv", delimiter=",", skip_header=1)
        close("rows: 10,000 to 24,000", float(10000 <= len(rows) <= 24000), 1)
        keep = rows[:, 2] > 0.05  # the whole file, by its own columns: what k and c leave with the delay is more than the noise alone
        B = np.c_[rows[keep, 2], rows[keep, 4]]
        rest = rows[keep, 3] - B @ np.linalg.lstsq(B, rows[keep, 3], rcond=None)[0]
        close("residual over noise is above 1 (delay in the file)", float(rest.std() > truth["noise_sd_n"]), 1)

def run():
    laws(); motions(); instruments(); sizes()
    print(f"{len(BAD)} failures {BAD if BAD else ''}")
    return 1 if BAD else 0
