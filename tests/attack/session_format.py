"""Recordings (.cavum), written from the page docs/formats/session.md: reading, packing, hashing, signing and writing.

The tables' texts are taken from a recording that the program made (see `Session.read`)."""
import copy
import hashlib
import sqlite3
import struct

import zstandard
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

INPUTS = ["tip_x", "tip_y", "tip_z", "rot_w", "rot_x", "rot_y", "rot_z", "pedal", "flags", "bur"]
RECORDS = ["rendered_x", "rendered_y", "rendered_z", "model_n", "penetration", "proxy_x", "proxy_y", "proxy_z", "rpm", "leaves", "notices"]
M32 = 0xFFFFFFFF


def sha(*parts):
    return hashlib.sha256(b"".join(parts)).digest()


def u64(n):
    return struct.pack("<Q", n & 0xFFFFFFFFFFFFFFFF)


def text(s):
    raw = s.encode() if isinstance(s, str) else s
    return struct.pack("<I", len(raw)) + raw


class Key:
    """An Ed25519 key from its seed."""

    def __init__(self, seed):
        self.seed = seed
        self.private = Ed25519PrivateKey.from_private_bytes(seed)
        self.public = self.private.public_key().public_bytes(serialization.Encoding.Raw, serialization.PublicFormat.Raw)
        self.hex = self.public.hex()

    def sign(self, message):
        return self.private.sign(message)

    @staticmethod
    def read(path):
        """The key's file: one line that ends with the seed in 64 hex digits."""
        with open(path) as file:
            return Key(bytes.fromhex(file.read().strip()[-64:]))


def fold_columns(columns, n):
    """Second differences, folded, in planes of bytes."""
    planes = []
    for column in columns:
        a = b = 0
        folded = []
        for w in column:
            w &= M32
            d = (w - 2 * b + a) & M32
            a, b = b, w
            signed = d - (1 << 32) if d >> 31 else d
            folded.append(((d << 1) & M32) ^ ((-(d >> 31)) & M32) if signed or d else 0)
        for k in range(4):
            planes.append(bytes(f >> 8 * k & 255 for f in folded))
    assert all(len(p) == n for p in planes)
    return b"".join(planes)


def unfold_columns(raw, count):
    n = len(raw) // (4 * count)
    columns = []
    for c in range(count):
        p = [raw[(4 * c + k) * n:(4 * c + k + 1) * n] for k in range(4)]
        a = b = 0
        column = []
        for i in range(n):
            f = p[0][i] | p[1][i] << 8 | p[2][i] << 16 | p[3][i] << 24
            a, b = b, (2 * b - a + ((f >> 1) ^ -(f & 1))) & M32
            column.append(b - (1 << 32) if b >> 31 else b)
        columns.append(column)
    return columns


def pack(raw, level=3):
    return zstandard.ZstdCompressor(level=level).compress(raw)


def unpack(blob):
    return zstandard.ZstdDecompressor().decompress(blob, max_output_size=1 << 26)


def varint(n):
    out = bytearray()
    while n > 127:
        out.append(n & 127 | 128)
        n >>= 7
    return bytes(out) + bytes([n])


def decode_removed(raw, n):
    """Leaves removed per tick, and every leaf's x, y, z and tissue."""
    at = 0

    def number():
        nonlocal at
        value = shift = 0
        while True:
            byte = raw[at]
            at += 1
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value
    counts = [number() for _ in range(n)]
    total = sum(counts)
    axes = []
    for _ in range(3):
        before, axis = 0, []
        for _ in range(total):
            z = number()
            before = (before + ((z >> 1) ^ -(z & 1))) & 0xFFFF
            axis.append(before)
        axes.append(axis)
    return counts, axes, list(raw[at:at + total])


def encode_removed(counts, axes, tissues):
    out = [varint(c) for c in counts]
    for axis in axes:
        before = 0
        for value in axis:
            d = (value - before) & 0xFFFF
            d = d - 65536 if d >= 32768 else d
            out.append(varint(d << 1 if d >= 0 else (-d << 1) - 1))
            before = value
    return b"".join(out) + bytes(tissues)


