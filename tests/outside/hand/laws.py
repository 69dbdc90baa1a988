"""Each law of docs/laws.md, written anew from its equation. A recording holds a list of (mechanism, parameters, session or None)."""
import numpy as np
from motion import DT, bouc_wen, in_contact, lag, pi, play

def spin(s):  # turns = integral of rpm/60
    turns = np.cumsum(s.rpm) * DT / 60
    return turns - np.interp(0, s.t, turns)  # 0 at the first row of the session
tanh = lambda s, p: np.tanh(s.V / p["v0_mm_s"])
def dahl(s, d):  # kept: it does not change with the size
    if not hasattr(s, "kept"):
        s.kept = bouc_wen(s.X, d) / d
    return s.kept
INSIDE = {  # added inside max(0, .) while X > 0: s, X, p
    "series_compliance": lambda s, X, p: s.k * X / (1 + s.k * X / p["softening_force_n"]) - s.k * X if "softening_force_n" in p else 0,
    "nonlinear_stiffness": lambda s, X, p: s.k * (np.maximum(X, 0) ** p["m"] - X),                      # k (X^m - X)
    "hidden_layer": lambda s, X, p: p["dk_n_per_mm"] * np.maximum(X - p["d0_mm"], 0),                   # dk (X - d0)+
    "graded_stiffness": lambda s, X, p: -s.k * p["alpha_per_mm"] * X**2,                                # -k alpha X^2
    "feed_power_law": lambda s, X, p: s.c * (np.abs(s.V) ** p["n"] * np.sign(s.V) - s.V),               # c (|V|^n sgn V - V)
    "hysteresis": lambda s, X, p: p["alpha_n_per_mm"] * in_contact(lambda x: bouc_wen(np.r_[0, x], p["d_mm"], p.get("gamma", 0))[1:], X > 0, X),
    "relaxation": lambda s, X, p: sum(p[f"k{i}_n_per_mm"] * p[f"tau{i}_s"] * in_contact(lambda v: lag(v, p[f"tau{i}_s"]), X > 0, s.V)
                                      for i in (1, 2) if f"k{i}_n_per_mm" in p),                        # k_i integral e^(-(t-s)/tau_i) V ds
    "edge_force": lambda s, X, p: p["edge_n"] * (s.rpm > 0),
    "run_out": lambda s, X, p: p["amplitude_n"] * np.sin(2 * pi * (spin(s) + p["phase_turns"] + s.phase)) * (s.rpm > 0),
    "chatter": lambda s, X, p: p["amplitude_n"] * np.sin(2 * pi * (p["frequency_hz"] * s.t + p["phase_turns"] + s.phase))}
FACTOR = {  # F_sim times
    "anisotropy": lambda s, p: p["epsilon"] * np.cos(2 * np.radians(s.approach_deg - p["phi0_deg"])),
    "wear": lambda s, p: p["per_mm3"] * s.removed_mm3, "coolant": lambda s, p: p["fraction"] * s.wet,
    "thermal_softening": lambda s, p: -p["per_k"] * (s.temperature_c - s.t0_c)}
OUTSIDE = {  # added in air, too
    "coulomb_friction": lambda s, p: p["fc_n"] * (dahl(s, p["stick_mm"]) if "stick_mm" in p else tanh(s, p)),  # Fc tanh(V/v0), or Dahl
    "stribeck_friction": lambda s, p: (p["fc_n"] + (p["fs_n"] - p["fc_n"]) * np.exp(-(s.V / p["vs_mm_s"]) ** 2)) * tanh(s, p),
    "viscous_friction": lambda s, p: p["b_n_s_per_mm"] * s.V, "inertia": lambda s, p: p["mass_kg"] * s.A / 1000,  # m a, a in mm/s^2
    "gravity_posture": lambda s, p: p["weight_n"] * (np.sin(np.radians(s.posture_deg)) - np.sin(np.radians(p["theta0_deg"]))),
    "cross_talk": lambda s, p: p["a"] * s.fy_n + p["b"] * s.fz_n,
    "hum": lambda s, p: p["amplitude_n"] * np.sin(2 * pi * (p["frequency_hz"] * s.t + s.id * 0.37)),
    "spring_arm": lambda s, p: p["cable_n_per_mm"] * np.sin(s.X / 0.21),  # a cable that catches on its guide: depends on place, in no list
    "grip": lambda s, p: p["leak"] * s.grip_n}                            # the squeeze of the hand leaks into the sensor: a further column
AFTER = {"gain_error": lambda s, F, p: F * (1 + p["gain"]),
         "low_pass": lambda s, F, p: lag(F, p["tau_s"]), "delay": lambda s, F, p: np.interp(s.t - p["tau_s"], s.t, F),
         "saturation": lambda s, F, p: np.minimum(F, p["f_max_n"])}
LAST = {"bias": lambda s, p: np.atleast_1d(p["bias_n"])[min(s.id, np.size(p["bias_n"])) - 1],
        "drift": lambda s, p: p["rate_n_per_s"] * s.t if "rate_n_per_s" in p else p["amplitude_n"] * (1 - np.exp(-s.t / p["tau_s"]))}

