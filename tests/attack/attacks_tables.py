"""Tables, triggers, documents, sessions, identities and cosignatures of a ledger changed."""
import os
import shutil

import ledger_format as lf
import school
from attacks_ledger import SCHEMA, checked, edited, sql
from kinds import ACCEPTED, FOUND, NOBODY, SURVIVES, attack
from session_format import sha


@attack("ledger", FOUND, SCHEMA, "schema_differs", "entry_stays")
def trigger_dropped(s):
    """The trigger that forbids changes is gone."""
    sql(s, "DROP TRIGGER entry_stays")
    return checked(s)


@attack("ledger", FOUND, SCHEMA, "schema_differs", "session")
def view_altered(s):
    """The view of sessions shows everybody a pass."""
    sql(s, "DROP VIEW session", "CREATE VIEW session AS SELECT seq, 'pass' AS verdict FROM entry WHERE text ->> '$.kind' = 'session'")
    return checked(s)


@attack("ledger", FOUND, SCHEMA, "schema_differs")
def index_and_table_added(s):
    """An index, a table, a trigger that changes an entry as soon as a cosignature comes in."""
    for line in ("CREATE INDEX i ON entry(text)", "CREATE TABLE more (a)", "CREATE TRIGGER t AFTER INSERT ON cosignature BEGIN INSERT INTO document VALUES (x'00', x'00'); END"):
        sql(s, line)
        s.must(s.ledger("verify").rc != 0, line + " is taken")
    return checked(s)


@attack("ledger", FOUND, "a table that was taken out is one [a finding]", "schema_differs", "cosignature")
def table_taken_out(s):
    """The table of cosignatures is gone."""
    sql(s, "DROP TABLE cosignature")
    return checked(s)


@attack("ledger", FOUND, "a file of another format is refused", "error")
def format_numbers(s):
    """user_version 0, 2, -1, 2^31 - 1; another application_id."""
    good = lf.Ledger(s.L).version
    for n in (good - 1, good + 1, -1, 2**31 - 1):
        sql(s, f"PRAGMA user_version={n}")
        s.must(s.ledger("verify").rc != 0, f"user_version {n} is taken")
    sql(s, f"PRAGMA user_version={good}", "PRAGMA application_id=1")
    return checked(s)


@attack("ledger", FOUND, "documents: by which a regrade was marked", "part_missing")
def document_edited(s):
    """The scenario that a result was marked anew by is another; then gone; then another under its hash."""
    def change(ledger):
        ledger.documents[0][1] = ledger.documents[0][1].replace(b"pass_percent = 5", b"pass_percent = 9")
    first = edited(s, change)
    s.must(first.rc != 0, "an edited document is taken")

    def swap(ledger):
        ledger.documents = [[sha(d), d] for _, d in ledger.documents]
    s.must(edited(s, swap).rc != 0, "an exchanged document is taken")
    return edited(s, lambda ledger: ledger.documents.clear())


@attack("ledger", FOUND, "a document that nobody names", "foreign")
def document_added(s):
    """A document that no entry names."""
    return edited(s, lambda ledger: ledger.documents.append([sha(b"contraband"), b"contraband"]), and_add=False)


@attack("ledger", FOUND, "edits or removes a filed session: its hash in its entry", "file_gone")
def session_edited(s):
    """One byte of a filed recording is another; then the file is gone; then it is another recording's; a link; a pipe; a folder."""
    body = lf.Ledger(s.L).body(14)
    path = f"{s.L}/sessions/{body['file_sha256']}.cavum"
    good = open(path, "rb").read()
    os.chmod(path, 0o600)

    def tried(what):
        s.must(s.ledger("verify").rc != 0, what + " is taken")
        s.must(s.ledger("verify", "--replay").rc != 0, what + " is taken (--replay)")
        os.rmdir(path) if os.path.isdir(path) else os.path.lexists(path) and os.remove(path)
    open(path, "wb").write(good[:-1] + bytes([good[-1] ^ 1]))
    tried("an edited session")
    tried("a removed session")
    shutil.copy(s.p("anna.cavum"), path)
    tried("an exchanged session")
    os.mkfifo(path)
    tried("a pipe")
    os.makedirs(path)
    tried("a folder")
    os.symlink("/dev/zero", path)
    tried("a link to /dev/zero")
    return s.ledger("verify")


@attack("ledger", FOUND, "exchanges names among the identities: each salt and number must give its pseudonym again", "identities_changed")
def numbers_exchanged(s):
    """Number and name of two candidates change places, the salts stay."""
    a, b = [r["pseudonym"] for r in school.identities(s)][:2]
    sql(s, f"""CREATE TEMP TABLE t AS SELECT * FROM identity; UPDATE identity SET id='zz' WHERE pseudonym='{a}';
        UPDATE identity SET (id, name) = (SELECT id, name FROM t WHERE pseudonym='{a}') WHERE pseudonym='{b}';
        UPDATE identity SET (id, name) = (SELECT id, name FROM t WHERE pseudonym='{b}') WHERE pseudonym='{a}';""", file="identities.db")
    for verb in (("release", "--all", "--undecided"), ("export", "--format", "moodle", "--out", s.p("g.csv"))):
        s.must(s.ledger(*verb).rc != 0, f"`ledger {verb[0]}` goes on")
    return checked(s, and_add=False)


