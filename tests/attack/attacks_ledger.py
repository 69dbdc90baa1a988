"""The ledger's file edited by SQL: entries, leaves, signatures, results, documents, sessions, tables, names."""
import json
import os
import sqlite3

import ledger_format as lf
from kinds import ACCEPTED, FOUND, SURVIVES, UNSTATED, attack

SQL = "edits, removes or slips in an entry by SQL: leaf, tree, signature: `cavum ledger verify`; nothing is added until it holds again"
SCHEMA = "alters, removes or adds a table, trigger, view or index of the ledger's file: `cavum ledger verify` names it"


def checked(s, and_add=True):
    """`ledger verify`; nothing may be added to what does not hold, and `show` warns."""
    r = s.ledger("verify")
    if r.rc != 0 and and_add:
        s.must(s.ledger("ticket", s.p("quick.toml"), "--candidate", "9999", "--from", "2026-11-21T09:00Z", "--until", "2030-01-01T00:00Z", "--out", s.p("t9")).rc != 0, "an entry is added to a ledger that does not hold")
        s.must(s.ledger("show").rc != 0, "`ledger show` does not warn")
    return r


def edited(s, change, from_size=None, school=None, witness=True, **more):
    ledger = lf.Ledger(s.L)
    change(ledger)
    if from_size:
        ledger.resign(school or s.school_key(), from_size)
    ledger.store()
    if not witness:
        os.remove(s.witness_path())
    return checked(s, **more)


def sql(s, *lines, file="ledger.db"):
    db = sqlite3.connect(f"{s.L}/{file}")
    for line in lines:
        db.execute(*line) if isinstance(line, tuple) else db.executescript(line)
    db.commit()
    db.close()


@attack("ledger", ACCEPTED, "leaves, roots, notes and witness of our own are the program's, byte by byte; signed anew they hold")
def control_ledger_is_understood(s):
    """Every leaf, note and witness line computed and compared; then stored and signed anew with the school's key."""
    s.must(lf.worked_example(), "the page's example comes out otherwise")
    ledger = lf.Ledger(s.L)
    leaves = [r[2] for r in ledger.entries]
    notes = [list(n) for n in ledger.notes]
    texts = [r[1] for r in ledger.entries]
    s.must(all(lf.json_text(json.loads(t)) == t for t in texts), "an entry is no JSON text as the page has it")
    s.must(open(s.witness_path()).read() == ledger.witness(), "the witness differs")
    ledger.resign(s.school_key())
    s.must([r[2] for r in ledger.entries] == leaves, "leaves differ")
    s.must([list(n) for n in ledger.notes] == notes, "notes differ")
    ledger.store()
    from school import identities
    seed = s.school_key().seed
    s.must(all(lf.identity_seal(seed, i["pseudonym"], i["exam"], i["id"], i["name"]) == i["seal"] for i in identities(s)), "seals differ")
    r = json.loads(open(s.p("results.json"), encoding="utf-8").read())
    signature = r.pop("signature")
    line = open(s.p("results.json"), encoding="utf-8").read()
    s.must(line.rstrip("\n")[:-144] + "}" == line.rstrip("\n").replace(f',"signature":"{signature}"', ""), "the signature is not the last of the line")
    s.must(s.school_key().sign(b"CVRESULT" + line.rstrip("\n").replace(f',"signature":"{signature}"', "").encode()).hex() == signature, "signed results differ")
    s.text("receipt.json", json.dumps(ledger.receipt(14, 5)))
    s.must(s.ledger("verify", "--receipt", s.p("receipt.json"), "--cosigned", s.p("cosigned"), "--results", s.p("results.json")).rc == 0, "receipt, note or results of our own are refused")
    return s.ledger("verify", "--replay")


@attack("ledger", ACCEPTED, "an entry of our own making, with the school's key, is an entry")
def control_entry_of_our_own(s):
    """With the school's key and the witness told: a `forget` for nobody."""
    ledger = lf.Ledger(s.L)
    ledger.add("forget", {"candidate": "C-0000-0000-0000"})
    ledger.resign(s.school_key(), len(ledger.entries))
    ledger.store()
    s.text("home/witness/" + ledger.id, ledger.witness())
    return s.ledger("verify")


def better(ledger):
    seq = ledger.find("session")
    result = ledger.result(seq)
    result["verdict"], result["score"]["points"] = "pass", 100.0
    return seq, result


@attack("ledger", FOUND, SQL, "part_changed", "14")
def result_edited(s):
    """The result beside an entry is another."""
    def change(ledger):
        ledger.set_result(*better(ledger), False)
    return edited(s, change)


def body_and_result(ledger):
    ledger.set_result(*better(ledger), True)


@attack("ledger", FOUND, SQL, "entry_changed", "14")
def entry_edited(s):
    """Entry and result are edited, the leaf stays."""
    return edited(s, body_and_result)


@attack("ledger", FOUND, SQL, "tree_differs", "14")
def entry_edited_leaf_too(s):
    """... and the leaf computed anew."""
    def change(ledger):
        body_and_result(ledger)
        for r in ledger.entries:
            r[2] = lf.leaf(r[1])
    return edited(s, change)


@attack("ledger", FOUND, SQL, "signature_invalid")
def entry_edited_notes_of_a_stranger(s):
    """... and all notes signed anew with a stranger's key."""
    return edited(s, body_and_result, 1, s.station("stranger"))


@attack("ledger", FOUND, "... and adds other entries: history was rewritten (the witness)", "rewritten")
def entry_edited_by_the_school(s):
    """... and all notes signed anew with the school's own key; the witness remembers."""
    return edited(s, body_and_result, 1)


