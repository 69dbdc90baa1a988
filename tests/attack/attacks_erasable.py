"""Format 5: openings, what is erased and what comes back, accommodations beside the ticket."""
import json
import os
import re
import shutil

import ledger_format as lf
from attacks_insider import insider
from attacks_ledger import edited, sql
from kinds import ACCEPTED, FOUND, attack
from session_format import sha


def traces(s, needle, folders=("L", "home")):
    """Files of the ledger in which these bytes still stand."""
    found = []
    for top in folders:
        for folder, _, files in os.walk(s.p(top)):
            found += [f for f in files if stands_in(needle, open(f"{folder}/{f}", "rb").read())]
    return found


def stands_in(needle, data):
    """Whether the bytes stand there as themselves: four digits within the hex or base64 of a hash are chance."""
    for found in re.finditer(re.escape(needle), data):
        run = re.search(rb"[0-9A-Za-z+/=_-]*$", data[max(0, found.start() - 64):found.start()])[0] + needle
        run += re.match(rb"[0-9A-Za-z+/=_-]*", data[found.end():found.end() + 64])[0]
        if len(run) < 40:
            return True
    return False


def erase(s, *what, session="14"):
    return s.ledger("erase", "--session", session, *what, "--reason", "kept long enough")


@attack("five", ACCEPTED, "erasing leaves every proof as it is")
def control_erased(s):
    """Result and motion of a session are erased: verify holds, the receipt too, and neither is in any file of the ledger."""
    ledger = lf.Ledger(s.L)
    salts = [json.loads(t)["salt"].encode() for t in (ledger.openings[ledger.body(14)["opens"]["result"]], ledger.openings[ledger.body(16)["opens"]["result"]])]
    file = ledger.body(14)["file_sha256"]
    done = erase(s, "--motion", "--results")
    s.must(done.rc == 0, "it is not erased")
    for salt in salts:
        s.must(not traces(s, salt), f"the salt is still in {traces(s, salt)}")
    s.must(not traces(s, b"5.00 \xc2\xb1 0.67 mm3", ("L",)), "the mark's reasons are still in the ledger's files")
    s.must(not os.path.exists(f"{s.L}/sessions/{file}.cavum"), "the recording is still there")
    s.must(s.ledger("verify", "--receipt", s.p("receipts/receipt-14.json")).rc == 0, "the receipt does not hold any more")
    return s.ledger("verify", "--replay")


@attack("five", FOUND, "changes a result: its hash in the entry", "part_missing", "14")
def opening_edited(s):
    """The opening's text is another under its old name; then under its own name, which no entry has."""
    def rename(ledger):
        old = ledger.body(14)["opens"]["result"]
        text = lf.opening(dict(json.loads(ledger.openings.pop(old))["value"], verdict="pass"))
        ledger.openings[sha(text.encode()).hex()] = text
    def other_salt(ledger):
        old = ledger.body(14)["opens"]["result"]
        ledger.openings[old] = lf.opening(json.loads(ledger.openings[old])["value"])
    shutil.copy(f"{s.L}/ledger.db", s.p("kept"))
    s.must(edited(s, other_salt).rc != 0, "another salt is taken")
    shutil.copy(s.p("kept"), f"{s.L}/ledger.db")
    return edited(s, rename)


@attack("five", FOUND, "changes a result, takes one out, or puts one in", "part_changed", "14")
def openings_exchanged(s):
    """The results of two sessions change places."""
    def change(ledger):
        a, b = ledger.body(14)["opens"]["result"], ledger.body(15)["opens"]["result"]
        ledger.openings[a], ledger.openings[b] = ledger.openings[b], ledger.openings[a]
    return edited(s, change)


@attack("five", FOUND, "takes a result or recording out without an entry: `verify`", "part_missing", "14")
def opening_taken_out(s):
    """The result is deleted (the schema lets one), no entry says so."""
    return edited(s, lambda ledger: ledger.openings.pop(ledger.body(14)["opens"]["result"]) and None)


@attack("five", FOUND, "puts one in: an opening of no entry", "foreign", "ZZ")
def opening_of_no_entry(s):
    """An opening that no entry names; one whose name is not hexadecimal."""
    def change(ledger):
        text = lf.opening("contraband")
        ledger.openings[sha(text.encode()).hex()] = text
    shutil.copy(f"{s.L}/ledger.db", s.p("kept"))
    s.must(edited(s, change).rc != 0, "it is taken")
    shutil.copy(s.p("kept"), f"{s.L}/ledger.db")
    return edited(s, lambda ledger: ledger.openings.update({"ZZ": "{}"}))


@attack("five", FOUND, "brings an erased one back: `verify`", "erased_still_there", "14")
def erased_result_brought_back(s):
    """The erased opening is put in again; the erased recording, too."""
    ledger = lf.Ledger(s.L)
    name, file = ledger.body(14)["opens"]["result"], f"{s.L}/sessions/{ledger.body(14)['file_sha256']}.cavum"
    text = ledger.openings[name]
    shutil.copy(file, s.p("kept"))
    erase(s, "--motion", "--results")
    shutil.copy(s.p("kept"), file)
    s.must(s.ledger("verify").rc != 0, "the recording came back unseen")
    os.remove(file)
    return edited(s, lambda ledger: ledger.openings.update({name: text}))


