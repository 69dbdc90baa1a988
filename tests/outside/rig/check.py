"""Each law and instrument against a closed form or a slow, independent sum."""
import math
from types import SimpleNamespace
import numpy as np
import channel
import motions
import rig
from families import FAMILIES
from laws import LAWS, decay, force, lag

failed = 0


def see(what, got, want, within):
    global failed
    worst = float(np.max(np.abs(np.asarray(got, float) - np.asarray(want, float))))
    failed += not worst <= within
    print(f"{'ok  ' if worst <= within else 'FAIL'} {what}: off by {worst:.2g}, allowed {within:.2g}")


def ses(x, dt, k=1.5, c=0.05, **true):
    v = np.gradient(x, dt)
    s = SimpleNamespace(i=0, dt=dt, t=np.arange(len(x)) * dt, x=x, v=v, a=np.gradient(v, dt), k=k, c=c, true=true, t0=0.0, first_c=20.0)
    s.plain = force(s, [])
    return s


def laws():
    dt = 1e-4
    t = np.arange(30000) * dt
    up = ses(np.minimum(2 * t, 1.0), dt)  # 2 mm/s to 1 mm, then a hold
    add = lambda s, name, **p: force(s, [(name, {**LAWS[name].start, **p})]) - s.plain
    see("plain law on a ramp", up.plain[1000:4900], 1.5 * 2 * t[1000:4900] + 0.05 * 2, 1e-9)
    see("plain law on the hold", up.plain[6000:], 1.5, 1e-9)
    k1, tau = 0.4, 0.35  # z = k1 V tau (1 - e^(-t/tau)) on the ramp, then it decays
    z = np.where(t < 0.5, k1 * 2 * tau * (1 - np.exp(-t / tau)), k1 * 2 * tau * (1 - math.exp(-0.5 / tau)) * np.exp(-(t - 0.5) / tau))
    see("relaxation, ramp and hold", add(up, "relaxation", k1_n_per_mm=k1, tau1_s=tau), z, 1e-4)
    see("hysteresis, alpha d (1 - e^(-X/d))", add(up, "hysteresis", alpha_n_per_mm=0.3, d_mm=0.12), 0.3 * 0.12 * (1 - np.exp(-up.x / 0.12)), 1e-6)
    tri = ses(1 - np.abs(1 - np.minimum(2 * t, 2.0)), dt, c=0.0)  # up to 1 mm and back
    y = np.where(t < 0.5, 2 * t, np.where(t < 0.55, 1.0, np.maximum(2 - 2 * t, 0) + 0.1))
    see("backlash on a triangle", force(tri, [("backlash", {"b_mm": 0.1})])[10:9900], 1.5 * y[10:9900], 1e-6)
    x, v = tri.x, tri.v
    for name, p, want in [
            ("contact_offset", {"delta_mm": [0.03]}, 1.5 * 0.03), ("nonlinear_stiffness", {"m": 1.2}, 1.5 * (x**1.2 - x)),
            ("hidden_layer", {"dk_n_per_mm": 0.5, "d0_mm": 0.4}, 0.5 * (x - 0.4) * (x > 0.4)), ("graded_stiffness", {"alpha_per_mm": 0.1}, -0.15 * x * x),
            ("series_compliance", {"softening_force_n": 10.0}, 1.5 * x / (1 + 0.15 * x) - 1.5 * x),
            ("coulomb_friction", {"fc_n": 0.1, "v0_mm_s": 0.2}, 0.1 * np.tanh(v / 0.2)), ("viscous_friction", {"b_n_s_per_mm": 0.02}, 0.02 * v),
            ("stribeck_friction", {"fc_n": 0.1, "fs_n": 0.3, "vs_mm_s": 2.0, "v0_mm_s": 0.1}, (0.1 + 0.2 * np.exp(-v * v / 4)) * np.tanh(v / 0.1)),
            ("gain_error", {"gain": 0.05}, 0.075 * x), ("saturation", {"f_max_n": 1.0}, np.minimum(1.5 * x, 1) - 1.5 * x),
            ("bias", {"bias_n": 0.1}, 0.1), ("drift", {"rate_n_per_s": 0.01}, 0.01 * t),
            ("drift", {"rate_n_per_s": 0, "amplitude_n": 0.2, "tau_s": 2.0}, 0.2 * (1 - np.exp(-t / 2)))]:
        mid = slice(50, 9900)
        see(name, add(tri, name, **p)[mid], np.broadcast_to(want, x.shape)[mid], 1e-9)
    true = dict(wet=np.ones(len(t)), removed_mm3=np.full(len(t), 3.0), temperature_c=np.full(len(t), 26.0), approach_deg=np.full(len(t), 90.0),
                posture_deg=np.full(len(t), 30.0), fy_n=np.full(len(t), 2.0), fz_n=np.full(len(t), 5.0), spindle_rpm=np.full(len(t), 1200.0), room_c=np.full(len(t), 25.0))
    s = ses(np.full(len(t), 0.8), dt, **true)  # F = 1.2 N, at rest
    for name, p, want in [
            ("coolant", {"fraction": -0.1}, -0.12), ("wear", {"per_mm3": 0.02}, 1.2 * 0.06), ("thermal_softening", {"per_k": 0.01}, -1.2 * 0.06),
            ("anisotropy", {"epsilon": 0.1, "phi0_deg": 30.0}, 1.2 * 0.1 * math.cos(math.radians(120))),
            ("gravity_posture", {"weight_n": 0.4, "theta0_deg": 0.0}, 0.2), ("cross_talk", {"a": 0.01, "b": 0.02}, 0.12), ("edge_force", {"edge_n": 0.3}, 0.3),
            ("room", {"n_per_k": 0.02}, 0.06)]:
        see(name, add(s, name, **p), want, 1e-9)
    see("run_out of 1200 / min is 20 Hz", add(s, "run_out", amplitude_n=0.2, phase_turns=0.1), 0.2 * np.sin(2 * np.pi * (20 * t + 0.1)), 1e-9)
    see("chatter", add(s, "chatter", amplitude_n=0.2, frequency_hz=31.0, phase_turns=0.1), 0.2 * np.sin(2 * np.pi * (31 * t + 0.1)), 1e-9)
    w = 2 * np.pi * 3  # a sine in contact: gain 1/sqrt(1 + w^2 tau^2), lag atan(w tau)
    s = ses(1.0 + 0.4 * np.sin(w * t), dt, c=0.0)
    tau, late = 0.02, slice(5000, 29000)
    want = 1.5 + 0.6 / math.hypot(1, w * tau) * np.sin(w * t - math.atan(w * tau))
    see("low_pass on a sine", force(s, [("low_pass", {"tau_s": tau})])[late], want[late], 1e-4)
    want = 1.5 + 0.6 / (1 + (w * tau) ** 2) * np.sin(w * t - 2 * math.atan(w * tau))
    see("amplifier on a sine", force(s, [("amplifier", {"tau_s": tau})])[late], want[late], 1e-4)
    see("delay on a sine", force(s, [("delay", {"tau_s": 0.013})])[late], (1.5 + 0.6 * np.sin(w * (t - 0.013)))[late], 1e-5)
    see("negative delay on a sine", force(s, [("delay", {"tau_s": -0.01})])[late], (1.5 + 0.6 * np.sin(w * (t + 0.01)))[late], 1e-5)
    see("two_clocks", force(s, [("two_clocks", {"rate": 1e-3})])[late], (1.5 + 0.6 * np.sin(w * t * 0.999))[late], 1e-5)
    see("inertia of 0.2 kg", add(s, "inertia", mass_kg=0.2)[late], (-0.2e-3 * 0.4 * w * w * np.sin(w * t))[late], 1e-5)
    see("feed_power_law", add(ses(2 * t, dt, c=0.2), "feed_power_law", n=0.8)[1:], 0.2 * (2**0.8 - 2), 1e-9)
    s = ses(1.0 + 0.1 * np.sin(w * t), dt, c=0.4)
    F = force(s, [("series_lag", {"ks_n_per_mm": 10.0})])  # F = k (X - F/ks) + c (V - F'/ks)
    see("series_compliance keeps its equation", F[late], (1.5 * (s.x - F / 10) + 0.4 * (s.v - np.gradient(F, dt) / 10))[late], 1e-3)
    see("stick: full force after some d, kept at rest", add(up, "stick", fc_n=0.2, d_mm=0.02)[3000:], 0.2, 1e-6)


