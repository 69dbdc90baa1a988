"""Recordings as hostile files: logs, links, pipes, bombs, numbers out of range, deep texts, flipped bits."""
import os
import random
import shutil
import sqlite3
import threading

import zstandard

from kinds import ACCEPTED, FOUND, SURVIVES, attack
from session_format import pack, unpack, varint


def all_verbs(s, name):
    last = None
    for args in (("verify",), ("replay", "--verify"), ("grade",), ("explain",), ("ledger", "add", s.L)):
        last = s.run(*args, s.p(name))
        s.must(last.rc != 0 or args[0] in ("explain",), f"`{args[0]}` ends with 0")
    return last


@attack("file", FOUND, "leaves or plants a log beside the file: one image of both is read, checked, kept and hashed", "recording_unsound")
def log_planted(s):
    """A write-ahead log beside the recording in which the result says pass."""
    db = sqlite3.connect(s.p("anna.cavum"))
    db.execute("PRAGMA journal_mode=WAL")
    db.execute("PRAGMA wal_autocheckpoint=0")
    db.execute("""UPDATE result SET json = replace(json, '"verdict":"fail"', '"verdict":"pass"')""")
    db.commit()
    shutil.copy(s.p("anna.cavum"), s.p("m.cavum"))
    shutil.copy(s.p("anna.cavum-wal"), s.p("m.cavum-wal"))
    db.close()
    s.must(s.run("verify", s.p("m.cavum")).rc != 0, "verify does not see the log")
    return s.add("m.cavum")


@attack("file", ACCEPTED, "one image of both is read, checked, kept and hashed")
def log_of_nothing_planted(s):
    """A log that changes nothing: what is kept must be one file that verifies without it."""
    db = sqlite3.connect(s.p("anna.cavum"))
    db.execute("PRAGMA journal_mode=WAL")
    db.execute("PRAGMA wal_autocheckpoint=0")
    db.execute("UPDATE result SET json = json || ''")
    db.commit()
    shutil.copy(s.p("anna.cavum"), s.p("m.cavum"))
    shutil.copy(s.p("anna.cavum-wal"), s.p("m.cavum-wal"))
    db.close()
    done = s.add("m.cavum")
    os.remove(s.p("m.cavum-wal"))
    if done.rc == 0:
        s.must(s.ledger("verify").rc == 0, "the kept file does not verify without its log")
    return done


@attack("file", SURVIVES, "leaves or plants a log beside the file")
def log_of_rubbish(s):
    """Logs of random bytes, of another database, a pipe and a folder in the log's place."""
    shutil.copy(s.p("anna.cavum"), s.p("m.cavum"))
    for content in (os.urandom(5000), b"", bytes.fromhex("377f0682002de218") + os.urandom(4096)):
        s.text("m.cavum-wal", content, "wb")
        s.run("verify", s.p("m.cavum"))
    os.remove(s.p("m.cavum-wal"))
    os.mkfifo(s.p("m.cavum-wal"))
    s.run("verify", s.p("m.cavum"))
    os.remove(s.p("m.cavum-wal"))
    os.makedirs(s.p("m.cavum-wal"))
    return s.run("verify", s.p("m.cavum"))


@attack("file", FOUND, "files that are none")
def no_files(s):
    """A pipe, a folder, an endless device, nothing, one byte, a sparse file of 8 GiB in the recording's place."""
    os.mkfifo(s.p("pipe.cavum"))
    os.makedirs(s.p("folder.cavum"))
    os.symlink("/dev/zero", s.p("zero.cavum"))
    os.symlink("loop.cavum", s.p("loop.cavum"))
    s.text("empty.cavum", "")
    s.text("one.cavum", "S")
    s.text("sparse.cavum", open(s.p("anna.cavum"), "rb").read(), "wb")
    os.truncate(s.p("sparse.cavum"), 8 << 30)
    last = None
    for name in ("pipe", "folder", "zero", "loop", "empty", "one", "sparse"):
        for args in (("verify",), ("ledger", "add", s.L)):
            last = s.run(*args, s.p(name + ".cavum"))
            s.must(last.rc != 0 or name == "folder", f"`{args[0]}` takes {name}")
    return last