@attack("five", FOUND, "an entry says what was erased, and what is gone without one is a finding", "entry_malformed")
def erased_only_on_paper(s):
    """With the school's key: an entry `erase` whose result stays; of an entry that is not there; of a ticket; of something unknown."""
    last = None
    for erased in ([{"entry": 14, "what": "result"}], [{"entry": 99, "what": "result"}], [{"entry": 9, "what": "result"}], [{"entry": 14, "what": "everything"}], [{"entry": -1, "what": "motion"}], [{"entry": 18, "what": "motion"}], "14"):
        ledger = lf.Ledger(s.L)
        saved = [list(r) for r in ledger.entries], [list(n) for n in ledger.notes]
        ledger.add("erase", {"erased": erased, "reason": "x"})
        ledger.resign(s.school_key(), 19)
        ledger.store()
        last = s.ledger("verify")
        s.must(last.rc != 0, f"taken: {erased}")
        ledger.entries, ledger.notes = saved
        ledger.store()
    return last


@attack("five", FOUND, "what was erased without results is marked no more", "submitted_twice")
def erased_is_released_no_more(s):
    """An erased result must not come back by regrade, release or export; a second filing of the same recording is refused."""
    shutil.copy(f"{s.L}/sessions/{lf.Ledger(s.L).body(14)['file_sha256']}.cavum", s.p("kept.cavum"))
    erase(s, "--motion", "--results")
    s.ledger("export", "--format", "moodle", "--out", s.p("g.csv"))
    s.must("14.1" not in open(s.p("g.csv")).read(), "the erased points are in the gradebook")
    s.must(s.ledger("regrade", "--session", "14", "--scenario", s.p("corrected.toml"), "--reason", "x").rc != 0, "an erased motion is marked anew")
    return s.add("kept.cavum")


@attack("five", ACCEPTED, "`forget`: identity and recordings, under every pseudonym")
def control_forgotten(s):
    """Dora is forgotten with her results: no name, number, salt or recording of hers is left in the ledger's folder."""
    ledger = lf.Ledger(s.L)
    salt = json.loads(ledger.openings[ledger.body(14)["opens"]["result"]])["salt"].encode()
    file = ledger.body(14)["file_sha256"]
    s.must(s.ledger("forget", "--candidate", "4714").rc == 0, "not forgotten")
    for needle in (b"Dora Dirks", b"4714", salt):
        s.must(not traces(s, needle, ("L",)), f"{needle[:12]!r} is still in {traces(s, needle, ('L',))}")
    s.must(not os.path.exists(f"{s.L}/sessions/{file}.cavum"), "the recording is still there")
    s.must(s.ledger("verify").rc == 0, "verify refuses it")
    return s.ledger("backup", "--out", s.p("backup"), "--with-identities")


@attack("five", ACCEPTED, "a backup that is brought up to date forgets it, too")
def control_backup_forgets(s):
    """After `forget` and another `backup` into the same folder nothing of Dora is left in the backup."""
    ledger = lf.Ledger(s.L)
    salt = json.loads(ledger.openings[ledger.body(14)["opens"]["result"]])["salt"].encode()
    file = ledger.body(14)["file_sha256"]
    s.ledger("forget", "--candidate", "4714")
    s.ledger("backup", "--out", s.p("backup"), "--with-identities")
    for needle in (b"Dora Dirks", salt):
        s.must(not traces(s, needle, ("backup",)), f"{needle[:12]!r} is still in the backup's {traces(s, needle, ('backup',))}")
    s.must(not os.path.exists(s.p(f"backup/sessions/{file}.cavum")), "the recording is still in the backup")
    return s.run("ledger", "verify", s.p("backup"))


@attack("five", FOUND, "the accommodations are not those that the ticket grants", "ticket_invalid")
def grant_edited(s):
    """The grant beside the ticket gives extra time: its hash is not the signed one; the ticket's hash edited, too; the grant taken out; with another salt; Ben's."""
    last = None
    for kind in range(6):
        def change(r):
            t = json.loads(r.facts["note.ticket"])
            more = lf.opening({"accommodation.extra_time_percent": "100"})
            if kind == 0:
                t["grant"] = more
            elif kind == 1:
                t["grant"], t["ticket"]["grant_sha256"] = more, sha(more.encode()).hex()
            elif kind == 2:
                del t["grant"]
            elif kind == 3:
                t["grant"] = lf.opening({})
            elif kind == 4:
                t["grant"] = json.loads(s.session("ben.cavum").facts["note.ticket"])["grant"]
            else:
                t["grant"] = json.loads(t["grant"])
            r.facts["note.ticket"] = lf.json_text(t)
        last = insider(s, change)
        s.must(last.rc != 0, f"grant of kind {kind} is taken")
    return last


@attack("five", FOUND, "each row is sealed", "identities_changed")
def identity_row_made_up(s):
    """The seal of a row is another's, or is empty."""
    rows = __import__("school").identities(s)
    a, b = rows[0], rows[3]
    sql(s, ("UPDATE identity SET id = 'gone' WHERE pseudonym = ?", (b["pseudonym"],)), ("UPDATE identity SET id = ?, name = ?, seal = ? WHERE pseudonym = ?", (b["id"], b["name"], b["seal"], a["pseudonym"])), file="identities.db")
    s.must(s.ledger("verify").rc != 0, "another row's seal is taken")
    sql(s, ("UPDATE identity SET id = ?, name = ?, seal = x'', exam = '' WHERE pseudonym = ?", (b["id"], b["name"], a["pseudonym"])), file="identities.db")
    s.must(s.ledger("export", "--format", "moodle", "--out", s.p("g.csv")).rc != 0, "`export` goes on")
    return s.ledger("verify")
