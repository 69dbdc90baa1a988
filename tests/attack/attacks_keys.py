"""Format 5: the school's keys and their replacement, the ledger's word to begin, tickets that are cancelled."""
import json
import os
import shutil
import time

import ledger_format as lf
import school
from attacks_ledger import sql
from kinds import ACCEPTED, FOUND, NOBODY, UNSTATED, attack
from school import as_hand
from session_format import Key


def replaced(s, *options):
    """The key is replaced by the verb; the old one and the new one."""
    old = s.school_key()
    s.needs("ledger", "key", s.L, "--replace", *options)
    return old, s.school_key()


def told(s, ledger):
    s.text("home/witness/" + ledger.id, ledger.witness())


@attack("five", ACCEPTED, "a key entry of our own making, signed by the key before it")
def control_key_replaced(s):
    """By the page alone: entry `key`, its note and the next by the new key; receipt, results and cosigned note of before still hold."""
    old, new = s.school_key(), Key(os.urandom(32))
    ledger = lf.Ledger(s.L)
    ledger.add("key", lf.key_entry(ledger.id, old, new))
    ledger.resign(new, 19)
    ledger.add("forget", {"candidate": "C-0000-0000-0000"})
    ledger.resign(new, 20)
    ledger.store()
    told(s, ledger)
    s.text("home/school.key", f"cavum school key 1 (Ed25519 seed; keep secret): {new.seed.hex()}\n")
    s.text("home/school.pub", new.hex + "\n")
    for i in school.identities(s):  # the page does not say so: all rows are sealed anew under the new key
        sql(s, ("UPDATE identity SET seal = ? WHERE pseudonym = ?", (lf.identity_seal(new.seed, i["pseudonym"], i["exam"], i["id"], i["name"]), i["pseudonym"])), file="identities.db")
    s.must(s.ledger("verify", "--receipt", s.p("receipts/receipt-14.json"), "--results", s.p("results.json"), "--cosigned", s.p("cosigned")).rc == 0, "what was signed before does not hold any more")
    return s.ledger("verify")


@attack("five", FOUND, "introduces a key of the school of his own: the key before it signs it", "signature_invalid", "18")
def key_signed_by_nobody(s):
    """A `key` entry signed by the new key itself, by a stranger, for another ledger, with another end than was signed."""
    stranger = s.station("stranger")
    last = None
    good = lf.Ledger(s.L)
    cases = [lf.key_entry(good.id, s.school_key(), stranger, signed_by=stranger), lf.key_entry("00" * 16, s.school_key(), stranger), lf.key_entry(good.id, stranger, stranger),
             dict(lf.key_entry(good.id, s.school_key(), stranger, 1), until_utc_ns=0), dict(lf.key_entry(good.id, s.school_key(), s.station("seat1")), public_key=stranger.hex)]
    for body in cases:
        ledger = lf.Ledger(s.L)
        ledger.entries, ledger.notes = [list(r) for r in good.entries], [list(n) for n in good.notes]
        ledger.add("key", body)
        ledger.resign(stranger, 19)
        ledger.store()
        last = s.ledger("verify")
        s.must(last.rc != 0, "taken: " + lf.json_text(body)[:80])
    return last


@attack("five", FOUND, "goes on with a key that was replaced: refused", "malformed signature_invalid")
def old_key_goes_on(s):
    """After the replacement: an entry by the verb with the old key; by hand with a note of the old key; the note of the `key` entry by the old one."""
    old, new = replaced(s)
    s.must(s.ledger("station", "--invite", "x", "--key", f"{s.home}/school.key.{old.hex[:8]}").rc != 0, "the verb adds with the old key")
    ledger = lf.Ledger(s.L)
    ledger.resign(old, 19)
    ledger.store()
    s.must(s.ledger("verify").rc != 0, "the note of the key's entry may be signed by the old one")
    ledger.resign(new, 19)
    ledger.add("forget", {"candidate": "C-0000-0000-0000"})
    ledger.resign(old, 20)
    ledger.store()
    return s.ledger("verify")


@attack("five", FOUND, "an older copy put back from before the replacement is found", "older_copy witness_changed")
def older_copy_from_before_the_key(s):
    """The ledger and school.key of before the replacement are put back; the witness stays."""
    shutil.copytree(s.L, s.p("before"))
    old, new = replaced(s)
    shutil.rmtree(s.L)
    shutil.copytree(s.p("before"), s.L)
    s.text("home/school.key", f"cavum school key 1 (Ed25519 seed; keep secret): {old.seed.hex()}\n")
    s.text("home/school.pub", old.hex + "\n")
    return s.ledger("verify")


