"""What a cosigner is asked to sign, what it remembers, and what comes back."""
import base64
import os

import ledger_format as lf
from kinds import ACCEPTED, FOUND, NOBODY, SURVIVES, UNSTATED, attack
from session_format import Key, sha

SIGNS = "it signs when the school's signature holds, old is the size that it signed last, the size is not smaller, and the proof leads from the root that it knows"


def cosign(s, text, *options, home="cosigner"):
    path = s.text("ask", text)
    if os.path.exists(s.p("answer")):
        os.remove(s.p("answer"))
    return s.run("ledger", "cosign", path, "--out", s.p("answer"), *options, home=s.p(home))


def longer(s, n=2):
    for i in range(n):
        s.needs("ledger", "station", s.L, "--invite", f"More {i}")
    return lf.Ledger(s.L)


def request(ledger, old, key=None, **changes):
    leaves = ledger.leaves()
    text = lf.cosign_request(old, lf.consistency(old, leaves) if old else [], ledger.notes[-1][1])
    return text


@attack("cosign", ACCEPTED, "a request of our own making is signed, and the answer holds")
def control_cosigned(s):
    """A request by the page, the same as the program's own; the cosigner signs; the answer is taken and verified."""
    ledger = longer(s)
    s.needs("ledger", "checkpoint", s.L, "--since", "18", "--out", s.p("theirs"))
    s.must(open(s.p("theirs")).read() == request(ledger, 18), "our request is another")
    s.must(cosign(s, request(ledger, 18), "--name", "cosigner.example/one").rc == 0, "it is not signed")
    s.must(s.ledger("add-cosignature", s.p("answer")).rc == 0, "the answer is not taken")
    return s.ledger("verify", "--cosigned", s.p("answer"))


@attack("cosign", FOUND, SIGNS, "rewritten")
def fork(s):
    """Another history of the same ledger, signed by the school: same size, larger, larger with a made-up proof."""
    ledger = lf.Ledger(s.L)
    ledger.set_body(9, dict(ledger.body(9), reason="other"))
    ledger.resign(s.school_key())
    s.must(cosign(s, request(ledger, 18)).rc != 0, "a fork of the same size is signed")
    s.must(cosign(s, request(ledger, 0)).rc != 0, "a fork that says it is the first time is signed")
    ledger.add("forget", {"candidate": "C-0000-0000-0000"})
    ledger.resign(s.school_key())
    s.must(cosign(s, lf.cosign_request(18, [], ledger.notes[-1][1])).rc != 0, "no proof is taken")
    s.must(cosign(s, lf.cosign_request(18, [sha(b"x")] * 3, ledger.notes[-1][1])).rc != 0, "any proof is taken")
    return cosign(s, request(ledger, 18))


@attack("cosign", FOUND, SIGNS, "rewritten")
def smaller_or_another_old(s):
    """A smaller size; old that is not the last one; the same size with a proof."""
    ledger = longer(s)
    good = ledger.notes[-1][1]
    s.must(cosign(s, lf.cosign_request(18, [], ledger.notes[15][1])).rc != 0, "a smaller size is signed")
    for old in (0, 17, 19, 20, 2**64 + 18, -1, "018", "18 ", "+18", "1e1"):
        s.must(cosign(s, lf.cosign_request(old, lf.consistency(17, ledger.leaves()), good)).rc != 0, f"old {old} is signed")
    return cosign(s, lf.cosign_request(18, lf.consistency(18, ledger.leaves()) + [sha(b"x")], good))


@attack("cosign", FOUND, SIGNS, "signature_invalid")
def of_another_school(s):
    """The note signed by a stranger under the same origin; with a second, good line of the school below another text."""
    ledger = longer(s)
    tree, at = lf.root(ledger.leaves()), 1900000000 * 10**9
    made = lf.note(ledger.id, 20, tree, at, s.station("stranger"))
    s.must(cosign(s, lf.cosign_request(18, lf.consistency(18, ledger.leaves()), made)).rc != 0, "a stranger's note is signed")
    both = lf.note_text(ledger.id, 20, sha(b"x"), at) + "\n" + ledger.notes[-1][1].split("\n\n")[1]
    return cosign(s, lf.cosign_request(18, [], both))


