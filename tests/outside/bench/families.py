"""The families: what each hides, on which bench, with which one difficulty. s: strength, 1 as a bench would meet it;
b: the bench drawn."""
import numpy as np

# the benches, as ranges: k N/mm, depth mm, slow and fast mm/s, rate Hz, damping: c fast / (k depth)
BENCHES = {
    "indenter": dict(k=(0.5, 5), depth=(0.8, 2.5), slow=(0.5, 1), fast=(6, 12), rate=(100, 200, 250), bandwidth=10,
                     hold=2.5, damping=(0.1, 0.4)),
    "servo": dict(k=(5, 30), depth=(0.3, 1.0), slow=(1, 3), fast=(30, 60), rate=(250, 500, 1000), bandwidth=30,
                  hold=1.2, damping=(0.1, 0.4)),
    "voicecoil": dict(k=(0.3, 3), depth=(1, 3), slow=(8, 15), fast=(100, 300), rate=(500, 1000), bandwidth=45,
                      hold=0.6, damping=(0.1, 0.5)),
    "handpiece": dict(k=(1, 8), depth=(0.5, 2), slow=(1, 2), fast=(20, 40), rate=(250, 500, 1000), bandwidth=20,
                      hold=1.0, damping=(0.1, 0.4)),
}
ANY = ("indenter", "servo", "voicecoil", "handpiece")
FAMILIES = {}
PLAIN = dict(noise="white", v="exact", x_noise=0.0, x_quantum=1e-5, f_quantum=0.0, nuisance={}, benches=ANY,
             motions="sawtooth sines staircase pecking",
             sampling="regular", sessions=(4, 7), columns="", laws=(), rows="contact", only=None)
MIXED = dict(PLAIN, noise=("white", "white", "ar1", "pink", "two_scales", "heavy", "hetero"),
             v=("none", "exact", "central", "causal", "tacho"),
             x_noise=(0.0, 0.0, 1e-3, 2e-3), nuisance="drawn")


def clean(name, **k):
    FAMILIES["clean." + name] = dict(PLAIN, kind="clean", **{**dict(laws=()), **k})


def hides(kind, name, *laws, **k):
    FAMILIES[f"{kind}.{name}"] = {**MIXED, "kind": kind, "laws": laws, **k}


# laws at strength s --------------------------------------------------------------------------------
def e(b):
    return 0.02 * b["force"]


def coulomb(share=0.1):
    return "coulomb_friction", lambda s, b: dict(fc_n=e(b) * s, v0_mm_s=share * b["slow"])


def stribeck(share=0.3):
    return "stribeck_friction", lambda s, b: dict(
        fc_n=e(b) * s, fs_n=2.2 * e(b) * s, vs_mm_s=share * (b["slow"] * b["fast"]) ** 0.5, v0_mm_s=0.1 * b["slow"])


def late(law, ms):
    return law, lambda s, b: dict(tau_s=ms * 1e-3 * s)


def relax(tau, tau2=None, sign=1):
    if tau2:
        return "relaxation", lambda s, b: dict(k1_n_per_mm=0.08 * b["k"] * s, tau1_s=tau,
                                               k2_n_per_mm=0.06 * b["k"] * s, tau2_s=tau2)
    return "relaxation", lambda s, b: dict(k1_n_per_mm=sign * 0.1 * b["k"] * s, tau1_s=tau)


def slip(d):
    return "hysteresis", lambda s, b: dict(alpha_n_per_mm=0.1 * b["k"] * s * 0.15 / d, d_mm=d * b["depth"])


def play(share, law="backlash"):
    return law, lambda s, b: dict(b_mm=share * b["depth"] * s)


def layer(depth, sign=1):
    return "hidden_layer", lambda s, b: dict(dk_n_per_mm=sign * 0.15 * b["k"] * s, d0_mm=depth * b["depth"])


def tone(law, share, hz=None):
    return law, lambda s, b: dict(amplitude_n=e(b) * s, frequency_hz=hz or round(share * b["rate"], 1),
                                  phase_turns=0.3)


def ring(share, mass=0.0):
    return "ringing", lambda s, b: dict(share=0.4 * s, frequency_hz=round(share * b["rate"], 1), damping_ratio=0.04,
                                        mass_kg=mass * heavy(b) * s)


