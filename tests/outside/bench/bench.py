#!/usr/bin/python3
"""Recordings of testing machines and handpiece benches.  bench.py --list | --family F --seed N --size S --out DIR"""
import argparse, json, os, sys, zlib
sys.dont_write_bytecode = True
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import numpy as np
import channel, laws, motions
from aliases import effective, indistinguishable
from families import BENCHES, FAMILIES


def pick(rng, value):
    """One of a tuple of choices, or the value itself."""
    return value[rng.integers(len(value))] if isinstance(value, tuple) else value


def draw_bench(rng, f):
    """The machine and the tissue: k N/mm, c N s/mm, depth, gap mm, speeds mm/s, rate Hz, seconds per session.
    force N is k depth."""
    kind = pick(rng, f["benches"])
    p = BENCHES[kind]
    b = {n: float(np.exp(rng.uniform(*np.log(p[n])))) for n in ("k", "depth", "slow", "fast")}
    b.update(kind=kind, rate=int(pick(rng, p["rate"])), bandwidth=p["bandwidth"], hold=p["hold"],
             rpm=float(rng.uniform(700, 2400)))
    damping = rng.uniform(*p["damping"])
    b.update({n: f[n] for n in ("k", "depth", "slow", "fast", "rate", "hold", "bandwidth") if n in f})
    damping = f.get("damping", damping)
    b["gap"], b["force"] = 0.4 * b["depth"], b["k"] * b["depth"]
    b["c"] = damping * b["force"] / b["fast"]
    if "fc_over_c" in f:
        b["c"] = min(0.02 * b["force"] / f["fc_over_c"], 0.6 * b["force"] / b["fast"])
    b["sessions"] = int(rng.integers(f["sessions"][0], f["sessions"][1] + 1))
    each = b["sessions"] * b["rate"]
    b["seconds"] = float(np.clip(rng.uniform(17000, 34000) / each, min(7.0, 55000 / each), 60))
    b["draw"] = rng.standard_normal(12) - 0.2
    return b


def nuisances(rng, f, b):
    """Differences between sessions: spread of k (share), surface mm, bias in noise sd, delay s."""
    n = dict(k=0.0, surface=0.0, bias=0.0, delay=0.0)
    if f["nuisance"] == "drawn":
        n["k"] = pick(rng, (0.0, 0.03, 0.1))
        if rng.random() < 0.4:
            n["surface"] = 0.005 * b["depth"]
        elif rng.random() < 0.4:
            n["bias"] = 0.5
    else:
        n.update(f["nuisance"])
    count = b["sessions"]
    return n, {name: n[name] * rng.uniform(-1, 1, count) for name in n}


def sessions(rng, f, b, between):
    """The runs on the fine grid, and the rows' times."""
    over = int(np.clip(np.ceil(1500 / b["rate"]), 5, 10))
    runs, rows, removed = [], [], 0.0
    names, odd = f["motions"].split(), f.get("odd", {})
    for i in range(b["sessions"]):
        seconds = b["seconds"] * (np.exp(rng.uniform(-0.9, 0.6)) if f.get("unequal") else 1.0)
        dt = 1 / (b["rate"] * over)
        x = motions.session(rng, b, names, seconds, dt)
        k = b["k"] * (1 + between["k"][i]) * (odd.get("k", 1.0) if i == 1 else 1.0)
        run = laws.Run(np.arange(len(x)) * dt, x, k, b["c"])
        run.number, run.over = i + 1, over
        for name in f["columns"].split():
            u = motions.COLUMNS[name](rng, run, b)
            if name == "removed_mm3":
                u = u + removed
                removed = u[-1]
            run.columns["spindle_rpm" if name == "steady_rpm" else name] = u
        if f.get("free"):
            run.free_phase = float(rng.random())
        runs.append(run)
        rows.append(channel.rows(rng, len(x) * dt, b["rate"], f["sampling"]))
    b["peak"] = max(r.fsim.max() for r in runs)
    return runs, rows


