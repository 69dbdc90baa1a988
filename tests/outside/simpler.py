#!/usr/bin/python3
"""A yardstick for `cavum explain`: what textbook methods make of the same recordings, in the same JSON names.

  simpler.py --method stlsq|bic|bma [--effective-rows] explain FILE [--json] [--seed N] [--surface-mm Z] [--negate x]
FILE is a recording.csv in mm, N and s, with a rig.toml beside it. Nothing is drawn at random: the seed is not used.

All share the base law F = max(0, k X + c V), k and c fitted anew in each model, and one library: each law of
docs/laws.md is a few columns, those with a parameter inside (a time, a depth, a power) in a small grid of shapes.
The grid is made finer where the data ask for it: around each law's best shape alone, then around those of the last
answer together, until the answer stays (three times at most). A model has one shape of each law. Over 20000 rows,
means of blocks of rows are fitted.
  stlsq  Sequentially thresholded least squares: fit all laws, drop those whose force is below lambda, fit again,
         until none drops. Brunton, Proctor, Kutz, PNAS 113 (2016) 3932; a ridge as in Rudy et al., Sci. Adv. 3
         (2017) e1602614. lambda by cross-validation and the rule of one standard error (Breiman et al. 1984; Hastie
         et al., Elements of Statistical Learning, 7.10). Probability: share of the cross-validation's fits that keep
         the law, after Fasel et al., Proc. R. Soc. A 478 (2022) 20210904.
  bic    Forward selection, each step looked over backwards, by BIC = n ln(RSS / n) + p ln n (Schwarz, Ann. Stat. 6
         (1978) 461). n: the rows, or with --effective-rows n / (1 + 2 sum rho_j), rho of the larger model's
         residual. Probability: 1 / (1 + exp(-dBIC / 2)), dBIC what leaving the law out costs (Raftery, Sociol.
         Methodol. 25 (1995) 111).
  bma    Average over all models of one and two laws, and those of three that extend the best hundred pairs, in
         closed form with Zellner's g-prior, g = max(n, p^2) (Fernandez, Ley, Steel, J. Econometrics 100 (2001) 381),
         after AR(1) whitening (Prais, Winsten 1954). Prior: uniform in size, then in the set (Scott, Berger, Ann.
         Stat. 38 (2010) 2587). Occam's window of 20 (Madigan, Raftery, J. Am. Stat. Assoc. 89 (1994) 1535).
         Probability: posterior inclusion. Named above 0.5: the law or, where laws stand in for each other, their
         set.
Aliases, in all three: laws that may take a named law's place at no cost that the method would notice.
"""
import argparse, collections, csv, itertools, json, math, os, re, sys
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np

BASE = 2                       # the first columns are k X and c V, in contact
KNOWN = set("session t_s x_mm f_n v_mm_s spindle_rpm wet posture_deg approach_deg fy_n fz_n removed_mm3 bur_id site "
            "layer temperature_c".split())
# A law's shape. columns: indices; sign: 1 where coefficients must be positive; inner: how many parameters sit inside;
# prior: log, within its law; own: has columns of single sessions; what: in words; grid, value: for finer ones
Shape = collections.namedtuple("Shape", "law columns sign inner prior own what grid value")
# function(values): for each value of the parameter inside, the columns of its shape
Grid = collections.namedtuple("Grid", "law values function sign name")


# ---- the recording ----

def refuse(what):
    sys.stderr.write(f"simpler: {what}\n")
    sys.exit(2)


def read_recording(path):
    """Columns by name: numbers where all cells are, else text. Separator: the header's comma, semicolon or tab."""
    with open(path, encoding="utf-8-sig", errors="replace", newline="") as file:
        lines = [l for l in file.read().splitlines() if l.strip() and not l.startswith("#")]
    rows = list(csv.reader(lines, delimiter=max(",;\t", key=lines[0].count)))
    header, data = [h.strip() for h in rows[0]], {}
    if missing := {"session", "t_s", "x_mm", "f_n"} - set(header):
        refuse(f"{path}: no column {', '.join(sorted(missing))}; this yardstick reads mm, N and s alone")
    for name, cells in zip(header, zip(*rows[1:])):
        try:
            data[name] = np.array([c if c.strip() else "nan" for c in cells], float)
        except ValueError:
            data[name] = np.array(cells)
    if any(data[name].dtype.kind != "f" for name in ("t_s", "x_mm", "f_n")):
        refuse(f"{path}: t_s, x_mm and f_n must be numbers")
    good = np.all([np.isfinite(c) for n, c in data.items() if c.dtype.kind == "f" and n in KNOWN], axis=0)
    return {n: c[good] for n, c in data.items()}


def read_rig(path):
    """The numbers and lists of numbers of rig.toml; nothing where there is none."""
    text = open(path).read() if os.path.exists(path) else ""
    number = re.compile(r"-?[0-9.]+(?:e[-+]?\d+)?", re.I)
    keys = re.finditer(r"^\s*(\w+)\s*=\s*([^#\n]*)", text, re.M)
    return {m[1]: [float(v) for v in number.findall(m[2])] for m in keys}


