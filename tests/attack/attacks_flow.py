"""From filing to release: oracles, findings that must stay, planted files, kills, time that was set back."""
import json
import os
import random
import shutil
import subprocess
import time

import ledger_format as lf
import school
from attacks_claims import ticket_of
from attacks_endings import cut_back
from kinds import ACCEPTED, FOUND, NOBODY, SURVIVES, attack
from school import as_hand
from session_format import sha


def unclosed(s, change):
    """A whole made-up recording, only without its end, that the honest program of seat 1 shall close and sign."""
    r = s.session("anna.cavum")
    r.seal = r.result = None
    r.artifacts = [a for a in r.artifacts if a[0] != "final_tooth.cvt"]
    change(r)
    os.remove(s.p("seat1/used_tickets"))
    s.write(r, "m.cavum")
    s.run("exam", "--resume", "--end", "--out", s.p("m.cavum"), "--quiet", home=s.p("seat1"))
    return s.add("m.cavum")


@attack("flow", FOUND, "taken up by another station than began it; the beginning is signed", "station_changed")
def station_as_an_oracle(s):
    """Without the station's key: a made-up hand's exam, begun by a stranger's key, is closed by the honest program (`--resume --end`)."""
    return unclosed(s, lambda r: r.rebuild(s.station("stranger")))


@attack("flow", FOUND, "taken up by another station than began it; the beginning is signed", "error station_changed")
def station_as_an_oracle_unsigned(s):
    """... whose beginning is not signed at all."""
    def change(r):
        del r.facts["begun_signature"], r.facts["station_key"]
        r.rebuild()
    return unclosed(s, change)


@attack("flow", FOUND, "... and with a line forged in used_tickets", "error station_changed")
def station_as_an_oracle_memory_forged(s):
    """... with a line `used` of the ticket forged at the station."""
    def change(r):
        del r.facts["begun_signature"], r.facts["station_key"]
        r.rebuild()
    r = s.session("anna.cavum")
    r.seal = r.result = None
    r.artifacts = [a for a in r.artifacts if a[0] != "final_tooth.cvt"]
    change(r)
    s.text("seat1/used_tickets", f"used {ticket_of(r)['ticket']['nonce']} {r.facts['created_utc']} m.cavum\n")
    s.write(r, "m.cavum")
    s.run("exam", "--resume", "--end", "--out", s.p("m.cavum"), "--quiet", home=s.p("seat1"))
    return s.add("m.cavum")


def forged(s):
    r = s.session("anna.cavum")
    r.result = r.result.replace('"verdict":"fail"', '"verdict":"pass"')
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")


@attack("flow", ACCEPTED, "what was filed with findings is released only by name, with --with-findings")
def findings_stay(s):
    """A forged result filed with --with-findings: --all leaves it, the gradebook has no 4711, verify holds."""
    forged(s)
    s.must(s.add("m.cavum", "--with-findings").rc == 1 or lf.Ledger(s.L).entry(18)["kind"] == "session", "it is not filed at all")
    s.ledger("release", "--all", "--undecided")
    s.must(s.ledger("release", "--session", "18").rc != 0, "released by its entry without --with-findings")
    s.ledger("release", "--candidate", "4711")
    s.ledger("export", "--format", "moodle", "--out", s.p("g.csv"))
    s.must("4711" not in open(s.p("g.csv")).read(), "it stands in the gradebook")
    return s.ledger("verify", "--replay")


@attack("flow", ACCEPTED, "the second ending contests the first, and neither is released until a person chooses one by its entry")
def contested(s):
    """Both endings of a hand's exam are filed (the second with --with-findings); release --all and --candidate leave both."""
    s.must(s.add("anna.cavum").rc == 0, "the first is refused")
    r = s.session("anna.cavum")
    cut_back(s, "cut.cavum")
    s.text("seat1/used_tickets", "".join(l for l in open(s.p("seat1/used_tickets")) if not l.startswith("closed")))
    s.run("exam", "--resume", "--operator", "novice", "--out", s.p("cut.cavum"), "--quiet", home=s.p("seat1"))
    second = s.session("cut.cavum")
    for i in (0, 1):
        second.chunks[i] = dict(r.chunks[i])
    second.facts = dict(r.facts)
    for e in second.events:
        if e["kind"] == "gap":
            d = json.loads(e["detail_json"])
            d["by"].update(source={"kind": "device", "name": "Novint Falcon", "serial": "F-1"})
            e["detail_json"] = lf.json_text(d)
    s.write(second.rebuild(s.station(), s.station()), "m.cavum")
    s.must(s.add("m.cavum").rc != 0, "the second is filed as clean")
    s.add("m.cavum", "--with-findings")
    s.ledger("release", "--all", "--undecided")
    s.must(s.ledger("release", "--candidate", "4711").rc != 0, "--candidate releases a contested one")
    s.ledger("export", "--format", "moodle", "--out", s.p("g.csv"))
    s.must("4711" not in open(s.p("g.csv")).read(), "a contested result stands in the gradebook")
    return s.ledger("verify")