@attack("ledger", FOUND, "verify --replay: the school's own mark", "result_differs")
def entry_edited_by_the_school_no_witness(s):
    """... and the witness taken away: only the motion tells (--replay)."""
    edited(s, body_and_result, 1, witness=False, and_add=False)
    return s.ledger("verify", "--replay")


@attack("ledger", FOUND, "a receipt or a cosigned note of a later state, when somebody shows it", "rewritten tree_differs")
def rewritten_and_a_receipt(s):
    """... and a candidate shows the receipt; a cosigner his note."""
    edited(s, body_and_result, 1, witness=False, and_add=False)
    s.must(s.ledger("verify", "--cosigned", s.p("cosigned")).rc != 0, "a cosigned note is not missed")
    os.remove(f"{s.home}/cosigners")
    return s.ledger("verify", "--receipt", s.p("receipts/receipt-14.json"))


@attack("ledger", FOUND, SQL, "rewritten")
def entry_inserted(s):
    """A ticket is slipped in between two entries, everything renumbered and signed by the school."""
    def change(ledger):
        copy = list(ledger.entries[9])
        ledger.entries.insert(10, copy)
        ledger.renumber()
    return edited(s, change, 1)


@attack("ledger", FOUND, SQL, "rewritten")
def entries_reordered(s):
    """Two tickets change places, signed by the school."""
    def change(ledger):
        ledger.entries[9], ledger.entries[10] = ledger.entries[10], ledger.entries[9]
        ledger.renumber()
    return edited(s, change, 1)


@attack("ledger", FOUND, "puts an older copy back: the witness on this computer", "older_copy")
def entries_truncated(s):
    """The release is cut off, its note too."""
    def change(ledger):
        ledger.entries.pop()
        ledger.notes.pop()
    return edited(s, change)


@attack("ledger", FOUND, SQL, "checkpoint_missing")
def note_cut_off(s):
    """Only the last note is missing."""
    return edited(s, lambda ledger: ledger.notes.pop())


@attack("ledger", FOUND, SQL, "other_school")
def init_names_another_school(s):
    """Entry 0 names a stranger's key and all is signed with that one; school.pub and key of the school stay."""
    def change(ledger):
        body = ledger.body(0)
        body["public_key"] = s.station("stranger").hex
        ledger.set_body(0, body)
    return edited(s, change, 1, s.station("stranger"), witness=False)


@attack("ledger", FOUND, "init: entry 0 and no other", "entry_out_of_order", "18")
def second_init(s):
    """A second `init` with another school's key, signed by the school, the witness told."""
    def change(ledger):
        ledger.add("init", dict(ledger.body(0), school="Another"))
        ledger.resign(s.school_key(), len(ledger.entries))
        s.text("home/witness/" + ledger.id, ledger.witness())
    return edited(s, change)


@attack("ledger", UNSTATED, "an entry of a kind that the page does not know, with the school's key")
def entry_of_unknown_kind(s):
    """Kind `pardon`, signed by the school, the witness told."""
    def change(ledger):
        ledger.add("pardon", {"session": 14})
        ledger.resign(s.school_key(), len(ledger.entries))
        s.text("home/witness/" + ledger.id, ledger.witness())
    return edited(s, change, and_add=False)


@attack("ledger", SURVIVES, "entries with the school's key and hostile bodies")
def entries_hostile(s):
    """Bodies nested deep, with keys twice, with numbers out of range, with missing members, releases of what is not there."""
    bodies = ['{"results":[999999999999999999999]}', '{"results":[-1]}', '{"results":[1e999]}', '{"results":[14,14]}', '{"results":"14"}', "{}", "[]", "null",
              '{"a":' * 50000 + "1" + "}" * 50000, '{"results":[17]}', '{"results":[18]}']
    last = None
    for kind in ("release", "regrade"):
        for body in bodies:
            ledger = lf.Ledger(s.L)
            saved = [list(r) for r in ledger.entries], [list(n) for n in ledger.notes]
            ledger.entries.append([18, f'{{"body":{body},"kind":"{kind}","seq":18,"utc_ns":{10**18 * 2}}}', b""])
            ledger.resign(s.school_key(), 19)
            ledger.store()
            last = s.ledger("verify")
            s.must(last.rc != 0, f"{kind} {body[:40]} is taken")
            s.ledger("export", "--format", "csv", "--out", s.p("x.csv"), "--overwrite")
            ledger.entries, ledger.notes = saved
            ledger.store()
    return last


@attack("ledger", FOUND, "an entry is JSON text: the keys of every object in the order of their bytes, no spaces", "entry_malformed", "18")
def entry_not_json_text(s):
    """With the school's key: a release with `results` twice (readers differ on which counts), then one with spaces, then keys out of order."""
    last = None
    for text in ('{"body":{"results":[14],"results":[15]},"kind":"release","seq":18,"utc_ns":2000000000000000000}', '{"body": {"results": [14]}, "kind": "release", "seq": 18, "utc_ns": 2000000000000000000}',
                 '{"kind":"release","body":{"results":[14]},"seq":18,"utc_ns":2000000000000000000}', '{"body":{"results":[14]},"kind":"release","kind":"forget","seq":18,"utc_ns":2000000000000000000}'):
        ledger = lf.Ledger(s.L)
        saved = [list(r) for r in ledger.entries], [list(n) for n in ledger.notes]
        ledger.entries.append([18, text, b""])
        ledger.resign(s.school_key(), 19)
        ledger.store()
        last = s.ledger("verify")
        s.must(last.rc != 0, "taken: " + text[:60])
        ledger.entries, ledger.notes = saved
        ledger.store()
    return last