@attack("cosign", FOUND, "the school's key of a ledger that it does not remember is told by a person, never by the file", "error")
def unknown_ledger(s):
    """A ledger that the cosigner never saw, without --school-key."""
    made = lf.note("ab" * 16, 1, sha(b"x"), 10**18, s.station("stranger"))
    return cosign(s, lf.cosign_request(0, [], made))


@attack("cosign", UNSTATED, "format 5: when the school replaced its key, a person tells it the new one; before: one key for ever")
def told_another_key(s):
    """A stranger's note that goes on from what was cosigned, and the cosigner is told the stranger's key by --school-key."""
    ledger = longer(s)
    return cosign(s, lf.cosign_request(18, lf.consistency(18, ledger.leaves()), lf.note(ledger.id, 20, lf.root(ledger.leaves()), 10**18, s.station("stranger"))),
                  "--school-key", s.station("stranger").hex)


@attack("cosign", FOUND, "the origin is cavum.ledger/ID, the memory is cosigned/ID", "error")
def origin_leads_out(s):
    """The ledger's id is a path: ../../planted, an absolute one, nothing, a dot, with a zero byte, of 5000 characters."""
    last = None
    key = s.station("stranger")
    for name in ("../../planted", "/tmp/../" + s.p("planted").lstrip("/"), "..", ".", "", "a/b", "x\0y", "A" * 5000, "AB" * 16, "../cosigner.key"):
        last = cosign(s, lf.cosign_request(0, [], lf.note(name, 1, sha(b"x"), 10**18, key)), "--school-key", key.hex)
        s.must(last.rc != 0, f"the id {name[:40]!r} is signed")
        s.must(not os.path.exists(s.p("planted")), "a file outside the memory was written")
    s.must(Key.read(s.p("cosigner/cosigner.key")), "the cosigner's key is gone")
    return last


@attack("cosign", FOUND, "what was changed in the memory is found", "error")
def memory_changed(s):
    """The memory's note is of a smaller size, unsigned; names another key; is empty, rubbish, a pipe."""
    ledger = longer(s)
    path = s.p("cosigner/cosigned/" + ledger.id)
    good = open(path).read()
    line, the_note = good.split("\n", 1)
    last = None
    for what, text in (("unsigned", good.replace("\n18\n", "\n17\n")), ("another key", lf.key_line("cavum.ledger/" + ledger.id, 1, s.station("stranger").public) + "\n" + the_note),
                       ("empty", ""), ("rubbish", "x" * 1000), ("cut", good[:200]), ("only the key", line + "\n")):
        s.text("cosigner/cosigned/" + ledger.id, text)
        for old in (17, 18, 0):
            last = cosign(s, request(ledger, old))
            if not (what == "empty" and old == 0):
                s.must(last.rc != 0, f"memory {what}: old {old} is signed")
    os.remove(path)
    os.mkfifo(path)
    return cosign(s, request(ledger, 18))


@attack("cosign", NOBODY, "puts a cosigner's memory back: the cosigner only by his backups")
def memory_put_back(s):
    """The memory of a smaller size, with its own sound note, then a fork from there on."""
    ledger = lf.Ledger(s.L)
    path = s.p("cosigner/cosigned/" + ledger.id)
    line = open(path).read().split("\n", 1)[0]
    s.text("cosigner/cosigned/" + ledger.id, line + "\n" + ledger.notes[13][1])
    ledger.entries, ledger.notes = ledger.entries[:14], ledger.notes[:14]
    ledger.add("forget", {"candidate": "C-0000-0000-0000"})
    ledger.resign(s.school_key(), 15)
    return cosign(s, request(ledger, 14))


