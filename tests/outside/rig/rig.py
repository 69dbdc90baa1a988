#!/usr/bin/python3
"""Recordings of a press rig with a known truth, for `cavum explain`, seen from outside.
  rig.py --list | --check | --family NAME --seed N --size S --out DIR
A session: a programmed motion on a fine grid -> laws.py (the force) -> channel.py (what the instruments make of it). families.py is the table."""
import argparse
import json
import os
import sys
import zlib
from datetime import datetime, timedelta
from types import SimpleNamespace
import numpy as np
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
import channel
import motions
from families import FAMILIES
from laws import LAWS, UP, force, own, scaled

# other shapes of a law that a rival may take, besides its own start
SHAPES = {"coulomb_friction": [{"v0_mm_s": 0.02}, {"v0_mm_s": 0.5}], "stribeck_friction": [{"fc_n": 0.04}, {"vs_mm_s": 0.2}, {"v0_mm_s": 0.5}],
          "relaxation": [{"tau1_s": q} for q in (0.003, 0.01, 0.03, 0.1, 1.2, 4.0)], "hysteresis": [{"d_mm": q} for q in (0.01, 0.03, 0.5)],
          "hidden_layer": [{"d0_mm": q} for q in (0.3, 0.55, 1.1)], "anisotropy": [{"phi0_deg": 65.0}],
          "drift": [{"amplitude_n": 0.05, "tau_s": 3.0, "rate_n_per_s": 0}], "chatter": []}

# laws with one sign only: a filter is never early, friction never drives
ONE_SIGN = {"low_pass", "amplifier", "series_lag", "series_compliance", "relaxation", "hysteresis", "backlash", "saturation", "coulomb_friction", "stick",
            "stribeck_friction", "viscous_friction", "inertia"}


def sample(sessions, effects):  # the force of all sessions at the rows
    return np.concatenate([force(s, effects)[s.pick] for s in sessions])


def calm_rows(s):
    """Rows further than 20 ms from a change of contact: there c V makes a step, and one row of it would outweigh the rest of a delay."""
    edge = np.flatnonzero(np.diff(s.x > 0)) * s.dt
    t = s.t[s.pick]
    return np.min(np.abs(t[:, None] - edge[None, :]), axis=1, initial=9.0) > 0.02


def unexplained(e, sessions, zeros):
    """What of e no change of k and c (and no zero of each session) makes, at the calm rows; e may have several columns."""
    live = np.concatenate([((s.x > 0) & (s.plain > 0))[s.pick] for s in sessions])
    base = [np.concatenate([getattr(s, a)[s.pick] for s in sessions]) * live for a in ("x", "v")]
    if zeros:
        which = np.concatenate([np.full(len(s.pick), s.i) for s in sessions])
        base += [(which == s.i).astype(float) for s in sessions]
    calm = np.concatenate([s.calm for s in sessions])
    e, base = e[calm], [b[calm] for b in base]
    m = np.column_stack([b / np.linalg.norm(b) for b in base if np.any(b)] or [np.zeros(len(e))])
    return e - m @ np.linalg.lstsq(m, e, rcond=None)[0]


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def own_part(sessions, name, p, plain):  # a bias is nothing but a zero, so it is measured without zeros
    return unexplained(sample(sessions, [(name, p)]) - plain, sessions, name != "bias")


def fit_scale(sessions, name, p, plain, want, peak):
    """The scale at which the effect has the wanted size, by the secant rule on logarithms."""
    s, last = 1.0, None
    for _ in range(30):
        now = rms(own_part(sessions, name, scaled(name, p, s, peak), plain))
        if abs(now / want - 1) < 0.003:
            break
        slope = np.clip(np.log(now / last[1]) / np.log(s / last[0]), 0.4, 3) if last and now > 0 and last[1] > 0 and now != last[1] and s != last[0] else 1.0
        last = (s, now)
        s = float(np.clip(s * np.clip(want / max(now, 1e-12), 0.02, 50) ** (1 / slope), 1e-5, 1e4))
    return s