@attack("five", FOUND, "one that ran out enters nothing until it is replaced", "key_run_out")
def key_ran_out(s):
    """The present key is good for a second; then an entry is added by the verb; then by hand."""
    r = s.ledger("key", "--until", time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(time.time() + 2)), "--reason", "x")
    if r.rc != 0:
        return r
    time.sleep(2.5)
    s.must(s.ledger("station", "--invite", "x").rc != 0, "the verb adds with a key that ran out")
    ledger = lf.Ledger(s.L)
    ledger.add("forget", {"candidate": "C-0000-0000-0000"})
    ledger.resign(s.school_key(), len(ledger.entries))
    ledger.store()
    told(s, ledger)
    return s.ledger("verify")


@attack("five", FOUND, "the first time, and when the school replaced its key, a person tells the cosigner", "signature_invalid")
def cosigner_and_another_key(s):
    """The cosigner is asked to sign a checkpoint of the new key without being shown that entry's receipt; then of a stranger's, which the ledger's id fits."""
    old, new = replaced(s)
    s.needs("ledger", "checkpoint", s.L, "--since", "18", "--out", s.p("ask"))
    s.must(s.run("ledger", "cosign", s.p("ask"), "--out", s.p("c1"), "--name", "cosigner.example/one", home=s.p("cosigner")).rc != 0, "a new key is taken untold")
    s.must(s.run("ledger", "cosign", s.p("ask"), "--out", s.p("c2"), "--name", "cosigner.example/one", "--school-key", new.hex, home=s.p("cosigner")).rc != 0,
           "a key that a person names is taken for the remembered one's successor")
    s.needs("ledger", "receipt", s.L, "--entry", "18", "--out", s.p("key.json"))
    shown = s.run("ledger", "cosign", s.p("ask"), "--out", s.p("c2"), "--name", "cosigner.example/one", "--key-receipt", s.p("key.json"), home=s.p("cosigner"))
    s.must(shown.rc == 0, "shown the receipt of the entry by which the key was replaced, it does not sign")
    ledger = lf.Ledger(s.L)
    return s.run("ledger", "cosign", s.text("ask2", lf.cosign_request(19, [], lf.note(ledger.id, 19, lf.root(ledger.leaves()), 10**18 * 2, old))), "--out", s.p("c3"), home=s.p("cosigner"))


@attack("five", FOUND, "signed results: by this school's key, unchanged", "other_school")
def results_by_the_old_key_after(s):
    """After the replacement, results made up with the old (stolen) key, with a checkpoint of after the replacement."""
    body = json.loads(open(s.p("results.json"), encoding="utf-8").read())
    del body["signature"]
    old, new = replaced(s)
    ledger = lf.Ledger(s.L)
    body["checkpoint"] = lf.note(ledger.id, 19, lf.root(ledger.leaves()), 2 * 10**18, old)
    body["results"] = []
    return s.ledger("verify", "--results", s.text("r.json", lf.signed_results(body, old)))


@attack("five", NOBODY, "a key that was stolen can be used to replace it: cosigners, told by a person, are what is left then")
def results_by_the_old_key_of_before(s):
    """After the replacement, results made up with the old (stolen) key over the last checkpoint of before."""
    body = json.loads(open(s.p("results.json"), encoding="utf-8").read())
    del body["signature"]
    old, new = replaced(s)
    body["results"][0]["result"]["verdict"] = "pass"
    return s.ledger("verify", "--results", s.text("r.json", lf.signed_results(body, old)))


@attack("five", FOUND, "a receipt: the school's signature; the note of entry `key` and all later ones are signed by the new key", "other_school")
def receipt_by_the_old_key_after(s):
    """After the replacement, a receipt with a note of after it that the old (stolen) key signed; then that note as a cosigned one."""
    old, new = replaced(s)
    ledger = lf.Ledger(s.L)
    r = ledger.receipt(18)
    r["checkpoint"] = lf.note(ledger.id, 19, lf.root(ledger.leaves()), 2 * 10**18, old)
    s.must(s.ledger("verify", "--cosigned", s.text("c.note", r["checkpoint"])).rc != 0, "as a note it is taken")
    return s.ledger("verify", "--receipt", s.text("r.json", json.dumps(r)))


