#!/usr/bin/python3
"""Asks `cavum explain` about recordings that others measured, and compares the answers with what was published about them.

  real.py CAVUM [--folder data/measured/real] [--only NAME,NAME]
Wanted figures and tolerances come from the publications and from physics, never from what the program answered; SOURCE.txt of each folder has
the source. Each row is `held` or `short`. It ends with 1 only where a row marked `must` is short, or where a cause is named that cannot be:
one none of whose set is allowed, or a mass below zero. What is short without `must` is what the program does not reach yet, with the value seen.
"""
import argparse, json, math, os, subprocess, sys, time

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FRICTION = {"coulomb_friction", "stribeck_friction", "viscous_friction", "hysteresis"}
DEEPER = {"nonlinear_stiffness", "graded_stiffness", "hidden_layer", "series_compliance"}


def named(*mechanisms, must=False):
    """One of these is a cause, or fits as well as one."""
    return dict(kind="named", any=set(mechanisms), must=must)


def variable(name, must=False):
    """This column is what stays unexplained."""
    return dict(kind="variable", name=name, must=must)


def figure(mechanism, parameter, low, high, must=False):
    """This parameter of this cause lies between."""
    return dict(kind="figure", mechanism=mechanism, parameter=parameter, low=low, high=high, must=must)


def friction(speed_mm_s, low, high, must=False):
    """All friction together at this speed, whichever laws it was given: Coulomb and viscous friction are hardly told apart at one speed."""
    return dict(kind="friction", speed=speed_mm_s, low=low, high=high, must=must)


RECORDINGS = {
    # The slope over pressure is geometry. No law has it, and no law has friction that grows with it.
    "oring_pressure": dict(allowed=FRICTION | {"bias", "drift", "inertia"}, wanted=[variable("pressure_bar", must=True), named(*FRICTION)]),
    # Half of the authors' friction force range, 3.92 and 7.81 N. Six runs of a like ring, by their script, scatter by 10 to 13 %: +- 12 %.
    "oring_1bar": dict(allowed=FRICTION | {"bias", "inertia"}, wanted=[named(*FRICTION, must=True), friction(10, 3.45, 4.38, must=True)]),
    "oring_7bar": dict(allowed=FRICTION | {"bias", "inertia"}, wanted=[named(*FRICTION, must=True), friction(10, 6.87, 8.75, must=True)]),
    # 0.6755 kg x 9.81 x 0.5 m = 3.3133. Steps of encoder and torque are 0.3 % each at most, the rest of 1 % is the lag. theta0 is 0, and one step
    # of each is 0.32 degrees.
    "dfki_gravity": dict(allowed={"gravity_posture", "bias", "delay", "low_pass", "position_late"}, wanted=[
        named("gravity_posture", must=True), figure("gravity_posture", "weight_n", 3.280, 3.347, must=True),
        figure("gravity_posture", "theta0_deg", -0.32, 0.32, must=True)]),
    # From the masses where they are to all of the mass at the end, and 10 % for the motor's torque constant, of which no tolerance is published.
    "dfki_swingup": dict(allowed=FRICTION | {"gravity_posture", "inertia", "bias", "backlash", "delay", "low_pass", "position_late"}, wanted=[
        named("gravity_posture"), figure("gravity_posture", "weight_n", 2.70, 3.65), named("inertia"), figure("inertia", "mass_kg", 0.135, 0.188),
        named(*FRICTION)]),
    # A power law in time, so no time constants to compare; the ramps go one way, so that offsets are aliases.
    "titin_relaxed": dict(options=["--as-it-is"], allowed=DEEPER | {"relaxation", "hysteresis", "feed_power_law", "bias", "contact_offset"}, wanted=[
        named("relaxation"), named(*DEEPER)]),
    # Not in this tree, for its licence is not clear (data/measured/README.md); asked for where --folder has it. EMPS_Description.pdf 3.4, three
    # standard deviations: M 95.109 (0.109), Fv 0.2035 (0.0011), Fc 20.39 (0.10), offset -3.165 (0.044). Section 4.2: viscous friction
    # differs by direction, which no law has: v_mm_s is to stay unexplained.
    "emps_cycles": dict(optional=True, allowed=FRICTION | {"inertia", "bias"}, wanted=[
        named("inertia"), figure("inertia", "mass_kg", 94.78, 95.44), named("coulomb_friction"), friction(100, 40.0, 41.5), named("viscous_friction"),
        figure("viscous_friction", "b_n_s_per_mm", 0.2001, 0.2069), named("bias"), figure("bias", "bias_n", -3.30, -3.03), variable("v_mm_s")]),
}


