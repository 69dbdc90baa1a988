"""What a testing machine or a handpiece bench commands. Positions in mm, penetration positive; time in s. b: depth,
gap in mm, speeds in mm/s."""
import numpy as np
from laws import convolve


def knots(points, dt):
    """Straight legs through (seconds, target mm), the first is the start."""
    t = np.cumsum([p[0] for p in points])
    return np.interp(np.arange(0, t[-1], dt), t, [p[1] for p in points])


def go(points, target, speed):
    """Adds a leg at a speed in mm/s."""
    points.append((max(abs(target - points[-1][1]) / speed, 1e-3), target))


def duration(points):
    return sum(p[0] for p in points)


def legs(rng, b, x, seconds, step):
    """Repeats step(points) from x until the seconds are full."""
    p = [(0.0, x)]
    while duration(p) < seconds:
        step(p)
    return p


def any_speed(rng, b):
    return float(np.exp(rng.uniform(np.log(b["slow"]), np.log(b["fast"]))))


def sawtooth(rng, b, x, seconds):
    """To and fro from air, one speed for each tooth, peaks of several heights."""
    def step(p):
        v = any_speed(rng, b)
        go(p, b["depth"] * rng.uniform(0.4, 1), v)
        go(p, -b["gap"] * rng.uniform(0.3, 1), v)
    return legs(rng, b, x, seconds, step)


def inside(rng, b, x, seconds):
    """To and fro within contact, strokes of several lengths."""
    def step(p):
        v, mean = any_speed(rng, b), b["depth"] * rng.uniform(0.35, 0.7)
        for _ in range(rng.integers(2, 5)):
            half = b["depth"] * rng.uniform(0.05, 0.3)
            go(p, mean + half, v)
            go(p, mean - half, v)
    return legs(rng, b, x, seconds, step)


def staircase(rng, b, x, seconds):
    """Steps up and down with holds."""
    def step(p):
        levels = np.linspace(0, b["depth"] * rng.uniform(0.6, 1), rng.integers(4, 7))[1:]
        for level in list(levels) + list(levels[-2::-1]) + [-b["gap"] / 2]:
            go(p, level, b["fast"] * 0.5)
            p.append((b["hold"] * rng.uniform(0.2, 0.5), level))
    return legs(rng, b, x, seconds, step)


def creep(rng, b, x, seconds):
    """Fast in, long hold, fast out, rest in air."""
    def step(p):
        level = b["depth"] * rng.uniform(0.3, 1)
        go(p, level, b["fast"] * rng.uniform(0.4, 1))
        p.append((b["hold"] * rng.uniform(0.7, 1.5), level))
        go(p, -b["gap"] / 2, b["fast"] * rng.uniform(0.4, 1))
        p.append((b["hold"] * rng.uniform(0.3, 0.9), -b["gap"] / 2))
    return legs(rng, b, x, seconds, step)


def pecking(rng, b, x, seconds):
    """An operator pecks: short touches of unlike depth and speed, short pauses over the surface."""
    def step(p):
        level = b["depth"] * rng.beta(3, 2)
        go(p, level * 0.7, any_speed(rng, b))
        go(p, level, b["slow"] * 2 + any_speed(rng, b) * 0.3)
        p.append((rng.exponential(0.15), level * rng.uniform(0.96, 1.0)))
        air = -b["gap"] * rng.uniform(0.1, 1)
        go(p, air, any_speed(rng, b))
        p.append((rng.exponential(0.1), air))
    return legs(rng, b, x, seconds, step)


def passes(rng, b, x, seconds):
    """Drilling passes: rapid to the surface, slow feed, dwell, rapid out; each goes deeper."""
    def step(p):
        for share in (0.4, 0.7, 1.0):
            go(p, -0.1 * b["gap"], b["fast"])
            go(p, b["depth"] * share * rng.uniform(0.85, 1), b["slow"] * rng.uniform(1, 4))
            p.append((0.2, p[-1][1]))
            go(p, -b["gap"], b["fast"])
            p.append((rng.uniform(0.1, 0.4), -b["gap"]))
    return legs(rng, b, x, seconds, step)


def prbs(rng, b, x, seconds):
    """A random binary sequence about a depth, slewed."""
    half, mean = b["depth"] * rng.uniform(0.1, 0.25), b["depth"] * rng.uniform(0.4, 0.65)

    def step(p):
        bit = mean + half * rng.choice((-1, 1))
        go(p, bit, b["fast"])
        p.append((rng.integers(1, 6) * 0.06, bit))
    return legs(rng, b, x, seconds, step)


def speeds(rng, b, x, seconds):
    """Triangles at five speeds over the whole range, from air."""
    def step(p):
        for v in np.geomspace(b["slow"], b["fast"], 5):
            for _ in range(max(1, int(seconds / 12 * v / (b["depth"] + b["gap"])))):
                go(p, b["depth"] * rng.uniform(0.7, 1), v)
                go(p, -b["gap"] * 0.3, v)
    return legs(rng, b, x, seconds, step)


def air(rng, b, x, seconds):
    """Strokes over the surface."""
    def step(p):
        v = any_speed(rng, b)
        go(p, -b["gap"] * rng.uniform(0.05, 0.3), v)
        go(p, -b["gap"] * rng.uniform(0.7, 1.5), v)
        p.append((rng.exponential(0.1), p[-1][1]))
    return legs(rng, b, x, seconds, step)