@attack("flow", SURVIVES, "filed sessions are L/sessions/HASH.cavum, on disk before the entry is")
def planted_in_sessions(s):
    """Where the next session will lie: a link to a file outside, another file, a folder. Nothing outside is written, and what is filed verifies."""
    name = sha(open(s.p("anna.cavum"), "rb").read()).hex()
    s.text("precious", "precious")
    path = f"{s.L}/sessions/{name}.cavum"
    os.symlink(s.p("precious"), path)
    first = s.add("anna.cavum")
    s.must(open(s.p("precious")).read() == "precious", "a file outside was written over")
    if first.rc == 0:
        s.must(s.ledger("verify").rc == 0, "filed, and does not verify")
    else:
        os.remove(path)
        s.text(f"L/sessions/{name}.cavum", "another")
        if s.add("anna.cavum").rc == 0:
            s.must(s.ledger("verify").rc == 0, "filed, and does not verify")
    return first


@attack("flow", SURVIVES, "names of files reach the terminal")
def names_of_files(s):
    """A recording and a folder whose names are escapes, formulas and bytes that are no UTF-8."""
    odd = s.folder + "/\u001b[2J\u202e=1+1"
    os.makedirs(odd)
    shutil.copy(s.p("anna.cavum"), odd + "/\u001b]0;x\u0007.cavum")
    shutil.copy(s.p("op_x.cavum"), os.fsencode(odd) + b"/\xff\xfe.cavum")
    os.symlink(odd, odd + "/loop")
    s.run("verify", odd + "/\u001b]0;x\u0007.cavum")
    s.run("grade", odd)
    s.run("replay", "--verify", odd)
    return s.ledger("add", odd, "--receipts", odd + "/rc")


