"""How a hand and a robot move, and the filters that both halves of the generator use."""
import numpy as np
pi, DT = np.pi, 1 / 5000  # the true motion lives on a grid of 5 kHz

def lag(x, tau, dt=DT, y0=0.0):
    """y' = (x - y)/tau, exact for x linear between the rows (mean of both ends)."""
    if tau < dt / 20 or len(x) == 0:
        return np.array(x, float)
    a, n = np.exp(-dt / tau), len(x)
    u, y, chunk = (1 - a) * 0.5 * (x + np.r_[x[:1], x[:-1]]), np.empty(n), max(1, int(300 * tau / dt))
    for i in range(0, n, chunk):
        w = a ** np.arange(1, min(chunk, n - i) + 1)
        y[i:i + len(w)] = w * (y0 + np.cumsum(u[i:i + len(w)] / w))
        y0 = y[i + len(w) - 1]
    return y

def runs(mask):
    e = np.flatnonzero(np.diff(np.r_[0, mask.astype(int), 0]))
    return [slice(a, b) for a, b in zip(e[::2], e[1::2])]

def in_contact(f, mask, *rows):
    """f(rows) on each stretch of contact by itself: the memory begins anew at each touch."""
    out = np.zeros(len(mask))
    for r in runs(mask):
        out[r] = f(*(x[r] for x in rows))
    return out

def play(x, b):
    """p' = 0 while |x - p| < b/2, else p follows: total play b, symmetric."""
    p, out = x[0], np.empty(len(x))
    for i, v in enumerate(x.tolist()):
        p = min(max(p, v - b / 2), v + b / 2)
        out[i] = p
    return out

def bouc_wen(x, d, gamma=0.0):
    """z' = V - (beta |V| z + gamma V |z|)/d, beta = 1 - gamma; exact for gamma = 0 at any step."""
    z, out, last = 0.0, np.empty(len(x)), x[0] if len(x) else 0.0
    for i, v in enumerate(x.tolist()):
        h = v - last
        if gamma:
            z += h - ((1 - gamma) * abs(h) * z + gamma * h * abs(z)) / d
        else:
            g = d if h > 0 else -d
            z = g + (z - g) * np.exp(-abs(h) / d)
        out[i], last = z, v
    return out

def band(rng, n, dt, lo, hi, slope=0.0):
    """A Gaussian process of unit sd, with power f^-slope between lo and hi, Hz. It is smooth and has no period of its own."""
    m = n + int(1 / (max(lo, 0.1) * dt))
    f = np.fft.rfftfreq(m, dt)
    a = np.where((f >= lo) & (f <= hi), np.maximum(f, 1e-9) ** (-slope / 2), 0)
    a[0] = 0
    y = np.fft.irfft(a * (rng.normal(size=len(f)) + 1j * rng.normal(size=len(f))), m)[:n]
    return y / (y.std() + 1e-12)

SHAPE = {"hand": lambda q: 10 * q**3 - 15 * q**4 + 6 * q**5,         # minimum jerk: peak speed 1.875 D/T
         "joint": lambda q: q - np.sin(2 * pi * q) / (2 * pi),       # cycloid of a joint: peak speed 2 D/T
         "scurve": lambda q: SCURVE(q)}                              # ramps of 15 %, constant speed between: peak D/(0.85 T)
def SCURVE(q, r=0.15):
    up = lambda s: (s / 2 - r / (2 * pi) * np.sin(pi * s / r)) / (1 - r)  # speed rises as (1 - cos)/2
    return np.where(q < r, up(np.minimum(q, r)), np.where(q > 1 - r, 1 - up(np.minimum(1 - q, r)), (q - r / 2) / (1 - r)))
PEAK = {"hand": 1.875, "joint": 2.0, "scurve": 1 / 0.85}

