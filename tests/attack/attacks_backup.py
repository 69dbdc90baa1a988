"""Backups edited before they are restored, restores, and two programs at once."""
import json
import os
import shutil
import sqlite3
import subprocess

import ledger_format as lf
import school
from attacks_ledger import body_and_result
from kinds import ACCEPTED, FOUND, SURVIVES, UNSTATED, attack
from session_format import Key


@attack("history", FOUND, "restore checks a backup", "part_changed")
def backup_edited(s):
    """A backup whose results, session, checkpoint or entries were edited is not restored."""
    bad = s.p("bad")

    def tried(what):
        r = s.run("ledger", "restore", bad, "--out", s.p("L2"))
        s.must(r.rc != 0 or json.loads(r.stdout)["missing_sessions"], what + " is restored")
        shutil.rmtree(bad)
        shutil.rmtree(s.p("L2"), ignore_errors=True)
        return r

    def fresh():
        shutil.copytree(s.p("backup"), bad)
    fresh()
    ledger = lf.Ledger(bad)
    body_and_result(ledger)
    ledger.store()
    tried("an edited entry")
    fresh()
    ledger = lf.Ledger(bad)
    body_and_result(ledger)
    ledger.resign(s.station("stranger"))
    ledger.store()
    tried("entries signed by a stranger")
    fresh()
    name = sorted(os.listdir(s.p("bad/sessions")))[0]
    with open(s.p("bad/sessions/" + name), "ab") as file:
        file.write(b"x")
    tried("an edited session")
    fresh()
    ledger = lf.Ledger(bad)
    ledger.documents[0][1] += b"#"
    ledger.store()
    return tried("an edited document")


@attack("history", FOUND, "restore checks a backup; checkpoint: the note of its last entry", "signature_invalid")
def backup_checkpoint_edited(s):
    """The backup's `checkpoint` names another size under the same signature."""
    s.text("backup/checkpoint", open(s.p("backup/checkpoint")).read().replace("\n18\n", "\n17\n"))
    return s.run("ledger", "restore", s.p("backup"), "--out", s.p("L2"))


@attack("history", FOUND, "restore checks a backup; checkpoint: the note of its last entry", "tree_differs", "18")
def backup_truncated(s):
    """On another computer, without witness: the backup's ledger.db lacks its last entry, which its own `checkpoint` still shows."""
    ledger = lf.Ledger(s.p("backup"))
    ledger.entries.pop()
    ledger.notes.pop()
    ledger.store()
    shutil.rmtree(f"{s.home}/witness")
    return s.run("ledger", "restore", s.p("backup"), "--out", s.p("L2"))


@attack("history", UNSTATED, "a backup's session put back from another place: what is missing is named")
def backup_with_links(s):
    """A session of the backup is a link to a file outside; the restored ledger keeps no link."""
    name = sorted(os.listdir(s.p("backup/sessions")))[0]
    shutil.move(s.p("backup/sessions/" + name), s.p("elsewhere"))
    os.symlink(s.p("elsewhere"), s.p("backup/sessions/" + name))
    r = s.run("ledger", "restore", s.p("backup"), "--out", s.p("L2"))
    if os.path.isdir(s.p("L2/sessions")):
        s.must(not os.path.islink(s.p("L2/sessions/" + name)), "a link is restored")
    return r


@attack("history", FOUND, "each row is sealed", "identities_changed")
def backup_identities_exchanged(s):
    """The identities of a backup are exchanged before it is restored."""
    db = sqlite3.connect(s.p("backup/identities.db"))
    db.executescript("UPDATE identity SET name = 'Ben Behrens' WHERE id = '4711'")
    db.close()
    r = s.run("ledger", "restore", s.p("backup"), "--out", s.p("L2"))
    if r.rc != 0:
        return r
    return s.run("ledger", "verify", s.p("L2"))


@attack("history", ACCEPTED, "an untouched backup is restored and verifies")
def control_backup(s):
    """The backup as it was made."""
    s.needs("ledger", "restore", s.p("backup"), "--out", s.p("L2"))
    return s.run("ledger", "verify", s.p("L2"))


@attack("history", FOUND, "when entries are lost it makes nothing until a person says why the school accepts that")
def older_backup_restored(s):
    """A backup that lacks entries that the witness saw, restored without --accept-loss; then with it, and the loss is shown by verify."""
    s.needs("ledger", "station", s.L, "--invite", "Later")
    r = s.run("ledger", "restore", s.p("backup"), "--out", s.p("L2"), "--json")
    s.must(json.loads(r.stdout)["lost"], "what is lost is not named")
    s.must(not os.path.exists(s.p("L2/ledger.db")), "something was made")
    s.must(s.run("ledger", "restore", s.p("backup"), "--out", s.p("L3"), "--accept-loss", "fire").rc == 0, "not with a reason, either")
    shown = s.run("ledger", "verify", s.p("L3"), "--json")
    s.must("restored" in shown.kinds("remarks"), "verify does not show the restore entry")
    s.must(s.ledger("station", "--invite", "Left behind").rc != 0, "the ledger that was left behind is added to")
    return r


@attack("history", FOUND, "restores never over what is there", "error")
def restore_over_a_ledger(s):
    """--out names the ledger itself."""
    return s.run("ledger", "restore", s.p("backup"), "--out", s.L)


@attack("history", SURVIVES, "a backup's folder with planted links: nothing outside is written over")
def backup_onto_links(s):
    """An earlier backup whose files were exchanged for links to another file: that one must stay as it is."""
    s.text("precious", "precious")
    for name in ("ledger.db", "checkpoint", "identities.db"):
        os.remove(s.p("backup/" + name))
        os.symlink(s.p("precious"), s.p("backup/" + name))
    s.ledger("station", "--invite", "One more")
    r = s.ledger("backup", "--out", s.p("backup"), "--with-identities")
    s.must(open(s.p("precious"), "rb").read() == b"precious", "a file outside the backup was written over")
    return r


@attack("history", ACCEPTED, "programs that add at the same time wait for one another")
def two_at_once(s):
    """The same recording added by three programs at once: one files it, and the ledger holds."""
    env = dict(os.environ, CAVUM_HOME=s.home)
    several = [subprocess.Popen([s.cavum, "ledger", "add", s.L, s.p("anna.cavum")], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(3)]
    codes = sorted(p.wait(60) for p in several)
    s.must(codes.count(0) == 1 and len(set(codes)) <= 3, f"exit codes {codes}: not exactly one filed it")
    return s.ledger("verify")


@attack("history", ACCEPTED, "a one-time code is good once, also at once")
def one_code_at_once(s):
    """The same code used by three stations at the same moment."""
    code = school.invite(s, "Race")
    env = dict(os.environ, CAVUM_HOME=s.home)
    several = []
    for i in range(3):
        request = lf.station_request(s.school_key().hex, Key(os.urandom(32)), lf.code_key(code))
        path = s.text(f"race{i}", lf.json_text(request) + "\n")
        several.append(subprocess.Popen([s.cavum, "ledger", "station", s.L, "--enrol", path], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))
    codes = sorted(p.wait(60) for p in several)
    s.must(codes.count(0) == 1, f"exit codes {codes}: not exactly one was enrolled")
    return s.ledger("verify")
