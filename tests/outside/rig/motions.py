"""Programmed motions of a press rig: each is a list of moves of a stage, rounded by the controller to a finite jerk. Units: mm, s."""
import numpy as np


class Track:
    """A path on a fine time grid, written move by move."""

    def __init__(self, start, dt):
        self.dt, self.parts, self.at = dt, [], start

    def add(self, x):
        if len(x):
            self.parts.append(x)
            self.at = float(x[-1])

    def count(self):
        return sum(len(p) for p in self.parts)

    def go(self, to, speed):  # a ramp at one speed
        n = max(2, round(abs(to - self.at) / speed / self.dt))
        self.add(self.at + (to - self.at) * np.arange(1, n + 1) / n)

    def hold(self, seconds):
        self.add(np.full(round(seconds / self.dt), self.at))

    def strokes(self, length, speed, n):  # to and fro, a triangle
        a = self.at
        for _ in range(n):
            self.go(a + length, speed)
            self.go(a, speed)

    def wave(self, amp, f0, f1, seconds):  # x = at + amp (1 - cos phi), phi = 2 pi (f0 t + (f1 - f0) t^2 / 2T)
        t = np.arange(1, round(seconds / self.dt) + 1) * self.dt
        self.add(self.at + amp * (1 - np.cos(2 * np.pi * (f0 * t + (f1 - f0) * t * t / (2 * seconds)))))

    def peck(self, to, seconds):  # minimum jerk: x = a + (b - a)(10 s^3 - 15 s^4 + 6 s^5)
        s = np.arange(1, round(seconds / self.dt) + 1) * self.dt / seconds
        self.add(self.at + (to - self.at) * s**3 * (10 - 15 * s + 6 * s * s))

    def hand(self, centre, spread, seconds, rng):  # a hand: slow wander and a tremor near 9 Hz
        t = np.arange(1, round(seconds / self.dt) + 1) * self.dt
        x = sum(spread / 2 * np.sin(2 * np.pi * (f * t + rng.random())) for f in rng.uniform(0.15, 0.9, 4))
        x += 0.015 * np.sin(2 * np.pi * (rng.uniform(8, 10.5) * t + rng.random())) * (1 + 0.5 * np.sin(t))
        self.go(centre + x[0], 4.0)
        self.add(centre + x)


def air(tr, d, rng, seconds):
    """Strokes in air at several speeds, each for its share of the time; the last speed is the full one."""
    tr.go(-0.4, d.v_air)
    speeds = np.array(d.air_speeds or (0.03 * d.v_air, 0.2 * d.v_air, d.v_air))
    speeds[:-1] *= rng.uniform(0.8, 1.25, len(speeds) - 1)
    share = seconds / len(speeds)
    n = 2 if share > 1.2 else 1
    for v in rng.permutation(speeds):
        tr.strokes(-v * share / (2 * n), v, n)


def ramp_hold(tr, d, rng):
    tr.go(-0.2, d.v_air)
    tr.go(d.depth * rng.uniform(0.4, 1), d.v_c * rng.choice([0.1, 0.4, 1]))
    tr.hold(rng.uniform(0.6, 1.6))
    tr.go(-0.3, d.v_c * rng.choice([0.2, 1]))


def inside(tr, d, rng):  # reversals within contact at several speeds and lengths
    tr.go(d.depth * 0.3, d.v_c * 0.5)
    for f in rng.permutation([0.08, 0.3, 1.0]):
        tr.strokes(d.depth * rng.uniform(0.1, 0.65) * min(1, 3 * f), d.v_c * f, 2 if f > 0.1 else 1)
    tr.go(-0.3, d.v_c)


def stairs(tr, d, rng):
    tr.go(-0.1, d.v_air)
    for level in (0.25, 0.5, 0.75, 1.0, 0.6, 0.3):
        tr.go(d.depth * level, d.v_c * rng.choice([0.15, 0.6]))
        tr.hold(0.25)
    tr.go(-0.3, d.v_c)


def sine(tr, d, rng):  # it leaves contact for some of each cycle
    tr.go(-0.15 * d.depth, d.v_c * 0.5)
    amp, f = 0.5 * d.depth * rng.uniform(0.5, 1), rng.uniform(0.4, 1.6)
    tr.wave(amp, min(f, d.v_c / (2 * np.pi * amp)), min(f, d.v_c / (2 * np.pi * amp)), 2.0)


def chirp(tr, d, rng):
    tr.go(0.25 * d.depth, d.v_c * 0.5)
    amp = 0.14 * d.depth
    tr.wave(amp, 0.3, min(9.0, d.v_c / (2 * np.pi * amp)), 2.5)
    tr.go(-0.3, d.v_c)


def pecks(tr, d, rng):
    for _ in range(3):
        tr.peck(d.depth * rng.uniform(0.4, 1), max(rng.uniform(0.25, 0.6), 1.9 * d.depth / d.v_c))
        tr.hold(0.1)
        tr.peck(-0.5, max(rng.uniform(0.25, 0.5), 1.9 * d.depth / d.v_c))


def hand(tr, d, rng):
    tr.hand(d.depth * rng.uniform(0.25, 0.55), 0.22 * d.depth, 2.5, rng)
    tr.go(-0.3, d.v_c)


def deep(tr, d, rng):
    tr.go(-0.1, d.v_air)
    tr.go(d.depth, d.depth / 1.5)
    tr.go(-0.3, d.v_c)


def air_wave(tr, d, rng):
    tr.go(-0.6, d.v_air)
    tr.wave(-min(1.0, d.v_air / 20), 0.5, 3.5, 3.0)


def air_hold(tr, d, rng):
    tr.peck(-rng.uniform(0.6, 6), 0.8)
    tr.hold(0.7)


def air_hand(tr, d, rng):
    tr.hand(-4.0, 1.2, 3.0, rng)


CONTACT = [ramp_hold, inside, stairs, sine, chirp, pecks, hand, deep]
AIR = [lambda tr, d, rng: air(tr, d, rng, 3.0), air_wave, air_hold, air_hand]


def box(x, n):  # the controller's limiter: a moving mean of n steps
    y = np.cumsum(np.concatenate([np.zeros(1), np.full(n, x[0]), x, np.full(n, x[-1])]))
    y = (y[n:] - y[:-n]) / n
    return y[n // 2 + 1: n // 2 + 1 + len(x)]


def motion(d, seconds, dt, order, rng):
    """x, v, a of one session: blocks in an order until the time is full, then limits of acceleration and of jerk."""
    tr, n, i = Track(-0.5, dt), round(seconds / dt), 0
    if d.air or d.air_only:
        air(tr, d, rng, 0.24 * seconds)
    while tr.count() < n:
        order[i % len(order)](tr, d, rng)
        i += 1
    x = np.concatenate(tr.parts)[:n]
    if not d.air:
        x = np.maximum(x, 0.12)
    for t in (0.04, 0.02, 0.01):
        x = box(x, round(t / dt))
    v = np.gradient(x, dt)
    return x, v, np.gradient(v, dt)
