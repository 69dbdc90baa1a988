"""The table of families: name, what it isolates, effects, and what differs from the usual bench. The kind is the name's first word."""
from types import SimpleNamespace

# the usual bench: 8 sessions, 200 Hz, 16000 rows, exact speed, white noise, all kinds of motion, strokes in air
BENCH = dict(n=8, fs=200, rows=16000, v_air=15.0, v_c=15.0, depth=1.8, air=True, air_only=False, air_speeds=None, k=None, c=None, v="exact",
             xn=0.0, wander=0.0, quantum=0.0, noise="white", arg=None, noise_n=None, cols=(), rpm=900.0, rpm_gate=True, rpm_column=1.0,
             hot=None, guess=True, ratio=None, jitter=0.0, drop=0.0, clip=None, own_k=None, accept_any=None, forbid=(), accept=(), notes=None,
             fault=None, units=None, options=(), clock=False)
FAMILIES = {}


def row(name, text, *effects, **design):
    unknown = set(design) - set(BENCH)
    assert not unknown and name not in FAMILIES, (name, unknown)
    kind = name.split(".")[0]
    FAMILIES[name] = SimpleNamespace(name=name, kind=kind, text=text, effects=[(e, {}) if isinstance(e, str) else e for e in effects],
                                     **{**BENCH, **design})


Q = 0.002  # a usual step of the encoder, mm
SPEEDS = {"absent": dict(v=None), "savgol": dict(v="savgol", quantum=Q), "gauss": dict(v="gauss", quantum=0.005), "causal": dict(v="causal", quantum=Q),
          "back_mean": dict(v="back_mean", quantum=Q), "v_quantised": dict(v="quantised"), "alpha_beta": dict(v="alpha_beta", quantum=Q)}
NOISES = {"ar1": dict(noise="ar1"), "pink": dict(noise="pink"), "walk": dict(noise="walk", noise_n=0.02), "walk_white": dict(noise="walk_white"),
          "two_scale": dict(noise="two_scale"), "hum_50": dict(noise="hum", arg=50.0, fs=400, n=6, rows=24000), "hum_60_alias": dict(noise="hum", arg=59.98, fs=100),
          "hum_50_alias": dict(noise="hum", arg=50.01, fs=125), "ringing_14": dict(noise="ringing", arg=(14.0, 0.02)),
          "ringing_33": dict(noise="ringing", arg=(33.0, 0.01), fs=400, n=6, rows=24000), "bursts": dict(noise="bursts"), "tails": dict(noise="tails")}
WHERE = {"xn_1um": dict(xn=0.001), "xn_5um": dict(xn=0.005, v=None), "xn_20um": dict(xn=0.02, v=None), "wander_20um_q": dict(wander=0.02, quantum=0.001, v="savgol"), "q_10um": dict(quantum=0.01, v=None),
         "q_55um": dict(quantum=0.055, v=None), "q_10um_xn_5um": dict(quantum=0.01, xn=0.005, v="savgol")}

row("clean.plain", "nothing hidden, ideal instruments")
for q, design in SPEEDS.items():
    row(f"clean.{q if q[:2] == 'v_' else 'v_' + q}", f"nothing hidden; speed column: {q}", **design)
for q, design in WHERE.items():
    row(f"clean.{q}", f"nothing hidden; position: {q}", **design)
for q, design in NOISES.items():
    row(f"clean.noise_{q}", f"nothing hidden; force noise: {q}", **design)
row("clean.no_air", "nothing hidden, the stage has its end stop at 0.12 mm depth", air=False)
row("clean.slow_10", "nothing hidden, ten slow sessions at 100 Hz", fs=100, n=10, rows=20000, v_c=3.0, v_air=3.0)
row("clean.decoys", "nothing hidden, but columns of humidity, motor current, room temperature", cols=("humidity", "motor_a", "room_c"))
row("clean.all_columns", "nothing hidden, but all columns that laws need", cols=("spindle_rpm", "wet", "posture_deg", "approach_deg", "fy_n", "fz_n",
    "removed_mm3", "temperature_c"))