def at_rows(run, u, rows):
    return u[np.minimum(np.rint(rows / run.dt).astype(int), len(u) - 1)]


def rest(runs, rows, forces, where, active):
    """rms in N of what k and c cannot make of forces, as converted; in contact, or in air. Sessions where the law is
    not are left out."""
    used = [(r, t, u) for r, t, u, on in zip(runs, rows, forces, active) if on]
    x, v, m = (np.concatenate([at_rows(r, getattr(r, n), t) for r, t, _ in used]) for n in ("x", "v", "contact"))
    h = np.concatenate([channel.integrate(r.t, u, t, r.over * r.dt) for r, t, u in used])
    if where == "air":
        return float(np.sqrt(np.mean(h[~m] ** 2)))
    if not m.any():
        return 0.0
    basis = np.stack([x[m], v[m]], 1)
    left = h[m] - basis @ np.linalg.lstsq(basis, h[m], rcond=None)[0]
    return float(np.sqrt(np.mean(left ** 2)))


def solve(f, b, runs, rows, active, law, target_n):
    """The strength at which the rest is target_n, by bisection and false position on logarithms; bounded to 1e-3 to
    20."""
    def at(s):
        return rest(runs, rows, [effective(r, law[0], law[1](s, b)) for r in runs], f["rows"], active)
    s, value = 1.0, at(1.0)
    low, high = (1e-3, 0.0), (20.0, np.inf)  # (strength, rest) below and above what is asked for
    for step in range(24):
        if abs(value / target_n - 1) < 0.002:
            break
        low, high = ((s, value), high) if value < target_n else (low, (s, value))
        proportional = s * target_n / value if value > 0 else 0.0
        known = low[1] > 0 and np.isfinite(high[1])
        if known and step % 3:
            share = np.log(target_n / low[1]) / np.log(high[1] / low[1])
            s = float(np.exp(np.log(low[0]) + share * np.log(high[0] / low[0])))
        else:
            s = proportional if step < 4 and low[0] < proportional < high[0] else float(np.sqrt(low[0] * high[0]))
        value = at(s)
    return s, value


def compose(run, b, hidden):
    """Force in N on the fine grid, and the position that is recorded: tissue, then the machine, then the channels."""
    felt = [(law, p, laws.LAWS[law](run, **p)) for law, p in hidden if law not in laws.CHANNEL | laws.POSITION]
    force = np.maximum(0.0, run.fsim + sum((h for law, _, h in felt if law in laws.TISSUE), np.zeros(len(run.t))))
    force = force + sum((h for law, _, h in felt if law not in laws.TISSUE), 0.0)
    x, v = run.x, run.v
    for law, p in hidden:
        if law == "delay":
            force = laws.shift(force, p["tau_s"], run.t)
        elif law == "low_pass":
            force = laws.lag(force, p["tau_s"], run.dt)
        elif law == "saturation":
            force = np.minimum(force, p["f_max_n"])
        elif law == "ringing":
            z = (p["frequency_hz"], p["damping_ratio"], run.dt)
            force = force + p["share"] * (laws.resonate(force, *z) - force)
            force = force + p["mass_kg"] * laws.resonate(run.a, *z) / 1000
        elif law in laws.POSITION:
            x = laws.shift(x, p["tau_s"], run.t) if law == "position_late" else laws.lag(x, p["tau_s"], run.dt)
            v = np.gradient(x, run.dt)
    return force, x, v


