#!/usr/bin/env python3
"""Checks a receipt of a Cavum ledger without Cavum: Python and python3-cryptography do. docs/formats/ledger.md explains each step.

usage: verify_receipt.py RECEIPT.json SCHOOL_KEY [COSIGNER_KEY_LINE ...]

SCHOOL_KEY: the school's public key, 64 hexadecimal digits, from the school and not from the receipt. COSIGNER_KEY_LINE: "NAME+id+base64", from the
cosigner; each one that is named must have signed. Exit code 0: verified."""
import base64, hashlib, json, sys
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey


def need(holds, why):
    if not holds:
        raise ValueError(why)


def sha(*parts):
    return hashlib.sha256(b"".join(parts)).digest()


def signed(note, name, kind, key):  # origin, size and root of a note that this key signed
    text, lines = note.rsplit("\n\n", 1)
    blobs = [base64.b64decode(line.split(" ")[2], validate=True) for line in lines.splitlines() if line.startswith(f"\u2014 {name} ")]
    blobs = [b[4:] for b in blobs if b[:4] == sha(f"{name}\n".encode(), bytes([kind]), key)[:4]]
    need(blobs and all(len(b) == (72 if kind == 4 else 64) for b in blobs), f"{name} has not signed")
    for b in blobs:
        head = f"cosignature/v1\ntime {int.from_bytes(b[:8], 'big')}\n" if kind == 4 else ""
        Ed25519PublicKey.from_public_bytes(key).verify(b[-64:], f"{head}{text}\n".encode())
    origin, size, root = text.split("\n")[:3]
    return origin, int(size), base64.b64decode(root, validate=True)


def root_with(leaf, index, size, path):  # RFC 6962, 2.1.1; the path's last hash is the highest
    if size == 1:
        return leaf
    half, beside = 1 << (size - 1).bit_length() - 1, path.pop()
    if index < half:
        return sha(b"\1", root_with(leaf, index, half, path), beside)
    return sha(b"\1", beside, root_with(leaf, index - half, size - half, path))


def roots_with(root, old, new, proof, whole=True):  # RFC 6962, 2.1.2: the roots of the first `old` and of all `new`
    if old == new:
        return (root, root) if whole else (proof[-1], proof.pop())
    half, beside = 1 << (new - 1).bit_length() - 1, proof.pop()
    if old <= half:
        before, after = roots_with(root, old, half, proof, whole)
        return before, sha(b"\1", after, beside)
    return tuple(sha(b"\1", beside, r) for r in roots_with(root, old - half, new - half, proof, False))


def verify(receipt, school, cosigners):
    origin, seq, path = "cavum.ledger/" + receipt["ledger"], receipt["seq"], [bytes.fromhex(h) for h in receipt["inclusion"]]
    named, size, root = signed(receipt["checkpoint"], origin, 1, school)
    need(named == origin and 0 <= seq < size and json.loads(receipt["entry"])["seq"] == seq, "the entry is of another place")
    need(root_with(sha(b"\0", receipt["entry"].encode()), seq, size, path) == root and not path, "the entry is not the one that was signed")
    if "consistency" in receipt:
        proof = [bytes.fromhex(h) for h in receipt["consistency"]["proof"]]
        named, old, before = signed(receipt["consistency"]["from"], origin, 1, school)
        need(named == origin and 0 < old <= size and roots_with(before, old, size, proof) == (before, root) and not proof, "not the same beginning")
    for name, _, key in (line.split("+", 2) for line in cosigners):
        signed(receipt["checkpoint"], name, 4, base64.b64decode(key, validate=True)[1:])
    return f"entry {seq} is among the {size} of {origin}"


if __name__ == "__main__":
    try:
        with open(sys.argv[1], encoding="utf-8") as file:
            print("verified:", verify(json.load(file), bytes.fromhex(sys.argv[2]), sys.argv[3:]))
    except IndexError if len(sys.argv) < 3 else ():
        sys.exit(__doc__)
    except Exception as error:  # whatever a made-up receipt brings about
        sys.exit(f"NOT VERIFIED: {error!r}")