row("clean.gain", "the gain of the load cell is 5 % off: no recording can show it", ("gain_error", dict(gain=0.05, fixed=True)), accept_any=["gain_error"],
    notes="k and c both read 5 % too large; nothing is left unexplained")
row("clean.dropped_rows", "nothing hidden, 3 % of the rows lost in short gaps", drop=0.03)
row("clean.jitter", "nothing hidden, time stamps late by up to 3 ms", jitter=0.003)
row("clean.stiff_stage", "nothing hidden, k 5 N/mm and c 0.6 N s/mm, shallow", k=5.0, c=0.6, depth=0.9, v_c=5.0)

# effects on the usual bench: every law that this rig can show. Not gain_error: k and c take it whole (clean.gain)
row("effect.bias", "a constant offset", "bias", noise="white")
row("effect.drift", "zero drifts in proportion to time since the tare of each session", "drift")
row("effect.drift_warm_up", "zero warms up over the day; the clock goes on through the sessions", ("drift", dict(rate_n_per_s=0, amplitude_n=0.05, tau_s=40.0, day=1)), clock=True)
row("effect.contact_offset", "the surface lies elsewhere in each session", "contact_offset")
row("effect.coulomb", "dry friction", "coulomb_friction")
row("effect.stribeck", "friction that falls with speed, five speeds of strokes", "stribeck_friction", air_speeds=(0.02, 0.1, 0.5, 2.0, 12.0), fs=100, rows=20000)
row("effect.stick", "dry friction that sticks: it turns over within 20 micrometres", "stick")
row("effect.viscous", "viscous friction", "viscous_friction")
row("effect.inertia", "mass of the holder", "inertia", v_c=20.0)
row("effect.gravity", "weight and posture", "gravity_posture", cols=("posture_deg",))
row("effect.cross_talk", "lateral force leaks in", "cross_talk", cols=("fy_n", "fz_n"))
row("effect.delay", "force channel late", "delay", v_c=20.0)
row("effect.low_pass", "force channel behind one pole", "low_pass", v_c=20.0)
row("effect.amplifier", "force channel behind an amplifier of two poles", "amplifier", v_c=20.0, accept=("delay",))
row("effect.saturation", "amplifier saturates below the stated limit", "saturation")
row("effect.backlash", "play before a tip held by its guide, low c", "backlash", c=0.008, v_c=8.0)
row("effect.hysteresis", "loop that does not depend on speed", "hysteresis")
row("effect.series_softening", "an elastic holder that softens the whole", "series_compliance")
row("effect.series_lag", "a spring in series with tissue of large c: standard linear solid", "series_lag", c=0.4, v_c=8.0, accept=("relaxation", "low_pass"))
row("effect.nonlinear", "power of depth", "nonlinear_stiffness")
row("effect.hidden_layer", "stiffer below 0.8 mm", "hidden_layer")
row("effect.graded", "stiffness falls evenly", "graded_stiffness")
row("effect.anisotropy", "stiffness by angle of approach", "anisotropy", cols=("approach_deg",))
row("effect.relaxation", "one time constant", "relaxation")
row("effect.relaxation_two", "two time constants", ("relaxation", dict(k1_n_per_mm=0.1, tau1_s=0.08, k2_n_per_mm=0.1, tau2_s=1.5)))
row("effect.feed_power", "force with a power of speed", "feed_power_law", c=0.2)
row("effect.edge", "cutting edges", "edge_force", cols=("spindle_rpm",))
row("effect.wear", "a bur that wears", "wear", cols=("removed_mm3",))
row("effect.run_out", "run-out of a spindle at 900 / min with an index pulse at the start", "run_out", cols=("spindle_rpm",))
row("effect.chatter", "chatter of 31.7 Hz, spindle at 900 / min", "chatter", cols=("spindle_rpm",))
row("effect.coolant", "water on and off", "coolant", cols=("wet",))
row("effect.thermal", "tissue warms and softens", "thermal_softening", cols=("temperature_c",))
row("effect.screw_error", "outside the list: the screw's cyclic error, lead 0.5 mm", "screw_error", k=2.0)
row("effect.cable", "outside the list: a cable pulls, far in air", "cable")
row("effect.room_column", "outside the list: the zero follows the room's temperature, column room_c", "room", cols=("room_c", "humidity"))