@attack("flow", ACCEPTED, "nothing acknowledged is lost")
def killed_while_adding(s):
    """`ledger add` and `ticket` killed at 12 random moments: afterwards the ledger holds, and adding works."""
    dice = random.Random(3)
    env = dict(os.environ, CAVUM_HOME=s.home)
    for i in range(12):
        args = ["ledger", "ticket", s.L, s.p("quick.toml"), "--candidate", f"77{i}", "--from", school.hours(-1), "--until", school.hours(1), "--out", s.p(f"k{i}.ticket")]
        p = subprocess.Popen([s.cavum, *args], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        time.sleep(dice.uniform(0.01, 0.25))
        p.kill()
        p.wait()
        s.must(s.ledger("verify").rc == 0, f"does not hold after kill {i}")
    return s.add("anna.cavum")


@attack("flow", FOUND, "a school.pub or key that is not the ledger's own is a finding", "other_school")
def another_schools_key(s):
    """school.pub of a stranger; then the key, too."""
    good = open(f"{s.home}/school.pub").read()
    s.text("home/school.pub", s.station("stranger").hex + "\n")
    s.must(s.ledger("verify").rc != 0, "another school.pub is no finding")
    s.text("home/school.pub", good)
    s.text("home/school.key", f"cavum school key 1 (Ed25519 seed; keep secret): {s.station('stranger').seed.hex()}\n")
    s.must(s.ledger("station", "--invite", "x").rc != 0, "an entry is signed with another key")
    return s.ledger("verify")


def old_ledger(s, days, hours_open):
    """A new ledger of `days` ago by the page alone: init, invitation, seat 1, one ticket."""
    now, key = time.time_ns(), s.school_key()
    then = now - int(days * 86400 * 10**9)
    ledger = lf.Ledger(s.L)
    init = ledger.body(0)
    ledger.entries, ledger.notes, ledger.documents, ledger.cosignatures = [], [], [], []
    ledger.openings = {}
    code = lf.code_key("S-0123-4567-89AB-CDEF-GHJK")
    ledger.add("init", init, utc_ns=then)
    ledger.add("invite", {"name": "Seat 1", "code_key": code.hex, "until_utc_ns": then + 10**15}, utc_ns=then + 10**9)
    asked = lf.station_request(key.hex, s.station(), code, made=then + 15 * 10**8)
    ledger.add("enrol", {"asked": asked, "until_utc_ns": 0}, utc_ns=then + 2 * 10**9)
    stamp = lambda t: time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(t // 10**9))
    ticket = dict(ticket_of(s.session("anna.cavum"))["ticket"], nonce="ab" * 16, not_before=stamp(then), not_after=stamp(then + int(hours_open * 3600 * 10**9)))
    text = lf.signed_ticket(ticket, key)
    ledger.add("ticket", lf.ticket_entry(text), utc_ns=then + 3 * 10**9)
    ledger.resign(key)
    ledger.store()
    s.text("home/witness/" + ledger.id, ledger.witness())
    for f in os.listdir(f"{s.L}/sessions"):
        os.remove(f"{s.L}/sessions/{f}")
    s.must(s.ledger("verify").rc == 0, "a ledger made by the page is refused")
    return text, then


def sat(s, text, at_ns):
    r = s.session("op_anna.cavum")
    r.facts["note.ticket"] = text
    r = as_hand(r, s.station(), (time.time_ns() - at_ns) // 10**9)
    s.write(r, "m.cavum")
    return s.add("m.cavum")


@attack("flow", ACCEPTED, "a ledger of two days ago, made by the page alone, with an exam sat now in its time")
def control_old_ledger(s):
    """The control of the two that follow: the ticket of two days ago is good for three days."""
    text, then = old_ledger(s, 2, 72)
    return sat(s, text, time.time_ns() - 60 * 10**9)


@attack("flow", FOUND, "more than a day after its ticket's time and its own end is a finding", "handed_in_late")
def handed_in_late(s):
    """The ticket was good two days ago for two hours; the station's clock says that it was sat then; handed in now."""
    text, then = old_ledger(s, 2, 2)
    return sat(s, text, then + 3600 * 10**9)


@attack("flow", NOBODY, "sets the station's clock back: within that day nothing but invigilators tells")
def clock_set_back_within_a_day(s):
    """The ticket ran out ten hours ago; the clock was set back to its time; handed in now."""
    text, then = old_ledger(s, 0.5, 2)
    return sat(s, text, then + 3600 * 10**9)


@attack("flow", FOUND, "takes the exam up again after the ticket's time: findings", "ticket_time")
def begun_after_the_hours(s):
    """The ticket ran out ten hours ago, the clock is honest."""
    text, then = old_ledger(s, 0.5, 2)
    return sat(s, text, time.time_ns() - 60 * 10**9)


@attack("flow", SURVIVES, "machine-readable output")
def json_output_is_json(s):
    """--json of every verb on a damaged ledger and a hostile recording is one JSON object."""
    r = s.session("x.cavum")
    r.facts["candidate"] = '"}\n{"\u001b\ud7ff\U0010ffff'
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    s.add("m.cavum", "--without-ticket", "--with-findings")
    last = None
    for args in (("verify", s.p("m.cavum"), "--json"), ("replay", "--verify", s.p("m.cavum"), "--json"), ("ledger", "show", s.L, "--json"), ("ledger", "verify", s.L, "--json"), ("ledger", "candidates", s.L, "--json"),
                 ("ledger", "station", s.L, "--json"), ("grade", s.p("m.cavum"), "--json")):
        last = s.run(*args)
        try:
            json.loads(last.out)
        except ValueError as error:
            s.must(False, f"`{' '.join(a for a in args if '/' not in a)}`: {error}")
    return last


@attack("flow", SURVIVES, "times are input")
def odd_times(s):
    """--from and --until of the year 99999, of 30 February, the wrong way round, before 1970, with zones."""
    last = None
    for a, b in (("99999-01-01T00:00Z", "99999-01-02T00:00Z"), ("2026-02-30T00:00Z", "2026-03-01T00:00Z"), ("2026-03-02T00:00Z", "2026-03-01T00:00Z"), ("1969-12-31T00:00Z", "2030-01-01T00:00Z"),
                 ("2026-11-21T09:00+01:00", "2030-01-01T00:00Z"), ("2026-11-21T25:00Z", "2030-01-01T00:00Z"), ("0000-00-00T00:00Z", "9999-12-31T23:59Z"), ("", "")):
        last = s.ledger("ticket", s.p("quick.toml"), "--candidate", "1", "--from", a, "--until", b, "--out", s.p("o.ticket"), "--overwrite")
    s.must(s.ledger("verify").rc == 0, "the ledger does not hold")
    return last
