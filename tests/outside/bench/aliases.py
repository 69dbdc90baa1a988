"""Which other laws could not be told from the hidden one in this very motion: fitted beside k and c, they leave next
to nothing."""
import numpy as np
import laws

TIMES = (1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0, 3.0)
LIMIT_CHI2 = 12.0  # left of the hidden force, in effective rows x (rms / noise)^2


def rivals(b):
    """(law, parameters) over a grid; the amplitude is fitted."""
    d, k, f, s = b["depth"], b["k"], b["force"], np.geomspace(b["slow"], b["fast"], 4)
    yield "bias", dict(bias_n=0.01 * f)
    yield "edge_force", dict(edge_n=0.01 * f)
    yield "contact_offset", dict(delta_1_mm=0.01 * d)
    for tau in (None, 2.0, 5.0, 10.0):
        yield "drift", dict(amplitude_n=0.05 * f, tau_s=tau) if tau else dict(rate_n_per_s=0.01 * f)
    for v0 in np.geomspace(0.05 * b["slow"], b["fast"], 6):
        yield "coulomb_friction", dict(fc_n=0.02 * f, v0_mm_s=v0)
    for vs in s:
        yield "stribeck_friction", dict(fc_n=0.0, fs_n=0.02 * f, vs_mm_s=vs, v0_mm_s=0.1 * b["slow"])
    yield "viscous_friction", dict(b_n_s_per_mm=0.02 * f / b["fast"])
    yield "inertia", dict(mass_kg=1e-3)
    for tau in (1e-3, 3e-3, 6e-3, 1e-2, 2e-2, 4e-2):
        for law in ("delay", "low_pass", "position_late"):
            yield law, dict(tau_s=tau)
    for share in (0.7, 0.85, 0.95):
        yield "saturation", dict(f_max_n=b["peak"] * share)
    for share in (0.01, 0.03, 0.08):
        yield "backlash", dict(b_mm=share * d)
    for share in (0.04, 0.1, 0.25, 0.6):
        yield "hysteresis", dict(alpha_n_per_mm=0.05 * k, d_mm=share * d)
    for share in (3, 10, 30, 100):
        yield "series_compliance", dict(softening_force_n=share * f)
        yield "series_compliance", dict(ks_n_per_mm=share * k)
    for m in (0.8, 0.9, 0.97, 1.03, 1.1, 1.25):
        yield "nonlinear_stiffness", dict(m=m)
    for share in (0.1, 0.2, 0.35, 0.5, 0.65, 0.8):
        yield "hidden_layer", dict(dk_n_per_mm=0.1 * k, d0_mm=share * d)
    yield "graded_stiffness", dict(alpha_per_mm=0.1 / d)
    for tau in TIMES[2:]:
        yield "relaxation", dict(k1_n_per_mm=0.1 * k, tau1_s=tau)
    for n in (0.6, 0.8, 0.95, 1.05, 1.2, 1.5):
        yield "feed_power_law", dict(n=n)


# the others' amplitude is not negative
SIGNED = {"bias", "drift", "edge_force", "contact_offset", "hidden_layer", "graded_stiffness", "relaxation"}


def indistinguishable(runs, hidden, own, b, noise_sd, n_eff):
    """Names whose best fit leaves less than LIMIT_CHI2 of the hidden force; runs and hidden are at the rows' rate."""
    x = np.concatenate([np.where(r.contact, r.x, 0) for r in runs])
    v = np.concatenate([np.where(r.contact, r.v, 0) for r in runs])
    h = np.concatenate(hidden)
    base, out = [x, v], set()

    def gram(u, w):
        return float(u @ w)
    for law, p in rivals(b):
        if law == own or law in out:
            continue
        g = np.concatenate([effective(r, law, p) for r in runs])
        basis = np.stack(base + [g])
        scale = np.sqrt((basis ** 2).sum(1)) + 1e-30
        basis = basis / scale[:, None]
        m = basis @ basis.T
        theta = np.linalg.lstsq(m, basis @ h, rcond=1e-9)[0]
        left = h - theta @ basis
        if theta[2] > 0 or law in SIGNED:
            if n_eff * gram(left, left) / len(h) / noise_sd ** 2 < LIMIT_CHI2:
                out.add(law)
    return sorted(out)


def effective(run, law, parameters):
    """The hidden force as it is felt: tissue does not pull."""
    if law == "edge_force" and "spindle_rpm" not in run.columns:
        return np.where(run.contact, parameters["edge_n"], 0.0)
    if law == "contact_offset" and len(parameters) == 1:
        return laws.f_sim(run, run.x + parameters["delta_1_mm"], run.v) - run.fsim
    h = laws.LAWS[law](run, **parameters)
    return np.maximum(0.0, run.fsim + h) - run.fsim if law in laws.TISSUE else h