# an effect under each difficulty
for q in ("absent", "gauss", "causal", "v_quantised", "alpha_beta"):
    row(f"effect.coulomb.{q}", f"dry friction; speed column: {q}", "coulomb_friction", **SPEEDS[q])
for q in ("absent", "causal", "alpha_beta"):
    row(f"effect.delay.{q}", f"force channel late; speed column: {q}", "delay", **{**SPEEDS[q], "v_c": 20.0})
for q in ("pink", "two_scale", "ringing_14"):
    row(f"effect.delay.noise_{q}", f"force channel late; noise: {q}", "delay", **{"v_c": 20.0, **NOISES[q]})
for q in ("ar1", "hum_60_alias"):
    row(f"effect.relaxation.noise_{q}", f"relaxation; noise: {q}", "relaxation", **NOISES[q])
row("effect.coulomb.noise_walk", "dry friction; random walk", "coulomb_friction", **NOISES["walk"])
row("effect.drift.noise_pink", "drift; pink noise", "drift", **NOISES["pink"])
for q in ("wander_20um_q", "q_55um"):
    row(f"effect.backlash.{q}", f"play; position: {q}", "backlash", c=0.008, v_c=8.0, **WHERE[q])
row("effect.hidden_layer.q_55um", "a layer; encoder of 55 um", "hidden_layer", **WHERE["q_55um"])
VMAX = {1: dict(v_air=1.0, v_c=1.0, depth=0.7, fs=100, rows=20000), 30: dict(v_air=30.0),
        300: dict(v_air=300.0, fs=500, n=6, rows=24000)}
for vmax in VMAX:
    for r in (0.1, 1, 10):
        row(f"pair.friction_v{vmax}_r{r}", f"dry and viscous friction, Fc = {r} b vmax, vmax {vmax} mm/s", "coulomb_friction", "viscous_friction", ratio=(r, vmax),
            air_speeds=tuple(vmax * q for q in (0.02, 0.1, 0.4, 1)), **VMAX[vmax])

row("pair.coulomb_delay", "friction and delay", "coulomb_friction", "delay", v_c=20.0)
row("pair.relaxation_layer", "relaxation and a layer", "relaxation", "hidden_layer")
row("pair.hysteresis_relaxation", "two loops, one of them with time", "hysteresis", "relaxation")
row("pair.offset_bias", "surface elsewhere by session and a bias", "contact_offset", "bias")
row("pair.low_pass_drift", "filter and drift", "low_pass", "drift", v_c=20.0)
row("pair.coolant_thermal", "water and heat", "coolant", "thermal_softening", cols=("wet", "temperature_c"))

for q in ("delay", "coulomb_friction", "bias", "low_pass", "relaxation"):
    row(f"session_only.{q}", f"{q} in session 4 alone", (q, dict(only=3)), v_c=20.0 if q in ("delay", "low_pass", "inertia") else 10.0)
row("session_only.offset", "the surface moved in session 4 alone", ("contact_offset", dict(delta_mm=[0, 0, 0, 0.03, 0, 0, 0, 0])))

# variation between sessions: the sizes are fixed
row("clean.sessions_k", "k differs by 10 % between sessions", own_k=[1, 1.1, 0.9, 1.05, 0.95, 1.1, 0.9, 1], accept_any=["gain_error"],
    notes="nothing, or: k differs by session. Naming any law with a column of depth or time is false")
row("clean.sessions_delay", "each session has its own delay of 0 to 6 ms", ("delay", dict(tau_s=[0, 0.004, 0.001, 0.006, 0.002, 0.005, 0, 0.003], fixed=True)), v_c=20.0,
    accept_any=["delay", "low_pass"], notes="a delay by session, or nothing; the mean is 2.6 ms")
