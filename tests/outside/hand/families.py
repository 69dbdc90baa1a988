"""The table: each row isolates one difficulty. Options are those of recording.BASE; a hidden effect is (mechanism, how)."""
from types import SimpleNamespace as NS
from recording import AIR

FAMILIES = {}
def row(name, text, hidden=(), kind=None, notes="", extra=None, **opts):
    hidden = [(h, {}) if isinstance(h, str) else h for h in hidden]
    if {h[0] for h in hidden} & {"delay", "low_pass", "backlash", "saturation", "series_compliance", "feed_power_law", "contact_offset", "wear",
                                 "thermal_softening", "coolant", "anisotropy"}:
        # on a soft tissue a lag of this size would be 50 ms, an offset 1 mm
        opts = {"k": 2.5, "c": 0.12} | opts
    kind = kind or ("units" if name.startswith("unit") else name.split(".")[0])
    notes = notes or ("names what is hidden" if hidden else "nothing beside k and c")
    FAMILIES[name] = NS(name=name, kind=kind, text=text, hidden=hidden, notes=notes, extra=extra or {}, opts=opts)
def honest(*names):  # clean, but these answers are no lie
    return {"accept_any": list(names)}

LATE = honest("delay", "low_pass")  # a pose of 120 Hz is 5 ms old on average: that it is late is true

# ---- 1, 2, 3: instruments. Each clean, and again with an effect: a false alarm and recall side by side
SPEEDS = {"v_exact": dict(), "v_absent": dict(v="absent"), "v_savgol": dict(v="savgol", xn=0.004), "v_gauss": dict(v="gauss", xn=0.004),
          "v_causal": dict(v="onepole", xn=0.002), "v_backward": dict(v="backward", xn=0.002), "v_quantised": dict(v="quantised"), "v_alphabeta": dict(v="alphabeta", xn=0.004),
          "v_scaled": dict(v="scaled")}
PLACES = {"x_exact": dict(xn=0, xq=0), "x_5um": dict(xn=0.005, xq=0), "x_20um": dict(xn=0.02, xq=0, v="savgol"), "x_encoder_55um": dict(xn=0.001, xq=0.055, v="absent"),
          "x_wander_20um": dict(xn=0.002, xw=0.02), "x_tracker_120hz": dict(tracker=120, xn=0.005, v="absent", fs=400), "x_late_packets": dict(repeat=0.08, xn=0.003, v="absent"),
          "x_dropped_rows": dict(drop=0.05, xn=0.003, v="savgol")}
NOISES = {"noise_ar1": "ar1", "noise_pink": "pink", "noise_walk": "walk", "noise_two_scale": "two", "noise_hum50": "hum50", "noise_hum60_aliased": "hum60",
          "noise_ring_jerk": "ring_jerk", "noise_ring_touch": "ring_touch", "noise_adc_resonance": "adc", "noise_bursts": "bursts", "noise_heavy": "heavy",
          "noise_of_each_session": ("white", "ar1", "two", "heavy")}
for n, w in SPEEDS.items():
    row("clean." + n, "hand and robot, " + n.replace("_", " "), **w)
for n, w in PLACES.items():
    row("clean." + n, "hand and robot, " + n.replace("_", " "), extra=LATE if "tracker" in w else None, **w)
for n, w in NOISES.items():
    row("clean." + n, "force with " + n.replace("_", " "), noise=w, fs=100 if "aliased" in n else 0, extra=honest("drift") if w == "walk" else honest("inertia", "chatter") if "ring" in n else None)