def heavy(b):
    """The mass in kg whose inertia is about 2 % of the force on this bench."""
    return 1000 * e(b) / (b["fast"] * 2 * np.pi * b["bandwidth"] * 0.2)


BIAS = "bias", lambda s, b: dict(bias_n=0.04 * b["force"] * s)
DRIFT = "drift", lambda s, b: dict(rate_n_per_s=0.08 * b["force"] * s / b["seconds"])
DRIFT_EXP = "drift", lambda s, b: dict(amplitude_n=0.1 * b["force"] * s, tau_s=0.25 * b["seconds"])
OFFSET = "contact_offset", lambda s, b: {
    f"delta_{i + 1}_mm": 0.03 * b["depth"] * s * b["draw"][i] for i in range(b["sessions"])}
OFFSET_ALL = "contact_offset", lambda s, b: {f"delta_{i + 1}_mm": 0.03 * b["depth"] * s for i in range(b["sessions"])}
VISCOUS = "viscous_friction", lambda s, b: dict(b_n_s_per_mm=0.05 * b["force"] / b["fast"] * s)
GRAVITY = "gravity_posture", lambda s, b: dict(weight_n=0.06 * b["force"] * s, theta0_deg=10.0)
INERTIA = "inertia", lambda s, b: dict(mass_kg=heavy(b) * s)
CROSS = "cross_talk", lambda s, b: dict(a=0.06 * s, b=-0.04 * s)
SATURATION = "saturation", lambda s, b: dict(f_max_n=b["peak"] * max(0.2, 1 - 0.15 * s))
SATURATION_RARE = "saturation", lambda s, b: dict(f_max_n=b["peak"] * max(0.2, 1 - 0.05 * s))
SOFTENING = "series_compliance", lambda s, b: dict(softening_force_n=12 * b["force"] / s)
COMPLIANT = "series_compliance", lambda s, b: dict(ks_n_per_mm=8 * b["k"] / s)
STIFFENING = "nonlinear_stiffness", lambda s, b: dict(m=min(1 + 0.08 * s, 4.0))
WEAKENING = "nonlinear_stiffness", lambda s, b: dict(m=max(1 - 0.08 * s, 0.15))
GRADED = "graded_stiffness", lambda s, b: dict(alpha_per_mm=0.1 * s / b["depth"])
GRADED_UP = "graded_stiffness", lambda s, b: dict(alpha_per_mm=-0.1 * s / b["depth"])
ANISOTROPY = "anisotropy", lambda s, b: dict(epsilon=0.05 * s, phi0_deg=25.0)
FEED_LOW = "feed_power_law", lambda s, b: dict(n=max(1 - 0.15 * s, 0.1))
FEED_HIGH = "feed_power_law", lambda s, b: dict(n=1 + 0.06 * s)
EDGE = "edge_force", lambda s, b: dict(edge_n=0.05 * b["force"] * s)
WEAR = "wear", lambda s, b: dict(per_mm3=0.12 * s)
RUN_OUT = "run_out", lambda s, b: dict(amplitude_n=e(b) * s, phase_turns=0.3)
COOLANT = "coolant", lambda s, b: dict(fraction=-0.08 * s)
COOLANT_UP = "coolant", lambda s, b: dict(fraction=0.08 * s)
THERMAL = "thermal_softening", lambda s, b: dict(per_k=0.015 * s)
GAIN = "gain_error", lambda s, b: dict(gain=0.07)
HUNT = "hunt_crossley", lambda s, b: dict(lambda_n_s_per_mm2=0.6 * b["c"] / b["depth"] * s)
COGGING = "cogging", lambda s, b: dict(amplitude_n=e(b) * s, pitch_mm=round(0.21 * b["depth"], 3))
AGEING = "memory_log", lambda s, b: dict(amplitude_n=0.02 * b["force"] * s)

# clean ---------------------------------------------------------------------------------------------
for kind in ("exact", "none", "central", "causal", "quantised", "lowres", "tacho"):
    clean("v_" + {"none": "absent", "lowres": "low_resolution"}.get(kind, kind), v=kind,
          **(dict(x_quantum=2e-3) if kind == "lowres" else {}))