row("effect.sessions_zero", "zero of x moves by 0.05 mm", ("contact_offset", dict(delta_mm=[0.05, -0.05, 0.02, -0.03, 0.05, 0, -0.05, 0.04], fixed=True)))
row("effect.sessions_bias", "each session has its own bias, some 30 mN", ("bias", dict(bias_n=[0.03, -0.02, 0.01, 0.04, -0.03, 0, 0.02, -0.04], fixed=True)))
row("effect.two_teeth", "teeth of k 0.8 and 1.1, the second's zero moved by 0.03 mm, session 8 is 9 K warmer",
    ("contact_offset", dict(delta_mm=[0, 0, 0, 0, 0.03, 0.03, 0.03, 0.03], fixed=True)), k=1.0, own_k=[0.8] * 4 + [1.1] * 4, cols=("temperature_c",), hot=7,
    forbid=("thermal_softening",), notes="zero of the second tooth; k by tooth; thermal_softening would be false")
row("clean.two_teeth_hot", "teeth of k 0.8 and 1.1, session 8 is 9 K warmer, nothing else", k=1.0, own_k=[0.8] * 4 + [1.1] * 4, cols=("temperature_c",), hot=7,
    accept_any=["gain_error"], forbid=("thermal_softening",), notes="k by tooth, or nothing; thermal_softening would be false")

# units: sound data. factor: what one N, mm, s is in the file's unit. header: the file's names. Friction is there to be found
F, UNIT = "coulomb_friction", lambda **u: u
row("units.f_mn", "column f_mn in mN", F, units=UNIT(f=(1000, "f_mn")), options=("force: mN, column f_mn",))
row("units.f_gf", "column f_gf in gram-force", F, units=UNIT(f=(1000 / 9.80665, "f_gf")), options=("force: gf, column f_gf",))
row("units.f_lbf", "column f_lbf", F, units=UNIT(f=(1 / 4.4482216, "f_lbf")), options=("force: lbf, column f_lbf",))
row("units.x_m", "column x_m, speed v_m_s", F, units=UNIT(x=(1e-3, "x_m"), v=(1e-3, "v_m_s")), options=("length: m, columns x_m and v_m_s",))
row("units.x_um", "column x_um, no speed", F, v=None, units=UNIT(x=(1e3, "x_um")), options=("length: um, column x_um",))
row("units.x_in", "column x_in, speed v_in_s", F, units=UNIT(x=(1 / 25.4, "x_in"), v=(1 / 25.4, "v_in_s")), options=("length: in, columns x_in and v_in_s",))
row("units.t_ms", "column t_ms", F, units=UNIT(t=(1e3, "t_ms")), options=("time: ms, column t_ms",))
row("units.negative", "compression counted negative, headed f_n", F, units=UNIT(f=(-1, "f_n")), options=("force: compression is negative",))
row("units.absolute", "machine position, surface at 37.4 mm, headed position_mm", F, units=UNIT(x=(1, "position_mm"), zero=37.4),
    options=("position: column position_mm, surface at 37.4 mm",))
row("units.absolute_down", "machine height, surface at 37.4 mm, counted upwards, headed z_mm", F, units=UNIT(x=(-1, "z_mm"), v=(-1, "v_mm_s"), zero=37.4),
    options=("position: column z_mm, surface at 37.4 mm, counted against the feed",))
row("units.decimal_comma", "decimal comma, semicolons", F, units=UNIT(sep=";", comma=True))
row("units.unit_line", "a line of units below the header", F, units=UNIT(line=True))
row("units.date_stamps", "date and time of day instead of seconds", F, units=UNIT(date=True), options=("time: date stamps in column t_s",))
row("units.lab_export", "lbf, in, ms, semicolons, decimal comma, unit line", F, v=None, options=("force: lbf", "length: in", "time: ms"),
    units=UNIT(f=(1 / 4.4482216, "force_lbf"), x=(1 / 25.4, "position_in"), t=(1e3, "time_ms"), sep=";", comma=True, line=True))

