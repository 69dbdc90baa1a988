"""From a row of the table to a recording: truth on a fine grid, the size of the effect, then the instruments."""
import json, os, zlib
from types import SimpleNamespace as NS
import numpy as np
from laws import ALIAS, COLUMN, PAR, VARIABLE, force
from motion import DT, band, lag, motion, pi

BASE = dict(v="exact", xn=0.001, xw=0, xq=0.001, fq=0.001, noise="white", hand=1, vtop=15.0, reach=0.6, depth=1.5, tremor=0.012, drift=0.03, k=0, c=0, fs=0, n=0,
            rows=0, kvar=0, cvar=0, late_sd=0, late=0, jitter=0, drop=0, repeat=0, tracker=0, xlag=0, zero=0, known=1, limit=0, gate=0, cols=(), unit=None, fault=None,
            kinds=("air", "pecks", "hold", "wander", "robot", "hesitate", "sweep"), rpm=0, rpm_error=0, free_phase=0, cap=0, teeth=0)

# ---------------------------------------------------------------- instruments
def ringing(rng, s, drive):
    """A light mode f0 of 10 to 40 Hz, y'' + 2 z w y' + w^2 y = u: of the jerk of the motion or of what contact sets free."""
    f0, z = rng.uniform(10, 40), rng.uniform(0.01, 0.04)
    u = np.gradient(s.A, DT) if drive == "jerk" else np.gradient(force(s, []), DT)
    f, m = np.fft.rfftfreq(2 * len(u), DT), 2 * len(u)
    h = 1j * f / f0 / (1 - (f / f0) ** 2 + 2j * z * f / f0)  # the velocity of the mode: no static part
    y = np.fft.irfft(np.fft.rfft(u, m) * h, m)[:len(u)]
    return np.interp(s.ts, s.t, y / (y.std() + 1e-12))

def noise(rng, s, name, fs):
    """Noise of unit sd on the rows of session s, by name."""
    n, w, mix = len(s.ts), rng.normal(size=len(s.ts)), lambda a, b, q: a * np.sqrt(1 - q) + b * np.sqrt(q)
    unit = lambda y: (y - y.mean()) / y.std()
    ar = lambda tau: unit(lag(rng.normal(size=n), tau, 1 / fs))
    hum = lambda f: np.sqrt(2) * np.sin(2 * pi * f * s.ts + rng.uniform(0, 6.28)) * (1 + 0.1 * band(rng, n, 1 / fs, 0.05, 0.5))
    return {"white": lambda: w, "ar1": lambda: ar(0.02), "pink": lambda: band(rng, n, 1 / fs, 0.05, fs / 2, 1), "walk": lambda: unit(np.cumsum(w)),
            "two": lambda: mix(w, ar(0.5), 0.6), "hum50": lambda: mix(w, unit(hum(50.0) + 0.3 * hum(150.0)), 0.7), "hum60": lambda: mix(w, unit(hum(60.0)), 0.7),
            "ring_jerk": lambda: mix(w, ringing(rng, s, "jerk"), 0.7), "ring_touch": lambda: mix(w, ringing(rng, s, "touch"), 0.7),
            "adc": lambda: mix(w, band(rng, n, 1 / fs, 0.21 * fs, 0.22 * fs), 0.7),  # a narrow resonance of the converter's supply
            "bursts": lambda: unit(w * (1 + 6 * (band(rng, n, 1 / fs, 0.1, 3) > 2))), "heavy": lambda: rng.standard_t(3, n) / np.sqrt(3)}[name]()

def fit_window(x, half, weight):
    """Least squares of a parabola under a symmetric weight: the slope in the middle, per row."""
    j = np.arange(-half, half + 1)
    P = np.linalg.pinv(np.c_[j**0, j, j**2] * np.sqrt(weight(j))[:, None]) * np.sqrt(weight(j))
    return np.convolve(np.pad(x, half, mode="reflect", reflect_type="odd"), P[1][::-1], "valid")