for um in (1, 5, 20):
    clean(f"x_noise_{um}um", x_noise=um * 1e-3, v="none")
clean("encoder_10um", x_quantum=0.01, v="central")
for kind, name in (("ar1", "ar1_noise"), ("pink", "pink_noise"), ("walk", "random_walk"),
                   ("two_scales", "two_time_scales"), ("hum", "noise_hum"),
                   ("ring", "noise_ring"), ("heavy", "heavy_tails"), ("hetero", "noise_grows_with_force")):
    clean(name, noise=kind)
clean("pink_noise_v_absent", noise="pink", v="none", x_noise=2e-3)
clean("force_quantised", f_quantum=0.02)
clean("k_by_session", nuisance=dict(k=0.1))
clean("surface_by_session", nuisance=dict(surface=0.05))
clean("bias_by_session", nuisance=dict(bias=1.0))
clean("delay_by_session", nuisance=dict(delay=1e-3))
clean("three_sessions", sessions=(3, 3))
clean("twelve_sessions", sessions=(12, 12))
clean("one_session", sessions=(1, 1))
clean("unequal_sessions", unequal=True)
clean("irregular_sampling", sampling="irregular", v="none")
clean("rows_missing", sampling="missing")
clean("rate_100", benches=("indenter",), rate=100)
clean("rate_1000", benches=("servo", "voicecoil"), rate=1000)
clean("soft_tissue", benches=("indenter",), k=0.3, noise="ar1")
clean("hard_tissue", benches=("servo",), k=30.0, noise="ar1")
clean("fast_300", benches=("voicecoil",), depth=4.0, slow=60.0, fast=360.0, bandwidth=120, v="central",
      motions="sawtooth prbs chirp")
clean("slow_1", benches=("indenter",), slow=0.15, fast=1.0, hold=5.0)
clean("drilling_passes", benches=("handpiece",), motions="passes pecking", v="causal")
clean("cyclic_fatigue", benches=("servo",), motions="cyclic", v="none")
clean("units_foreign", units=True, v="none")
clean("machine_coordinates", machine=True, v="none")
clean("idle_columns", columns="posture_deg wet spindle_rpm temperature_c approach_deg fy_n")
clean("gain_error_unseen", laws=(GAIN,), fixed=True)
clean("all_mixed", **{n: MIXED[n] for n in ("noise", "v", "x_noise", "nuisance")})

# effects -------------------------------------------------------------------------------------------
LOOPS, HOLDS = "sawtooth inside cyclic pecking", "creep staircase sawtooth sines"
FAST = dict(benches=("servo", "voicecoil", "handpiece"), motions="sawtooth prbs chirp pecking")
CUT = dict(benches=("handpiece",), motions="passes pecking sawtooth")
hides("effect", "drift_linear", DRIFT, benches=("indenter", "handpiece"))
hides("effect", "drift_exponential", DRIFT_EXP, benches=("indenter", "handpiece"))
hides("effect", "contact_offset_by_session", OFFSET, nuisance={})
hides("effect", "contact_offset_common", OFFSET_ALL, nuisance={})
hides("effect", "bias", BIAS, nuisance=dict(k=0.03))
hides("effect", "coulomb_ratio_0p1", coulomb(), benches=("indenter",), slow=0.2, fast=2.0, fc_over_c=0.1,
      motions=LOOPS)
hides("effect", "coulomb_ratio_1", coulomb(), benches=("indenter",), fc_over_c=1.0, motions=LOOPS)
hides("effect", "coulomb_ratio_10", coulomb(), benches=("servo", "handpiece"), fc_over_c=10.0, motions=LOOPS)
hides("effect", "coulomb_slow", coulomb(2.0), benches=("indenter",), motions="sawtooth inside sines")
hides("effect", "coulomb_prbs", coulomb(), motions="prbs sawtooth", benches=("voicecoil", "servo"))
hides("effect", "coulomb_one_session", coulomb(), sessions=(1, 1), nuisance={})
hides("effect", "stribeck_slow", stribeck(0.3), benches=("indenter",), slow=0.1, fast=4.0,
      motions="speeds inside sawtooth")
