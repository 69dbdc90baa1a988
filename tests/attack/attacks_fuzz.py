"""Random changes, with hashes and signatures made anew where there are any: nothing may crash, hang or eat memory."""
import json
import os
import random
import struct

import zstandard

import ledger_format as lf
from kinds import SURVIVES, attack
from session_format import pack, unpack

ROUNDS = int(os.environ.get("ATTACK_ROUNDS", "4"))
SEED = int(os.environ.get("ATTACK_SEED", "1"))
SPECIAL = [0, 1, 127, 128, 255, 254]


def spoil(data, dice, hits=None):
    """A few bytes exchanged, cut out or doubled."""
    data = bytearray(data)
    for _ in range(hits or dice.choice([1, 1, 2, 8, 64])):
        if not data:
            break
        at, kind = dice.randrange(len(data)), dice.randrange(6)
        if kind < 3:
            data[at] = dice.choice(SPECIAL + [dice.randrange(256)])
        elif kind == 3:
            del data[at:at + dice.choice([1, 2, 8, 100])]
        elif kind == 4:
            data[at:at] = data[at:at + dice.choice([1, 8, 100])]
        else:
            data[at:at + 4] = struct.pack("<I", dice.choice([0, 2**31 - 1, 2**31, 2**32 - 1, 2**16]))
    return bytes(data)


def spoil_text(text, dice):
    return spoil(text.encode(), dice).decode("utf-8", "replace").replace("\0", "0")


def signed(s, r):
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    s.run("verify", s.p("m.cavum"))
    return s.run("replay", "--verify", s.p("m.cavum"))


@attack("fuzz", SURVIVES)
def fuzz_chunks(s):
    """Motion, records and removed leaves spoiled before they are packed, signed anew."""
    dice, last = random.Random(SEED), None
    for _ in range(ROUNDS):
        r = s.session("anna.cavum")
        c = dice.choice(r.chunks)
        name = dice.choice(["inputs", "records", "removed", "inputs"])
        raw = unpack(c[name])
        changed = spoil(raw, dice)
        if name != "removed" and dice.random() < 0.8:
            changed = (changed + bytes(len(raw)))[:len(raw)]
        c[name] = pack(changed)
        last = signed(s, r)
    return last


@attack("fuzz", SURVIVES)
def fuzz_artifacts(s):
    """Scenario, burs, model, servo and teeth spoiled, signed anew; the teeth also inside their packing."""
    dice, last = random.Random(SEED + 1), None
    for _ in range(ROUNDS):
        r = s.session("anna.cavum")
        a = dice.choice(r.artifacts)
        data = a[1]
        if a[0].endswith(".cvt"):
            at = data.find(b"\x28\xb5\x2f\xfd")
            if at > 0 and dice.random() < 0.8:
                raw = zstandard.ZstdDecompressor().decompress(data[at:], max_output_size=1 << 26)
                raw = spoil(raw, dice)
                packed = pack(raw)
                head = bytearray(data[:at])
                if at == 24:
                    head[8:16], head[16:24] = struct.pack("<Q", len(raw)), struct.pack("<Q", len(packed))
                data = bytes(head) + packed
            else:
                data = spoil(data, dice)
        else:
            data = spoil_text(data.decode(), dice).encode()
        a[1] = data
        last = signed(s, r)
        s.run("grade", s.p("m.cavum"))
    return last


@attack("fuzz", SURVIVES)
def fuzz_texts(s):
    """Facts, events and the result spoiled, signed anew, and handed in."""
    dice, last = random.Random(SEED + 2), None
    for _ in range(ROUNDS):
        r = s.session("anna.cavum")
        kind = dice.randrange(3)
        if kind == 0:
            key = dice.choice(sorted(r.facts))
            r.facts[key] = spoil_text(r.facts[key], dice)
        elif kind == 1:
            e = dice.choice(r.events)
            e["detail_json"] = spoil_text(e["detail_json"], dice)
            e["tick"] = dice.choice([0, -1, 2**62, 5])
        else:
            r.result = spoil_text(r.result, dice)
        try:
            s.write(r.rebuild(s.station(), s.station()), "m.cavum")
        except Exception:  # no text that SQLite takes
            continue
        last = s.add("m.cavum", "--with-findings")
        s.run("grade", s.p("m.cavum"))
    return last