row("clean.usb_jitter", "time stamps late by 2 ms on average", jitter=0.002, v="savgol", xn=0.003, notes="nothing; that the clock is uneven may be said", extra=honest("delay"))
row("clean.rig_silent", "rig.toml knows neither k nor c", known=0)
row("clean.hand_only", "no robot: pecks, drifting holds, hesitation, tremor of 25 um", kinds=("pecks", "hold", "hesitate", "wander"), tremor=0.025, v="savgol", xn=0.004)
row("clean.robot_only", "joint strokes and sweeps, no tremor", kinds=("robot", "sweep", "air"), hand=0)
row("clean.jabs", "short jabs through the surface, little depth", kinds=("jab", "jab", "air", "pecks"), vtop=20.0)
row("clean.never_in_air", "the hand stays in contact", kinds=("wander", "sweep"), reach=0.02)

# ---- 6: each law that a hand can show. Not shown: drift of A and tau apart from R t (sessions are too short), gain_error but in one session
LAWS = ["coulomb_friction", "stribeck_friction", "viscous_friction", "inertia", "delay", "low_pass", "saturation", "backlash", "hysteresis", "nonlinear_stiffness", "graded_stiffness",
        "hidden_layer", "relaxation", "feed_power_law", "drift", "bias", "contact_offset", "gravity_posture", "cross_talk", "anisotropy", "wear", "coolant", "thermal_softening"]
for m in LAWS:
    row(f"effect.{m}", f"{m}, v exact", [m])
ks = dict(softening_force_n=None, ks_n_per_mm=lambda g, u: 60 * u.k / g, accept=["series_compliance", "relaxation", "low_pass", "delay"])
row("effect.series_softening", "softening k X/(1 + k X/Fs)", ["series_compliance"])
row("effect.series_spring", "a spring ks before k and c: all that k and c leave is a lag of c/(k + ks)", [("series_compliance", ks)], c=0.1, k=2.0, vtop=20.0)
row("effect.drift_warm_up", "A (1 - exp(-t/tau)) from the start of each session", [("drift", dict(rate_n_per_s=None, amplitude_n=lambda g, u: 0.05 * g * u.sign, tau_s=4.0))])
row("effect.relaxation_two", "two branches, 0.1 s and 2 s", [("relaxation", dict(tau1_s=0.1, k2_n_per_mm=lambda g, u: 0.06 * u.k * g, tau2_s=2.0))], kinds=("air", "hold", "pecks", "hold", "robot"))
row("effect.relaxation.usb_jitter", "relaxation with uneven stamps", [("relaxation", {})], jitter=0.002, v="absent", kinds=("air", "hold", "pecks", "robot"))
row("effect.hysteresis_gamma", "Bouc-Wen with gamma 0.3", [("hysteresis", dict(gamma=0.3))])
SPIN = dict(fs=500, rows=20000, rpm=4200)
row("effect.edge_force", "edges cut while the spindle turns; it goes on and off", ["edge_force"], **SPIN)
row("effect.run_out", "spindle of 70 Hz, index pulse starts the session", ["run_out"], **SPIN)
row("effect.run_out_free_phase", "the same, each session at its own phase", ["run_out"], free_phase=1, **SPIN)
row("effect.chatter", "a vibration of 0.131 fs in contact", ["chatter"])
row("effect.chatter_free_phase", "the same, each session at its own phase", ["chatter"], free_phase=1)
row("effect.outside.cable", "a cable catches on its guide: a force of the place, in air and contact; in no list", [("spring_arm", dict(named=None, accept=[]))], notes="left over, by place x_mm; no mechanism")
row("effect.outside.grip", "the squeeze of the fingers leaks in: column grip_n; in no list", [("grip", dict(named=None, accept=["grip_n"]))], notes="the further column grip_n explains it")
CROSS = [("coulomb_friction", SPEEDS, ("v_absent", "v_savgol", "v_causal", "v_quantised", "v_alphabeta")), ("delay", SPEEDS, ("v_savgol", "v_causal", "v_backward", "v_absent")),
         ("nonlinear_stiffness", PLACES, ("x_20um", "x_encoder_55um", "x_wander_20um")), ("coulomb_friction", PLACES, ("x_20um", "x_encoder_55um", "x_tracker_120hz")),
         ("relaxation", SPEEDS, ("v_causal", "v_savgol")), ("hysteresis", PLACES, ("x_5um", "x_late_packets")), ("backlash", PLACES, ("x_5um", "x_encoder_55um"))]
