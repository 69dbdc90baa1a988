"""The ledger's files, written from the page docs/formats/ledger.md: entries, tree, notes, witness, receipts, requests, tickets, cosignatures."""
import base64
import hashlib
import hmac
import json
import os
import sqlite3
import struct
import time

from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.kdf.hkdf import HKDF

from session_format import Key, sha

CROCKFORD = "0123456789ABCDEFGHJKMNPQRSTVWXYZ"


def json_text(value):
    """JSON as the ledger writes it: keys in the order of their bytes, no spaces, UTF-8 as it is."""
    return json.dumps(value, ensure_ascii=False, sort_keys=True, separators=(",", ":"))


def b64(data):
    return base64.b64encode(data).decode()


# --- the tree -------------------------------------------------------------------------------------------------------

def leaf(entry_text):
    return sha(b"\0", entry_text.encode())


def split(n):
    return 1 << (n - 1).bit_length() - 1


def root(leaves):
    if not leaves:
        return sha()
    if len(leaves) == 1:
        return leaves[0]
    k = split(len(leaves))
    return sha(b"\1", root(leaves[:k]), root(leaves[k:]))


def inclusion(m, leaves):
    if len(leaves) == 1:
        return []
    k = split(len(leaves))
    if m < k:
        return inclusion(m, leaves[:k]) + [root(leaves[k:])]
    return inclusion(m - k, leaves[k:]) + [root(leaves[:k])]


def consistency(m, leaves, whole=True):
    n = len(leaves)
    if m == n:
        return [] if whole else [root(leaves)]
    k = split(n)
    if m <= k:
        return consistency(m, leaves[:k], whole) + [root(leaves[k:])]
    return consistency(m - k, leaves[k:], False) + [root(leaves[:k])]


# --- notes ----------------------------------------------------------------------------------------------------------

def key_id(name, kind, public):
    return sha(name.encode(), b"\n", bytes([kind]), public)[:4]


def note_text(ledger, size, tree, utc_ns):
    return f"cavum.ledger/{ledger}\n{size}\n{b64(tree)}\nutc_ns {utc_ns}\n"


def school_line(ledger, text, school):
    name = "cavum.ledger/" + ledger
    return f"\u2014 {name} {b64(key_id(name, 1, school.public) + school.sign(text.encode()))}\n"


def note(ledger, size, tree, utc_ns, school):
    text = note_text(ledger, size, tree, utc_ns)
    return text + "\n" + school_line(ledger, text, school)


def cosigner_line(text, name, key, seconds=None):
    seconds = int(time.time()) if seconds is None else seconds
    signed = key.sign(f"cosignature/v1\ntime {seconds}\n{text}".encode())
    return f"\u2014 {name} {b64(key_id(name, 4, key.public) + struct.pack('>Q', seconds) + signed)}\n"


def key_line(name, kind, public):
    return f"{name}+{key_id(name, kind, public).hex()}+{b64(bytes([kind]) + public)}"


def cosign_request(old, proof, the_note):
    return f"old {old}\n" + "".join(b64(h) + "\n" for h in proof) + "\n" + the_note


def witness_line(size, tree, utc_ns, the_note):
    signature = base64.b64decode(the_note.rstrip("\n").rsplit(" ", 1)[1])[4:]
    return f"{size} {tree.hex()} {utc_ns} {b64(signature)}\n"


# --- what stations and the school exchange --------------------------------------------------------------------------

def code_key(code):
    digits = code.removeprefix("S-").replace("-", "")
    return Key(sha(b"CVCODE_1", digits.encode()))


def station_request(school_hex, key, by, devices=(), made=None, replaces=False, **changes):
    request = {"format": "cavum station request 1", "school": school_hex, "public_key": key.hex, "by": by.hex,
               "made_utc_ns": made or time.time_ns(), "devices": list(devices)}
    request.update(changes)
    message = b"CVENROL1" + json_text(request).encode()
    return {"request": request, "signature": key.sign(message).hex(), ("old_signature" if replaces else "code_signature"): by.sign(message).hex()}


def opening(value, salt=None):
    """The text of an opening: what an entry or a ticket names by its hash."""
    return json_text({"salt": (salt or os.urandom(16)).hex(), "value": value})