def instruments():
    rng = np.random.default_rng(5)
    u, y = rng.normal(size=700), []
    for q in u:
        y.append(q + (y[-1] * math.exp(-0.03) if y else 0))
    see("recursion in blocks", decay(u, -0.03, 1.0), y, 1e-10)
    see("lag: step response", lag(np.concatenate([[0.0], np.ones(4000)]), 0.05, 1e-4)[1:], 1 - np.exp(-(np.arange(4000) + 0.5) * 1e-4 / 0.05), 1e-5)
    s = SimpleNamespace(i=0, dt=1 / 4000, t=np.arange(400000) / 4000, a=rng.normal(size=400000), plain=np.zeros(400000), pick=np.arange(0, 400000, 20))
    for kind, arg, slope in (("white", None, 0), ("pink", None, -1), ("walk", None, -2)):
        n = channel.force_noise([s], kind, arg, rng)[0]
        p = np.abs(np.fft.rfft(n * np.hanning(len(n)))) ** 2
        bins = np.unique(np.geomspace(20, 3000, 25).astype(int))
        level = [p[a:b].mean() for a, b in zip(bins[:-1], bins[1:])]
        see(f"{kind}: slope of the spectrum", np.polyfit(np.log(np.sqrt(bins[:-1] * bins[1:])), np.log(level), 1)[0], slope, 0.15)
        see(f"{kind}: standard deviation", n.std(), 1, 1e-9)
    n = channel.force_noise([s], "ar1", 8, rng)[0]
    see("ar1: correlation of neighbours", np.corrcoef(n[1:], n[:-1])[0, 1], math.exp(-1 / 8), 0.02)
    for kind, arg, where in (("hum", 60.0, 60.0), ("line", 71.3, 71.3), ("ringing", (14.0, 0.02), 14.0)):
        n = channel.force_noise([s], kind, arg, rng)[0]
        p = np.abs(np.fft.rfft(n * np.hanning(len(n)))) ** 2
        see(f"{kind}: place of the peak, Hz", np.argmax(p) / 100, where, 0.05 if kind != "ringing" else 0.6)
    dt = 0.005
    t = np.arange(400) * dt
    see("savgol on a parabola", channel.savgol(3 * t * t, 5, dt)[20:-20], (6 * t)[20:-20], 1e-9)
    see("gauss on a parabola", channel.gauss(3 * t * t, 2.5, dt)[20:-20], (6 * t)[20:-20], 1e-9)
    tau = dt * math.exp(-dt / 0.012) / (1 - math.exp(-dt / 0.012)) + dt / 2
    see("one-pole speed on a parabola is late", channel.one_pole(3 * t * t, 0.012, dt)[100:], 6 * (t[100:] - tau), 1e-6)
    see("mean backward difference is late by n/2", channel.back_mean(3 * t * t, 6, dt)[20:], 6 * (t[20:] - 3 * dt), 1e-9)
    see("alpha-beta follows a ramp", channel.alpha_beta(2 * t, 0.35, dt)[200:], 2.0, 1e-4)
    d = SimpleNamespace(xn=0.005, wander=0.0, quantum=0.0)
    see("noise of position", channel.encoder(np.zeros(40000), d, rng, 200).std(), 0.005, 1e-4)
    d = SimpleNamespace(xn=0.0, wander=0.0, quantum=0.01)
    x = np.linspace(0, 3, 40000)
    see("step of 0.01 mm: sd is step / sqrt 12", (channel.encoder(x, d, rng, 200) - x).std(), 0.01 / math.sqrt(12), 1e-5)