def alpha_beta(x, a, b):
    """x^ = x~ + a r, v^ = v~ + b r (steps of one row)."""
    p, v, out = x[0], 0.0, np.empty(len(x))
    for i, m in enumerate(x.tolist()):
        p += v
        r = m - p
        p, v = p + a * r, v + b * r
        out[i] = v
    return out

def speed(x, v, h, how):
    """The v column: exact or from the recorded x. The clock is taken as even (h s a row), as a driver does."""
    back = np.diff(x, prepend=x[0]) / h
    w = max(4, int(0.02 / h))
    return {"exact": lambda: v, "quantised": lambda: np.round(v / 0.4) * 0.4, "savgol": lambda: fit_window(x, w, lambda j: j * 0 + 1.0) / h,
            "gauss": lambda: fit_window(x, 3 * w // 2, lambda j: np.exp(-0.5 * (2 * j / w) ** 2)) / h, "onepole": lambda: lag(back, 0.015, h),
            "backward": lambda: np.convolve(np.pad(back, (7, 0), "edge"), np.ones(8) / 8, "valid"), "alphabeta": lambda: alpha_beta(x, 0.25, 0.04) / h,
            "scaled": lambda: v * 1.12}[how]()

# ---------------------------------------------------------------- truth
def make_sessions(rng, o, hidden_names):
    d = NS(depth=min(o.depth, 7 / o.k), vtop=o.vtop, reach=o.reach, tremor=o.tremor * min(1, o.vtop / 8), drift=o.drift)
    out, heat, cut = [], 22.0, 0.0
    names = {c for m in hidden_names for c in COLUMN.get(m, ())} | set(o.cols)
    for i in range(1, o.n + 1):
        g = int((o.rows / o.n / o.fs + 0.3) / DT)
        kinds = [o.kinds[(i + j) % len(o.kinds)] for j in range(len(o.kinds))]
        if "air" in kinds and i % 3:  # most sessions begin in air
            kinds.remove("air"); kinds.insert(0, "air")
        s = NS(id=i, t=np.arange(g) * DT - 0.05, phase=rng.uniform() if o.free_phase else 0.0)
        s.X = motion(rng, g, d, kinds, o.hand and i % 4)
        s.V = np.gradient(s.X, DT); s.A = np.gradient(s.V, DT)
        s.k, s.c = o.k * (1 + o.kvar * rng.uniform(-1.7, 1.7)), o.c * (1 + o.cvar * rng.uniform(-1.7, 1.7))
        if o.teeth:  # two teeth, in turn
            s.k = o.teeth[i % 2]
        F = force(s, [])
        slow = lambda lo=0.02, hi=0.3: band(rng, g, DT, lo, hi, 1)
        s.rpm = np.where(band(rng, g, DT, 0.05, 0.4) > -0.2, o.rpm * (1 + 0.01 * slow()), 0) if o.rpm and "spindle_rpm" in names else np.zeros(g)
        s.wet = (band(rng, g, DT, 0.05, 0.4) > 0).astype(float)
        s.posture_deg, s.approach_deg = 20 + 15 * rng.normal() + 8 * slow(), ((i * 37) % 180) + 6 * slow()
        s.fy_n, s.fz_n = 0.25 * F + 0.5 * slow(0.1, 2), -0.15 * F + 0.4 * slow(0.1, 2)
        s.grip_n = np.maximum(0.5, 6 + 2 * slow(0.1, 1.5))  # the squeeze of the fingers
        s.removed_mm3 = (0 if i == o.n // 2 + 1 else cut) + np.cumsum(F * np.abs(s.V)) * DT * 0.02  # Archard; a new bur halfway
        cut = s.removed_mm3[-1]
        s.temperature_c = heat + lag(F * 4, 4.0, y0=0)  # T' = h F - (T - T0)/4 s
        if o.teeth:  # one session in a warm room, nothing else of it
            s.temperature_c = 22 + 9.0 * (i == o.n - 1) + 0.1 * slow()
        s.t0_c = out[0].temperature_c[0] if out else s.temperature_c[0]
        out.append(s)
    return out, [c for c in ("spindle_rpm", "wet", "posture_deg", "approach_deg", "fy_n", "fz_n", "removed_mm3", "temperature_c", "grip_n") if c in names]

def plain_columns(ss, o, name, own):
    """What k, c (of each session, if they differ) and a zero for each session can make."""
    touch, cols = [force(s, []) > 0 for s in ss], []
    for q in ("X", "V"):
        r = np.concatenate([np.interp(s.ts, s.t, t * getattr(s, q)) for s, t in zip(ss, touch)])
        cols += [r * (own == s.id) for s in ss] if o.kvar or o.cvar or o.teeth else [r]
    if name != "bias":
        cols += [(own == s.id) * 1.0 for s in ss]
    return np.stack(cols, 1)

STEP = {"delay", "low_pass", "contact_offset", "backlash", "series_compliance"}  # they move the step c V of the touch: a few rows would be the whole size

def size_of(m, p, only, ss, o, sd):
    E = np.concatenate([np.interp(s.ts, s.t, force(s, [(m, p, only)]) - force(s, [])) for s in ss])
    own, near = np.concatenate([np.full(len(s.ts), s.id) for s in ss]), np.zeros(len(E), bool)
    if m in STEP:  # so from 10 ms before a touch or a leaving to 25 ms after, rows do not count
        near = np.concatenate([np.interp(s.ts, s.t, np.convolve(np.abs(np.diff(force(s, []) > 0, prepend=False)), np.ones(int(0.035 / DT)))[50:50 + len(s.t)]) > 0 for s in ss])
    B = plain_columns(ss, o, m, own)[~near]
    q = np.linalg.lstsq(B / (norm := np.linalg.norm(B, axis=0) + 1e-12), E[~near], rcond=1e-8)[0] / norm
    r, own = E[~near] - B @ q, own[~near]
    return float(np.sqrt(np.mean(r[own == only] ** 2 if only else r**2)) / sd)

def scale(m, fix, only, ss, o, u, sd, want):
    """Secant on log g. Most laws are linear or nearly so."""
    def par(g):
        p = {**PAR[m](g, u)}
        for key, val in fix.items():  # a fixed value, a function of (g, u), or None: leave the parameter out
            p[key] = val(g, u) if callable(val) else val
        return {key: val for key, val in p.items() if val is not None and (not only or not key.startswith("delta_") or key == f"delta_{only}_mm")}
    g, lo, hi, best = 1.0, 0.0, np.inf, (np.inf, 1.0)
    for _ in range(14):
        got = size_of(m, par(g), only, ss, o, sd)
        best = min(best, (abs(got / want - 1), g))
        if best[0] < 0.01:
            break
        lo, hi = (g, hi) if got < want else (lo, g)
        new = g * float(np.clip(want / max(got, 1e-9), 0.2, 5))
        g = new if lo < new < hi else (lo + hi) / 2 if hi < np.inf else new
    g = best[1]  # a size out of reach: the nearest; truth.json tells what it is
    return par(g), size_of(m, par(g), only, ss, o, sd)

def build(fam, seed, size):
    rng = np.random.default_rng([zlib.crc32(fam.name.encode()), seed])
    o = NS(**{**BASE, **fam.opts})
    o.fs = o.fs or int(rng.choice([125, 200, 250, 400])); o.rows = o.rows or rng.uniform(13000, 22000)
    o.n = o.n or int(np.clip(o.rows / o.fs / 9, 6, 10)); o.rows = max(o.rows, 10500)
    o.k = o.k or float(np.exp(rng.uniform(np.log(0.4), np.log(4)))); o.c = o.c or float(np.clip(o.k * rng.uniform(0.01, 0.06), 0.005, 0.6))
    sd = rng.uniform(0.007, 0.025)
    ss, cols = make_sessions(rng, o, [h[0] for h in fam.hidden])
    for s in ss:  # rows of the converter: even, but a driver may drop some
        n = int(o.rows / o.n)
        keep = rng.uniform(size=n) >= o.drop if o.drop else np.ones(n, bool)
        s.ts = np.arange(n)[keep] / o.fs  # the motion began 0.05 s before
    u = NS(k=o.k, c=o.c, depth=min(o.depth, 7 / o.k), sign=float(rng.choice([-1, 1])), z=np.clip(rng.normal(size=12), -2, 2), n=o.n, top=o.vtop, fs=o.fs,
           peak=max(force(s, []).max() for s in ss))
    one = int(rng.integers(1, o.n + 1))
    hid, told = [], []
    for m, fix in fam.hidden:
        fix = dict(fix); only = one if fix.pop("only", 0) else None
        accept, named, exact = fix.pop("accept", None), fix.pop("named", m), fix.pop("fixed", None)
        if exact:
            p = exact(u); got = size_of(m, p, only, ss, o, sd)
        else:
            p, got = scale(m, fix, only, ss, o, u, sd, size)
        hid.append((m, p, only)); u.last = p
        clean = {k: (v.tolist() if isinstance(v, np.ndarray) else v) for k, v in p.items()}
        told.append(dict(mechanism=named, accept=accept if accept is not None else [m] + [a for a in ALIAS.get(m, []) if a != m], parameters=clean,
                         variable=VARIABLE.get(m, "x_mm"), size=round(got, 4), **({"session": only} if only else {})))
    recs = [record(rng, s, hid, o, sd, cols) for s in ss]
    truth = dict(family=fam.name, kind=fam.kind, seed=seed, size=told[0]["size"] if told else 0.0, size_asked=size, noise_sd_n=sd, k_n_per_mm=[s.k for s in ss], c_n_s_per_mm=[s.c for s in ss],
                 hidden=told, notes=fam.notes, position_noise_as_force_sd_n=float(o.k * np.sqrt(o.xn**2 + o.xw**2 + o.xq**2 / 12)), **fam.extra)
    if o.kinds == AIR:
        truth["k_n_per_mm"] = truth["c_n_s_per_mm"] = None
    return recs, rig(o, rng, u), truth, o
AIR = ("stroke",)

def record(rng, s, hid, o, sd, cols):
    """What the instruments write of session s: a dict of columns."""
    F, n, fs = force(s, hid), len(s.ts), o.fs
    late = o.late + o.late_sd * rng.normal()
    tp = s.ts - late  # the position is that of a moment before
    X = lag(s.X, o.xlag) if o.xlag else s.X
    V = lag(s.V, o.xlag) if o.xlag else s.V
    if o.tracker:  # a tracker with its own clock: the last pose that has come in
        tp = np.floor((tp - 0.001) * o.tracker + rng.uniform()) / o.tracker
    x = np.interp(tp, s.t, X) + o.xn * rng.normal(size=n) + (o.xw * band(rng, n, 1 / fs, 0.02, 0.4, 1) if o.xw else 0) + o.zero * rng.normal()
    x = np.round(x / o.xq) * o.xq if o.xq else x
    if o.repeat:  # a late packet: the pose of the row before stands again
        hold = rng.uniform(size=n) < o.repeat
        x = x[np.maximum.accumulate(np.where(hold, 0, np.arange(n)))]
    names = [o.noise] if isinstance(o.noise, str) else o.noise
    f = np.interp(s.ts, s.t, F) + sd * noise(rng, s, names[s.id % len(names)], fs)
    f = np.minimum(f, o.limit) if o.limit else f
    f = np.round(f / o.fq) * o.fq if o.fq else f
    t = s.ts
    v = None if o.v == "absent" else speed(x, np.interp(tp, s.t, V), 1 / fs, o.v)
    if o.jitter:  # USB: stamps come late by a random time, seldom by a lot, never backwards
        t = np.maximum.accumulate(t + o.jitter * rng.exponential(size=n)) + np.arange(n) * 1e-6
    r = dict(session=np.full(n, s.id), t_s=t, x_mm=x, f_n=f)
    if v is not None:
        r["v_mm_s"] = v
    for c in cols:
        r[c] = np.interp(s.ts, s.t, s.rpm * (1 + o.rpm_error) if c == "spindle_rpm" else getattr(s, c))
        r[c] = np.round(r[c]) if c in ("wet", "spindle_rpm") else np.round(r[c], 3)
    return r

def rig(o, rng, u):
    r = {} if not o.known else dict(k_n_per_mm=round(o.k * rng.uniform(0.9, 1.1), 3), c_n_s_per_mm=round(o.c * rng.uniform(0.85, 1.15), 4))
    return r | dict(position_quantum_mm=o.xq, force_quantum_n=o.fq, force_limit_n=round(o.limit or u.peak * 3 + 1, 1))

# ---------------------------------------------------------------- files
def spoil(recs, o, rng):
    """A recording that is not sound, or units of another house."""
    top = max(r["f_n"].max() for r in recs)
    for r in recs:
        n, i = len(r["t_s"]), int(r["session"][0])
        a = int(n * rng.uniform(0.3, 0.6)); b = a + int(n * 0.25)
        if o.fault == "mn": r["f_n"] = r["f_n"] * 1000
        if o.fault == "clip": r["f_n"] = np.minimum(r["f_n"], o.cap * top)
        if o.fault == "clock": r["t_s"] = r["t_s"] * 1.25
        if o.fault == "stuck_f" and i % 2: r["f_n"][a:b] = r["f_n"][a]
        if o.fault == "stuck_x" and i % 2: r["x_mm"][a:b] = r["x_mm"][a]
        if o.fault == "swap_xf": r["x_mm"], r["f_n"] = r["f_n"], r["x_mm"]
        if o.fault == "swap_xv": r["x_mm"], r["v_mm_s"] = r["v_mm_s"], r["x_mm"]
        if o.fault == "sign_x": r["x_mm"] = -r["x_mm"]
        if o.fault == "gap": r["t_s"][a:] += 1.7
        if o.fault == "backwards": r["t_s"][a:] -= 0.4
        if o.fault == "nan": r["f_n"][a:a + 40] = np.nan

def write(recs, toml, truth, o, folder, rng):
    u = o.unit or {}
    os.makedirs(folder, exist_ok=True)
    spoil(recs, o, rng)
    sep, dec, names = u.get("sep", ","), u.get("dec", "."), list(recs[0])
    head = {n: n for n in names} | {n: h for n, (h, _, _) in u.get("cols", {}).items()}
    gain = {n: (g, z) for n, (_, g, z) in u.get("cols", {}).items()}
    digits = {"session": 0, "t_s": 6, "x_mm": 5, "f_n": 5, "v_mm_s": 4}
    lines = [sep.join(head[n] for n in names)] + ([sep.join(u["row"].get(n, "-") for n in names)] if "row" in u else [])
    for r in recs:
        text = []
        for n in names:
            g, z = gain.get(n, (1, 0))
            y = r[n] * g + z
            if n == "t_s" and u.get("date"):
                base = np.datetime64("2024-05-14T09:30:00") + np.timedelta64(int(r["session"][0]) * 60, "s")
                text.append([str(base + np.timedelta64(int(round(q * 1e6)), "us")) for q in y])
            elif n == "session":
                text.append([str(int(q)) for q in y])
            else:
                p = max(0, digits.get(n, 4) - int(np.floor(np.log10(abs(g)))) if g != 1 else digits.get(n, 4))
                text.append([("" if q != q else f"{q:.{p}f}".replace(".", dec)) for q in y.tolist()])
        lines += [sep.join(q) for q in zip(*text)]
    open(os.path.join(folder, "recording.csv"), "w").write("\n".join(lines) + "\n")
    open(os.path.join(folder, "rig.toml"), "w").write("".join(f"{k} = {float(v)!r}\n" for k, v in toml.items()))
    json.dump(truth, open(os.path.join(folder, "truth.json"), "w"), indent=1, default=float)