def make(family, seed, size):
    """Everything about one recording, as a dictionary; write() puts it down."""
    f = FAMILIES[family]
    rng = np.random.default_rng([seed, zlib.crc32(family.encode())])
    b = draw_bench(rng, f)
    x_noise, noise_kind, v_kind = pick(rng, f["x_noise"]), pick(rng, f["noise"]), pick(rng, f["v"])
    spread, between = nuisances(rng, f, b)
    runs, rows = sessions(rng, f, b, between)
    count = len(runs)
    chosen = rng.permutation(count)[:f["only"]] if f["only"] else np.arange(count)
    active = np.isin(np.arange(count), chosen)
    sampling, noises = np.random.default_rng([seed, zlib.crc32(family.encode()), 1]), []

    # the noise: as large as the (lesser) law at strength 1, within 0.1 to 3 % of the force; x noise and steps count
    # as noise too
    fixed_n = b["k"] * np.hypot(x_noise, f["x_quantum"] / np.sqrt(12))
    searched = () if f.get("fixed") else f["laws"]
    at_one = [rest(runs, rows, [effective(r, n, p(1.0, b)) for r in runs], f["rows"], active) for n, p in searched]
    wanted = min(at_one) if at_one else b["force"] * np.exp(rng.uniform(np.log(0.005), np.log(0.02)))
    f_quantum = f["f_quantum"] * b["force"]
    sd = float(np.clip(np.sqrt(max(wanted ** 2 - fixed_n ** 2, 0)), 0.001 * b["force"], 0.03 * b["force"]))
    noise_n = float(np.sqrt(sd ** 2 + fixed_n ** 2 + f_quantum ** 2 / 12))

    hidden, described = [], []
    for name, parameters in f["laws"]:
        s, value = (1.0, 0.0) if f.get("fixed") else solve(f, b, runs, rows, active, (name, parameters),
                                                           size * noise_n)
        p = parameters(s, b)
        hidden.append((name, p))
        described.append(dict(mechanism=laws.GOES_BY.get(name, name), law=name,
                              parameters={n: float(u) for n, u in p.items()}, size=value / noise_n))

    table, biases = [], sd * between["bias"]
    for i, (run, t) in enumerate(zip(runs, rows)):
        force, x, v = compose(run, b, hidden if active[i] else [])
        if between["delay"][i]:
            force = laws.shift(force, between["delay"][i], run.t)
        width = 1 / b["rate"]
        clean_f = channel.integrate(run.t, force, t, width) + biases[i]
        louder = f.get("odd", {}).get("noise", 1.0) if i == 1 else 1.0
        noises.append(channel.noise(sampling, noise_kind, t, np.abs(clean_f)) * louder)
        x_rows = np.interp(t, run.t, x) + between["surface"][i]
        seen = channel.quantise(x_rows + x_noise * sampling.standard_normal(len(t)), f["x_quantum"])
        speed = channel.speed(sampling, v_kind, t, seen, np.interp(t, run.t, v), b)
        columns = {n: at_rows(run, u, t) for n, u in run.columns.items()}
        table.append(dict(t=t, x=seen, f=clean_f, v=speed, columns=columns, x_error=seen - x_rows,
                          base=channel.integrate(run.t, run.fsim, t, width)))
    scale = sd / np.concatenate(noises).std()
    for rec, u in zip(table, noises):
        rec["noise"] = u * scale
        rec["f"] = channel.quantise(rec["f"] + rec["noise"], f_quantum or 1e-6)

    rho = float(np.mean([np.corrcoef(u[1:], u[:-1])[0, 1] for u in noises]))
    n_eff = sum(map(len, rows)) * (1 - max(rho, 0)) / (1 + max(rho, 0))
    for (name, p), d in zip(hidden, described):
        same = []
        if d["mechanism"] and not f.get("fixed"):
            thin = [r.thin(r.over) for r in runs]
            felt = [effective(r, name, p)[::r.over] * active[j] for j, r in enumerate(runs)]
            same = indistinguishable(thin, felt, d["mechanism"], b, noise_n, n_eff)
        d["accept"] = ([d["mechanism"]] if d["mechanism"] else []) + same
        # an even spindle with another phase in each session is a fixed frequency
        if f.get("free") and name == "run_out":
            d["accept"] += ["chatter"]
    any_of = (["contact_offset"] if spread["surface"] else []) + (["bias"] if spread["bias"] else [])
    any_of += ["delay", "low_pass", "position_late"] if spread["delay"] else []
    # in few sessions, or not to be seen: to name it is right, not to name it is right too
    apart = f["only"] or f.get("fixed")
    if apart:
        any_of += [n for d in described for n in d["accept"]]
    truth = dict(family=family, kind=f["kind"], seed=seed, size=size, hidden=[] if apart else described,
                 accept_any=any_of, options=options(f),
                 beside_hidden=described if apart else [],
                 sessions_with_it=[int(i) + 1 for i in chosen] if f["only"] else None,
                 noise=dict(kind=noise_kind, force_sd_n=sd, x_sd_mm=x_noise, all_sd_n=noise_n, lag_1=rho), v=v_kind,
                 between={n: u.tolist() for n, u in between.items() if spread[n]},
                 bias_by_session_n=biases.tolist() if spread["bias"] else None,
                 bench={n: u for n, u in b.items() if n != "draw"})
    rig = dict(k_n_per_mm=b["k"] * rng.uniform(0.9, 1.1), c_n_s_per_mm=b["c"] * rng.uniform(0.8, 1.2),
               position_quantum_mm=f["x_quantum"],
               force_quantum_n=f_quantum, force_limit_n=3 * b["peak"] if b["peak"] > 0 else 20.0)
    return dict(table=table, truth=truth, rig=rig, bench=b, family=f, runs=runs, noise_n=noise_n)


