"""What the instruments do to the truth: noise of the force channel, an encoder with a step, a derived speed, columns beside."""
import numpy as np
from laws import decay
from motions import box


def unit(parts):  # one scale for all sessions: standard deviation 1 about each session's mean
    return [p / np.sqrt(np.mean(np.concatenate([q - q.mean() for q in parts]) ** 2)) for p in parts]


def ar1(rng, n, tau_rows):
    r = np.exp(-1 / tau_rows)
    return decay(rng.normal(size=n + int(5 * tau_rows)), np.log(r), 1.0)[-n:] * np.sqrt(1 - r * r)


def pink(rng, n):  # power in proportion to 1/f
    z = np.fft.rfft(rng.normal(size=2 * n))
    z[1:] /= np.sqrt(np.arange(1, len(z)))
    z[0] = 0
    return np.fft.irfft(z)[:n]


def hum(t, rng, f):  # the mains: base and third harmonic, with a rate that wanders by some hundredths
    phase = 2 * np.pi * (f * t + 0.02 * np.sin(2 * np.pi * t / 17 + rng.uniform(0, 6)) + rng.random())
    return np.sqrt(2) * (0.9 * np.sin(phase) + 0.43 * np.sin(3 * phase + 0.7))


def ringing(s, f, damping):  # q'' + 2 z w q' + w^2 q: the free vibration that jerks of the motion and of the contact force set off
    w = 2 * np.pi * f
    j = np.gradient(s.a, s.dt) / 1e3 + 40 * np.gradient(s.plain, s.dt)
    return np.real(decay(j.astype(complex), -damping * w + 1j * w * np.sqrt(1 - damping**2), s.dt))[s.pick]


def force_noise(sessions, kind, arg, rng):
    """Force noise by session, standard deviation 1 over the recording."""
    out = []
    for s in sessions:
        n, t = len(s.pick), s.t[s.pick]
        w = rng.normal(size=n)
        out.append({
            "white": lambda: w,
            "ar1": lambda: ar1(rng, n, arg or 8),
            "pink": lambda: pink(rng, n),
            "walk": lambda: np.cumsum(w),
            "walk_white": lambda: 0.8 * w + 0.6 * np.cumsum(rng.normal(size=n)) * np.sqrt(6.0 / n),
            "two_scale": lambda: 0.7 * w + 0.5 * ar1(rng, n, 6) + 0.5 * ar1(rng, n, 150),
            "hum": lambda: 0.6 * w + 0.8 * hum(t, rng, arg),
            "line": lambda: 0.6 * w + 0.8 * np.sqrt(2) * np.sin(2 * np.pi * (arg * t + rng.random())),
            "bursts": lambda: w * (1 + 7 * (ar1(rng, n, 20) > 1.9)),
            "tails": lambda: rng.standard_t(3, n),
        }.get(kind, lambda: None)() if kind != "ringing" else ringing(s, arg[0], arg[1]))
    if kind == "ringing":
        out = [0.8 * q + 0.6 * rng.normal(size=len(q)) for q in unit(out)]
    return unit(out)


def encoder(x, d, rng, fs):
    """Position as recorded: white noise, a slow wander, then the step."""
    x = x + d.xn * rng.normal(size=len(x)) + d.wander * ar1(rng, len(x), 0.8 * fs)
    return np.round(x / d.quantum) * d.quantum if d.quantum else x


def savgol(x, half, dt):  # the slope of the least-squares line (same as the parabola's) over 2 half + 1 rows
    k = np.arange(-half, half + 1)
    padded = np.concatenate([2 * x[0] - x[half:0:-1], x, 2 * x[-1] - x[-2:-half - 2:-1]])
    return np.convolve(padded, -k / np.sum(k * k) / dt, "valid")


def gauss(x, sd, dt):  # the slope of x under a Gaussian of sd rows
    half = int(4 * sd)
    g = np.exp(-0.5 * (np.arange(-half, half + 1) / sd) ** 2)
    padded = np.concatenate([2 * x[0] - x[half:0:-1], x, 2 * x[-1] - x[-2:-half - 2:-1]])
    return np.gradient(np.convolve(padded, g / g.sum(), "valid"), dt)


def one_pole(x, tau, dt):  # backward difference through a one-pole filter: late by tau
    d = np.diff(x, prepend=x[0]) / dt
    return decay((1 - np.exp(-dt / tau)) * d, -1 / tau, dt)


