"""The list of attacks, and how the outcome of one is judged against what the pages promise."""
import re

ATTACKS = []
FOUND, ACCEPTED, NOBODY, SURVIVES, UNSTATED = "found", "accepted", "nobody", "survives", "unstated"
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f\x80-\x9f\u202a-\u202e\u2066-\u2069]")


class Attack:
    def __init__(self, name, family, promise, page, kinds, told, run):
        self.name, self.family, self.promise, self.page, self.kinds, self.told, self.run = name, family, promise, page, set(kinds.split()), told, run
        self.what = " ".join((run.__doc__ or "").split())


def attack(family, promise, page="", kinds="", told=""):
    """Registers a function as an attack. promise: what the page says becomes of it.

    found: refused or named, with exit code other than 0, by a finding of one of `kinds`, or `error`: exit code 2; and with names or numbers that the
    regular expression `told` matches; accepted: a control;
    nobody: the page owns up that nobody finds it; survives: any orderly end; unstated: the page says nothing, reported as it is."""
    def register(run):
        ATTACKS.append(Attack(run.__name__, family, promise, page, kinds, told, run))
        return run
    return register


def judge(a, s, result):
    """(verdict, is it a hole, is it a broken promise)."""
    for r in s.results:
        if r.crash():
            return f"HOLE: crash of `{r.verb}`: {r.crash()}", True, False
        if CONTROL.search(r.out):
            return f"HOLE: control characters reach the terminal from `{r.verb}`", True, False
    if s.notes:
        return "HOLE: " + "; ".join(s.notes), True, False
    if result is None:
        return "ok", False, False
    refused = result.rc != 0
    if a.promise == FOUND:
        if not refused:
            return "HOLE: taken as clean", True, True
        kinds = {"error"} if result.rc == 2 else result.kinds()
        if (a.kinds and not a.kinds & kinds) or not re.search(a.told, result.out):
            return "BROKEN PROMISE: refused, but for another reason", False, True
        return "found", False, False
    if a.promise == ACCEPTED:
        return ("CONTROL FAILED", False, True) if refused else ("accepted", False, False)
    if a.promise == NOBODY:
        return ("found (more than the page promises)" if refused else "not found, as the page says"), False, False
    if a.promise == SURVIVES:
        return ("refused" if refused else "orderly"), False, False
    return ("unstated: refused" if refused else "unstated: accepted"), False, False