def recordings():
    def rows_of(s, name):
        return getattr(s, name)[s.pick]
    for name in ("clean.plain", "clean.slow_10", "effect.coulomb", "effect.delay.causal", "units.f_gf", "clean.q_10um", "air.gravity"):
        if name not in FAMILIES:
            continue
        table, rig_toml, truth, d, sessions, live = rig.make(name, 3, 1.5)
        again = rig.make(name, 3, 1.5)[0]
        see(f"{name}: the same twice", sum(float(np.sum(table[q] != again[q])) for q in table), 0, 0)
        n = len(table["t_s"])
        see(f"{name}: rows 10000 to 24000, off the middle", n, 17000, 7000)
        for s in sessions:
            see(f"{name}: x is the integral of v", np.cumsum(s.v)[-1] * s.dt, s.x[-1] - s.x[0], 0.02) if s.i == 0 else None
            assert s.x.max() <= 2.2 and np.abs(s.a).max() < 6e3, (name, s.x.max(), np.abs(s.a).max())
        if d.air_only:
            continue
        # what is recorded less the sum of the law from the recorded x, row by row with plain python
        k, c = truth["k_n_per_mm"][0], truth["c_n_s_per_mm"][0]
        if name in ("clean.plain", "clean.q_10um"):
            rest = [f - (max(0.0, k * x + c * v) if x > 0 else 0.0) for x, v, f in zip(table["x_mm"], table["v_mm_s"] if d.v else np.concatenate([rows_of(s, "v") for s in sessions]), table["f_n"])]
            see(f"{name}: sd of the rest is the noise", np.std(rest) / truth["noise_sd_n"], 1, 0.06)
        for h, (law, p) in zip(truth["hidden"], live):  # the size again, by normal equations in plain sums
            e = rig.sample(sessions, [(law, p)]) - rig.sample(sessions, [])
            on = np.concatenate([rows_of(s, "plain") for s in sessions]) > 0
            cols = [np.concatenate([rows_of(s, a) for s in sessions]) * on for a in ("x", "v")]
            cols += [np.concatenate([np.full(len(s.pick), float(s.i == j)) for s in sessions]) for j in range(d.n)]
            calm = []
            for s in sessions:  # no change of contact within 20 ms, counted on the fine grid
                change, w = np.concatenate([[0], np.cumsum(np.abs(np.diff((s.x > 0).astype(int))))]), round(0.02 / s.dt)
                calm += [change[min(i + w, len(s.x) - 1)] == change[max(i - w, 0)] for i in s.pick]
            calm = np.array(calm)
            cols, left = [q[calm] for q in cols], e[calm]
            for i, q in enumerate(cols):  # Gram-Schmidt, twice
                for _ in range(2):
                    for p_ in cols[:i]:
                        cols[i] = cols[i] - p_ * (cols[i] @ p_)
                cols[i] = cols[i] / np.linalg.norm(cols[i])
                left = left - cols[i] * (left @ cols[i])
            see(f"{name}: size of {law}", np.sqrt(np.mean(left**2)) / truth["noise_sd_n"], 1.5, 0.02)


def main():
    laws()
    instruments()
    recordings()
    print("all checks passed" if not failed else f"{failed} checks FAILED")
    return int(failed > 0)