@attack("five", UNSTATED, "begin.utc_ns: the ledger's clock; key: a new key")
def words_and_keys_that_mean_nothing(s):
    """With the school's key: a word of 2001, entered today (the entry's own time says so); a key put in its own place."""
    key, good = s.school_key(), lf.Ledger(s.L)
    nonce = good.body(8)["ticket"]["nonce"]
    ledger = lf.Ledger(s.L)
    ledger.add("begin", lf.begin_word(good.id, nonce, key, 10**18))
    ledger.add("key", lf.key_entry(good.id, key, key))
    ledger.resign(key, 19)
    ledger.store()
    told(s, ledger)
    return s.ledger("verify")


# --- the word to begin -----------------------------------------------------------------------------------------------

def promised(s):
    """A ticket for Gerd that asks for the word; the word; both by the verbs."""
    s.needs("ledger", "ticket", s.L, s.p("quick.toml"), "--candidate", "4720", "--begin-at-ledger", "--from", school.hours(-2), "--until", school.hours(9), "--out", s.p("gerd.ticket"))
    s.needs("ledger", "begin", s.L, "--ticket", s.p("gerd.ticket"))
    return open(s.p("gerd.ticket"), encoding="utf-8").read().strip(), open(s.p("gerd.begin"), encoding="utf-8").read().strip()


def sat(s, ticket, word, at_ns=None, also=lambda r: None):
    r = s.session("op_anna.cavum")
    r.facts.update({"note.ticket": ticket, "candidate": json.loads(ticket)["ticket"]["candidate"]})
    if word:
        r.facts["note.begin"] = word
    also(r)
    r = as_hand(r, s.station(), 0)
    r.set_clocks(at_ns or time.time_ns(), int(r.facts["created_boot_ns"]))
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    if not at_ns:
        time.sleep(4.5)
    return s.add("m.cavum")


@attack("five", ACCEPTED, "a hand's exam with ticket and word is filed")
def control_word(s):
    """The recording bears both and begins after the word."""
    return sat(s, *promised(s))


@attack("five", FOUND, "leaves out the word that a ticket asks for, or uses another's: filing", "begin_invalid")
def word_left_out_or_anothers(s):
    """No word; the word of another ticket; made by the station; edited to another time; of another ledger; twice the word's text; not entered in the ledger."""
    ticket, word = promised(s)
    begin = json.loads(word)["begin"]
    s.needs("ledger", "ticket", s.L, s.p("quick.toml"), "--candidate", "4721", "--begin-at-ledger", "--from", school.hours(-2), "--until", school.hours(9), "--out", s.p("hans.ticket"))
    s.needs("ledger", "begin", s.L, "--ticket", s.p("hans.ticket"))
    mine = lf.begin_word(begin["ledger"], begin["ticket"], s.station())
    never_entered = lf.begin_word(begin["ledger"], begin["ticket"], s.school_key(), begin["utc_ns"])
    last = None
    at = begin["utc_ns"] + 2 * 10**8
    time.sleep(5)
    for what, text in (("none", None), ("another ticket's", open(s.p("hans.begin"), encoding="utf-8").read().strip()), ("the station's own", lf.json_text(mine)), ("the station's own, in the school's name",
                       lf.json_text(lf.begin_word(begin["ledger"], begin["ticket"], s.station(), public_key=s.school_key().hex))), ("edited", word.replace(str(begin["utc_ns"]), str(begin["utc_ns"] - 10**12))),
                       ("another ledger's", lf.json_text(lf.begin_word("00" * 16, begin["ticket"], s.school_key()))), ("rubbish", "{}"), ("never entered, with the school's key", lf.json_text(never_entered))):
        last = sat(s, ticket, text, at)
        s.must(last.rc != 0, f"the word: {what}: filed as clean")
        s.must(last.kinds() & {"begin_missing", "begin_invalid"}, f"the word: {what}: found for another reason")
    return last


@attack("five", FOUND, "a station's clock that was set back is named by the ledger's word", "clock")
def clock_before_the_word(s):
    """By the station's clock the exam began an hour before the ledger's word."""
    ticket, word = promised(s)
    return sat(s, ticket, word, time.time_ns() - 3600 * 10**9)


@attack("five", FOUND, "of a ticket only the recording with the last word is sound", "begin_invalid")
def first_word_after_a_second(s):
    """Sat at two stations, each with a word; the recording with the first word is handed in after the second was given."""
    ticket, word = promised(s)
    s.needs("ledger", "begin", s.L, "--ticket", s.p("gerd.ticket"), "--again", "broken stylus", "--out", s.p("second.begin"))
    return sat(s, ticket, word)