def savgol(u, t, window):
    """Value, first and second derivative of u(t) by a parabola over `window` rows (Savitzky, Golay 1964)."""
    half = window // 2
    if len(u) < 2 * window or half < 1:
        d = np.gradient(u, t) if len(u) > 2 else np.zeros_like(u)
        return u, d, np.gradient(d, t) if len(u) > 2 else d
    even = np.linspace(t[0], t[-1], len(t))
    g = np.interp(even, t, u)
    g = np.concatenate([2 * g[0] - g[half:0:-1], g, 2 * g[-1] - g[-2:-half - 2:-1]])
    weights = np.linalg.pinv(np.vander(np.arange(-half, half + 1) * (even[1] - even[0]), 3, increasing=True))
    return tuple(np.interp(t, even, m * np.convolve(g, w[::-1], "valid")) for w, m in zip(weights, (1, 1, 2)))


def chain(a, b):
    """s_i = a_i s_(i-1) + b_i, all rows at once by doubling. a_i = 0 starts anew."""
    a, b, d = a.copy(), b.copy(), 1
    while d < len(a) and np.abs(a).max() > 1e-14:
        b[d:], a[d:] = b[d:] + a[d:] * b[:-d], a[d:] * a[:-d]
        d *= 2
    return b


def one_pole(u, dt, rates, start=None):
    """s' = -r s + u for each (complex) rate r, 1/s: n x rates. Where dt is 0 it starts at start / r, or 0."""
    rates = np.asarray(rates)
    decay = np.exp(-np.outer(dt, rates))
    drive = (1 - decay) / rates * (u + np.roll(u, 1))[:, None] / 2
    first = dt <= 0
    decay[first], drive[first] = 0, 0 if start is None else start[first, None] / rates
    return chain(decay, drive)


def play(x, dt, half):
    """s_i = s_(i-1) held within x_i - half and x_i + half, mm. To hold twice is to hold once: by doubling."""
    first = (dt <= 0)[:, None]
    low, high = (np.where(first, x[:, None], x[:, None] + side * half) for side in (-1, 1))
    d = 1
    while d < len(x):
        low[d:], high[d:] = np.clip(low[:-d], low[d:], high[d:]), np.clip(high[:-d], low[d:], high[d:])
        d *= 2
    return low


# ---- the library of laws ----

