"""Hostile names and texts: formulas, terminal escapes, markup, paths, in every field that reaches people or files."""
import csv
import json
import os
import re

import ledger_format as lf
import school
from kinds import FOUND, SURVIVES, attack

EVIL = "=HYPERLINK(\"http://x\",\"y\")\u001b[2J\u202e<script>alert(1)</script>\r\n@x\t+1"


def no_formulas(s, path):
    for row in csv.reader(open(path, encoding="utf-8", newline="")):
        for cell in row:
            s.must(not re.match(r"^[=+\-@\t\r]", cell) or re.match(r"^-?\d+(\.\d+)?$", cell), f"a formula in {os.path.basename(path)}: {cell[:30]!r}")
            s.must("\n" not in cell and "\r" not in cell, f"a line end in {os.path.basename(path)}")


def no_markup(s, path):
    page = open(path, encoding="utf-8", errors="replace").read()
    s.must("<script>alert" not in page and "<img src=x" not in page, f"markup in {os.path.basename(path)}")


@attack("text", SURVIVES, "in exports every text is one line and no formula")
def names_are_formulas(s):
    """Names and numbers of candidates: formulas, tabs, quotes, line ends, escapes, right-to-left marks; then all exports."""
    names = ["=1+1", "+1", "-1+2", "@SUM(A1)", "\t=1", "\r=1", "a\nb", EVIL, "x" * 100000, "'=1", "\uff1d1+1", " =1"]
    rows = "".join('{},"{}"\n'.format("90%02d" % i, n.replace('"', '""')) for i, n in enumerate(names))
    r = s.ledger("ticket", s.p("quick.toml"), "--candidates", s.text("evil.csv", "id,name\n" + rows), "--from", school.hours(-2), "--until", school.hours(9), "--out", s.p("t2"))
    for i, n in enumerate(names):
        s.ledger("ticket", s.p("quick.toml"), "--candidate", n[:200], "--name", n[:200], "--from", school.hours(-2), "--until", school.hours(9), "--out", s.p(f"n{i}.ticket")) if "\0" not in n else None
    s.ledger("candidates")
    import sqlite3
    db = sqlite3.connect(f"{s.L}/identities.db")
    row = next(i for i in school.identities(s) if i["id"] == "4714")
    db.execute("UPDATE identity SET name = ? WHERE id = '4714'", (EVIL,))
    if "seal" in row:
        db.execute("UPDATE identity SET seal = ? WHERE id = '4714'", (lf.identity_seal(s.school_key().seed, row["pseudonym"], row["exam"], "4714", EVIL),))
    db.commit()
    db.close()
    for kind in ("moodle", "csv", "lti", "json"):
        r = s.ledger("export", "--format", kind, "--with-simulated", "--out", s.p("out." + kind))
        if kind in ("moodle", "csv") and r.rc == 0:
            no_formulas(s, s.p("out." + kind))
    r = s.ledger("candidates")
    s.ledger("report", "--out", s.p("reports"), "--with-name")
    for f in os.listdir(s.p("reports")) if os.path.isdir(s.p("reports")) else []:
        no_markup(s, s.p("reports/" + f))
    return r


@attack("text", SURVIVES, "texts reach people clean")
def scenario_texts(s):
    """Title, instruction, ids and reasons of a scenario with escapes, markup and formulas: checked, sat, reported, filed, exported."""
    evil = json.dumps("<img src=x onerror=alert(1)>=cmd|' /C calc'!A0\u202e")
    text = open(s.p("quick.toml"), encoding="utf-8").read()
    text = re.sub(r"(title|instruction) = .*", lambda m: m[1] + " = " + evil, text)
    s.text("evil.toml", text)
    s.run("scenario", "check", "--no-trial", s.p("evil.toml"))
    s.text("id.toml", text.replace('id = "block_cavity"', 'id = "=cmd"'))
    s.must(s.run("scenario", "check", s.p("id.toml")).rc != 0, "an id that is a formula is taken")
    s.text("escape.toml", text.replace("u202e", "u001b[2J"))
    s.run("scenario", "check", "--no-trial", s.p("escape.toml"))
    r = s.run("exam", s.p("evil.toml"), "--candidate", "x", "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", "--report", s.p("r.html"), home=s.p("seat1"))
    if os.path.exists(s.p("r.html")):
        no_markup(s, s.p("r.html"))
    if r.rc == 0:
        s.add("m.cavum", "--simulated", "--without-ticket")
        s.ledger("release", "--all", "--undecided")
        r = s.ledger("export", "--format", "csv", "--out", s.p("out.csv"))
        no_formulas(s, s.p("out.csv"))
        s.ledger("show")
    return r


