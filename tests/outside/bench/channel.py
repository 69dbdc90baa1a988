"""The bench's channels: integrating converter, encoder, speed column, noise. Noise has the standard deviation 1
before it is scaled."""
import numpy as np
from laws import convolve, lag, resonate


def ar(rng, n, rho):
    """AR(1) of unit variance, by blocks of the kernel."""
    u = rng.standard_normal(n)
    u[0] /= np.sqrt(1 - rho ** 2)
    return np.sqrt(1 - rho ** 2) * convolve(u, rho ** np.arange(n))


def pink(rng, n):
    """1/f between one per session and Nyquist."""
    f = np.fft.rfftfreq(n)
    f[0] = np.inf
    u = np.fft.irfft(np.fft.rfft(rng.standard_normal(n)) / np.sqrt(f), n)
    return u / u.std()


def noise(rng, kind, t, force):
    """t in s at the rows, force in N (clean) for what grows with it."""
    n, dt = len(t), float(np.median(np.diff(t)))
    if kind == "white":
        return rng.standard_normal(n)
    if kind == "ar1":
        return ar(rng, n, rng.uniform(0.6, 0.95))
    if kind == "pink":
        return pink(rng, n)
    if kind == "walk":  # a bounded walk: the zero of a cheap cell, with white noise over it
        return 0.45 * ar(rng, n, np.exp(-dt / 15.0)) + 0.89 * rng.standard_normal(n)
    if kind == "two_scales":
        return 0.7 * ar(rng, n, np.exp(-dt / 0.01)) + 0.71 * ar(rng, n, np.exp(-dt / 0.8))
    if kind == "hum":
        tones = sum(a * np.sin(2 * np.pi * (50.0 * h * t + rng.random())) for h, a in ((1, 0.6), (3, 0.3)))
        return tones + 0.85 * rng.standard_normal(n)
    if kind == "ring":  # floor knocks ring the frame
        knocks = (rng.random(n) < dt / 1.5) * rng.standard_normal(n) * 30
        u = resonate(knocks, 0.13 / dt, 0.03, dt)
        return 0.6 * u / max(u.std(), 1e-9) + 0.8 * rng.standard_normal(n)
    if kind == "heavy":
        return rng.standard_t(3.5, n) / np.sqrt(3.5 / 1.5)
    if kind == "hetero":
        grow = 0.5 + 1.5 * force / max(force.max(), 1e-9)
        return grow * rng.standard_normal(n) / np.sqrt(np.mean(grow ** 2))
    raise ValueError(kind)


def integrate(t, u, rows, width):
    """Mean of u over a window of width s about each row: an integrating converter, stamped at its middle."""
    total = np.concatenate([[0.0], np.cumsum((u[1:] + u[:-1]) / 2 * (t[1] - t[0]))])
    hi, lo = np.minimum(rows + width / 2, t[-1]), np.maximum(rows - width / 2, t[0])
    return (np.interp(hi, t, total) - np.interp(lo, t, total)) / (hi - lo)


def rows(rng, seconds, rate, kind):
    """The times of the rows, s: regular, irregular (true stamps), or with rows missing."""
    t = np.arange(1, int(seconds * rate) - 1) / rate
    if kind == "irregular":
        t = np.sort(t + rng.uniform(-0.35, 0.35, len(t)) / rate)
    if kind == "missing":
        keep = rng.random(len(t)) > 0.015
        for start in rng.integers(0, len(t), 4):
            keep[start:start + rng.integers(3, 15)] = False
        t = t[keep]
    return t


def quantise(u, step):
    return np.round(u / step) * step if step else u


def speed(rng, kind, t, x, v, b):
    """The v column, mm/s, from the recorded x or from a transducer of its own; None when there is none."""
    if kind == "none":
        return None
    if kind == "exact":
        return v
    if kind == "tacho":
        return v + 0.01 * b["fast"] * rng.standard_normal(len(v))
    if kind == "quantised":
        return quantise(v, 0.02 * b["fast"])
    back = np.diff(x, prepend=x[0]) / np.diff(t, prepend=t[0] - (t[1] - t[0]))
    if kind == "lowres":
        return back
    if kind == "central":
        half = int(rng.integers(2, 6))
        window = np.ones(2 * half + 1) / (2 * half + 1)
        return np.convolve(np.pad(np.gradient(x, t), half, mode="edge"), window, "valid")
    if kind == "causal":
        return lag(back, rng.uniform(2, 5), 1.0)
    raise ValueError(kind)