def force(s, hidden):
    """F = max(0, k X + c V + terms) where X > 0; then what is felt in air; then the sensor; then its zero."""
    mine, X = [(m, p) for m, p, only in hidden if only in (None, s.id)], s.X
    for m, p in mine:
        X = X + p[f"delta_{s.id}_mm"] if m == "contact_offset" else play(X, p["b_mm"]) if m == "backlash" else X
    with np.errstate(invalid="ignore"):
        F = s.k * X + s.c * s.V + sum(INSIDE[m](s, X, p) for m, p in mine if m in INSIDE)
    for m, p in mine:  # F (1 + k/ks) + c F'/ks = k X + c V: a lag of c/(k + ks)
        if "ks_n_per_mm" in p:
            F = in_contact(lambda f: lag(f / (1 + s.k / p["ks_n_per_mm"]), s.c / (s.k + p["ks_n_per_mm"])), X > 0, F)
    F = np.where(X > 0, np.maximum(0, F), 0) * (1 + sum(FACTOR[m](s, p) for m, p in mine if m in FACTOR))
    F = F + sum(OUTSIDE[m](s, p) for m, p in mine if m in OUTSIDE)
    for m, p in mine:
        F = AFTER[m](s, F, p) if m in AFTER else F
    return F + sum(LAST[m](s, p) for m, p in mine if m in LAST)

# Parameters as a function of the scale g. u: k, depth, sign, peak force, fs, rng values fixed by the seed, number of sessions.
each = lambda u, sd: sd * (u.z[:u.n] - u.z[:u.n].mean())
PAR = {"bias": lambda g, u: dict(bias_n=g * u.sign * 0.02), "drift": lambda g, u: dict(rate_n_per_s=g * u.sign * 0.005),
       "contact_offset": lambda g, u: {f"delta_{i + 1}_mm": v for i, v in enumerate(each(u, 0.03 * g))},
       "coulomb_friction": lambda g, u: dict(fc_n=0.02 * g, v0_mm_s=u.top * 0.015), "viscous_friction": lambda g, u: dict(b_n_s_per_mm=g * 0.01),
       "stribeck_friction": lambda g, u: dict(fc_n=0.015 * g, fs_n=0.04 * g, vs_mm_s=u.top * 0.12, v0_mm_s=u.top * 0.008),
       "gravity_posture": lambda g, u: dict(weight_n=g * 0.1, theta0_deg=20.0), "inertia": lambda g, u: dict(mass_kg=0.03 * g),
       "cross_talk": lambda g, u: dict(a=0.04 * g, b=-0.02 * g), "delay": lambda g, u: dict(tau_s=0.003 * g), "low_pass": lambda g, u: dict(tau_s=0.003 * g),
       "saturation": lambda g, u: dict(f_max_n=u.peak / (1 + 0.1 * g)), "backlash": lambda g, u: dict(b_mm=0.02 * g),
       "hysteresis": lambda g, u: dict(alpha_n_per_mm=0.3 * g, d_mm=0.08 * u.depth), "series_compliance": lambda g, u: dict(softening_force_n=u.peak * 5 / g),
       "nonlinear_stiffness": lambda g, u: dict(m=1 + (0.1 * g if u.sign > 0 else -0.1 * g / (1 + 0.2 * g))), "graded_stiffness": lambda g, u: dict(alpha_per_mm=0.03 * g * u.sign),
       "hidden_layer": lambda g, u: dict(dk_n_per_mm=0.1 * u.k * g, d0_mm=0.45 * u.depth), "anisotropy": lambda g, u: dict(epsilon=0.02 * g, phi0_deg=25.0),
       "relaxation": lambda g, u: dict(k1_n_per_mm=0.1 * u.k * g, tau1_s=0.4), "feed_power_law": lambda g, u: dict(n=1 - 0.1 * g / (1 + 0.143 * g)),
       "edge_force": lambda g, u: dict(edge_n=0.04 * g), "wear": lambda g, u: dict(per_mm3=0.02 * g), "coolant": lambda g, u: dict(fraction=0.03 * g),
       "run_out": lambda g, u: dict(amplitude_n=0.02 * g, phase_turns=0.3), "chatter": lambda g, u: dict(amplitude_n=0.02 * g, frequency_hz=u.fs * 0.131, phase_turns=0.1),
       "thermal_softening": lambda g, u: dict(per_k=0.002 * g), "hum": lambda g, u: dict(amplitude_n=0.02 * g, frequency_hz=50.0),
       "spring_arm": lambda g, u: dict(cable_n_per_mm=0.02 * g), "grip": lambda g, u: dict(leak=0.01 * g), "gain_error": lambda g, u: dict(gain=0.03 * g)}
COLUMN = {"gravity_posture": ["posture_deg"], "anisotropy": ["approach_deg"], "cross_talk": ["fy_n", "fz_n"], "edge_force": ["spindle_rpm"], "run_out": ["spindle_rpm"],
          "wear": ["removed_mm3"], "coolant": ["wet"], "thermal_softening": ["temperature_c"], "grip": ["grip_n"]}
VARIABLE = {m: "v_mm_s" for m in ("coulomb_friction", "stribeck_friction", "viscous_friction", "feed_power_law", "inertia")} | {
    m: "t_s" for m in ("drift", "delay", "low_pass", "relaxation", "chatter", "hum")} | {m: c[0] for m, c in COLUMN.items()} | {"bias": "session", "contact_offset": "session", "saturation": "f_n"}
SOFT = ["nonlinear_stiffness", "graded_stiffness", "series_compliance"]  # one bend of force over depth: the same on a noisy hand
ALIAS = {"coulomb_friction": ["stribeck_friction"], "stribeck_friction": ["coulomb_friction"], "delay": ["low_pass"], "low_pass": ["delay"],
         **{m: SOFT for m in SOFT}}