def script(kind, rng, d):
    """Way points of one habit: (target mm, peak speed, dwell s, amplitude, Hz, shape)."""
    u, D, top, R = rng.uniform, d.depth, d.vtop, d.reach
    air = -R * u(0.5, 1)
    if kind == "pecks":
        for _ in range(3):
            yield from ((D * u(0.3, 1), top * u(0.3, 1), u(0.05, 0.25), 0, 1, "hand"), (-R * u(0.2, 1), top * u(0.3, 1), u(0.05, 0.3), 0, 1, "hand"))
    elif kind == "hold":
        yield from ((D * u(0.4, 0.9), top * u(0.2, 1), u(1.5, 3), 0, 1, "hand"), (D * u(0.1, 0.3), top * u(0.1, 0.5), u(0.4, 1), 0, 1, "hand"),
                    (air, top * u(0.2, 0.6), 0.2, 0, 1, "hand"))
    elif kind == "wander":  # to and fro within contact, speed and reach vary all the time
        a = D * u(0.25, 0.42)
        yield from ((D * 0.5, top * u(0.2, 0.6), u(2, 3.5), a, min(top * u(0.3, 0.9) / (2 * pi * a), 5), "hand"), (air, top * 0.4, 0.2, 0, 1, "hand"))
    elif kind == "air":
        a = R * u(0.25, 0.4)
        yield (-R * 0.55, top * 0.5, u(1.2, 2.2), a, min(top * u(0.3, 1) / (2 * pi * a), 6), "hand")
    elif kind == "hesitate":
        for x, v, w in ((-0.04 * R, 0.3, 0.4), (0.3 * D, 0.5, 0.3), (0.12 * D, 0.2, 0.2), (D * u(0.6, 1), 0.7, 0.1), (0.5 * D, 0.15, 0.5), (air, 0.5, 0.3)):
            yield (x, top * v * u(0.7, 1.2), w * u(0.6, 1.4), 0, 1, "hand")
    elif kind == "robot":
        sh = rng.choice(["joint", "scurve"])
        for x in (0.35 * D, 0.7 * D, D, 0.45 * D, 0.8 * D, air, D * u(0.5, 1), air):
            yield (x, top * rng.choice([0.1, 0.3, 0.6, 1.0]), u(0.1, 0.5), 0, 1, sh)
    elif kind == "sweep":
        yield from ((D * 0.5, top * 0.3, 3.0, D * 0.2, (0.4, min(5, top / (2 * pi * D * 0.2))), "joint"), (air, top * 0.5, 0.3, 0, 1, "joint"))
    elif kind == "jab":
        for _ in range(4):
            yield from ((D * u(0.15, 0.5), top, 0.02, 0, 1, "hand"), (-R * u(0.1, 0.4), top, 0.15, 0, 1, "hand"))
    elif kind == "stroke":  # long strokes that stay in air
        for _ in range(2):
            yield from ((-R * u(0.05, 0.35), top * u(0.2, 1), u(0.02, 0.2), 0, 1, "hand"), (-R * u(0.6, 1), top * u(0.2, 1), u(0.02, 0.2), 0, 1, "joint"))

def motion(rng, n, d, kinds, hand):
    x, out, i = -d.reach * 0.55, [np.full(int(0.15 / DT), -d.reach * 0.55)], 0
    while sum(map(len, out)) < n:
        for target, speed, dwell, amp, hz, shape in script(kinds[i % len(kinds)], rng, d):
            T = max(PEAK[shape] * abs(target - x) / max(speed, 1e-3), 0.03)
            out.append(x + (target - x) * SHAPE[shape](np.arange(1, int(T / DT) + 1) * DT / (int(T / DT) * DT)))
            m, x = int(dwell / DT), target
            seg = np.full(m, float(x))
            if amp and m > 10:  # a stroke that begins and ends at rest; a hand is not even in rate and reach
                f0, f1 = hz if isinstance(hz, tuple) else (hz, hz)
                rate = np.linspace(f0, f1, m) * (1 + (0.25 * band(rng, m, DT, 0.1, 0.8) if shape == "hand" else 0))
                env = np.minimum(1, np.sin(pi * np.linspace(0, 1, m)) * 3) if m else 1
                env = env * env * (3 - 2 * env)
                reach = 1 + (0.12 * band(rng, m, DT, 0.1, 0.6) if shape == "hand" else 0)
                seg = seg + amp * env * reach * np.sin(2 * pi * np.cumsum(rate) * DT)
            out.append(seg)
        i += 1
    x = np.concatenate(out)[:n]
    if hand:
        x = x + d.tremor * rng.uniform(0.6, 1.4) * band(rng, n, DT, 8, 12) + d.drift * band(rng, n, DT, 0.05, 0.5, 2)
    w = np.hanning(41)  # 8 ms: no motor and no hand makes a step of acceleration
    return np.convolve(np.pad(x, 20, "edge"), w / w.sum(), "valid")