for m, table, names in CROSS:
    for n in names:
        row(f"effect.{m}.{n}", f"{m}, {n.replace('_', ' ')}", [m], extra=LATE if "tracker" in n else None, **table[n])
for m, names in (("delay", ("noise_two_scale", "noise_pink")), ("coulomb_friction", ("noise_ar1", "noise_walk", "noise_hum50")), ("hidden_layer", ("noise_pink", "noise_ring_touch")),
                 ("relaxation", ("noise_two_scale", "noise_walk")), ("inertia", ("noise_ring_jerk", "noise_heavy"))):
    for n in names:
        row(f"effect.{m}.{n}", f"{m}, {n.replace('_', ' ')}", [m], noise=NOISES[n])

# ---- 5: friction. Fc/(b vmax) at top speeds of 1, 30, 300 mm/s; with stick
for top, more in ((1.0, dict(depth=0.8, fs=100, n=6, rows=18000, tremor=0.004, drift=0.01)), (30.0, dict(reach=3.0, fs=250)), (300.0, dict(reach=50.0, k=1.0, c=0.005, fs=500, rows=22000, n=6))):
    for ratio in (0.1, 1.0, 10.0):
        b = lambda u, q=ratio: dict(b_n_s_per_mm=u.last["fc_n"] / (q * u.top))
        row(f"effect.friction_{top:g}mm_s.ratio_{ratio:g}", f"Fc + b V, Fc/(b vmax) = {ratio:g}, to {top:g} mm/s", ["coulomb_friction", ("viscous_friction", dict(fixed=b))], kind="pair",
            notes="size of each is its own; the small part may be left out", vtop=top, **more)
row("effect.friction_stick", "Fc with stick over 15 um (Dahl)", [("coulomb_friction", dict(v0_mm_s=None, stick_mm=0.015))], vtop=8.0)
row("effect.stribeck_slow", "stribeck, to 2 mm/s", ["stribeck_friction"], vtop=2.0, fs=100, rows=18000, n=6, tremor=0.004)

# ---- pairs
for a, b in (("coulomb_friction", "delay"), ("coulomb_friction", "nonlinear_stiffness"), ("relaxation", "contact_offset"), ("hysteresis", "hidden_layer"), ("inertia", "coulomb_friction"),
             ("gravity_posture", "viscous_friction"), ("thermal_softening", "coulomb_friction"), ("backlash", "drift")):
    row(f"pair.{a}.{b}", f"{a} and {b}, each of the size asked", [a, b])
row("pair.run_out.coulomb_friction", "a turning bur in a drive with friction", ["run_out", "coulomb_friction"], **SPIN)

# ---- 4: sessions differ
two = lambda u: {f"delta_{i + 1}_mm": 0.03 * ((i + 1) % 2) for i in range(u.n)}
row("clean.k_by_session", "k +-10 %", kvar=0.06, extra=honest("gain_error"), notes="k differs by session: no mechanism")
row("clean.c_by_session", "c +-15 %", cvar=0.09, notes="c differs by session: no mechanism")
row("clean.delay_by_session", "the position comes 0 to 6 ms late, by session", late=0.003, late_sd=0.002, extra=honest("delay", "low_pass"), notes="a delay that differs by session")
row("effect.offset_by_session", "zero of x +-0.05 mm", [("contact_offset", dict(fixed=lambda u: {f"delta_{i + 1}_mm": 0.03 * u.z[i] for i in range(u.n)}))], notes="size is what it comes to")
row("effect.bias_by_session", "each session has its own bias", [("bias", dict(bias_n=lambda g, u: 0.02 * g * u.z[:u.n]))])
row("effect.two_teeth", "k 0.8 and 1.1, one tooth's zero moved by 0.03 mm, one session at another temperature_c", [("contact_offset", dict(fixed=two))], teeth=(0.8, 1.1), k=0.95,
    c=0.03, n=8, cols=("temperature_c",), notes="not thermal_softening: the temperature is of one session only")