@attack("ledger", FOUND, "exchanges names among the identities: ... `verify`, `release`, `export`", "identities_changed")
def names_exchanged(s):
    """Only the names of two candidates change places; numbers and salts stay."""
    a, b = [r["pseudonym"] for r in school.identities(s) if r["id"] in ("4711", "4714")]
    sql(s, f"""CREATE TEMP TABLE t AS SELECT * FROM identity;
        UPDATE identity SET name = (SELECT name FROM t WHERE pseudonym='{a}') WHERE pseudonym='{b}';
        UPDATE identity SET name = (SELECT name FROM t WHERE pseudonym='{b}') WHERE pseudonym='{a}';""", file="identities.db")
    s.ledger("export", "--format", "moodle", "--out", s.p("g.csv"))
    return checked(s, and_add=False)


@attack("ledger", FOUND, "`forget` removes salt and number, after which the school itself cannot say who it was", "file_unreadable", "identities.db")
def forget_undone_by_a_trigger(s):
    """A table and a trigger planted in identities.db keep every identity that is removed; `forget`, then `verify`."""
    sql(s, "CREATE TABLE kept (pseudonym TEXT, id TEXT, name TEXT, salt BLOB); "
        "CREATE TRIGGER t BEFORE DELETE ON identity BEGIN INSERT INTO kept VALUES (old.pseudonym, old.id, old.name, old.salt); END", file="identities.db")
    forgot = s.ledger("forget", "--candidate", "4711")
    if forgot.rc == 0:
        s.must(b"Anna Ahrens" not in open(f"{s.L}/identities.db", "rb").read(), "the name is still in identities.db after `forget` ended with 0")
    return checked(s, and_add=False)


@attack("ledger", ACCEPTED, "identities.db: secure delete")
def control_forget(s):
    """Without the trigger: name and number are nowhere in the ledger's folder any more."""
    done = s.ledger("forget", "--candidate", "4711")
    for folder, _, files in os.walk(s.L):
        for f in files:
            s.must(b"Anna Ahrens" not in open(f"{folder}/{f}", "rb").read(), f"the name is still in {f}")
    s.must(s.ledger("verify").rc == 0, "verify refuses it")
    return done


@attack("ledger", NOBODY, "takes cosignatures out of the ledger: nobody")
def cosignatures_taken_out(s):
    """The table of cosignatures is empty."""
    return edited(s, lambda ledger: ledger.cosignatures.clear())


@attack("ledger", FOUND, "lines of a known one must hold", "cosignature_invalid", "999")
def cosignature_forged(s):
    """A known cosigner's name and key id over another signature; and one of a size that is not there."""
    ledger = lf.Ledger(s.L)
    line = ledger.cosignatures[0][1]
    ledger.cosignatures.append([17, line])
    ledger.store()
    s.must(s.ledger("verify").rc != 0, "a cosignature of another size is taken")
    return edited(s, lambda ledger: ledger.cosignatures.append([999, line]), and_add=False)


@attack("ledger", FOUND, "leaf, tree, signature; types", "schema_differs", "entry_stays")
def types_confused(s):
    """A leaf of 31 bytes; the table made without STRICT and a leaf as TEXT, a sequence number as TEXT."""
    def change(ledger):
        ledger.entries[5][2] = ledger.entries[5][2][:31]
    s.must(edited(s, change).rc != 0, "a leaf of 31 bytes is taken")
    ledger = lf.Ledger(s.L)
    for r in ledger.entries:
        r[2] = lf.leaf(r[1])
    ledger.store()
    sql(s, "PRAGMA writable_schema=ON; UPDATE sqlite_master SET sql=replace(sql, ') STRICT', ')') WHERE type='table' AND name='entry'")
    sql(s, "DROP TRIGGER entry_stays", "UPDATE entry SET leaf_sha256 = 'text', text = x'00ff' WHERE seq = 5")
    sql(s, "PRAGMA writable_schema=ON; UPDATE sqlite_master SET sql=sql || ' STRICT' WHERE type='table' AND name='entry'")
    return checked(s, and_add=False)


@attack("ledger", SURVIVES, "other files in the ledger's place")
def ledger_files_hostile(s):
    """ledger.db and identities.db as pipe, folder, link to a device, rubbish, nothing; a planted log."""
    last = None
    for name in ("ledger.db", "identities.db"):
        path = f"{s.L}/{name}"
        for make in (os.mkfifo, os.makedirs, lambda p: os.symlink("/dev/zero", p), lambda p: open(p, "wb").write(b"SQLite format 3\0" + os.urandom(8000)), lambda p: open(p, "wb")):
            if os.path.isdir(path) and not os.path.islink(path):
                os.rmdir(path)
            elif os.path.lexists(path):
                os.remove(path)
            make(path)
            last = s.ledger("verify")
            if name == "ledger.db":
                s.must(last.rc != 0, "verify takes a ledger that is none")
            s.ledger("show")
    return last
