"""The laws as a rig would show them, each on the fine grid. The stages follow the way of the force:
tip (where the tip is) -> tissue (before contact opens) -> contact (a factor or a ripple) -> machine (in air too) -> channel (the force channel).
A law's function takes a session s, the force F so far and its parameters p; it gives what is added (stage tip: the new place of the tip)."""
from collections import namedtuple
import numpy as np


def decay(u, lam, dt):
    """y[n] = e^(lam dt) y[n-1] + u[n], y[-1] = 0, in blocks; lam may be complex."""
    size, r = 128, np.exp(lam * dt)
    p = r ** np.arange(size + 1)
    i = np.arange(size)
    low = np.where(i[:, None] >= i[None, :], p[np.abs(i[:, None] - i[None, :])], 0)
    n = len(u)
    y = np.concatenate([u, np.zeros(-n % size, u.dtype)]).reshape(-1, size) @ low.T
    carry = 0.0
    for row in y:
        row += carry * p[1:]
        carry = row[-1]
    return y.reshape(-1)[:n]


def lag(u, tau, dt):  # tau y' = u - y, y(0) = u(0)
    if tau < 1e-7:
        return u.copy()
    mid = np.concatenate([[0.0], (u[1:] + u[:-1]) / 2 - u[0]])
    return u[0] + decay((1 - np.exp(-dt / tau)) * mid, -1 / tau, dt)


def play(x, b):  # x <= y <= x + b: the surface was set on the way in; on the way out the tip stays behind by b
    out, y = [], x[0]
    for q in x.tolist():
        y = q if y < q else (q + b if y > q + b else y)
        out.append(y)
    return np.array(out)


def loop(x, d, inside):  # z' = V - |V| z / d, so over a step z -> +-d + (z -+ d) e^(-|dx| / d); z = 0 outside
    step = np.diff(x, prepend=x[0])
    out, z = [], 0.0
    for e, s, on in zip(np.exp(-np.abs(step) / d).tolist(), (np.sign(step) * d).tolist(), inside.tolist()):
        z = s + (z - s) * e if on else 0.0
        out.append(z)
    return np.array(out)


def turns(s):  # integral of rpm / 60 from the session's start
    rate = s.true["spindle_rpm"] / 60
    return np.cumsum(rate) * s.dt - (rate + rate[0]) * s.dt / 2


def series(s, F, p):  # F (1 + k/ks) + (c/ks) F' = k X + c V: a smaller k, and a lag of c/(k + ks)
    return lag(F / (1 + s.k / p["ks_n_per_mm"]), s.c / (s.k + p["ks_n_per_mm"]), s.dt) - F


def relax(s, F, p):  # z' = (X+)' - z/tau, force k1 z (the spring and dashpot in series rests against the tissue)
    rate = np.diff(np.maximum(s.y, 0), prepend=max(s.y[0], 0))
    half = np.exp(-s.dt / 2 / p["tau1_s"])
    z = p["k1_n_per_mm"] * decay(rate * half, -1 / p["tau1_s"], s.dt)
    if "k2_n_per_mm" in p:
        z += p["k2_n_per_mm"] * decay(rate * np.exp(-s.dt / 2 / p["tau2_s"]), -1 / p["tau2_s"], s.dt)
    return z


def ripple(s, F, p):
    phase = p["phase_turns"] + (p["session_phase"][s.i] if "session_phase" in p else 0)
    return p["amplitude_n"] * np.sin(2 * np.pi * (turns(s) + phase)) * (s.y > 0) * (s.true["spindle_rpm"] > 0)


def stribeck(s, F, p):
    f = p["fc_n"] + (p["fs_n"] - p["fc_n"]) * np.exp(-(s.v / p["vs_mm_s"]) ** 2)
    return f * np.tanh(s.v / p["v0_mm_s"])


def drift(s, F, p):
    t = s.t + s.t0 if p.get("day") else s.t
    return p["amplitude_n"] * (1 - np.exp(-t / p["tau_s"])) if "tau_s" in p else p["rate_n_per_s"] * t


def own(s, values):
    return values[s.i % len(values)]