@attack("file", ACCEPTED, "a link to a recording is a recording; what is kept is a file of its own")
def link_to_a_recording(s):
    """A symbolic link: the ledger must keep a copy, not the link."""
    os.symlink(s.p("anna.cavum"), s.p("m.cavum"))
    done = s.add("m.cavum")
    s.must(not any(os.path.islink(f"{s.L}/sessions/{f}") for f in os.listdir(f"{s.L}/sessions")), "a link is kept")
    return done


@attack("file", FOUND, "numbers out of range")
def numbers_out_of_range(s):
    """Ticks, places and counts of 2^31, 2^63 - 1, -1 and -2^63 in chunks and events, hashed and signed."""
    last = None
    for table, column, value in (("chunks", "ticks", -1), ("chunks", "ticks", 2**31), ("chunks", "ticks", 2**62), ("chunks", "first_tick", 2**63 - 1),
                                 ("chunks", "first_tick", -2**63), ("events", "tick", -1), ("events", "tick", 2**63 - 1),
                                 ("chunks", "utc_ns", 2**63 - 1), ("chunks", "utc_ns", -2**63), ("chunks", "boot_ns", -2**63)):
        r = s.session("anna.cavum")
        getattr(r, table)[1][column] = value
        key = s.station()
        s.write(r.rebuild(key, key), "m.cavum")
        s.run("verify", s.p("m.cavum"))
        last = s.add("m.cavum")
        s.must(last.rc != 0, f"filed with {column} = {value}")
    return last


@attack("file", FOUND, "numbers out of range")
def facts_out_of_range(s):
    """Facts that are numbers: not numbers, infinite, too large, negative, with rests."""
    last = None
    for fact, value in (("tick_s", "nan"), ("tick_s", "0"), ("tick_s", "-0.001"), ("tick_s", "1e999"), ("first_tip_x_nm", "99999999999999999999"),
                        ("first_tip_z_nm", "x"), ("created_utc_ns", "-9223372036854775808"), ("created_boot_ns", "9223372036854775807"),
                        ("created_utc_ns", " 12"), ("station_key", "00"), ("begun_signature", "zz")):
        r = s.session("anna.cavum")
        key = s.station()
        r.facts[fact] = value
        if fact in ("station_key", "begun_signature"):
            r.rebuild(None, key)
        else:
            r.rebuild(key, key)
        s.write(r, "m.cavum")
        s.run("verify", s.p("m.cavum"))
        last = s.add("m.cavum")
        s.must(last.rc != 0, f"filed with {fact} = {value}")
    return last


def bomb(size):
    """A zstd frame of that many zeros."""
    packer = zstandard.ZstdCompressor(level=3).compressobj()
    out, zeros = [], bytes(1 << 24)
    for _ in range(size >> 24):
        out.append(packer.compress(zeros))
    out.append(packer.flush())
    return b"".join(out)