@attack("fuzz", SURVIVES)
def fuzz_recording_pages(s):
    """Bytes of the recording's file itself."""
    dice, last = random.Random(SEED + 3), None
    good = open(s.p("anna.cavum"), "rb").read()
    for _ in range(ROUNDS * 2):
        data = bytearray(good)
        for _ in range(dice.choice([1, 3, 20])):
            at = dice.choice([dice.randrange(len(data)), dice.randrange(2048), dice.randrange(len(data) // 1024) * 1024 + dice.randrange(12)])
            data[at] = dice.randrange(256)
        s.text("m.cavum", bytes(data), "wb")
        last = s.run("verify", s.p("m.cavum"))
    return last


@attack("fuzz", SURVIVES)
def fuzz_ledger_pages(s):
    """Bytes of ledger.db and identities.db themselves."""
    dice, last = random.Random(SEED + 4), None
    for name in ("ledger.db", "identities.db"):
        path = f"{s.L}/{name}"
        for extra in ("-wal", "-shm"):
            if os.path.exists(path + extra):
                os.remove(path + extra)
        good = open(path, "rb").read()
        for _ in range(ROUNDS * 2):
            data = bytearray(good)
            for _ in range(dice.choice([1, 3, 20])):
                data[dice.choice([dice.randrange(len(data)), dice.randrange(200), dice.randrange(len(data) // 4096) * 4096 + dice.randrange(12)])] = dice.randrange(256)
            open(path, "wb").write(data)
            last = s.ledger("verify")
            s.ledger("show")
            for extra in ("-wal", "-shm"):
                if os.path.exists(path + extra):
                    os.remove(path + extra)
        open(path, "wb").write(good)
    return last


@attack("fuzz", SURVIVES)
def fuzz_entries(s):
    """Entries' bodies and results spoiled, leaves and notes made anew with the school's key."""
    dice, last = random.Random(SEED + 5), None
    os.remove(s.witness_path())
    kept = lf.Ledger(s.L)
    for _ in range(ROUNDS * 2):
        ledger = lf.Ledger(s.L)
        r = dice.choice(ledger.entries)
        if dice.random() < 0.3:
            seq = ledger.find("session")
            body = ledger.body(seq)
            text = spoil_text(ledger.openings.pop(body["opens"]["result"]), dice)
            body["opens"]["result"] = lf.sha(text.encode()).hex()
            ledger.openings[body["opens"]["result"]] = text
            ledger.set_body(seq, body)
        else:
            head, tail = r[1].rsplit(',"kind":', 1)
            r[1] = spoil_text(head, dice) + ',"kind":' + tail
        ledger.resign(s.school_key())
        ledger.store()
        last = s.ledger("verify")
        s.ledger("show")
        s.ledger("export", "--format", dice.choice(["csv", "moodle", "lti", "json"]), "--out", s.p("o"), "--overwrite")
        ledger.entries, ledger.notes, ledger.openings = [list(r) for r in kept.entries], [list(n) for n in kept.notes], dict(kept.openings)
        ledger.store()
    return last


@attack("fuzz", SURVIVES)
def fuzz_files(s):
    """Receipts, notes, requests, results, tickets, key lines and witness spoiled."""
    dice, last = random.Random(SEED + 6), None
    texts = {n: open(s.p(n), "rb").read() for n in ("receipts/receipt-14.json", "cosigned", "to-sign", "results.json", "finn.ticket", "seat1.request", "home/cosigners", "class.csv", "quick.toml")}
    for i in range(ROUNDS):
        for name, args in (("receipts/receipt-14.json", ("ledger", "verify", s.L, "--receipt")), ("cosigned", ("ledger", "verify", s.L, "--cosigned")), ("results.json", ("ledger", "verify", s.L, "--results")),
                           ("seat1.request", ("ledger", "station", s.L, "--enrol")), ("to-sign", ("ledger", "cosign", "--out", s.p(f"c{i}"))), ("quick.toml", ("scenario", "check", "--no-trial"))):
            s.text("f", spoil(texts[name], dice), "wb")
            last = s.run(*args, s.p("f"), home=s.p("cosigner") if "cosign" in args else None)
        s.text("home/cosigners", spoil(texts["home/cosigners"], dice), "wb")
        last = s.ledger("verify")
    s.text("home/cosigners", texts["home/cosigners"], "wb")
    return last