def aliases(sessions, name, p, plain, noise, want_cols, peak):
    """Laws that make the same force on this design: they leave under 1 % of the power, or less than 5 standard deviations of the noise in all."""
    e = sample(sessions, [(name, p)]) - plain
    left = rms(unexplained(e, sessions, False))
    if left < 0.02 * noise:
        return []
    out = ["stribeck_friction"] if name in ("coulomb_friction", "stick") else []  # with Fs = Fc it is the same
    only = {"only": p["only"]} if "only" in p else {}
    for rival, law in LAWS.items():
        title = law.mechanism if law.mechanism is not None else rival
        if title in ("", "gain_error") or title in out or rival == name or set(law.needs) - set(want_cols):
            continue
        linear = law.stage in ("tissue", "contact", "machine") and set(law.how.values()) == {UP}
        scales = (1.0,) if linear else (0.3, 3.0)
        for shape in [{}] + SHAPES.get(rival, []):
            q = {**law.start, **shape, **only}
            if rival == "contact_offset" and not only:
                columns = [sample(sessions, [(rival, {"delta_mm": [0.01], "only": s.i})]) - plain for s in sessions]
            else:
                columns = [sample(sessions, [(rival, scaled(rival, q, z, peak))]) - plain for z in scales]
            if not any(np.any(c) for c in columns):
                continue
            both = unexplained(np.column_stack([e] + columns), sessions, False)
            m = both[:, 1:] / np.maximum(np.linalg.norm(both[:, 1:], axis=0), 1e-12)
            fit = m @ np.linalg.lstsq(m, both[:, 0], rcond=1e-6)[0]
            rest = rms(both[:, 0] - fit)
            if rival in ONE_SIGN and fit @ m[:, 0] < 0:
                continue
            if rest < 0.1 * left or rest * np.sqrt(len(e)) < 5 * noise:
                out.append(title)
                break
    return out


def bench(d, rng):
    """The sessions: motion, tissue, columns; fine grid of at least 4 kHz."""
    d.k = d.k or round(rng.uniform(0.6, 2.5), 3)
    d.c = d.c or round(float(np.exp(rng.uniform(np.log(0.01), np.log(0.1)))), 4)
    d.noise_n = d.noise_n or round(rng.uniform(0.007, 0.02), 4)
    fine = int(np.ceil(4000 / d.fs))
    seconds, dt = d.rows / d.n / d.fs, 1 / d.fs / fine
    sessions, before = [], None
    for i in range(d.n):
        blocks = motions.AIR if d.air_only else motions.CONTACT
        order = [blocks[q] for q in rng.permutation(len(blocks))]
        x, v, a = motions.motion(d, seconds, dt, order, rng)
        s = SimpleNamespace(i=i, dt=dt, t=np.arange(len(x)) * dt, x=x, v=v, a=a, k=d.own_k[i] if d.own_k else d.k, c=d.c, true={}, t0=i * (seconds + 4.0))
        s.pick = np.arange(0, len(x), fine)
        s.plain = force(s, [])
        s.calm = calm_rows(s)
        for name in d.cols:
            s.true[name] = channel.column(name, s, before, rng, d)
        s.first_c = (sessions[0] if sessions else s).true.get("temperature_c", [0])[0]
        sessions.append(s)
        before = s
    return sessions