def waves(rng, b, x, seconds, dt, shape):
    """sines, chirp and cyclic: a formula, entered at its first value."""
    t = np.arange(0, seconds, dt)
    depth, top = b["depth"], b["fast"]
    if shape == "sines":
        f = np.sort(rng.uniform(0.15, 1.0, 4)) * min(8.0, top / (depth * 2.5))
        w = 0.11 * depth * rng.uniform(0.7, 1.3, 4)
        y = 0.5 * depth + sum(a * np.sin(2 * np.pi * (g * t + rng.random())) for a, g in zip(w, f))
    elif shape == "chirp":
        lo, hi = 0.2, min(12.0, top / (2 * np.pi * 0.22 * depth))
        hi = max(hi, 0.4)
        turns = lo * seconds / np.log(hi / lo) * ((hi / lo) ** (t / seconds) - 1)
        y = 0.5 * depth + 0.22 * depth * np.sin(2 * np.pi * turns)
    else:  # cyclic loading; the mean drifts, the amplitude grows; it leaves the surface now and then
        f = min(4.0, top / (np.pi * depth)) * rng.uniform(0.4, 1)
        y = depth * (0.42 + 0.12 * t / seconds + (0.3 + 0.12 * t / seconds) * np.sin(2 * np.pi * f * t)) - 0.06 * depth
    approach = knots([(0.0, x), (max(abs(y[0] - x) / (0.5 * top), 2 * dt), y[0])], dt)
    return np.concatenate([approach, y])


def actuator(x, bandwidth_hz, dt):
    """The machine follows the command as a damped second-order system; at rest before and after."""
    pad = int(1.0 / dt)
    u = np.concatenate([np.full(pad, x[0]), x, np.full(pad, x[-1])])
    r = np.fft.rfftfreq(len(u), dt) / bandwidth_hz
    return np.fft.irfft(np.fft.rfft(u - u[0]) / (1 - r ** 2 + 1.7j * r), len(u))[pad:pad + len(x)] + u[0]


BLOCKS = {f.__name__: f for f in (sawtooth, inside, staircase, creep, pecking, passes, prbs, speeds, air)}


def session(rng, b, names, seconds, dt):
    """Blocks one after the other, in a drawn order, from rest in air; as long as asked."""
    parts, x = [np.full(int(rng.uniform(0.5, 1.0) / dt), -b["gap"])], -b["gap"]
    for name in rng.permutation(names):
        share = seconds / len(names)
        if name in BLOCKS:
            part = knots(BLOCKS[name](rng, b, x, share), dt)[:int(share / dt)]
        else:
            part = waves(rng, b, x, share, dt, name)[:int(share / dt)]
        parts.append(part)
        x = part[-1]
    n = int(seconds / dt)
    return actuator(np.concatenate(parts)[:n], b["bandwidth"], dt)


def switching(rng, t, values, lo_s, hi_s):
    """A schedule that steps through values in turn, each for lo to hi seconds."""
    edges = np.cumsum(rng.uniform(lo_s, hi_s, int(t[-1] / lo_s) + 2))
    start = rng.integers(len(values))
    return np.asarray(values, float)[(np.searchsorted(edges, t) + start) % len(values)]


def spindle(rng, run, b):
    """rpm, off and on in turn; a little wow when on."""
    on = switching(rng, run.t, (0.0, 1.0), 1.5, 4.0)
    return on * np.round(b["rpm"] * (1 + 0.01 * np.sin(2 * np.pi * 0.3 * run.t + rng.uniform(0, 6))), 2)


def steady_spindle(rng, run, b):
    return np.round(b["rpm"] * (1 + 0.01 * np.sin(2 * np.pi * 0.2 * run.t + rng.uniform(0, 6))), 3)


def wet(rng, run, b):
    return switching(rng, run.t, (0.0, 1.0), 1.5, 4.0)


def posture(rng, run, b):
    """A tilting table, deg; new angle every few seconds, smooth."""
    steps = switching(rng, run.t, rng.permutation([-30.0, -5.0, 15.0, 35.0, 60.0]), 2.0, 4.0)
    return np.convolve(np.pad(steps, (0, int(0.4 / run.dt)), mode="edge"),
                       np.ones(int(0.4 / run.dt)) / int(0.4 / run.dt), "valid")[:len(steps)]


def approach(rng, run, b):
    """deg; another one for each contact."""
    touch = np.cumsum(np.diff(run.contact.astype(int), prepend=0) > 0)
    return rng.choice((0.0, 45.0, 90.0, 135.0), touch[-1] + 1)[touch]


def lateral(rng, run, b):
    """A lateral force in N: a part follows the feed, the rest wanders on its own, in air too."""
    steps = np.interp(run.t, np.arange(0, run.t[-1] + 0.5, 0.35),
                      rng.standard_normal(int((run.t[-1] + 0.5) / 0.35) + 1))
    return 0.3 * b["force"] * steps + rng.uniform(-0.1, 0.1) * run.fsim


def temperature(rng, run, b):
    """deg C; friction heats, the room cools in about 8 s."""
    heat = run.fsim * (0.3 * b["fast"] + np.abs(run.v)) / (b["force"] * b["fast"])
    a = np.exp(-run.dt / 8.0)
    return 23.0 + 30.0 * convolve(heat, run.dt / 8.0 * a ** np.arange(len(heat)))


def removed(rng, run, b):
    """mm^3 since the start of the session; bench.py adds what the sessions before removed."""
    return np.cumsum(run.fsim) * run.dt / (b["force"] * 20.0)


COLUMNS = {"spindle_rpm": spindle, "steady_rpm": steady_spindle, "wet": wet, "posture_deg": posture,
           "approach_deg": approach, "fy_n": lateral, "fz_n": lateral,
           "temperature_c": temperature, "removed_mm3": removed}