@attack("five", FOUND, "begin: once", "error")
def word_twice(s):
    """A second word without --again; of a cancelled ticket; of a ticket that was edited; of a ticket of another ledger."""
    promised(s)
    s.must(s.ledger("begin", "--ticket", s.p("gerd.ticket"), "--out", s.p("b2")).rc != 0, "a second word is given")
    s.text("e.ticket", open(s.p("finn.ticket"), encoding="utf-8").read().replace('"not_after":"2026', '"not_after":"2036'))
    s.must(s.ledger("begin", "--ticket", s.p("e.ticket"), "--out", s.p("b3")).rc != 0, "the word for an edited ticket")
    ledger = lf.Ledger(s.L)
    number = next(r[0] for r in ledger.entries if json.loads(r[1])["kind"] == "ticket" and ledger.body(r[0])["ticket"]["nonce"] == json.load(open(s.p("finn.ticket")))["ticket"]["nonce"])
    s.must(s.ledger("cancel", "--ticket", str(number), "--reason", "ill").rc == 0, "it is not cancelled")
    return s.ledger("begin", "--ticket", s.p("finn.ticket"), "--out", s.p("b4"))


@attack("five", FOUND, "makes a ticket up, or uses a cancelled one", "ticket_cancelled")
def cancelled_ticket_used(s):
    """Anna's ticket is cancelled, then her recording is handed in; a used one cannot be cancelled."""
    s.must(s.ledger("cancel", "--ticket", "8", "--reason", "ill").rc == 0, "it is not cancelled")
    s.must(s.ledger("cancel", "--ticket", "11", "--reason", "x").rc != 0, "a ticket whose exam is filed is cancelled")
    s.must(s.ledger("cancel", "--ticket", "8", "--reason", "x").rc != 0, "a ticket is cancelled twice")
    s.must(s.ledger("cancel", "--ticket", "3", "--reason", "x").rc != 0, "an invitation is cancelled")
    return s.add("anna.cavum")


@attack("five", FOUND, "gets two tickets for one exam: refused, unless a person says so", "error")
def two_tickets(s):
    """A second ticket for Anna without --another; for a class in which she is."""
    r = s.ledger("ticket", s.p("quick.toml"), "--candidates", s.p("class.csv"), "--from", school.hours(-2), "--until", school.hours(9), "--out", s.p("t4"))
    s.must(r.rc != 0, "a class in which Anna has a ticket is given others")
    return s.ledger("ticket", s.p("quick.toml"), "--candidate", "4711", "--from", school.hours(-2), "--until", school.hours(9), "--out", s.p("t5"))


@attack("five", FOUND, "made-up entries of the new kinds", "malformed signature_invalid")
def new_kinds_hostile(s):
    """With the school's key: cancel of what is no ticket, begin with a word of a stranger, forget with a list of nonsense, `key` with a key that is none."""
    key, stranger = s.school_key(), s.station("stranger")
    good = lf.Ledger(s.L)
    nonce = good.body(8)["ticket"]["nonce"]
    last = None
    for what, kind, body in (("cancel of an enrolment", "cancel", {"ticket": 3, "reason": "x"}), ("cancel of what is not there", "cancel", {"ticket": 99, "reason": "x"}), ("cancel of -1", "cancel", {"ticket": -1, "reason": "x"}),
                             ("a stranger's word", "begin", lf.begin_word(good.id, nonce, stranger)), ("a word for no ticket", "begin", lf.begin_word(good.id, "00" * 16, key)),
                             ("another ledger's word", "begin", lf.begin_word("00" * 16, nonce, key)),
                             ("a forget that erases another's recording", "forget", {"candidate": "C-0000-0000-0000", "erased": [{"entry": 14, "what": "motion"}]}),
                             ("a key that is none", "key", {"public_key": "zz", "signature": "", "until_utc_ns": 0, "reason": ""}), 
                             ("a key entry with a note of the old key", "key", lf.key_entry(good.id, key, stranger, 2**63 - 1))):
        ledger = lf.Ledger(s.L)
        ledger.entries, ledger.notes = [list(r) for r in good.entries], [list(n) for n in good.notes]
        ledger.add(kind, body)
        ledger.resign(key, 19)
        ledger.store()
        last = s.ledger("verify")
        s.must(last.rc != 0, f"taken: {what}")
        s.ledger("show")
        s.ledger("tickets")
    return last