def signed_ticket(ticket, school, grant=None):
    """A ticket's JSON text; `school` is whoever signs it; `grant` the accommodations, an opening beside it."""
    beside = opening(grant or {})
    ticket = dict(ticket, grant_sha256=sha(beside.encode()).hex())
    return json_text({"grant": beside, "signature": school.sign(b"CVTICKET" + json_text(ticket).encode()).hex(), "ticket": ticket})


def ticket_entry(text):
    """What the ledger enters of a ticket: all but the accommodations."""
    whole = json.loads(text)
    return {"signature": whole["signature"], "ticket": whole["ticket"]}


def begin_word(ledger, ticket_nonce, school, utc_ns=None, **changes):
    """The ledger's word to begin."""
    begin = {"format": "cavum begin 1", "ledger": ledger, "nonce": os.urandom(16).hex(), "public_key": school.hex, "ticket": ticket_nonce, "utc_ns": utc_ns or time.time_ns()}
    begin.update(changes)
    return {"begin": begin, "signature": school.sign(b"CVLETBEG" + json_text(begin).encode()).hex()}


def key_entry(ledger, old, new, until_utc_ns=0, signed_by=None):
    """The body of an entry `key`."""
    message = json_text({"ledger": ledger, "previous": old.hex, "public_key": new.hex, "until_utc_ns": until_utc_ns})
    return {"public_key": new.hex, "reason": "test", "signature": (signed_by or old).sign(b"CVKEYNEW" + message.encode()).hex(), "until_utc_ns": until_utc_ns}


def identity_seal(school_seed, pseudonym, exam, number, name):
    """The seal of a row of identities.db."""
    secret = HKDF(algorithm=hashes.SHA256(), length=32, salt=None, info=b"cavum identities").derive(school_seed)
    return hmac.new(secret, json_text([pseudonym, exam, number, name]).encode(), hashlib.sha256).digest()


def signed_results(results, school):
    """One line of JSON text, signed as `export --format json` is; `results` is without its signature."""
    body = json_text(results)
    return body[:-1] + ',"signature":"' + school.sign(b"CVRESULT" + body.encode()).hex() + '"}\n'


# --- ledger.db ------------------------------------------------------------------------------------------------------