@attack("text", SURVIVES, "texts reach people clean")
def facts_with_escapes(s):
    """Candidate, device, source, calibration and notes of a signed recording with escapes and markup; every verb shows it."""
    r = s.session("x.cavum")
    for fact in ("candidate", "source_name", "source_serial", "calibration", "boot_id", "engine_version", "created_utc"):
        r.facts[fact] = EVIL
    r.facts["note." + EVIL] = EVIL
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    for args in (("verify",), ("replay", "--verify"), ("grade",), ("explain",)):
        s.run(*args, s.p("m.cavum"))
    s.run("report", s.p("m.cavum"), "--out", s.p("r.html"))
    if os.path.exists(s.p("r.html")):
        no_markup(s, s.p("r.html"))
    done = s.add("m.cavum", "--without-ticket", "--with-findings")
    s.ledger("show")
    s.ledger("release", "--session", "18", "--with-findings")
    for kind in ("moodle", "csv", "lti"):
        if s.ledger("export", "--format", kind, "--out", s.p("o." + kind)).rc == 0 and kind != "lti":
            no_formulas(s, s.p("o." + kind))
    s.ledger("report", "--out", s.p("reports"))
    for f in os.listdir(s.p("reports")) if os.path.isdir(s.p("reports")) else []:
        no_markup(s, s.p("reports/" + f))
    s.ledger("verify")
    return done


@attack("text", SURVIVES, "texts that reach a file's name")
def candidate_is_a_path(s):
    """The candidate of an exam without ticket is ../../planted, an absolute path, a dot; reports and receipts stay in their folders."""
    before = set(os.listdir(s.folder))
    for i, name in enumerate(("../../planted", s.p("planted"), "x\0y")):
        r = s.session("x.cavum")
        r.facts["candidate"] = name
        r.set_clocks(int(r.facts["created_utc_ns"]) - i * 10**10, int(r.facts["created_boot_ns"]) - i * 10**10)
        s.write(r.rebuild(s.station(), s.station()), "m.cavum")
        s.add("m.cavum", "--without-ticket", "--receipts", s.p("rc"))
    s.ledger("release", "--all", "--undecided")
    r = s.ledger("report", "--out", s.p("rep"), "--overwrite")
    s.must(set(os.listdir(s.folder)) - before <= {"m.cavum", "rc", "rep"}, "a file was written outside: " + str(set(os.listdir(s.folder)) - before))
    s.must(all(not os.path.isdir(s.p("rep/" + f)) for f in os.listdir(s.p("rep"))) if os.path.isdir(s.p("rep")) else True, "a folder was made in the reports")
    return r


@attack("text", SURVIVES, "texts of the office")
def office_texts(s):
    """School, station, reason: with escapes, line ends, a formula, 1 MB; the program's own verbs show them."""
    for text in (EVIL, "a\nb", "\u001b]0;x\u0007", "x" * 100000, "", "\u202e" + "abc", "\x9b2J"):
        s.ledger("station", "--invite", text)
        s.ledger("regrade", "--session", "14", "--scenario", s.p("corrected.toml"), "--reason", text) if text in (EVIL, "\x9b2J") else None
    s.ledger("station")
    s.run("ledger", "init", s.p("N"), "--school", EVIL, "--key", s.p("n.key"), home=s.p("nhome"))
    s.run("ledger", "verify", s.p("N"), "--key", s.p("n.key"), home=s.p("nhome"))
    return s.ledger("verify")


@attack("text", FOUND, "what was edited is named, and the names are harmless")
def edited_entries_with_escapes(s):
    """Entries, notes and witness lines edited to hold escapes: findings quote them harmlessly."""
    ledger = lf.Ledger(s.L)
    body = ledger.body(9)
    body["ticket"].update(candidate=EVIL, exam=EVIL)
    ledger.set_body(9, body)
    ledger.resign(s.school_key())
    ledger.notes[3][1] = ledger.notes[3][1].replace("utc_ns", "\u001b[2Jutc")
    ledger.store()
    s.ledger("show")
    with open(s.witness_path(), "a") as file:
        file.write("\u001b[2J 1 2 3\n")
    return s.ledger("verify")


@attack("text", SURVIVES, "classes as spreadsheets write them")
def class_lists(s):
    """Lists with a BOM, semicolons, NUL, one quote that never ends, 200000 rows of nothing, the same number twice, numbers that are paths."""
    last = None
    for text in ("\ufeffid,name\n1,A\n", "id;name\n1;A\n", "id,name\n1,\0\n", 'id,name\n1,"A\n' + "x" * 10**6, "id,name\n" + ",\n" * 200000, "id,name\n1,A\n1,B\n",
                 "id,name\n../../planted,A\n", "", "\n", "name,id\nA,1\n", "id,id,name\n1,2,A\n", "id,name\n" + "1" * 10**6 + ",A\n"):
        for f in os.listdir(s.p("t3")) if os.path.isdir(s.p("t3")) else []:
            os.remove(s.p("t3/" + f))
        last = s.ledger("ticket", s.p("quick.toml"), "--candidates", s.text("c.csv", text), "--from", school.hours(-2), "--until", school.hours(9), "--out", s.p("t3"))
        s.must(not os.path.exists(s.p("planted.ticket")) and not os.path.exists(s.p("planted")), "a ticket outside its folder")
    return s.ledger("verify")