def force_of_friction(cause, speed):
    p = {name: value["value"] for name, value in cause["parameters"].items()}
    if cause["mechanism"] == "viscous_friction":
        return p["b_n_s_per_mm"] * speed
    if cause["mechanism"] == "hysteresis":
        return p["alpha_n_per_mm"] * p["d_mm"]  # what the loop saturates at
    if cause["mechanism"] == "stribeck_friction":
        return p["fc_n"] + (p["fs_n"] - p["fc_n"]) * math.exp(-((speed / p["vs_mm_s"]) ** 2))
    return p["fc_n"]


def sets_of(answer):
    return [{cause["mechanism"], *cause["aliases"]} for cause in answer["causes"]]


def seen(answer, want):
    """What was seen, in words, and whether it is what was wanted."""
    causes = answer["causes"]
    instead = ", ".join(cause["mechanism"] for cause in causes) or answer["verdict"]
    if want["kind"] == "named":
        hits = [cause for cause in causes if {cause["mechanism"], *cause["aliases"]} & want["any"]]
        return (", ".join("/".join([c["mechanism"], *c["aliases"]]) for c in hits), True) if hits else (instead, False)
    if want["kind"] == "variable":
        found = (answer["unexplained"] or {}).get("variable", "nothing")
        return found, found == want["name"]
    if want["kind"] == "friction":
        parts = [force_of_friction(cause, want["speed"]) for cause in causes if cause["mechanism"] in FRICTION]
        value = sum(parts)
        return (f"{value:.4g}", want["low"] <= value <= want["high"]) if parts else (instead, False)
    for cause in causes:
        if cause["mechanism"] == want["mechanism"] and want["parameter"] in cause["parameters"]:
            value = cause["parameters"][want["parameter"]]
            return f"{value['value']:.4g} ({value['low']:.4g} to {value['high']:.4g})", want["low"] <= value["value"] <= want["high"]
    return instead, False


def words(want):
    if want["kind"] == "named":
        return {frozenset(FRICTION): "friction, of any law", frozenset(DEEPER): "a stiffness that changes, of any law"}.get(
            frozenset(want["any"]), " or ".join(sorted(want["any"])))
    if want["kind"] == "variable":
        return f"unexplained: {want['name']}"
    what = f"friction at {want['speed']} mm/s, N" if want["kind"] == "friction" else want["parameter"]
    return f"{what}: {want['low']:g} to {want['high']:g}"


def impossible(answer, allowed):
    out = ["/".join(sorted(names)) for names in sets_of(answer) if not names & allowed]
    for cause in answer["causes"]:
        mass = cause["parameters"].get("mass_kg")
        if cause["mechanism"] == "inertia" and mass and mass["high"] < 0:
            out.append(f"a mass of {mass['value']:.3g} kg")
    return out


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("cavum")
    parser.add_argument("--folder", default=os.path.join(ROOT, "data", "measured", "real"))
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    only = set(filter(None, arguments.only.split(",")))
    if only - set(RECORDINGS):
        parser.error(f"not known: {', '.join(sorted(only - set(RECORDINGS)))}; known are {', '.join(RECORDINGS)}")
    failed, held, rows = [], 0, 0
    line = "{:15} {:38} {:50} {}".format
    print(line("recording", "wanted", "seen", ""))
    for name, entry in RECORDINGS.items():
        file = os.path.join(arguments.folder, name, "recording.csv")
        if only and name not in only or entry.get("optional") and not os.path.exists(file):
            continue
        began = time.time()
        run = subprocess.run([arguments.cavum, "explain", file, "--json", "--seed", "1", *entry.get("options", [])], capture_output=True, text=True)
        seconds = time.time() - began
        answer = json.loads(run.stdout or "{}")
        if "verdict" not in answer:
            failed.append(f"{name}: no answer: {run.stderr.strip()[-200:]}")
            continue
        for want in entry["wanted"]:
            value, good = seen(answer, want)
            rows, held = rows + 1, held + good
            print(line(name, words(want), value, ("held" if good else "SHORT" if want["must"] else "short") + (" (must)" if want["must"] else "")))
            if want["must"] and not good:
                failed.append(f"{name}: {words(want)}, seen {value}")
        for what in impossible(answer, entry["allowed"]):
            print(line(name, "nothing that cannot be", what, "WRONG"))
            failed.append(f"{name}: {what} cannot be")
        for fault in answer["data_faults"]:
            print(f"{name:15} fault: {fault['text']}")
        print(f"{name:15} {seconds:.1f} s")
    print(f"{held} of {rows} held, {rows - held} short")
    for what in failed:
        print("failed:", what)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