row("clean.two_teeth", "the same with the zero in place", teeth=(0.8, 1.1), k=0.95, c=0.03, n=8, cols=("temperature_c",), notes="k by session; not thermal_softening")
row("clean.idle_columns", "posture, approach, lateral force, wear and temperature are written but do nothing", cols=("posture_deg", "approach_deg", "fy_n", "fz_n", "removed_mm3", "temperature_c", "grip_n"))

# ---- 7: in one session only
for m in ("delay", "coulomb_friction", "contact_offset", "inertia", "gain_error", "drift", "relaxation", "saturation"):
    row(f"session_only.{m}", f"{m} in one session, none in the others", [(m, dict(only=1))], notes="size is that of the one session; naming the session is the best answer",
        extra=honest("contact_offset", "bias") if m == "contact_offset" else None)

# ---- 8: units of another house, sound data
KG, LB, T = 1000 / 9.80665, 1 / 4.4482216, ("t_ms", 1000, 0)
UNITS = {"mn": dict(cols=dict(f_n=("f_mN", 1000, 0))), "gf": dict(cols=dict(f_n=("f_gf", KG, 0))), "kgf": dict(cols=dict(f_n=("f_kgf", KG / 1000, 0))), "lbf": dict(cols=dict(f_n=("f_lbf", LB, 0))),
         "metre": dict(cols=dict(x_mm=("x_m", 1e-3, 0), v_mm_s=("v_m_s", 1e-3, 0))), "um_ms": dict(cols=dict(x_mm=("x_um", 1000, 0), v_mm_s=("v_um_s", 1000, 0), t_s=T)),
         "inch": dict(cols=dict(x_mm=("x_in", 1 / 25.4, 0), v_mm_s=("v_in_s", 1 / 25.4, 0))), "decimal_comma": dict(sep=";", dec=","), "semicolon": dict(sep=";"),
         "unit_row": dict(cols=dict(t_s=("time", 1, 0), x_mm=("position", 1, 0), f_n=("force", 1000, 0), v_mm_s=("speed", 1, 0)), row=dict(t_s="s", x_mm="mm", f_n="mN", v_mm_s="mm/s")),
         "date": dict(date=1), "compression_negative": dict(cols=dict(f_n=("f_n", -1, 0))), "machine_position": dict(cols=dict(x_mm=("x_mm", 1, 37.4))),
         "machine_downwards": dict(cols=dict(x_mm=("x_mm", -1, 37.4), v_mm_s=("v_mm_s", -1, 0))), "brackets": dict(cols=dict(t_s=("Time [ms]", 1000, 0), f_n=("Fz [mN]", 1000, 0), x_mm=("Z [um]", 1000, 0)))}
WORDS = {"compression_negative": ["compression is negative"], "machine_position": ["surface at 37.4 mm"], "machine_downwards": ["surface at 37.4 mm", "the tool goes in towards smaller x"]}
for n, w in UNITS.items():
    row("unit." + n, "sound, " + n.replace("_", " "), unit=w, extra={"options_in_words": WORDS.get(n, [])}, notes="nothing beside k and c; the same as in N and mm")
    if n in ("gf", "um_ms", "decimal_comma", "machine_position"):
        row(f"unit.{n}.coulomb_friction", "friction, " + n.replace("_", " "), ["coulomb_friction"], unit=w, extra={"options_in_words": WORDS.get(n, [])})