@attack("file", FOUND, "oversized input", "recording_unsound")
def zstd_bomb(s):
    """2 GiB of zeros packed into a chunk's inputs, with a fitting and with a wrong number of ticks; into removed; in many frames."""
    big = bomb(2 << 30)
    last = None
    for column, ticks in (("inputs", 1000), ("inputs", (2 << 30) // 40), ("records", 1000), ("removed", 1000)):
        r = s.session("anna.cavum")
        r.chunks[1][column] = big
        r.chunks[1]["ticks"] = ticks
        s.write(r.rebuild(s.station(), s.station()), "m.cavum")
        last = all_verbs(s, "m.cavum")
    return last


@attack("file", FOUND, "one zstd frame; malformed packing", "recording_unsound")
def packing_malformed(s):
    """Two frames, a rest behind the frame, varints without an end, counts of 2^62, a tissue too many."""
    last = None
    raw = unpack(s.session("anna.cavum").chunks[1]["removed"])
    good = s.session("anna.cavum").chunks[1]["inputs"]
    for column, value in (("inputs", good + good), ("inputs", good + b"rest"), ("inputs", good + pack(b"")), ("inputs", good[:-3]), ("inputs", b""),
                          ("removed", pack(b"\xff" * 5000)), ("removed", pack(varint(2**62) + bytes(999))), ("removed", pack(raw + b"\1")),
                          ("removed", pack(b"\x80\x00" + raw[1:])), ("removed", pack(b""))):
        r = s.session("anna.cavum")
        r.chunks[1][column] = value
        s.write(r.rebuild(s.station(), s.station()), "m.cavum")
        last = s.run("verify", s.p("m.cavum"))
        s.must(last.rc != 0, f"`verify` takes {column} = {value[:12].hex()}… ({len(value)} bytes)")
    return s.add("m.cavum")


@attack("file", SURVIVES, "deeply nested texts")
def texts_nested_deep(s):
    """Result, event, ticket and scenario nested 100000 deep; numbers 1e999; keys twice."""
    deep = '{"a":' * 100000 + "1" + "}" * 100000
    last = None
    cases = [lambda r: setattr(r, "result", deep), lambda r: setattr(r, "result", '{"verdict":"pass","score":{"points":1e999,"max":NaN}}'),
             lambda r: setattr(r, "result", "[" * 100000), lambda r: r.events[0].update(detail_json=deep), lambda r: r.facts.update({"note.ticket": deep}),
             lambda r: r.set_artifact("scenario.toml", b"a = " + b"[" * 100000), lambda r: r.set_artifact("scenario.toml", b"a." * 100000 + b"b = 1"),
             lambda r: r.set_artifact("servo.toml", b"tick_s = " + b"9" * 100000), lambda r: setattr(r, "result", r.result[:-1] + ',"verdict":"pass"}')]
    for change in cases:
        r = s.session("anna.cavum")
        change(r)
        s.write(r.rebuild(s.station(), s.station()), "m.cavum")
        last = s.run("verify", s.p("m.cavum"))
        last = s.add("m.cavum")
        s.must(last.rc != 0, "filed as clean")
    return last


@attack("file", FOUND, "a lying tooth", "recording_unsound")
def tooth_lies(s):
    """The start tooth claims to be of 2^64 - 1 bytes, of none, or is cut short; the final tooth, too."""
    last = None
    for name in ("start_tooth.cvt", "final_tooth.cvt"):
        for start, value in ((8, b"\xff" * 8), (16, b"\xff\xff\xff\xff\xff\xff\xff\x7f"), (8, b"\0" * 16), (None, b"")):
            r = s.session("anna.cavum")
            data = bytearray(r.artifact(name))
            if start is None:
                del data[len(data) // 2:]
            else:
                data[start:start + len(value)] = value
            r.set_artifact(name, bytes(data))
            s.write(r.rebuild(s.station(), s.station()), "m.cavum")
            last = s.run("verify", s.p("m.cavum"))
            s.must(last.rc != 0, f"`verify` takes {name}")
            last = s.run("replay", "--verify", s.p("m.cavum"))
    last = s.add("m.cavum")
    return last


@attack("file", SURVIVES, "a flipped bit is found, or changes nothing")
def bits_flipped(s):
    """30 recordings with one random bit flipped: what `verify` takes must hold the same values."""
    good = open(s.p("anna.cavum"), "rb").read()
    before = s.session("anna.cavum")
    dice = random.Random(7)
    last = None
    for _ in range(30):
        data = bytearray(good)
        data[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
        s.text("m.cavum", bytes(data), "wb")
        last = s.run("verify", s.p("m.cavum"))
        if last.rc == 0:
            after = s.session("m.cavum")
            same = all(getattr(before, n) == getattr(after, n) for n in ("facts", "artifacts", "chunks", "events", "result", "seal"))
            s.must(same, "a flipped bit changed a value, and verify holds")
    return last


@attack("file", ACCEPTED, "what is filed is what was checked")
def changed_while_checked(s):
    """While `ledger add` runs, the file is exchanged again and again for one with another result: whatever is kept must verify."""
    r = s.session("anna.cavum")
    r.result = r.result.replace('"verdict":"fail"', '"verdict":"pass"')
    s.write(r, "bad.cavum")
    shutil.copy(s.p("anna.cavum"), s.p("m.cavum"))
    stop = threading.Event()

    def exchange():
        while not stop.is_set():
            for source in ("bad.cavum", "anna.cavum"):
                shutil.copy(s.p(source), s.p("swap"))
                os.replace(s.p("swap"), s.p("m.cavum"))
                stop.wait(0.01)
    thread = threading.Thread(target=exchange)
    thread.start()
    for _ in range(3):
        done = s.add("m.cavum")
        if done.rc == 0:
            break
    stop.set()
    thread.join()
    return s.ledger("verify")