row("fault.mn_as_n", "force in mN headed f_n", fault="mn", notes="say that the force does not fit the stated k by 1000")
row("fault.clipping", "converter clips at 45 % of the peak, force_limit_n says so", clip=0.45, fault="clip", accept_any=["saturation"], notes="say that rows are clipped")
row("fault.clock_quarter", "clock runs a quarter too fast, speed column is right", fault="clock", notes="say that v_mm_s and x_mm disagree on time by 1.25")
row("fault.stuck_force", "force sensor stuck from the middle of session 3 to its end", fault="stuck_f", notes="say that f_n stands still in session 3")
row("fault.stuck_position", "encoder stuck in session 5 for a third of it", fault="stuck_x", notes="say that x_mm stands still in session 5")
row("fault.swapped", "columns x_mm and f_n swapped", v=None, fault="swap", notes="say that x_mm looks like a force: it has no travel in air")

A = dict(air_only=True, air=True)
row("air.clean", "drive in air, nothing hidden", **A)
row("air.clean_posture", "stylus joint in air, posture changes, nothing hidden", cols=("posture_deg",), v="causal", quantum=Q, **A)
row("air.coulomb", "drive in air: dry friction", F, **A)
row("air.stribeck", "drive in air: Stribeck", "stribeck_friction", air_speeds=(0.02, 0.1, 0.5, 2.0, 12.0), **A)
row("air.stick", "stylus joint in air: dry friction that sticks", "stick", v=None, quantum=Q, **A)
row("air.inertia", "stylus in air: mass", "inertia", v="savgol", quantum=Q, **A)
row("air.gravity", "stylus in air: weight and posture", "gravity_posture", cols=("posture_deg",), **A)
row("air.joint_weight", "joint in air: weight goes with the sine of elbow_deg", ("gravity_posture", dict(column="elbow_deg")), cols=("elbow_deg",), **A)
row("air.coulomb_viscous", "drive in air: dry and viscous", F, "viscous_friction", v_air=60.0, fs=400, **A)
row("air.coulomb_inertia_v_absent", "drive in air: dry friction and mass, no speed column", F, "inertia", v=None, quantum=Q, **A)

row("interference.mains_also_in_air", "a hum of 40 Hz (60 Hz at 100 Hz) in contact and in air, spindle at 900 / min", cols=("spindle_rpm",), **NOISES["hum_60_alias"])
row("interference.nyquist", "a line just below Nyquist", noise="line", arg=99.1)
row("interference.chatter_alias", "chatter of 168 Hz at 200 Hz: seen at 32 Hz", ("chatter", dict(frequency_hz=168.3)), cols=("spindle_rpm",),
    notes="the rate seen is 31.7 Hz; 168.3 Hz cannot be told from it")
row("interference.run_out_alias", "run-out of 12600 / min = 210 Hz at 200 Hz: seen at 10 Hz", "run_out", cols=("spindle_rpm",), rpm=12600.0, rpm_gate=False)
row("interference.rpm_wrong", "run-out, and the column spindle_rpm is 3 % too large", "run_out", cols=("spindle_rpm",), rpm_column=1.03, accept=("chatter",))
row("interference.run_out_free_phase", "run-out with another phase in each session",
    ("run_out", dict(session_phase=[0, .31, .77, .12, .55, .93, .24, .68])), cols=("spindle_rpm",))
for ms in (5, 10, 20):
    row(f"interference.force_ahead_{ms}ms", f"position late by {ms} ms: force comes ahead, as a negative delay", ("delay", dict(tau_s=-ms / 1000, fixed=True)), v_c=20.0, v=None,
        quantum=Q, notes="a negative delay, or: the position channel is late; any other law would be false")
row("interference.relaxation_jitter", "relaxation, time stamps late by up to 4 ms", "relaxation", jitter=0.004)
row("interference.delay_jitter", "force late, time stamps late by up to 4 ms", "delay", jitter=0.004, v_c=20.0)
row("interference.two_clocks", "force and position run on two clocks: the delay grows with time", "two_clocks", v_c=20.0, accept=("delay",),
    notes="the delay grows with t_s; plain delay explains half of it")