hides("effect", "stribeck_wide", stribeck(1.5), benches=("handpiece", "servo"), motions="speeds inside sawtooth")
hides("effect", "gravity_tilting_table", GRAVITY, columns="posture_deg", benches=("indenter", "handpiece"))
hides("effect", "inertia_voicecoil", INERTIA, benches=("voicecoil",), motions="sawtooth prbs chirp", x_noise=0.0)
hides("effect", "inertia_noisy_encoder", INERTIA, benches=("servo", "voicecoil"), motions="sawtooth prbs chirp",
      x_noise=1e-3, v=("none", "central"))
hides("effect", "cross_talk_lateral", CROSS, columns="fy_n fz_n")
hides("effect", "delay_1ms", late("delay", 1), v=("exact", "tacho", "none"), x_noise=0.0, **FAST)
hides("effect", "delay_5ms", late("delay", 5), **FAST)
hides("effect", "delay_20ms", late("delay", 20), benches=("indenter", "handpiece"),
      motions="sawtooth inside pecking sines")
hides("effect", "delay_coarse_encoder", late("delay", 8), x_quantum=0.01, v=("none", "lowres"), x_noise=0.0, **FAST)
hides("effect", "low_pass_fast", late("low_pass", 3), **FAST)
hides("effect", "low_pass_slow", late("low_pass", 25), benches=("indenter", "handpiece"),
      motions="sawtooth staircase pecking prbs")
hides("effect", "force_ahead_fine", late("position_late", 3), x_noise=0.0, **FAST)
hides("effect", "force_ahead_coarse", late("position_late", 8), x_quantum=0.01, x_noise=0.0, v=("none", "causal"),
      **FAST)
hides("effect", "position_filtered", late("position_filtered", 6), **FAST)
hides("effect", "ringing_holder", ring(0.12), **FAST)
hides("effect", "ringing_mass", ring(0.15, 0.5), benches=("servo", "voicecoil"), motions="sawtooth prbs pecking")
hides("effect", "saturation_often", SATURATION)
hides("effect", "saturation_rare", SATURATION_RARE)
hides("effect", "backlash_small", play(0.01), motions=LOOPS, x_noise=0.0)
hides("effect", "backlash_large", play(0.05), motions=LOOPS)
hides("effect", "backlash_loose_collet", play(0.02, "backlash_tip"), motions=LOOPS, benches=("handpiece", "indenter"))
hides("effect", "hysteresis_short", slip(0.04), motions=LOOPS)
hides("effect", "hysteresis_long", slip(0.4), motions=LOOPS)
hides("effect", "compliance_softening", SOFTENING)
hides("effect", "compliance_damped", COMPLIANT, damping=0.8, **FAST)
hides("effect", "stiffening", STIFFENING)
hides("effect", "weakening", WEAKENING)
hides("effect", "layer_stiff", layer(0.5))
hides("effect", "layer_crust", layer(0.15, -1))
hides("effect", "graded_softer", GRADED)
hides("effect", "graded_stiffer", GRADED_UP, benches=("indenter", "handpiece"))
hides("effect", "anisotropy_four_angles", ANISOTROPY, columns="approach_deg", motions="sawtooth pecking passes")
hides("effect", "relaxation_fast", relax(0.05), benches=("servo", "voicecoil", "handpiece"), motions=HOLDS)
hides("effect", "relaxation_slow", relax(2.0), benches=("indenter",), motions=HOLDS)
hides("effect", "relaxation_two_times", relax(0.15, 3.0), benches=("indenter",), motions=HOLDS)
hides("effect", "feed_power_low", FEED_LOW, motions="speeds sawtooth sines", damping=0.4)
hides("effect", "feed_power_high", FEED_HIGH, motions="speeds sawtooth sines", damping=0.4)
hides("effect", "edge_force", EDGE, columns="spindle_rpm", **CUT)
hides("effect", "wear", WEAR, columns="spindle_rpm removed_mm3", **CUT)
hides("effect", "run_out", RUN_OUT, columns="steady_rpm", rate=500, **CUT)
hides("effect", "run_out_free_phase", RUN_OUT, columns="steady_rpm", rate=500, free=True, **CUT)
hides("effect", "chatter", tone("chatter", 0.17), rate=500, **CUT)
hides("effect", "chatter_free_phase", tone("chatter", 0.17), rate=500, free=True, **CUT)
hides("effect", "coolant", COOLANT, columns="wet spindle_rpm", **CUT)
hides("effect", "thermal_softening", THERMAL, columns="temperature_c", **CUT)