class Ledger:
    """A ledger's entries and notes, read with SQLite alone; `store` writes them back, past the triggers."""

    def __init__(self, folder):
        self.path = f"{folder}/ledger.db"
        db = sqlite3.connect(self.path)
        self.entries = [list(r) for r in db.execute("SELECT seq, text, leaf_sha256 FROM entry ORDER BY seq")]
        self.notes = [list(r) for r in db.execute("SELECT size, text FROM note ORDER BY size")]
        self.documents = [list(r) for r in db.execute("SELECT sha256, bytes FROM document")]
        self.cosignatures = [list(r) for r in db.execute("SELECT size, line FROM cosignature")]
        self.version = db.execute("PRAGMA user_version").fetchone()[0]
        self.openings = dict(db.execute("SELECT sha256, text FROM opening").fetchall())
        db.close()
        self.id = self.body(0)["ledger"]

    def entry(self, seq):
        return json.loads(self.entries[seq][1])

    def body(self, seq):
        return self.entry(seq)["body"]

    def find(self, kind, nth=0):
        return [r[0] for r in self.entries if json.loads(r[1])["kind"] == kind][nth]

    def leaves(self):
        return [leaf(r[1]) for r in self.entries]

    def set_body(self, seq, body):
        e = self.entry(seq)
        e["body"] = body
        self.entries[seq][1] = json_text(e)

    def result(self, seq, name="result"):
        """The result of an entry."""
        return json.loads(self.openings[self.body(seq)["opens"][name]])["value"]

    def set_result(self, seq, result, entry_too):
        """Puts another result in its place; with `entry_too` the entry names the new hash."""
        body = self.body(seq)
        text = opening(result)
        old = body["opens"]["result"]
        if entry_too:
            del self.openings[old]
            body["opens"]["result"] = sha(text.encode()).hex()
            self.openings[body["opens"]["result"]] = text
            self.set_body(seq, body)
        else:
            self.openings[old] = text

    def add(self, kind, body, utc_ns=None):
        seq = len(self.entries)
        body_text = json_text({"body": body, "kind": kind, "seq": seq, "utc_ns": utc_ns or time.time_ns()})
        self.entries.append([seq, body_text, b""])

    def renumber(self):
        for i, r in enumerate(self.entries):
            e = json.loads(r[1])
            e["seq"] = i
            r[0], r[1] = i, json_text(e)

    def resign(self, school, from_size=1):
        """Leaves anew, and the notes from this size on signed by `school`."""
        for r in self.entries:
            r[2] = leaf(r[1])
        leaves = self.leaves()
        self.notes = [n for n in self.notes if n[0] < from_size]
        for size in range(from_size, len(leaves) + 1):
            at = int(self.entries[size - 1][1].rsplit(":", 1)[1].rstrip("}"))
            self.notes.append([size, note(self.id, size, root(leaves[:size]), at, school)])

    def store(self):
        db = sqlite3.connect(self.path)
        triggers = db.execute("SELECT name, sql FROM sqlite_master WHERE type = 'trigger'").fetchall()
        for name, _ in triggers:
            db.execute(f"DROP TRIGGER {name}")
        tables = [("entry", self.entries), ("note", self.notes), ("document", self.documents), ("cosignature", self.cosignatures),
                  ("opening", [list(o) for o in self.openings.items()])]
        for table, rows in tables:
            db.execute(f"DELETE FROM {table}")
            for r in rows:
                db.execute(f"INSERT INTO {table} VALUES ({','.join('?' * len(r))})", r)
        for _, sql in triggers:
            db.execute(sql)
        db.commit()
        db.close()

    def witness(self):
        lines = []
        for size, text in self.notes:
            head = text.split("\n")
            lines.append(witness_line(size, base64.b64decode(head[2]), int(head[3][7:]), text))
        return "".join(lines)

    def receipt(self, seq, from_size=None):
        leaves = self.leaves()
        r = {"ledger": self.id, "public_key": self.body(0)["public_key"], "entry": self.entries[seq][1], "seq": seq,
             "inclusion": [h.hex() for h in inclusion(seq, leaves)], "checkpoint": self.notes[-1][1]}
        if from_size:
            r["consistency"] = {"from": self.notes[from_size - 1][1], "proof": [h.hex() for h in consistency(from_size, leaves)]}
        return r


def worked_example():
    """The page's own example; true when this module gives its bytes."""
    school, cosigner = Key(bytes(range(32))), Key(bytes(range(32, 64)))
    ledger = "00112233445566778899aabbccddeeff"
    first = json_text({"kind": "init", "seq": 0, "utc_ns": 1795426309851141386,
                       "body": {"ledger": ledger, "school": "School of Dentistry", "public_key": school.hex}})
    second = json_text({"kind": "forget", "seq": 1, "utc_ns": 1795426310579526174, "body": {"candidate": "C-BJJF-E2PD-TP2J"}})
    tree = root([leaf(first), leaf(second)])
    made = note(ledger, 2, tree, 1795426310579526174, school)
    line = cosigner_line(made.split("\n\n")[0] + "\n", "cosigner.example/one", cosigner, 1795426400)
    return (tree.hex() == "2beda5e108f20060f21f0c359957819034535e8af802a4e087d473a512a521c5" and
            made.endswith("mwYXn1BevOqtRPOT7y7pShSHESKQBmnZFj9fDrGJL1G0S8ELcbJfjPO60D4zCs1GETQ3ZtKAfs/KzH5l0G5pw5H/qw8=\n") and
            line.endswith("VOz1lgAAAABrBAhgN0gjWJVxxM0K1a43D99r64FY84Qs+5ob6KuNeE2PhZdbzmf5TVmCaTIRpWRzAE8chci0JWWGqXci7/5ZW8uMAg==\n") and
            key_line("cosigner.example/one", 4, cosigner.public) == "cosigner.example/one+54ecf596+BCmsuuFBvMrwsi4alNNNC8c2HlJtC/4SyJeUvJMilm3X")