class Recording:
    """Rows, the motion as smooth as the base law likes it best, and the library of columns with its shapes."""

    def __init__(self, data, rig):
        order = {name: i for i, name in enumerate(dict.fromkeys(data["session"]))}
        session = np.array([order[name] for name in data["session"]])
        rows = np.argsort(session, kind="stable")     # each session's rows together
        self.data, self.session = {n: c[rows] for n, c in data.items()}, session[rows]
        self.raw, self.t = self.data["f_n"], self.data["t_s"]
        self.whole = [np.flatnonzero(self.session == s) for s in range(len(order))]
        self.names = [str(name) for name in order]
        self.dt = np.zeros(len(self.raw))             # 0 in the first row of a session
        for p in self.whole:
            self.dt[p[1:]] = np.maximum(np.diff(self.t[p]), 1e-9)
        self.step = float(np.median(self.dt[self.dt > 0]))
        self.move(rig)
        # the laws are made at the file's rate; what is fitted are means of blocks, 20000 at most
        block = math.ceil(len(self.raw) / 20000)
        self.starts = np.concatenate([p[::block] for p in self.whole])
        gap = np.maximum.reduceat(np.where(self.dt > 0, self.dt, math.inf), self.starts)
        self.joined = gap < 1.5 * self.step           # blocks that follow the one before without a gap
        self.f, self.session = self.thin(self.raw), self.session[self.starts]
        self.parts = [np.flatnonzero(self.session == s) for s in range(len(order))]
        self.folds = np.zeros(len(self.f), int)       # an eighth of each session, another one in each: blocked folds
        for s, p in enumerate(self.parts):            # (Roberts et al., Ecography 40 (2017) 913)
            self.folds[p] = (np.arange(len(p)) * 8 // len(p) + s) % 8
        self.columns, self.shapes, self.scale, self.untestable, self.kept = [], [], [], [], None
        self.build(rig)

    @property
    def sums(self):
        if self.kept is None or self.kept.width != len(self.columns):
            self.kept = Sums(np.column_stack(self.columns), self.f, self.folds)
        return self.kept

    def thin(self, u):
        """Means of blocks of rows."""
        return np.add.reduceat(u, self.starts) / np.diff(np.append(self.starts, len(u)))

    def by_session(self, u, function):
        """function(u of a session, its times), put together again."""
        return np.concatenate([function(u[p], self.t[p]) for p in self.whole])

    def sim(self, x, v):
        """F = max(0, k X + c V) in contact, N, with the library's k and c: rig.toml's, if given."""
        return np.where(x > 0, np.maximum(0, self.k * x + self.c * v), 0)

    def move(self, rig):
        """X, V, acceleration. A wider window must lower the base law's RSS by 2 %. V: the file's, if given."""
        best, given = None, self.data.get("v_mm_s")
        for window in (1, 5, 9, 15, 25, 41):
            smooth = [savgol(self.data["x_mm"][p], self.t[p], window) for p in self.whole]
            x = np.concatenate([s[0] for s in smooth])
            v = np.concatenate([s[1] for s in smooth]) if given is None else given
            k, c = rig.get("k_n_per_mm", [0])[0], rig.get("c_n_s_per_mm", [0])[0]
            for _ in range(1 if k > 0 else 5):        # without k, the contact is found again each time
                on = (x > 0) & (k * x + c * v > 0 if k > 0 else True)
                z = np.column_stack([x * on, v * on])
                fit = np.linalg.lstsq(z, self.raw, rcond=None)[0]
                k, c = (k, c) if "k_n_per_mm" in rig else (max(fit[0], 1e-6), max(fit[1], 0.0))
            rss = float(np.sum((self.raw - z @ fit) ** 2))
            if best is None or rss < 0.98 * best:
                best, self.x, self.v, self.k, self.c, self.window = rss, x, v, k, c, window
        wide, by = max(self.window, 9), 2 if given is None else 1
        self.a = self.by_session(self.x if given is None else self.v, lambda u, t: savgol(u, t, wide)[by])
        self.force = self.sim(self.x, self.v)
        self.on = (self.force > 0).astype(float)
        self.member = [(self.session == s).astype(float) for s in range(len(self.whole))]

    def stack(self, model):
        """k X, c V and the columns of a model."""
        return np.column_stack([self.columns[i] for i in index_of(model)])

    def beyond(self, columns, model=()):
        """What k, c and a model leave of the columns."""
        q = np.linalg.qr(self.stack(model))[0]
        return columns - q @ (q.T @ columns)

    def add(self, law, columns, sign=0, inner=0, shapes=1, own=False, what="", grid=None, value=0.0):
        """One shape of a law, of so many. Columns that keep under 1 % of their norm beside k and c show nothing."""
        columns = [self.thin(np.asarray(c, float)) for c in columns]
        if law != "base":
            kept = [c for c in columns if np.linalg.norm(self.beyond(c)) > 0.01 * np.linalg.norm(c)]
            if not kept or len(kept) < len(columns) and not own:
                self.untestable.append(law)
                return None
            columns = kept
        index = list(range(len(self.columns), len(self.columns) + len(columns)))
        for c in columns:                             # in units of their root mean square
            self.scale.append(float(np.sqrt(np.mean(c ** 2))) or 1.0)
            self.columns.append(c / self.scale[-1])
        shape = Shape(law, index, sign, inner, -math.log(shapes), own, what, grid, value)
        if law != "base":
            self.shapes.append(shape)
        return shape

    def add_grid(self, law, values, function, sign=1, name="", shapes=None, each=True):
        """A shape for each value of the parameter inside. each: the function takes one value and gives one column."""
        many = (lambda vs: [[function(v)] for v in vs]) if each else function
        grid = Grid(law, np.sort(np.array(values, float)), many, sign, name)
        for value, columns in zip(grid.values, many(grid.values)):
            self.add(law, columns, sign, 1, shapes or len(values), what=f"{name}{value:.4g}", grid=grid, value=value)

    def finer(self, shape, beside):
        """The shape of least squares beside a model, between its grid's neighbours: three rounds of seven.

        The parameter inside, now free, weighs ln(n) / 2 in the prior (unit information, Kass and Wasserman 1995)."""
        if shape.law == "contact_offset":
            return self.offsets(shape, beside)
        if shape.grid is None:
            return shape
        grid, rest, best = shape.grid, self.beyond(self.f, beside), None
        ladder = np.concatenate([grid.values[:1] / 2, grid.values, grid.values[-1:] * 1.5])
        low, high = ladder[ladder < shape.value * (1 - 1e-9)].max(), ladder[ladder > shape.value * (1 + 1e-9)].min()
        for _ in range(3):
            trial = np.linspace(low, high, 9)
            for value, columns in zip(trial[1:-1], grid.function(trial[1:-1])):
                z = self.beyond(np.column_stack([self.thin(c) for c in columns]), beside)
                w = np.linalg.lstsq(z, rest, rcond=1e-6)[0]
                rss = np.sum((rest - z @ w) ** 2)
                if (best is None or rss < best[0]) and (grid.sign == 0 or np.all(w >= 0)):
                    best = rss, value, columns
            if best is None:
                return shape
            low, high = best[1] - (trial[1] - trial[0]), best[1] + (trial[1] - trial[0])
        what = f"{grid.name}{best[1]:.4g}"
        return self.add(grid.law, best[2], grid.sign, 1, math.sqrt(len(self.f)), False, what, grid, best[1]) or shape

    def offsets(self, shape, beside):
        """F_sim(X + delta) - F_sim(X), the contact where the deltas put it: Gauss and Newton; linear below 2 um."""
        many, flat = len(self.member), [self.thin(self.k * self.on * m) for m in self.member]
        z = np.column_stack([self.stack(beside), *flat])
        delta = np.linalg.lstsq(z, self.f, rcond=1e-9)[0][-many:]
        for _ in range(4):
            delta = np.where(delta < 0, -1, 1) * np.clip(np.abs(delta), 1e-6, 1.0)
            columns = [(self.sim(self.x + d, self.v) - self.force if abs(d) > 0.002 else self.k * d * self.on) * m
                       for d, m in zip(delta, self.member)]
            z[:, -many:] = np.column_stack([self.thin(c) for c in columns])
            w = np.linalg.lstsq(z, self.f, rcond=1e-9)[0]
            delta = delta * np.clip(w[-many:] * self.k * self.scale[0] / w[0], -2, 2)   # k is the fit's
        return self.add(shape.law, columns, own=True, what="finite") or shape

    def lines(self):
        """The three sharpest lines of the base law's residual, Hz, and how many were looked through.

        Periodogram, mean of the sessions, over its running median."""
        z = np.column_stack([self.x * self.on, self.v * self.on, np.ones(len(self.raw))])
        rest = self.raw - z @ np.linalg.lstsq(z, self.raw, rcond=None)[0]
        longest = max(len(p) for p in self.whole)
        size, power = 8 * 2 ** math.ceil(math.log2(longest)), 0.0
        for p in self.whole:
            u = np.interp(np.linspace(self.t[p[0]], self.t[p[-1]], len(p)), self.t[p], rest[p])
            power = power + np.abs(np.fft.rfft((u - u.mean()) * np.hanning(len(u)), size)) ** 2
        coarse = power[:len(power) // 64 * 64].reshape(-1, 64).mean(1)
        floor = np.array([np.median(coarse[max(0, i - 8):i + 9]) for i in range(len(coarse))])
        hz = np.fft.rfftfreq(size, self.step)[:64 * len(floor)]
        ratio, found = np.where(hz < 1.0, 0, power[:len(hz)] / np.repeat(floor, 64)), []
        while len(found) < 3 and ratio.max() > 0:
            i = int(np.argmax(ratio))
            found.append(float(hz[i]))
            ratio[max(0, i - 32):i + 33] = 0
        return found, longest // 2

    def build(self, rig):
        """The laws of docs/laws.md. The tissue's are gated by contact, those felt in air are not. `force`: F_sim."""
        x, v, t, on, force, one = self.x, self.v, self.t, self.on, self.force, np.ones(len(self.t))
        data = {n: c for n, c in self.data.items() if c.dtype.kind == "f" and np.isfinite(c).all() and np.ptp(c) > 0}
        top, add, add_grid = float(np.max(force)) or 1.0, self.add, self.add_grid
        split = lambda z: [[c] for c in z.T]
        add("base", [x * on, v * on])
        # the load cell and the drive
        add("bias", [one])
        add("drift", [t - t.min()], shapes=5, what="linear")
        add_grid("drift", (3, 10, 30, 100), lambda tau: 1 - np.exp(-(t - t.min()) / tau), 0, "tau_s ", 5)
        add("contact_offset", [self.k * on * m for m in self.member], own=True)
        add_grid("coulomb_friction", (0.01, 0.1, 0.5, 2.0), lambda v0: np.tanh(v / v0), 1, "v0_mm_s ")
        slip = np.tanh(v / 0.01)
        falling = lambda many: [[slip, np.exp(-(v / vs) ** 2) * slip] for vs in many]
        add_grid("stribeck_friction", (0.05, 0.2, 1.0, 5.0), falling, 1, "vs_mm_s ", each=False)
        add("viscous_friction", [v], 1)
        add("inertia", [self.a], 1)
        if "posture_deg" in data:
            add("gravity_posture", [np.sin(np.radians(data["posture_deg"])), one])
        if lateral := [data[n] for n in ("fy_n", "fz_n") if n in data]:
            add("cross_talk", lateral)
        # the force's channel
        shift = lambda tau: self.by_session(force, lambda u, at: np.interp(at - tau, at, u)) - force
        lag = lambda taus: one_pole(force, self.dt, 1 / taus, force) / taus - force[:, None]
        add_grid("delay", (0.002, 0.005, 0.01, 0.02, 0.04), shift, 1, "tau_s ")
        add_grid("position_late", (0.002, 0.005, 0.01, 0.02, 0.04), lambda tau: shift(-tau), 1, "tau_s ")
        add_grid("low_pass", (0.003, 0.01, 0.03, 0.1), lambda taus: split(lag(taus)), 1, "tau_s ", each=False)
        cut = lambda part: np.minimum(force, part * top) - force
        add_grid("saturation", (0.4, 0.55, 0.7, 0.8, 0.9), cut, 1, "of peak ")
        # memory of the motion
        for ahead, word in ((0, "half_mm "), (1, "surface set on the way in, half_mm ")):
            free = lambda half, ahead=ahead: [[self.sim(tip + ahead * h, v) - force]
                                              for tip, h in zip(play(x, self.dt, half).T, half)]
            add_grid("backlash", (0.01, 0.02, 0.04, 0.08, 0.16), free, 1, word, 10, False)
        inside = (self.dt > 0) & (x > 0)
        dx = np.where(inside, x - np.roll(x, 1), 0)[:, None]

        def loop(d):       # z' = V - |V| z / d, exact for a step of the position, begun anew with each contact
            decay = np.exp(-np.abs(dx) / d)
            return split(chain(np.where(inside[:, None], decay, 0), np.sign(dx) * d * (1 - decay)) * on[:, None])

        # q' = V - q / tau in contact
        memory = lambda taus: split(one_pole(v * (x > 0), self.dt, 1 / taus) * on[:, None])
        add_grid("hysteresis", (0.02, 0.06, 0.2, 0.6), loop, 1, "d_mm ", each=False)
        add_grid("relaxation", (0.03, 0.1, 0.3, 1, 3, 10), memory, 1, "tau_s ", each=False)
        # other stiffness. A linear spring in series makes a lag of c / (k + ks)
        soft = lambda part: force / (1 + force / (part * top)) - force
        add_grid("series_compliance", (1, 3, 10), soft, 1, "softening, peaks ", 6)
        late = lambda parts: split(lag(max(self.c, 1e-6) / self.k / (1 + parts)) * on[:, None])
        add_grid("series_compliance", (3, 10, 30), late, 1, "ks over k ", 6, False)
        deep = np.maximum(x, 0) * on
        add_grid("nonlinear_stiffness", (0.5, 0.75, 1.25, 1.5, 2, 3), lambda m: deep ** m - deep, 1, "m ")
        depths = [d for d in rig.get("layer_depths_mm", []) if 0 < d < deep.max()]
        depths += list(np.quantile(deep[deep > 0], np.arange(0.1, 0.95, 0.1))) if deep.any() else []
        add_grid("hidden_layer", depths, lambda d0: np.maximum(deep - d0, 0), 0, "d0_mm ")
        add("graded_stiffness", [deep ** 2])
        add_grid("feed_power_law", (0.3, 0.5, 0.7, 1.5, 2), lambda n: (np.abs(v) ** n * np.sign(v) - v) * on, 1, "n ")
        if "approach_deg" in data:
            phi = 2 * np.radians(data["approach_deg"])
            for by, what in ((force, "of the force"), (on, "constant")):
                add("anisotropy", [by * np.cos(phi), by * np.sin(phi)], shapes=2, what=what)
        # the bur and the cut
        rpm = self.data.get("spindle_rpm", one)
        spinning = on * (rpm > 0)
        add("edge_force", [spinning])
        for law, name in (("wear", "removed_mm3"), ("coolant", "wet"), ("thermal_softening", "temperature_c")):
            if name in data:
                add(law, [force * (data[name] - (data[name][0] if law == "thermal_softening" else 0))])
        found, looked = self.lines()
        gates = ("chatter", on), ("interference", one)
        waves = [(law, f, t * f, gate, looked) for law, gate in gates for f in found]
        if "spindle_rpm" in self.data and np.any(rpm > 0):
            waves.append(("run_out", 0, self.by_session(rpm / 60 * self.dt, lambda u, at: np.cumsum(u)), spinning, 1))
        for law, f, phase, gate, many in waves:       # one phase for all sessions, or one for each
            pair, what = [gate * np.sin(2 * np.pi * phase), gate * np.cos(2 * np.pi * phase)], f"{f:.3f} Hz"
            add(law, pair, 0, int(f > 0), 2 * many, what=what)
            if len(self.member) > 1:
                pair = [w * m for m in self.member for w in pair]
                add(law, pair, 0, int(f > 0), 2 * many, True, what + " by session")
        for f, zeta in itertools.product(found, (0.005, 0.02, 0.1)):
            w, swing = 2 * np.pi * f, 2 * np.pi * f * math.sqrt(1 - zeta ** 2)
            pole = np.array([zeta * w - 1j * swing])
            y, ya = (one_pole(u, self.dt, pole)[:, 0].imag * w ** 2 / swing for u in (force, self.a))
            add("ringing", [y - force, ya], 0, 2, 3 * looked, what=f"{f:.3f} Hz, zeta {zeta}")
        for name in sorted(set(data) - KNOWN):        # any other column, as a zero and as a stiffness
            unit = (data[name] - data[name].mean()) / data[name].std()
            for by, what in ((one, "zero"), (force, "stiffness")):
                add("column " + name, [unit * by], shapes=2, what=what)


# ---- least squares from sums of products ----

class Sums:
    """G = [Z y]'[Z y], whole and by fold. Each model is then a small system."""

    def __init__(self, z, y, folds):
        parts = [np.column_stack([z[folds == j], y[folds == j]]) for j in range(8)]
        self.by_fold, self.rows = [p.T @ p for p in parts], [max(1, len(p)) for p in parts]
        self.all, self.n, self.width = sum(self.by_fold), len(y), z.shape[1]

    def fit(self, index, g=None, ridge=1e-9):
        """Coefficients of the columns `index`; residual sum of squares."""
        g = self.all if g is None else g
        a, b = g[index][:, index], g[index, -1]
        w = np.linalg.solve(a + ridge * self.n * np.eye(len(index)), b)
        return w, max(float(g[-1, -1] - 2 * b @ w + w @ a @ w), 1e-300)

    def crossed(self, models):
        """Mean squared error of each fold, N^2, fitted on the others. models: one for each fold."""
        out = []
        for model, g, n in zip(models, self.by_fold, self.rows):
            index = index_of(model)
            w = self.fit(index, self.all - g)[0]
            out.append((g[-1, -1] - 2 * g[index, -1] @ w + w @ g[index][:, index] @ w) / n)
        return np.array(out)

    def squares(self, model):
        """Residual sum of squares, N^2; infinite where a coefficient has a sign that its law cannot have."""
        w, rss = self.fit(index_of(model))
        return math.inf if any(s < 0 for s in w[BASE:] * np.array([m.sign for m in model for _ in m.columns])) else rss


def index_of(model):
    return list(range(BASE)) + [c for s in model for c in s.columns]


def laws_of(shapes):
    out = {}
    for s in shapes:
        out.setdefault(s.law, []).append(s)
    return out


def best_shapes(model, shapes, score):
    """Each law of the model in turn in its best shape, the others held; twice round."""
    model, groups = list(model), laws_of(shapes)
    for i in 2 * list(range(len(model))):
        model[i] = min(groups[model[i].law], key=lambda s: score(model[:i] + [s] + model[i + 1:]))
    return model


def swapped(model, i, shapes, score):
    """For each other law, the model with that law in its best shape in the place of the i-th."""
    held = {m.law for m in model}
    places = {law: [model[:i] + [s] + model[i + 1:] for s in many] for law, many in laws_of(shapes).items()
              if law not in held and not law.startswith("column ")}
    return {law: min(many, key=score) for law, many in places.items()}


def effective_rows(rest, r):
    """n / (1 + 2 sum rho_j), summed while pairs of rho are positive (Geyer, Stat. Sci. 7 (1992) 473)."""
    size = 2 ** math.ceil(math.log2(2 * max(len(p) for p in r.parts)))
    rho = np.fft.irfft(sum(np.abs(np.fft.rfft(rest[p], size)) ** 2 for p in r.parts))[:size // 4]
    pairs = (rho[1:-1:2] + rho[2::2][:len(rho[1:-1:2])]) / rho[0]
    end = int(np.argmax(pairs <= 0)) if np.any(pairs <= 0) else len(pairs)
    return len(rest) / (1 + 2 * float(pairs[:end].sum()))


# ---- three methods: each gives model, probabilities, aliases, probabilities of the sets ----

def by_bic(r, effective):
    """Forward by BIC, then backward, to six laws. A parameter inside a shape counts as one."""
    sums, model = r.sums, []

    def bic(model, rows):
        parameters = BASE + sum(len(m.columns) + m.inner for m in model)
        return rows * math.log(sums.squares(model) / sums.n) + parameters * math.log(rows)

    def rows_of(model):
        return effective_rows(r.f - r.stack(model) @ sums.fit(index_of(model))[0], r) if effective else float(sums.n)

    while len(model) < 6:
        free = [s for s in r.shapes if s.law not in {m.law for m in model}]
        # both sides of a step are judged with the rows of the larger model's residual
        rows = rows_of(model + [min(free, key=lambda s: bic(model + [s], sums.n))])
        score = lambda m: bic(m, rows)
        larger = best_shapes(model + [min(free, key=lambda s: score(model + [s]))], r.shapes, score)
        if score(larger) >= score(model):
            break
        model = larger
        while len(model) > 1:
            less = min((model[:i] + model[i + 1:] for i in range(len(model))), key=score)
            if score(less) >= score(model):
                break
            model = less
    rows = rows_of(model)
    score, chance, aliases = (lambda m: bic(m, rows)), [], []
    for i in range(len(model)):
        cost = score(model[:i] + model[i + 1:]) - score(model)
        chance.append(1 / (1 + math.exp(-min(700, max(-700, cost)) / 2)))
        places = swapped(model, i, r.shapes, score)   # 6: "strong", Kass and Raftery 1995
        aliases.append([law for law in places if score(places[law]) < score(model) + 6])
    return model, chance, aliases, chance


def by_stlsq(r, _):
    """Thresholds on the root mean square, N, of what a law makes beyond k and c."""
    sums, full = r.sums, r.sums.all[:-1, :-1]
    beyond = full - full[:, :BASE] @ np.linalg.lstsq(full[:BASE, :BASE], full[:BASE, :], rcond=1e-12)[0]

    def threshold(model, level, g):
        while True:
            w, at, kept = sums.fit(index_of(model), g, 1e-6)[0], BASE, []
            for s in model:
                part = w[at:at + len(s.columns)]
                at += len(s.columns)
                size = math.sqrt(max(0.0, part @ beyond[s.columns][:, s.columns] @ part) / sums.n)
                if size >= level and (s.sign == 0 or np.all(part >= 0)):
                    kept.append(s)
            if len(kept) == len(model):
                return model
            model = kept

    library = [min(many, key=lambda s: sums.squares([s])) for many in laws_of(r.shapes).values()]
    levels = math.sqrt(sums.squares([]) / sums.n) * np.geomspace(0.02, 2.0, 24)
    for _ in range(2):     # the second time the laws that stayed are in the shapes that suit them together
        paths = [[threshold(library, level, sums.all - g) for g in sums.by_fold] for level in levels]
        errors = np.array([sums.crossed(path) for path in paths])
        mean, error = errors.mean(1), errors.std(1, ddof=1) / math.sqrt(errors.shape[1])
        low = int(np.argmin(mean))
        pick = max(i for i in range(len(levels)) if mean[i] <= mean[low] + error[low])
        model = best_shapes(threshold(library, levels[pick], sums.all), r.shapes, sums.squares)
        library = [next((m for m in model if m.law == s.law), s) for s in library]
    chance = [float(np.mean([any(k.law == s.law for k in m) for m in paths[pick]])) for s in model]
    aliases, own = [], sums.crossed([model] * 8)
    for i in range(len(model)):
        aliases.append([])
        for law, other in swapped(model, i, r.shapes, sums.squares).items():
            more = sums.crossed([other] * 8) - own    # no more than its own standard error
            if sums.squares(other) < math.inf and more.mean() <= more.std(ddof=1) / math.sqrt(len(more)):
                aliases[-1].append(law)
    return model, chance, aliases, chance


def by_bma(r, _):
    """ln BF against the base law = (n - q - p)/2 ln(1 + g) - (n - q)/2 ln(1 + g RSS/RSS0); q: base, p: laws"""
    z = np.column_stack(r.columns)
    rest = r.f - z @ r.sums.fit(list(range(len(r.columns))), ridge=1e-6)[0]   # noise: what the largest model leaves
    pairs = np.flatnonzero(r.joined)
    phi = float(np.clip(rest[pairs] @ rest[pairs - 1] / (rest[pairs] @ rest[pairs]), 0.0, 0.99))

    def white(u):          # within unbroken rows; the first of them times sqrt(1 - phi^2)
        out = u * math.sqrt(1 - phi ** 2)
        out[pairs] = u[pairs] - phi * u[pairs - 1]
        return out

    sums = Sums(white(z), white(r.f), r.folds)
    n, g, laws, none = sums.n - BASE, float(max(sums.n, z.shape[1] ** 2)), len(laws_of(r.shapes)), sums.squares([])

    def weight(key):
        model = [r.shapes[i] for i in key]
        rss, p = sums.squares(model), sum(len(s.columns) for s in model)
        if rss == math.inf or len({s.law for s in model}) < len(model):
            return -math.inf
        evidence = 0.5 * (n - p) * math.log1p(g) - 0.5 * n * math.log1p(g * rss / none)
        return evidence + sum(s.prior for s in model) - math.log(math.comb(laws, len(model)))

    many = range(len(r.shapes))
    twos = {key: weight(key) for key in itertools.combinations(many, 2)}
    extended = {tuple(sorted(key + (i,))) for key in sorted(twos, key=twos.get)[-100:] for i in many if i not in key}
    models = {key: weight(key) for key in [(), *((i,) for i in many), *extended]} | twos
    top, sets = max(models.values()), collections.Counter()
    for key, value in models.items():                # all shapes of a set of laws add up
        sets[frozenset(r.shapes[i].law for i in key)] += math.exp(value - top)
    peak = max(sets, key=sets.get)
    sets = {k: v for k, v in sets.items() if v >= sets[peak] / 20}   # Occam's window
    inside = lambda names: sum(v for k, v in sets.items() if k & names) / sum(sets.values())
    lead = max((k for k in models if frozenset(r.shapes[i].law for i in k) == peak), key=models.get)
    model, chance, aliases, together = [], [], [], []
    for s in (r.shapes[i] for i in lead):
        swaps = [law for law in laws_of(r.shapes) if law not in peak and (peak - {s.law}) | {law} in sets]
        if (whole := inside({s.law, *swaps})) > 0.5:
            model.append(s); chance.append(inside({s.law})); aliases.append(swaps); together.append(whole)
    return model, chance, aliases, together


METHODS = {"stlsq": by_stlsq, "bic": by_bic, "bma": by_bma}


# ---- the answer ----

def search(r, method, effective):
    """The library made finer, and the method's answer to it, until it names the same laws again."""
    sums, before = r.sums, None
    for many in laws_of(r.shapes).values():
        r.finer(min(many, key=lambda s: sums.squares([s])), [])
    for _ in range(3):
        result = METHODS[method](r, effective)
        left, beside = {s.law for s in result[0]}, []
        if not left or left == before:
            break
        before, whole = set(left), list(r.shapes)
        while left:        # the strongest law first, each in its best shape beside those before it
            s = min((s for s in whole if s.law in left), key=lambda s: r.sums.squares(beside + [s]))
            left.remove(s.law)
            beside.append(r.finer(s, beside))
    return result


def chi2_tail(value, freedom):
    """P(chi^2 > value), Wilson and Hilferty 1931."""
    z = ((max(value, 0) / freedom) ** (1 / 3) - (1 - 2 / (9 * freedom))) / math.sqrt(2 / (9 * freedom))
    return 0.5 * math.erfc(z / math.sqrt(2))


def held_out(r, model):
    """Root mean square error, N, of each session: fitted on the other sessions.

    On other blocks instead where the model has columns of single sessions, and where there are fewer than three."""
    folds = r.folds if len(r.parts) < 3 or any(s.own for s in model) else r.session
    z, rest = r.stack(model), r.f.copy()
    products = {j: (z[folds == j].T @ z[folds == j], z[folds == j].T @ r.f[folds == j]) for j in np.unique(folds)}
    a, b = (sum(p[i] for p in products.values()) for i in (0, 1))
    for j, (aj, bj) in products.items():
        rest[folds == j] -= z[folds == j] @ np.linalg.lstsq(a - aj, b - bj, rcond=1e-10)[0]
    return np.array([np.sqrt(np.mean(rest[p] ** 2)) for p in r.parts])


def gain_of(before, after):
    """Per cent by which the error falls: mean over sessions, Student's interval of 95 %, each session."""
    percent = 100 * (1 - after / before)
    freedom, mean = len(percent) - 1, float(percent.mean())
    wide = abs(mean)
    if freedom > 0:
        wide = (1.96 + 2.37 / freedom + 2.8 / freedom ** 2) * percent.std(ddof=1) / math.sqrt(len(percent))
    return mean, mean - wide, mean + wide, percent


def answer(r, method, effective):
    model, chance, aliases, together = search(r, method, effective)
    sums, index, taken = r.sums, index_of(model), {s.law for s in model}
    w, rss = sums.fit(index)
    before, after = held_out(r, []), held_out(r, model)
    rows = effective_rows(r.f - r.stack(model) @ w, r)
    causes, unexplained = [], None
    for i, s in enumerate(model):
        less = model[:i] + model[i + 1:]
        smaller = sums.fit(index_of(less))[1]
        effect = math.sqrt(max(0.0, smaller - rss) / sums.n)
        if s.law.startswith("column "):
            unexplained = {"variable": s.law[7:], "effect_n": effect, "form": s.what}
            continue
        mean, low, high, each = gain_of(held_out(r, less), after)
        sessions = [{"session": n, "percent": float(p)} for n, p in zip(r.names, each)]
        causes.append({"mechanism": s.law, "aliases": [a for a in aliases[i] if a not in taken], "parameters": {},
                       "p_value": chi2_tail(rows * math.log(smaller / rss), len(s.columns) + s.inner),
                       "effect_n": effect,
                       "probability": chance[i], "set_probability": together[i], "shape": s.what, "rivals": [],
                       "gain": {"value": mean, "low": low, "high": high, "by_session": sessions}})
    causes.sort(key=lambda c: -c["effect_n"])
    named = "alias" if any(c["aliases"] for c in causes) else "named"
    mean, low, high, _ = gain_of(before, after)
    k, c = (float(w[i] / r.scale[i]) for i in range(BASE))
    return {"verdict": named if causes else "unexplained" if unexplained else "clean", "causes": causes,
            "unexplained": unexplained, "data_faults": [],
            "not_testable": sorted({"gain_error", *r.untestable} - {s.law for s in r.shapes}),
            "base": {"heldout_rmse_n": float(np.sqrt(np.mean(before ** 2))), "k_n_per_mm": k, "c_n_s_per_mm": c},
            "extended": {"heldout_rmse_n": float(np.sqrt(np.mean(after ** 2)))},
            "gain": {"percent": mean, "low": low, "high": high},
            "notes": [f"{method}: {len(r.f)} rows or blocks, {rows:.0f} effective, "
                      f"position over {r.window} rows, {len(r.shapes)} shapes"]}


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("words", nargs="+", metavar="[explain] FILE")
    a.add_argument("--method", choices=sorted(METHODS), default="bic")
    a.add_argument("--effective-rows", action="store_true", help="with bic")
    a.add_argument("--json", action="store_true")
    a.add_argument("--seed", type=int, help="not used")
    a.add_argument("--surface-mm", type=float, default=0.0)
    a.add_argument("--negate", action="append", default=[], choices=("x", "v", "f"))
    a = a.parse_args()
    data = read_recording(a.words[-1])
    data["x_mm"] = data["x_mm"] - a.surface_mm
    for name in {"x_mm", "v_mm_s", "f_n"} & set(data):
        data[name] = -data[name] if name[0] in a.negate else data[name]
    r = Recording(data, read_rig(os.path.join(os.path.dirname(a.words[-1]), "rig.toml")))
    print(json.dumps(answer(r, a.method, a.effective_rows), indent=None if a.json else 1))


if __name__ == "__main__":
    main()