def options(f):
    """In the words that score.py reads."""
    return ["surface at 37.25 mm", "compression is negative"] if f.get("machine") else []


def write(made, folder):
    """recording.csv, rig.toml, truth.json."""
    os.makedirs(folder, exist_ok=True)
    f, table = made["family"], made["table"]
    columns = list(table[0]["columns"])
    header = ["session", "t_s", "x_mm", "f_n"] + (["v_mm_s"] if table[0]["v"] is not None else []) + columns
    x_scale, x_zero, t_scale, f_scale, parting = 1.0, 0.0, 1.0, 1.0, ","
    if f.get("units"):
        header[:4] = ["session", "Time [ms]", "Position [um]", "Force [mN]"]
        x_scale, t_scale, f_scale, parting = 1e3, 1e3, 1e3, ";"
    if f.get("machine"):
        x_zero, f_scale = 37.25, -1.0
    with open(os.path.join(folder, "recording.csv"), "w", newline="\n") as out:
        out.write(parting.join(header) + "\n")
        for i, rec in enumerate(table):
            cells = [np.full(len(rec["t"]), i + 1), rec["t"] * t_scale, rec["x"] * x_scale + x_zero,
                     rec["f"] * f_scale]
            cells += [rec["v"]] if rec["v"] is not None else []
            cells += [rec["columns"][n] for n in columns]
            fmt = parting.join(["%d", "%.6f", "%.6f", "%.6f"] + ["%.7g"] * (len(cells) - 4))
            out.write("\n".join(fmt % row for row in zip(*(u.tolist() for u in cells))) + "\n")
    with open(os.path.join(folder, "rig.toml"), "w", newline="\n") as out:
        out.write("".join(f"{n} = {float(u):.6g}\n" for n, u in made["rig"].items()))
    with open(os.path.join(folder, "truth.json"), "w", newline="\n") as out:
        json.dump(made["truth"], out, indent=1)
        out.write("\n")


def main():
    a = argparse.ArgumentParser(description=__doc__)
    a.add_argument("--list", action="store_true")
    a.add_argument("--family")
    a.add_argument("--seed", type=int, default=1)
    a.add_argument("--size", type=float, default=1.0)
    a.add_argument("--out")
    a = a.parse_args()
    if a.list:
        print("\n".join(f"{name}\t{f['kind']}" for name, f in FAMILIES.items()))
    elif a.family in FAMILIES and a.out:
        write(make(a.family, a.seed, a.size), a.out)
    else:
        sys.exit("bench.py: --list, or --family of the list and --out")


if __name__ == "__main__":
    main()