# in air, pick-up, in some sessions only, unlisted --------------------------------------------------
AIR = dict(motions="air air air sawtooth", rows="air")
hides("air", "bias", BIAS, nuisance={}, **AIR)
hides("air", "coulomb_strokes", coulomb(), **AIR)
hides("air", "viscous_strokes", VISCOUS, benches=("voicecoil", "servo"), **AIR)
hides("air", "inertia_shake", INERTIA, benches=("voicecoil",), **AIR)
hides("air", "gravity_postures", GRAVITY, columns="posture_deg", **AIR)
hides("air", "drift_hold", DRIFT, benches=("indenter",), **AIR)
hides("air", "nothing", **AIR)
hides("air", "never_touches", motions="air", rows="air", nuisance={})
hides("interference", "mains_50", tone("interference", 0, 50.0), rate=500, benches=("servo", "handpiece"))
hides("interference", "mains_free_phase", tone("interference", 0, 50.0), rate=500, benches=("servo", "handpiece"),
      free=True)
hides("interference", "alias_of_drive", tone("interference", 0.382))
hides("interference", "pump_1p7", tone("interference", 0, 1.7), benches=("indenter", "handpiece"))
hides("session_only", "coulomb_one", coulomb(), only=1)
hides("session_only", "delay_two", late("delay", 6), only=2, **FAST)
hides("session_only", "drift_one", DRIFT, only=1)
hides("session_only", "relaxation_half", relax(1.0), only=3, sessions=(6, 6), benches=("indenter",), motions=HOLDS)
hides("session_only", "stiff_one", odd=dict(k=1.35))
hides("session_only", "noisy_one", odd=dict(noise=4.0))
hides("unlisted", "hunt_crossley", HUNT, nuisance={}, motions="speeds sawtooth inside", damping=0.4)
hides("unlisted", "cogging", COGGING, nuisance={})
hides("unlisted", "contact_ageing", AGEING, nuisance={}, benches=("indenter",), motions=HOLDS)

# pairs ---------------------------------------------------------------------------------------------
hides("pair", "relaxation_friction", relax(1.5), coulomb(), benches=("indenter",),
      motions="creep staircase sawtooth inside")
hides("pair", "relaxation_delay", relax(0.5), late("delay", 6), benches=("handpiece", "servo"),
      motions="creep staircase sawtooth pecking")
hides("pair", "backlash_coulomb", play(0.02), coulomb(), motions=LOOPS)
hides("pair", "hysteresis_drift", slip(0.15), DRIFT, benches=("indenter", "handpiece"), motions=LOOPS)
hides("pair", "stiffening_coulomb", STIFFENING, coulomb(), motions=LOOPS)
hides("pair", "layer_delay", layer(0.5), late("delay", 5), **FAST)
hides("pair", "inertia_low_pass", INERTIA, late("low_pass", 3), benches=("voicecoil",),
      motions="sawtooth prbs chirp air")
hides("pair", "offset_relaxation", OFFSET, relax(1.0), benches=("indenter",), motions=HOLDS, nuisance={})
hides("pair", "coolant_edge", COOLANT_UP, EDGE, columns="wet spindle_rpm", **CUT)
hides("pair", "run_out_wear", RUN_OUT, WEAR, columns="steady_rpm removed_mm3", rate=500, **CUT)
hides("pair", "coulomb_inertia", coulomb(), INERTIA, benches=("voicecoil",), motions="sawtooth prbs chirp air")
hides("pair", "anisotropy_graded", ANISOTROPY, GRADED, columns="approach_deg", motions="sawtooth pecking passes")
hides("pair", "cross_talk_coulomb", CROSS, coulomb(), columns="fy_n fz_n", motions=LOOPS)
hides("pair", "feed_power_saturation", FEED_LOW, SATURATION, motions="speeds sawtooth sines", damping=0.4)
hides("pair", "encoder_late_coulomb", late("position_late", 5), coulomb(), **FAST)
hides("pair", "pickup_hysteresis", tone("interference", 0, 50.0), slip(0.1), rate=500, benches=("servo", "handpiece"),
      motions=LOOPS)