def back_mean(x, n, dt):  # backward difference over n rows: late by n/2 rows
    lead = np.concatenate([np.full(n, x[0]), x])
    return (lead[n:] - lead[:-n]) / (n * dt)


def alpha_beta(x, alpha, dt):  # a tracking filter: x += v dt, x += alpha r, v += beta r / dt
    beta = alpha * alpha / (2 - alpha)
    out, p, v = [], x[0], 0.0
    for q in x.tolist():
        p += v * dt
        r = q - p
        p += alpha * r
        v += beta * r / dt
        out.append(v)
    return np.array(out)


SPEED = {
    "exact": lambda v, x, dt: v,
    "quantised": lambda v, x, dt: np.round(v / 0.25) * 0.25,
    "savgol": lambda v, x, dt: savgol(x, 5, dt),
    "gauss": lambda v, x, dt: gauss(x, 2.5, dt),
    "causal": lambda v, x, dt: one_pole(x, 0.012, dt),
    "back_mean": lambda v, x, dt: back_mean(x, 6, dt),
    "alpha_beta": lambda v, x, dt: alpha_beta(x, 0.35, dt),
}


def steps(s, rng, low, high, seconds):  # a value that changes every few seconds, with ramps of 0.3 s between
    n = int(s.t[-1] / seconds) + 3
    v = np.repeat(rng.uniform(low, high, n), 2)
    at = np.sort(np.concatenate([np.arange(n) * seconds, np.arange(1, n + 1) * seconds - 0.3]))
    return np.interp(s.t, at, v)


def slow(s, rng, sd):  # a smooth wandering value
    return sd * sum(np.sin(2 * np.pi * (f * s.t + rng.random())) for f in rng.uniform(0.05, 0.7, 5)) * np.sqrt(2 / 5)


def column(name, s, before, rng, d):
    """One column on the fine grid; before = the session before (wear, temperature go on)."""
    if name == "spindle_rpm":  # off in each third session, and off for a while within the others; 0.3 s to run up and down
        on = 1.0 - ((s.i % 3 == 2) | ((s.t // 2.5) % 3 == s.i % 3)) if d.rpm_gate else np.ones(len(s.t))
        return d.rpm * np.round(box(on, round(0.3 / s.dt)), 6)
    if name == "wet":  # the tap is opened and closed
        return (((s.t + 1.3 * s.i) // 2.1) % 2).astype(float)
    if name == "posture_deg":
        return steps(s, rng, -60, 70, 3.0)
    if name == "elbow_deg":
        return steps(s, rng, 20, 130, 2.2)
    if name == "approach_deg":
        return np.full(len(s.t), [0.0, 45, 90, 135][s.i % 4])
    if name in ("fy_n", "fz_n"):
        return slow(s, rng, 1.2)
    if name == "removed_mm3":  # removed volume grows while the bur is in the tissue
        start = before.true[name][-1] if before is not None else 0.0
        return start + np.cumsum(np.maximum(s.x, 0)) * s.dt * 0.15
    if name == "temperature_c":  # T' = 0.9 F - (T - room)/6, it warms in contact and cools in air
        room = 23.0 + rng.uniform(-0.4, 0.4) + (9.0 if d.hot == s.i else 0.0)
        return room + (0.0 if d.hot is not None else 1.0) * 0.9 * decay(s.plain * s.dt, -1 / 6.0, s.dt)
    if name == "room_c":
        return 22 + 0.8 * np.sin(2 * np.pi * (s.i * 0.17 + s.t / 60)) + 0.2 * s.i
    if name == "humidity":
        return 45 + 0.3 * np.cumsum(rng.normal(size=len(s.t))) * np.sqrt(s.dt)
    if name == "motor_a":  # the current of the drive: some of the force, some of the acceleration, its own noise
        return 0.2 + 0.05 * s.v + 0.0004 * s.a
    raise KeyError(name)


STEP = {"temperature_c": 0.01, "posture_deg": 0.1, "elbow_deg": 0.1, "fy_n": 0.001, "fz_n": 0.001, "removed_mm3": 1e-4, "room_c": 0.01, "humidity": 0.1,
        "motor_a": 0.001, "spindle_rpm": 1.0, "wet": 1.0, "approach_deg": 1.0}