def hidden_of(sessions, d, size, noise, plain):
    """Scale the effects; say what they are."""
    peak = float(plain.max())
    live = []
    for name, extra in d.effects:
        p = {**LAWS[name].start, **extra}
        fixed = p.pop("fixed", False)
        live.append([name, p if fixed else scaled(name, p, fit_scale(sessions, name, p, plain, size * noise, peak), peak)])
    if d.ratio:  # one of the two grows until Fc / (b vmax) is as asked
        fc, b = live[0][1], live[1][1]
        r = fc["fc_n"] / (b["b_n_s_per_mm"] * d.ratio[1]) / d.ratio[0]
        fc["fc_n"] *= max(1, 1 / r)
        b["b_n_s_per_mm"] *= max(1, r)
    out = []
    for name, p in live:
        law = LAWS[name]
        title = (law.mechanism if law.mechanism is not None else name) or None
        values = {key: q for key, q in p.items() if key not in ("only", "day", "column", "session_phase", "delta_mm")}
        if "delta_mm" in p:  # one delta for each session
            values = {f"delta_{s.i + 1}_mm": own(s, p["delta_mm"]) if p.get("only") in (None, s.i) else 0.0 for s in sessions}
        alike = aliases(sessions, name, p, plain, noise, d.cols, peak)
        entry = {"mechanism": title, "accept": sorted({q for q in [title, *alike, *d.accept] if q}), "parameters": values,
                 "variable": p.get("column", law.variable), "size": round(rms(own_part(sessions, name, p, plain)) / noise, 4)}
        if "only" in p:
            entry["session"] = p["only"] + 1
        if title is None:
            entry["what"] = name
        out.append(entry)
    return [tuple(q) for q in live], out


