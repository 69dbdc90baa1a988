"""The laws of docs/laws.md on one session's fine grid. Each gives the hidden force in N, an array as long as run.t."""
import numpy as np


class Run:
    """One session: t in s, x in mm (negative in air), v in mm/s, a in mm/s^2, k in N/mm, c in N s/mm, columns by
    name."""

    def __init__(self, t, x, k, c, columns=None, v=None, a=None):
        self.t, self.x, self.k, self.c = t, x, k, c
        self.dt = t[1] - t[0]
        self.v = np.gradient(x, self.dt) if v is None else v
        self.a = np.gradient(self.v, self.dt) if a is None else a
        self.columns = columns if columns is not None else {}
        self.contact = x > 0
        self.fsim = f_sim(self, x, self.v)

    def thin(self, step):
        """Every step-th point, with v and a kept as they are."""
        s = slice(None, None, step)
        return Run(self.t[s], self.x[s], self.k, self.c, {n: u[s] for n, u in self.columns.items()}, self.v[s],
                   self.a[s])


def f_sim(run, x, v):
    """max(0, k X + c V) in contact, 0 in air. N."""
    return np.where(x > 0, np.maximum(0.0, run.k * x + run.c * v), 0.0)


def convolve(u, kernel):
    """Causal convolution by FFT, nothing before the first sample."""
    n = len(u)
    size = 1 << int(np.ceil(np.log2(2 * n)))
    return np.fft.irfft(np.fft.rfft(u, size) * np.fft.rfft(kernel[:n], size), size)[:n]


def lag(u, tau_s, dt):
    """First-order lag of u, at rest at u[0]."""
    if tau_s <= 0:
        return u.copy()
    a = np.exp(-dt / tau_s)
    return u[0] + convolve(u - u[0], (1 - a) * a ** np.arange(len(u)))


def shift(u, tau_s, t):
    """u(t - tau), held at both ends."""
    return np.interp(t - tau_s, t, u)


def resonate(u, frequency_hz, damping_ratio, dt):
    """y of y'' + 2 z w y' + w^2 y = w^2 u, at rest before."""
    n = len(u)
    size = 1 << int(np.ceil(np.log2(2 * n)))
    r = np.fft.rfftfreq(size, dt) / frequency_hz
    return np.fft.irfft(np.fft.rfft(u, size) / (1 - r ** 2 + 2j * damping_ratio * r), size)[:n]


def play(x, b):
    """The play operator of half-width b; engaged forwards at the start."""
    out, p = np.empty(len(x)), x[0] - b
    for i, u in enumerate(x.tolist()):
        if p < u - b:
            p = u - b
        elif p > u + b:
            p = u + b
        out[i] = p
    return out


def bouc_wen(run, d_mm, gamma=0.0):
    """z in mm: z' = V - (beta |V| z + gamma V |z|)/d with beta = 1 - gamma; z = 0 at each new contact."""
    out, z, beta = np.zeros(len(run.t)), 0.0, 1.0 - gamma
    for i, (dx, touching) in enumerate(zip((run.v * run.dt).tolist(), run.contact.tolist())):
        z = z + dx - (beta * abs(dx) * z + gamma * dx * abs(z)) / d_mm if touching else 0.0
        out[i] = z
    return out


def spinning(run):
    """True where the spindle turns."""
    return run.columns["spindle_rpm"] > 0


def bias(run, bias_n):
    return np.full(len(run.t), bias_n)


def drift(run, rate_n_per_s=0.0, amplitude_n=0.0, tau_s=1.0):
    return rate_n_per_s * run.t + amplitude_n * (1 - np.exp(-run.t / tau_s))


def contact_offset(run, **deltas):
    x = run.x + deltas[f"delta_{run.number}_mm"]
    return f_sim(run, x, run.v) - run.fsim


def coulomb_friction(run, fc_n, v0_mm_s):
    return fc_n * np.tanh(run.v / v0_mm_s)


def stribeck_friction(run, fc_n, fs_n, vs_mm_s, v0_mm_s):
    return (fc_n + (fs_n - fc_n) * np.exp(-(run.v / vs_mm_s) ** 2)) * np.tanh(run.v / v0_mm_s)


def viscous_friction(run, b_n_s_per_mm):
    return b_n_s_per_mm * run.v


def gravity_posture(run, weight_n, theta0_deg):
    return weight_n * (np.sin(np.radians(run.columns["posture_deg"])) - np.sin(np.radians(theta0_deg)))


def inertia(run, mass_kg):
    return mass_kg * run.a / 1000.0


def gain_error(run, gain):
    return gain * run.fsim


def cross_talk(run, a, b):
    return a * run.columns["fy_n"] + b * run.columns["fz_n"]


def delay(run, tau_s):
    return shift(run.fsim, tau_s, run.t) - run.fsim


def low_pass(run, tau_s):
    return lag(run.fsim, tau_s, run.dt) - run.fsim


def position_late(run, tau_s):
    return shift(run.fsim, -tau_s, run.t) - run.fsim


def position_filtered(run, tau_s):
    """Not a law of its own: the position is lagged, so the force of the lagged position is missed. Goes by
    position_late."""
    x = lag(run.x, tau_s, run.dt)
    return run.fsim - f_sim(run, x, np.gradient(x, run.dt))


def ringing(run, share, frequency_hz, damping_ratio, mass_kg=0.0):
    y = resonate(run.fsim, frequency_hz, damping_ratio, run.dt)
    h = share * (y - run.fsim)
    if mass_kg:
        h = h + mass_kg * resonate(run.a, frequency_hz, damping_ratio, run.dt) / 1000.0
    return h