class Session:
    """What one recording holds, as plain values that can be changed; `rebuild` makes chain and signatures anew."""

    @staticmethod
    def read(path):
        s = Session()
        db = sqlite3.connect(f"file:{path}?mode=ro&immutable=1", uri=True)
        db.row_factory = sqlite3.Row
        s.schema = [r[0] for r in db.execute("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL ORDER BY rowid")]
        s.facts = dict(db.execute("SELECT key, value FROM meta").fetchall())
        s.artifacts = [[r["name"], bytes(r["bytes"])] for r in db.execute("SELECT name, bytes FROM artifact ORDER BY seq")]
        s.chunks = [dict(r) for r in db.execute("SELECT * FROM chunk ORDER BY seq")]
        s.events = [dict(r) for r in db.execute("SELECT * FROM event ORDER BY seq")]
        row = db.execute("SELECT json FROM result").fetchone()
        s.result = row[0] if row else None
        row = db.execute("SELECT * FROM seal").fetchone()
        s.seal = dict(row) if row else None
        db.close()
        return s

    def copy(self):
        return copy.deepcopy(self)

    def inputs(self, i):
        return unfold_columns(unpack(self.chunks[i]["inputs"]), 10)

    def set_inputs(self, i, columns):
        self.chunks[i]["inputs"] = pack(fold_columns(columns, self.chunks[i]["ticks"]))

    def records(self, i):
        return unfold_columns(unpack(self.chunks[i]["records"]), 11)

    def set_records(self, i, columns):
        self.chunks[i]["records"] = pack(fold_columns(columns, self.chunks[i]["ticks"]))

    def artifact(self, name):
        return next(a[1] for a in self.artifacts if a[0] == name)

    def set_artifact(self, name, data):
        for a in self.artifacts:
            if a[0] == name:
                a[1] = data

    def start(self, without=()):
        """The hash of facts and artifacts, with which the chain begins."""
        facts = sorted((k.encode(), v) for k, v in self.facts.items() if k not in without)
        parts = [b"CVSTART1", u64(len(facts))]
        parts += [text(k) + text(v) for k, v in facts]
        parts += [text(n) + u64(len(b)) + sha(b) for n, b in self.artifacts if n != "final_tooth.cvt"]
        return sha(*parts)

    def rebuild(self, begin_key=None, seal_key=None):
        """Chain, counts and hashes anew; signs the beginning and the seal with these keys."""
        if begin_key:
            self.facts["station_key"] = begin_key.hex
            self.facts["begun_signature"] = begin_key.sign(b"CVBEGIN1" + self.start({"begun_signature"})).hex()
        before = self.start()
        for c in self.chunks:
            for name in ("inputs", "records", "removed"):
                c[name + "_sha256"] = sha(c[name])
            mine = [e for e in self.events if e["chunk"] == c["seq"]]
            c["events_sha256"] = sha(b"CVEVENT1", *[u64(e["seq"]) + u64(e["tick"]) + text(e["kind"]) + text(e["detail_json"]) for e in mine])
            c["prev_sha256"] = before
            numbers = [c["seq"], c["first_tick"], c["ticks"], c["state_hash"], c["monotonic_ns"], c["boot_ns"], c["utc_ns"]]
            before = sha(b"CVCHUNK1", before, *[u64(n) for n in numbers],
                         *[c[n] for n in ("inputs_sha256", "records_sha256", "removed_sha256", "events_sha256")])
            c["sha256"] = before
        if self.seal is not None and seal_key:
            self.seal.update(chain_sha256=before, final_tooth_sha256=sha(self.artifact("final_tooth.cvt")), result_sha256=sha(self.result.encode()),
                             chunks=len(self.chunks), ticks=sum(c["ticks"] for c in self.chunks), events=len(self.events))
            self.sign_seal(seal_key)
        return self

    def sign_seal(self, key):
        e = self.seal
        e["public_key"] = key.public
        numbers = [e[n] for n in ("chunks", "ticks", "events", "monotonic_ns", "boot_ns", "utc_ns")]
        e["signature"] = key.sign(b"CVSEAL_1" + e["chain_sha256"] + e["final_tooth_sha256"] + e["result_sha256"] +
                                  b"".join(u64(n) for n in numbers) + key.public)

    def write(self, path):
        db = sqlite3.connect(path)
        db.executescript("PRAGMA page_size=1024; PRAGMA application_id=0x43617675; PRAGMA user_version=1;")
        for line in self.schema:
            db.execute(line)
        db.executemany("INSERT INTO meta VALUES (?,?)", sorted(self.facts.items()))
        for i, (name, data) in enumerate(self.artifacts):
            db.execute("INSERT INTO artifact VALUES (?,?,?,?,?)", (i, name, sha(data), len(data), data))
        for table, rows in (("chunk", self.chunks), ("event", self.events)):
            for r in rows:
                db.execute(f"INSERT INTO {table} ({','.join(r)}) VALUES ({','.join('?' * len(r))})", list(r.values()))
        if self.result is not None:
            db.execute("INSERT INTO result VALUES (0,?)", (self.result,))
        if self.seal is not None:
            db.execute(f"INSERT INTO seal ({','.join(self.seal)}) VALUES ({','.join('?' * len(self.seal))})", list(self.seal.values()))
        db.commit()
        db.close()
        return path

    def set_clocks(self, first_utc_ns, first_boot_ns, jitter=None):
        """Makes the clocks those of an exam that took as long as its ticks say and began then."""
        from datetime import datetime, timezone
        day = datetime.fromtimestamp(first_utc_ns // 10**9, timezone.utc)
        self.facts.update(created_utc=day.strftime("%Y-%m-%dT%H:%M:%SZ"), created_utc_ns=str(first_utc_ns),
                          created_boot_ns=str(first_boot_ns), created_monotonic_ns=str(first_boot_ns - 41))
        tick_ns = round(float(self.facts["tick_s"]) * 10**9)
        for i, c in enumerate(self.chunks):
            late = 10**6 * (10 + 3 * i % 7)
            at = (c["first_tick"] + c["ticks"]) * tick_ns + late + 10**8
            c.update(monotonic_ns=first_boot_ns + at, boot_ns=first_boot_ns + at + 29, utc_ns=first_utc_ns + at + 31)
        if self.seal:
            at += 10**9
            self.seal.update(monotonic_ns=first_boot_ns + at, boot_ns=first_boot_ns + at + 29, utc_ns=first_utc_ns + at + 31)