def make(name, seed, size):
    """All of one recording: table, rig, truth."""
    d = SimpleNamespace(**vars(FAMILIES[name]))
    rng = np.random.default_rng([zlib.crc32(name.encode()), seed])
    sessions = bench(d, rng)
    dt = 1 / d.fs
    plain = sample(sessions, [])
    kx = 0.0 if d.air_only else d.k * np.sqrt(d.xn**2 + d.wander**2 + d.quantum**2 / 12) * np.sqrt(np.mean(plain > 0))
    total = float(np.hypot(d.noise_n, kx))
    live, hidden = hidden_of(sessions, d, size, total, plain)
    noise = channel.force_noise(sessions, d.noise, d.arg, rng)
    limit = round(d.clip * float(plain.max()), 2) if d.clip else 20.0
    table = {q: [] for q in ("session", "t_s", "x_mm", "f_n", *(["v_mm_s"] if d.v else []), *d.cols)}
    for s, w in zip(sessions, noise):
        x = channel.encoder(s.x[s.pick], d, rng, d.fs)
        f = np.clip(np.round((force(s, live)[s.pick] + d.noise_n * w) / 0.0005) * 0.0005, -limit, limit)
        t = s.t[s.pick] + (s.t0 if d.clock else 0.0)
        if d.jitter:  # a stamp is late, seldom much; they stay in order
            t = np.maximum.accumulate(t + np.minimum(rng.exponential(d.jitter / 3, len(t)), d.jitter)) + np.arange(len(t)) * 1e-6
        if d.fault == "stuck_f" and s.i == 2:
            f[len(f) // 2:] = f[len(f) // 2]
        if d.fault == "stuck_x" and s.i == 4:
            x[len(x) // 3: 2 * len(x) // 3] = x[len(x) // 3]
        keep = np.ones(len(t), bool)
        for at in rng.choice(len(t) - 8, round(d.drop * len(t) / 4), replace=False) if d.drop else ():
            keep[at + 1:at + 5] = False
        full = {"session": np.full(len(t), s.i + 1), "t_s": t * (1.25 if d.fault == "clock" else 1),
                "x_mm": x, "f_n": f * (1000 if d.fault == "mn" else -1 if d.fault == "sign" and s.i == 1 else 1)}
        if d.v:
            full["v_mm_s"] = channel.SPEED[d.v](s.v[s.pick], x, dt)
        for q in d.cols:
            q_step = channel.STEP[q]
            full[q] = np.round(s.true[q][s.pick] * (d.rpm_column if q == "spindle_rpm" else 1) / q_step) * q_step
        for q in table:
            table[q].append(full[q][keep])
    table = {q: np.concatenate(parts) for q, parts in table.items()}
    if d.fault == "swap":
        table["x_mm"], table["f_n"] = table["f_n"], table["x_mm"]
    rig = {"position_quantum_mm": d.quantum, "force_quantum_n": 0.0005, "force_limit_n": limit}
    if d.guess and not d.air_only:
        rig = {"k_n_per_mm": round(d.k * rng.uniform(0.9, 1.1), 3), "c_n_s_per_mm": round(d.c * rng.uniform(0.85, 1.15), 4), **rig}
    silent = d.effects and d.accept_any is not None and not name.startswith("effect")
    truth = {"family": name, "kind": d.kind, "seed": seed, "size": size, "noise_sd_n": round(total, 5), "noise_force_sd_n": d.noise_n,
             "k_n_per_mm": [] if d.air_only else [s.k for s in sessions], "c_n_s_per_mm": [] if d.air_only else [s.c for s in sessions],
             "hidden": [] if silent else hidden, "notes": d.notes or advice(hidden)}
    if silent:
        truth["made"] = hidden
    for key in ("accept_any", "forbid", "fault", "options"):
        if getattr(d, key):
            truth[key] = list(getattr(d, key)) if key != "fault" else d.fault
    return table, rig, truth, d, sessions, live


def advice(hidden):
    if not hidden:
        return "nothing is left unexplained"
    return "; ".join((f"{h['mechanism'] or 'outside the list: ' + h['what']}" + (f" in session {h['session']} alone" if "session" in h else "")
                      + (f", not to be told from {', '.join(q for q in h['accept'] if q != h['mechanism'])}" if set(h["accept"]) - {h["mechanism"]} else "")) for h in hidden)


def write(table, d, path):
    """The CSV, in the units and manner of the family."""
    u = d.units or {}
    names, columns, units = [], [], []
    unit_of = {"session": "-", "t_s": "s", "x_mm": "mm", "f_n": "N", "v_mm_s": "mm/s"}
    begin = datetime(2024, 3, 5, 9, 30)
    for q, values in table.items():
        factor, head = u.get({"x_mm": "x", "f_n": "f", "v_mm_s": "v", "t_s": "t"}.get(q, ""), (1, q))
        values = values * factor + (u.get("zero", 0) if q == "x_mm" else 0)
        if q == "session":
            text = ["%d" % i for i in values]
        elif q == "t_s" and u.get("date"):
            text = [(begin + timedelta(minutes=int(i), seconds=float(t))).isoformat(sep=" ", timespec="microseconds") for i, t in zip(table["session"] * 3, values)]
        else:
            digits = {"t_s": 6, "x_mm": 5, "f_n": 5, "v_mm_s": 4}.get(q, 4)
            digits = max(0, digits - int(np.floor(np.log10(abs(factor)))))
            text = [f"{i:.{digits}f}" for i in values.tolist()]
        names.append(head)
        units.append({"mn": "mN", "gf": "gf", "kgf": "kgf", "lbf": "lbf", "um": "um", "in": "in", "m": "m", "ms": "ms"}.get(head.split("_")[-1], "") or unit_of.get(q, ""))
        columns.append([i.replace(".", ",") for i in text] if u.get("comma") else text)
    sep = u.get("sep", ",")
    with open(path, "w") as out:
        out.write(sep.join(names) + "\n" + (sep.join(units) + "\n" if u.get("line") else ""))
        out.writelines(sep.join(r) + "\n" for r in zip(*columns))


def main():
    ask = argparse.ArgumentParser()
    ask.add_argument("--list", action="store_true")
    ask.add_argument("--check", action="store_true")
    ask.add_argument("--family")
    ask.add_argument("--seed", type=int, default=1)
    ask.add_argument("--size", type=float, default=1.0)
    ask.add_argument("--out")
    a = ask.parse_args()
    if a.list:
        for d in FAMILIES.values():
            print(d.name, d.kind, d.text, sep="\t")
    elif a.check:
        import check
        sys.exit(check.main())
    elif a.family in FAMILIES and a.out:
        table, rig, truth, d, _, _ = make(a.family, a.seed, a.size)
        os.makedirs(a.out, exist_ok=True)
        write(table, d, os.path.join(a.out, "recording.csv"))
        with open(os.path.join(a.out, "rig.toml"), "w") as out:
            out.writelines(f"{q} = {float(v)!r}\n" for q, v in rig.items())
        with open(os.path.join(a.out, "truth.json"), "w") as out:
            json.dump(truth, out, indent=1)
            out.write("\n")
    else:
        ask.error("a family of --list, and --out")


if __name__ == "__main__":
    main()