def saturation(run, f_max_n):
    return np.minimum(run.fsim, f_max_n) - run.fsim


def backlash(run, b_mm):
    return np.where(run.contact, run.k * (play(run.x, b_mm) - run.x), 0.0)


def backlash_tip(run, b_mm):
    """The tip itself has the play, its speed too: what a bench with a loose collet does. Goes by backlash."""
    tip = play(run.x, b_mm)
    return f_sim(run, tip, np.gradient(tip, run.dt)) - run.fsim


def hysteresis(run, alpha_n_per_mm, d_mm, gamma=0.0):
    return alpha_n_per_mm * bouc_wen(run, d_mm, gamma)


def series_compliance(run, ks_n_per_mm=None, softening_force_n=None):
    if softening_force_n:
        kx = run.k * np.maximum(run.x, 0)
        return kx / (1 + kx / softening_force_n) - kx
    share = 1 + run.k / ks_n_per_mm
    return lag(run.fsim / share, run.c / ks_n_per_mm / share, run.dt) - run.fsim


def nonlinear_stiffness(run, m):
    x = np.maximum(run.x, 0)
    return run.k * (x ** m - x)


def hidden_layer(run, dk_n_per_mm, d0_mm):
    return dk_n_per_mm * np.maximum(run.x - d0_mm, 0)


def graded_stiffness(run, alpha_per_mm):
    return -run.k * alpha_per_mm * np.maximum(run.x, 0) ** 2


def anisotropy(run, epsilon, phi0_deg):
    return run.fsim * epsilon * np.cos(2 * np.radians(run.columns["approach_deg"] - phi0_deg))


def relaxation(run, k1_n_per_mm, tau1_s, k2_n_per_mm=0.0, tau2_s=1.0):
    rate, h = np.where(run.contact, run.v, 0.0), 0.0
    for k, tau in ((k1_n_per_mm, tau1_s), (k2_n_per_mm, tau2_s)):
        if k:
            a = np.exp(-run.dt / tau)
            h = h + k * convolve(rate, tau * (1 - a) * a ** np.arange(len(rate)))
    return np.where(run.contact, h, 0.0)


def feed_power_law(run, n):
    h = run.c * (np.abs(run.v) ** n * np.sign(run.v) - run.v)
    return np.where(run.contact, np.maximum(h, -run.fsim), 0.0)


def edge_force(run, edge_n):
    return np.where(run.contact & spinning(run), edge_n, 0.0)


def wear(run, per_mm3):
    return run.fsim * per_mm3 * run.columns["removed_mm3"]


def run_out(run, amplitude_n, phase_turns):
    turns = np.cumsum(run.columns["spindle_rpm"]) * run.dt / 60 + getattr(run, "free_phase", 0.0)
    return np.where(run.contact & spinning(run), amplitude_n * np.sin(2 * np.pi * (turns + phase_turns)), 0.0)


def tone(run, amplitude_n, frequency_hz, phase_turns):
    """A sine of the session's clock; free_phase is what a real source has more in each session."""
    turns = frequency_hz * run.t + phase_turns + getattr(run, "free_phase", 0.0)
    return amplitude_n * np.sin(2 * np.pi * turns)


def chatter(run, amplitude_n, frequency_hz, phase_turns):
    return np.where(run.contact, tone(run, amplitude_n, frequency_hz, phase_turns), 0.0)


def interference(run, amplitude_n, frequency_hz, phase_turns):
    return tone(run, amplitude_n, frequency_hz, phase_turns)


def coolant(run, fraction):
    return run.fsim * fraction * run.columns["wet"]


def thermal_softening(run, per_k):
    return -run.fsim * per_k * (run.columns["temperature_c"] - run.columns["temperature_c"][0])


def hunt_crossley(run, lambda_n_s_per_mm2):
    """Unlisted: damping in proportion to depth."""
    return np.where(run.contact, np.maximum(lambda_n_s_per_mm2 * run.x * run.v, -run.fsim), 0.0)


def cogging(run, amplitude_n, pitch_mm):
    """Unlisted: the ripple of a linear motor, periodic in position, in air too."""
    return amplitude_n * np.sin(2 * np.pi * run.x / pitch_mm)


def memory_log(run, amplitude_n):
    """Unlisted: ageing of the contact: grows with the logarithm of the time since touching, in contact."""
    index = np.arange(len(run.t))
    touched = np.maximum.accumulate(np.where(run.contact, 0, index))
    return np.where(run.contact, amplitude_n * np.log1p((index - touched) * run.dt / 0.05), 0.0)


CHANNEL = {"delay", "low_pass", "saturation", "ringing"}
POSITION = {"position_late", "position_filtered"}
TISSUE = {"hysteresis", "backlash", "backlash_tip", "series_compliance", "nonlinear_stiffness", "hidden_layer",
          "graded_stiffness", "relaxation", "contact_offset", "feed_power_law", "anisotropy", "coolant",
          "thermal_softening", "wear", "hunt_crossley", "memory_log"}
GOES_BY = {"position_filtered": "position_late", "backlash_tip": "backlash", "hunt_crossley": None, "cogging": None,
           "memory_log": None}
LAWS = {f.__name__: f for f in (
    bias, drift, contact_offset, coulomb_friction, stribeck_friction, viscous_friction, gravity_posture, inertia,
    gain_error, cross_talk, delay, low_pass, position_late, position_filtered, ringing, saturation, backlash,
    backlash_tip, hysteresis, series_compliance, nonlinear_stiffness, hidden_layer, graded_stiffness, anisotropy,
    relaxation, feed_power_law, edge_force, wear, run_out, chatter, interference, coolant, thermal_softening,
    hunt_crossley, cogging, memory_log)}