# ---- 8: unsound
for n, text, more in (("mn", "force in mN headed f_n", {}), ("clip", "clipped at 60 % of the peak, not told", dict(cap=0.6)), ("clock", "clock wrong by a quarter, v right", {}),
                      ("clock_slow_rig", "the same without v: only rig.toml's c tells", dict(v="absent", fault="clock")), ("stuck_f", "the force stands still for a quarter of each second session", {}),
                      ("stuck_x", "the position stands still likewise", {}), ("swap_xf", "x and f swapped", {}), ("swap_xv", "x and v swapped", {}), ("sign_x", "x counted the other way, v not", {}),
                      ("gap", "1.7 s are missing in the time", {}), ("backwards", "time jumps back 0.4 s once a session", {}), ("nan", "40 empty cells of force a session", {})):
    row("fault." + n, text, notes="says that the data are not sound; no mechanism", extra=honest("saturation") if n == "clip" else None, **({"fault": n} | more))

# ---- 9: wholly in air
DRIVE = dict(kinds=AIR, known=0, k=1.0, c=0.02)
for n, w in (("stylus", dict(reach=30.0, vtop=120.0)), ("drive_slow", dict(reach=3.0, vtop=5.0, hand=0)), ("stylus_quantised", dict(reach=20.0, vtop=60.0, xq=0.055, v="absent"))):
    row(f"air.{n}.clean", "in air, nothing hidden: " + n, **DRIVE, **w, cols=("posture_deg",), notes="no contact: k and c cannot be told; nothing else")
    for m in ("coulomb_friction", "stribeck_friction", "viscous_friction", "inertia", "gravity_posture")[:5 if n == "stylus" else 3]:
        row(f"air.{n}.{m}", f"in air, {m}: {n}", [m], **DRIVE, **w)
row("air.stylus.friction_and_weight", "in air: friction and weight", ["coulomb_friction", "gravity_posture"], **DRIVE, reach=30.0, vtop=120.0)

# ---- 10: interference, aliases, force ahead
line = lambda f: ("hum", dict(named=None, accept=[], frequency_hz=lambda g, u: f * u.fs if f < 1 else f))
row("interference.mains_50", "50 Hz in air and contact, 250 Hz rows", [line(50.0)], fs=250, notes="a line at 50 Hz that does not heed contact: not chatter, not run_out")
row("interference.mains_60_alias", "60 Hz at 100 Hz rows: seen at 40 Hz", [line(60.0)], fs=100, notes="a line at 40 Hz, perhaps an alias")
row("interference.near_nyquist", "a line at 0.493 fs", [line(0.493)], notes="a line close to half the rate")
row("interference.slow_alias", "50 Hz at 125 Hz rows beside rpm that do nothing", [line(50.0)], fs=125, cols=("spindle_rpm",), rpm=3000, notes="50 Hz is the mains and spindle 3000 rpm both; in air, too: mains")
row("interference.run_out_aliased", "spindle of 667 Hz at 500 Hz rows: seen at 167 Hz", ["run_out"], **(SPIN | dict(rpm=40000)))
row("interference.run_out_rpm_off_3_percent", "the spindle_rpm column is 3 % high", ["run_out"], rpm_error=0.03, **SPIN, notes="run_out, and that the rpm column is off; a line beside the column's rate is honest")
ahead = ("delay", dict(tau_s=lambda g, u: -0.003 * g, accept=["delay"]))
row("interference.force_ahead", "the force comes ahead of the position: negative delay of the size asked", [ahead], notes="position late; tau below 0")
for ms in (5, 12, 20):
    row(f"interference.position_late_{ms}ms", f"the position comes {ms} ms late", [("delay", dict(fixed=lambda u, q=ms: dict(tau_s=-q / 1000), accept=["delay"]))], v="absent", notes="position late; size is what it comes to")
row("interference.position_filtered", "tracker smooths the position with 8 ms, v too", kind="interference", xlag=0.008, extra=honest("delay", "low_pass"), notes="the position is late by 8 ms: a delay below 0, or nothing")