SIGNS = [0.9, -0.6, 1.1, -1.0, 0.3, -0.8, 0.6, -0.4, 1.0, -0.9]
UP, NEAR1, INVERSE, PEAK = "times s", "1 + (p - 1) s", "p / s", "peak / (1 + p s)"
# how = the way each scaled parameter goes with the scale s; needs = columns; variable = what the effect depends on
Law = namedtuple("Law", "stage add start how variable needs mechanism", defaults=("v_mm_s", (), None))
LAWS = {
    "contact_offset": Law("tip", lambda s, F, p: s.y + own(s, p["delta_mm"]), {"delta_mm": [0.01 * q for q in SIGNS]}, {"delta_mm": UP}, "session"),
    "backlash": Law("tip", lambda s, F, p: play(s.y, p["b_mm"]), {"b_mm": 0.02}, {"b_mm": UP}, "x_mm"),
    "series_compliance": Law("tissue", lambda s, F, p: s.k * s.y / (1 + s.k * s.y / p["softening_force_n"]) - s.k * s.y,
                             {"softening_force_n": 40.0}, {"softening_force_n": INVERSE}, "x_mm"),
    "nonlinear_stiffness": Law("tissue", lambda s, F, p: s.k * (s.y ** p["m"] - s.y), {"m": 1.05}, {"m": NEAR1}, "x_mm"),
    "hidden_layer": Law("tissue", lambda s, F, p: p["dk_n_per_mm"] * np.maximum(s.y - p["d0_mm"], 0), {"dk_n_per_mm": 0.1, "d0_mm": 0.8},
                        {"dk_n_per_mm": UP}, "x_mm"),
    "graded_stiffness": Law("tissue", lambda s, F, p: -s.k * p["alpha_per_mm"] * s.y**2, {"alpha_per_mm": 0.05}, {"alpha_per_mm": UP}, "x_mm"),
    "feed_power_law": Law("tissue", lambda s, F, p: s.c * (np.sign(s.v) * np.abs(s.v) ** p["n"] - s.v), {"n": 0.95}, {"n": NEAR1}),
    "relaxation": Law("tissue", relax, {"k1_n_per_mm": 0.1, "tau1_s": 0.35}, {"k1_n_per_mm": UP, "k2_n_per_mm": UP}, "t_s"),
    "hysteresis": Law("tissue", lambda s, F, p: p["alpha_n_per_mm"] * loop(s.y, p["d_mm"], s.y > 0), {"alpha_n_per_mm": 0.1, "d_mm": 0.12},
                      {"alpha_n_per_mm": UP}, "x_mm"),
    "edge_force": Law("tissue", lambda s, F, p: p["edge_n"] * (s.true["spindle_rpm"] > 0), {"edge_n": 0.02}, {"edge_n": UP}, "spindle_rpm",
                      ("spindle_rpm",)),
    "anisotropy": Law("contact", lambda s, F, p: F * p["epsilon"] * np.cos(2 * np.radians(s.true["approach_deg"] - p["phi0_deg"])),
                      {"epsilon": 0.02, "phi0_deg": 20.0}, {"epsilon": UP}, "approach_deg", ("approach_deg",)),
    "wear": Law("contact", lambda s, F, p: F * p["per_mm3"] * s.true["removed_mm3"], {"per_mm3": 0.01}, {"per_mm3": UP}, "removed_mm3", ("removed_mm3",)),
    "coolant": Law("contact", lambda s, F, p: F * p["fraction"] * s.true["wet"], {"fraction": -0.02}, {"fraction": UP}, "wet", ("wet",)),
    "thermal_softening": Law("contact", lambda s, F, p: -F * p["per_k"] * (s.true["temperature_c"] - s.first_c), {"per_k": 0.005}, {"per_k": UP},
                             "temperature_c", ("temperature_c",)),
    "run_out": Law("contact", ripple, {"amplitude_n": 0.02, "phase_turns": 0.15}, {"amplitude_n": UP}, "spindle_rpm", ("spindle_rpm",)),
    "chatter": Law("contact", lambda s, F, p: p["amplitude_n"] * np.sin(2 * np.pi * (p["frequency_hz"] * s.t + p["phase_turns"])) * (s.y > 0),
                   {"amplitude_n": 0.02, "frequency_hz": 31.7, "phase_turns": 0.3}, {"amplitude_n": UP}, "t_s"),
    "series_lag": Law("contact", series, {"ks_n_per_mm": 30.0}, {"ks_n_per_mm": INVERSE}, "t_s", (), "series_compliance"),
    "coulomb_friction": Law("machine", lambda s, F, p: p["fc_n"] * np.tanh(s.v / p["v0_mm_s"]), {"fc_n": 0.02, "v0_mm_s": 0.2}, {"fc_n": UP}),
    "stribeck_friction": Law("machine", stribeck, {"fc_n": 0.01, "fs_n": 0.04, "vs_mm_s": 1.0, "v0_mm_s": 0.05}, {"fc_n": UP, "fs_n": UP}),
    # dry friction that sticks: the force stays when the stage stops, and turns over within d of travel (Dahl)
    "stick": Law("machine", lambda s, F, p: p["fc_n"] * loop(s.x, p["d_mm"], s.x < np.inf) / p["d_mm"], {"fc_n": 0.02, "d_mm": 0.02}, {"fc_n": UP},
                 "v_mm_s", (), "coulomb_friction"),
    "viscous_friction": Law("machine", lambda s, F, p: p["b_n_s_per_mm"] * s.v, {"b_n_s_per_mm": 0.005}, {"b_n_s_per_mm": UP}),
    "inertia": Law("machine", lambda s, F, p: p["mass_kg"] * s.a / 1000, {"mass_kg": 0.05}, {"mass_kg": UP}, "a"),
    "gravity_posture": Law("machine", lambda s, F, p: p["weight_n"] * (np.sin(np.radians(s.true[p.get("column", "posture_deg")]))
                           - np.sin(np.radians(p["theta0_deg"]))), {"weight_n": 0.05, "theta0_deg": 12.0}, {"weight_n": UP}, "posture_deg", ("posture_deg",)),
    "cross_talk": Law("machine", lambda s, F, p: p["a"] * s.true["fy_n"] + p["b"] * s.true["fz_n"], {"a": 0.01, "b": -0.006}, {"a": UP, "b": UP}, "fy_n",
                      ("fy_n", "fz_n")),
    # outside the list
    "screw_error": Law("tip", lambda s, F, p: s.y + p["amp_mm"] * np.sin(2 * np.pi * s.x / p["lead_mm"]), {"amp_mm": 0.005, "lead_mm": 0.5},
                       {"amp_mm": UP}, "x_mm", (), ""),
    "cable": Law("machine", lambda s, F, p: p["k_cable"] * np.maximum(-s.x - 0.6, 0), {"k_cable": 0.02}, {"k_cable": UP}, "x_mm", (), ""),
    "room": Law("channel", lambda s, F, p: p["n_per_k"] * (s.true["room_c"] - 22), {"n_per_k": 0.02}, {"n_per_k": UP}, "room_c", ("room_c",), ""),
    "two_clocks": Law("channel", lambda s, F, p: np.interp(s.t - p["rate"] * s.t, s.t, F) - F, {"rate": 2e-4}, {"rate": UP}, "t_s", (), ""),
    "low_pass": Law("channel", lambda s, F, p: lag(F, p["tau_s"], s.dt) - F, {"tau_s": 0.004}, {"tau_s": UP}, "t_s"),
    # a filter of two equal poles, as a strain gauge amplifier has: tau each, so it lags by 2 tau
    "amplifier": Law("channel", lambda s, F, p: lag(lag(F, p["tau_s"], s.dt), p["tau_s"], s.dt) - F, {"tau_s": 0.002}, {"tau_s": UP}, "t_s", (), "low_pass"),
    "delay": Law("channel", lambda s, F, p: np.interp(s.t - own(s, np.atleast_1d(p["tau_s"])), s.t, F) - F, {"tau_s": 0.003}, {"tau_s": UP}, "t_s"),
    "gain_error": Law("channel", lambda s, F, p: p["gain"] * F, {"gain": 0.05}, {"gain": UP}, "f_n"),
    "saturation": Law("channel", lambda s, F, p: np.minimum(F, p["f_max_n"]) - F, {"f_max_n": 0.05}, {"f_max_n": PEAK}, "f_n"),
    "bias": Law("channel", lambda s, F, p: np.full(len(F), own(s, np.atleast_1d(p["bias_n"]))), {"bias_n": 0.02}, {"bias_n": UP}, "f_n"),
    "drift": Law("channel", drift, {"rate_n_per_s": 0.003}, {"rate_n_per_s": UP, "amplitude_n": UP}, "t_s"),
}
STAGES = ["tissue", "contact", "machine", "channel"]


def force(s, effects):
    """The force of one session on the fine grid. Contact only where the tip is in the tissue, and tissue never pulls."""
    live = [(LAWS[n], p) for n, p in effects if p.get("only") in (None, s.i)]
    s.y = s.x
    for law, p in live:
        if law.stage == "tip":
            s.y = law.add(s, None, p)
    touch = s.y > 0
    keep, s.y = s.y, np.where(touch, s.y, 0.0)
    F = s.k * s.y + s.c * s.v  # F = max(0, k X + c V), and 0 for X <= 0
    for stage in STAGES:
        for law, p in live:
            if law.stage == stage:
                F = F + law.add(s, F, p)
        if stage == "tissue":
            F = np.where(touch, np.maximum(F, 0), 0.0)
    s.y = keep
    return F


def scaled(name, p, scale, peak):
    """Parameters at a scale: each scaled parameter goes its own way."""
    out = dict(p)
    for key, how in LAWS[name].how.items():
        if key in out:
            q = np.asarray(out[key], float)
            q = {UP: lambda: q * scale, NEAR1: lambda: 1 + (q - 1) * scale, INVERSE: lambda: q / scale, PEAK: lambda: peak / (1 + q * scale)}[how]()
            out[key] = q.tolist()
    return out