@attack("cosign", SURVIVES, "requests to a cosigner are input")
def requests_hostile_to_cosigner(s):
    """A million proof hashes, 64 of them, base64 that is not canonical, CRLF, sizes of 10^30 and 018, a note without end, a pipe, nothing."""
    ledger = longer(s)
    good = request(ledger, 18)
    the_note = ledger.notes[-1][1]
    proof = lf.consistency(18, ledger.leaves())
    last = None
    for text in (lf.cosign_request(18, proof + [sha(b"x")] * 10**6, the_note), lf.cosign_request(18, [sha(b"x")] * 64, the_note), good.replace("\n", "\r\n"), good.replace("\n20\n", "\n" + "9" * 30 + "\n"),
                 good.replace("\n20\n", "\n020\n"), good.replace("=\n", "\n"), good[:-1], good + "\u2014 x " + lf.b64(b"1234") + "x\n", good * 2, "", "old 18\n\n\n\n", "\ufeff" + good,
                 good.replace("\u2014", "-"), good.replace("\u2014", "\u2013"), good.replace("\u2014 ", "\u2014  ")):
        last = cosign(s, text)
        s.must(last.rc != 0, f"signed: {text[:60]!r} ({len(text)})")
    os.mkfifo(s.p("pipe"))
    return s.run("ledger", "cosign", s.p("pipe"), "--out", s.p("answer2"), home=s.p("cosigner"))


@attack("cosign", FOUND, "lines of a known one must hold; others are not checked", "older_copy", "30")
def answers_forged(s):
    """What comes back: signed by nobody, by a stranger under the cosigner's name, for another text, with a time of another."""
    cosigner = Key.read(s.p("cosigner/cosigner.key"))
    ledger = lf.Ledger(s.L)
    the_note = ledger.notes[-1][1]
    text = the_note.split("\n\n")[0] + "\n"
    name = "cosigner.example/one"
    line = lf.cosigner_line(text, name, cosigner)
    blob = bytearray(base64.b64decode(line.split(" ")[2]))
    blob[11] ^= 1
    raw = base64.b64decode(lf.cosigner_line(text, name, s.station("stranger")).split(" ")[2])[4:]
    last = None
    for what, answer in (("another time", the_note + f"\u2014 {name} {lf.b64(bytes(blob))}\n"), ("a stranger's signature", the_note + f"\u2014 {name} {lf.b64(lf.key_id(name, 4, cosigner.public) + raw)}\n"),
                         ("another text", lf.note_text(ledger.id, 18, sha(b"x"), 1) + "\n" + the_note.split("\n\n")[1] + line), ("no signature of the school", text + "\n" + line),
                         ("of a later ledger", lf.note(ledger.id, 30, sha(b"x"), 10**18, s.school_key()) + lf.cosigner_line(lf.note_text(ledger.id, 30, sha(b"x"), 10**18), name, cosigner))):
        s.text("answer", answer)
        s.must(s.ledger("add-cosignature", s.p("answer")).rc != 0, what + ": kept")
        last = s.ledger("verify", "--cosigned", s.p("answer"))
        s.must(last.rc != 0, what + ": verified")
    return last


@attack("cosign", SURVIVES, "cosigners: a key line on each line")
def key_lines_hostile(s):
    """$CAVUM_HOME/cosigners: names with Unicode's spaces, plus signs, keys of small order, of 31 bytes, a pipe, 40 MB."""
    last = None
    key = Key.read(s.p("cosigner/cosigner.key")).public
    good = lf.key_line("cosigner.example/one", 4, key)
    for text in (good.replace("one", "o\u3000ne"), good.replace("one", "o+ne"), good.replace("+", "++"), good[:-4], good.replace("one", "\u001b[2Jone"), "x" * 300 + good, good + "\n" + good,
                 lf.key_line("small", 4, b"\1" + bytes(31)), lf.key_line("short", 4, key[:31]), "+" * 20_000_000, "#" * 1000 + "\n\n" + good + "\r\n"):
        s.text("home/cosigners", text + "\n")
        last = s.ledger("verify")
    os.remove(f"{s.home}/cosigners")
    os.mkfifo(f"{s.home}/cosigners")
    return s.ledger("verify")
