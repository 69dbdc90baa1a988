"""Older copies, witnesses, receipts, signed results, backups and restores; two programs at once."""
import json
import os
import re
import shutil

import ledger_format as lf
from attacks_ledger import better
from kinds import ACCEPTED, FOUND, NOBODY, SURVIVES, UNSTATED, attack
from session_format import sha


def put_back(s, with_witness):
    for f in os.listdir(s.L):
        if f.startswith("ledger.db"):
            os.remove(f"{s.L}/{f}")
    shutil.copy(s.p("older/ledger.db"), s.L)
    if with_witness == "older":
        shutil.rmtree(f"{s.home}/witness")
        shutil.copytree(s.p("older_witness"), f"{s.home}/witness")
    if with_witness == "gone":
        shutil.rmtree(f"{s.home}/witness")


@attack("history", FOUND, "puts an older copy of the ledger back: the witness on this computer", "older_copy")
def older_copy(s):
    """The ledger of before Dora's filing; nothing may be added to it."""
    put_back(s, "kept")
    s.must(s.add("anna.cavum").rc != 0, "something is added to an older copy")
    s.must(s.ledger("show").rc != 0, "`show` does not warn")
    return s.ledger("verify")


@attack("history", NOBODY, "... together with its witness file: nothing on this computer tells")
def older_copy_and_witness(s):
    """... with the witness of then."""
    put_back(s, "older")
    return s.ledger("verify")


@attack("history", FOUND, "... a receipt or a cosigned note of a later state, when somebody shows it", "older_copy")
def older_copy_and_witness_and_a_receipt(s):
    """... and a receipt, then the cosigned note, is shown."""
    put_back(s, "older")
    s.must(s.ledger("verify", "--cosigned", s.p("cosigned")).rc != 0, "the cosigned note does not tell")
    return s.ledger("verify", "--receipt", s.p("receipts/receipt-14.json"))


@attack("history", FOUND, "... and adds other entries: `history was rewritten`; a cosigner signs neither", "rewritten")
def older_copy_gone_on_with(s):
    """... and other entries are added; a receipt tells, and the cosigner refuses."""
    put_back(s, "older")
    for i in range(5):
        s.ledger("station", "--invite", f"Seat {i}")
    s.ledger("checkpoint", "--since", "0", "--out", s.p("again"))
    s.must(s.run("ledger", "cosign", s.p("again"), "--out", s.p("c2"), home=s.p("cosigner")).rc != 0, "the cosigner signs a fork")
    s.ledger("checkpoint", "--since", "14", "--out", s.p("again"), "--overwrite")
    s.must(s.run("ledger", "cosign", s.p("again"), "--out", s.p("c3"), home=s.p("cosigner")).rc != 0, "the cosigner signs a fork since 14")
    return s.ledger("verify", "--receipt", s.p("receipts/receipt-14.json"))


@attack("history", ACCEPTED, "... and takes the witness away: `verify` lists as not checked whether an older copy was put back")
def older_copy_without_witness(s):
    """The witness is gone: verify must say that this was not checked."""
    put_back(s, "gone")
    done = s.ledger("verify", "--json")
    s.must("older_copy" in done.kinds("not_checked"), "it is not listed as not checked")
    return done


@attack("history", FOUND, "makes up a line of the witness: the school's signature under each", "witness_changed", "40")
def witness_line_made_up(s):
    """A line of a larger size with a signature of a stranger."""
    with open(s.witness_path(), "a") as file:
        file.write(lf.witness_line(40, sha(b"x"), 2 * 10**18, lf.note(lf.Ledger(s.L).id, 40, sha(b"x"), 2 * 10**18, s.station("stranger"))))
    return s.ledger("verify")


@attack("history", ACCEPTED, "a line that is cut short is passed over")
def witness_line_unsigned(s):
    """A line of a larger size without signature, as a power cut leaves it: it says nothing."""
    with open(s.witness_path(), "a") as file:
        file.write(f"40 {sha(b'x').hex()} {2 * 10**18}\n")
    return s.ledger("verify")


@attack("history", UNSTATED, "a witness whose lines are gone but one")
def witness_thinned(s):
    """Lines are taken out of the middle of the witness."""
    lines = open(s.witness_path()).read().splitlines(True)
    s.text("home/witness/" + lf.Ledger(s.L).id, lines[0] + lines[-1])
    return s.ledger("verify")


@attack("history", SURVIVES, "hostile files in the witness's place")
def witness_hostile(s):
    """A pipe, a folder, an endless device, rubbish, sizes of 10^30, a line of 50 MB."""
    path = s.witness_path()
    good = open(path).read()
    last = None

    def clear():
        if os.path.isdir(path):
            os.rmdir(path)
        elif os.path.lexists(path):
            os.remove(path)
    for make in (os.mkfifo, os.makedirs, lambda p: os.symlink("/dev/zero", p), lambda p: open(p, "wb").write(os.urandom(5000)),
                 lambda p: open(p, "w").write(good + "9" * 30 + " " + "00" * 32 + " 1 AAAA\n"), lambda p: open(p, "w").write(good + "-1 " + "00" * 32 + " 1\n"),
                 lambda p: open(p, "w").write("1" * 50_000_000)):
        clear()
        make(path)
        last = s.ledger("verify")
    return last


RECEIPT = "a receipt's inclusion, consistency and the school's signature"


@attack("history", FOUND, RECEIPT, "malformed")
def receipts_wrong(s):
    """Receipts with another entry, place, path, checkpoint, ledger, key; with a proof too long, of a stranger's signature."""
    ledger = lf.Ledger(s.L)
    stranger = s.station("stranger")

    def signed_by_stranger(r):
        r["checkpoint"] = lf.note(ledger.id, 18, lf.root(ledger.leaves()), 1795437967141666175, stranger)
        r["public_key"] = stranger.hex
    zero = "00" * 32
    cases = {"another entry": lambda r: r.update(entry=r["entry"].replace('"ticks":3000', '"ticks":3001')), "place": lambda r: r.update(seq=13), "place -1": lambda r: r.update(seq=-1),
             "place 2^64 + 14": lambda r: r.update(seq=2**64 + 14), "place 14.0": lambda r: r.update(seq=14.0), "place as text": lambda r: r.update(seq="14"),
             "path shorter": lambda r: r["inclusion"].pop(), "path longer": lambda r: r["inclusion"].append(zero), "path of a million": lambda r: r.update(inclusion=[zero] * 10**6),
             "path changed": lambda r: r["inclusion"].__setitem__(0, zero), "upper case": lambda r: r.update(inclusion=[h.upper() + "g" for h in r["inclusion"]]),
             "a stranger's": signed_by_stranger, "another ledger": lambda r: r.update(ledger="00" * 16), "proof changed": lambda r: r["consistency"]["proof"].__setitem__(0, zero),
             "proof longer": lambda r: r["consistency"]["proof"].append(zero), "from stranger": lambda r: r["consistency"].update({"from": lf.note(ledger.id, 5, sha(b"x"), 1, stranger)}),
             "size changed": lambda r: r.update(checkpoint=r["checkpoint"].replace("\n18\n", "\n17\n", 1)), "size 018": lambda r: r.update(checkpoint=r["checkpoint"].replace("\n18\n", "\n018\n", 1)),
             "CRLF": lambda r: r.update(checkpoint=r["checkpoint"].replace("\n", "\r\n")), "no checkpoint": lambda r: r.pop("checkpoint"),
             "old kind": lambda r: r.update(checkpoint={"size": 18, "root": zero, "utc": "", "utc_ns": 1, "signature": zero * 2})}
    last = None
    for name, change in cases.items():
        r = ledger.receipt(14, 5)
        change(r)
        s.text("r.json", json.dumps(r))
        last = s.ledger("verify", "--receipt", s.p("r.json"))
        s.must(last.rc != 0, f"taken: {name}")
    return last


@attack("history", SURVIVES, "receipts, notes and results are input")
def receipts_hostile(s):
    """Nested 200000 deep, keys twice, 1e999, NaN, a pipe, nothing, 60 MB; as receipt, cosigned note and results."""
    os.mkfifo(s.p("pipe"))
    s.text("big", '"' + "x" * 60_000_000 + '"')
    good = json.dumps(lf.Ledger(s.L).receipt(14))
    s.text("twice", good[:-1] + ', "entry": "{}"}')
    s.text("deep", "[" * 200000)
    s.text("deeper", '{"a":' * 200000)
    s.text("number", good.replace('"seq": 14', '"seq": 1e999'))
    s.text("nan", good.replace('"seq": 14', '"seq": NaN'))
    s.text("empty", "")
    s.text("bytes", os.urandom(2000), "wb")
    last = None
    for option in ("--receipt", "--cosigned", "--results"):
        for name in ("pipe", "big", "twice", "deep", "deeper", "number", "nan", "empty", "bytes"):
            last = s.ledger("verify", option, s.p(name))
            s.must(last.rc != 0, f"{option} {name} is taken")
    return last


@attack("history", FOUND, "`verify --results`: an export of --format json, signed and unchanged", "malformed")
def results_edited(s):
    """Points edited; signed by a stranger; a key twice; results appended; a space; the signature's place."""
    line = open(s.p("results.json"), encoding="utf-8").read()
    body = json.loads(line)
    del body["signature"]
    seq, better_result = better(lf.Ledger(s.L))
    body["results"][0]["result"] = better_result
    more = re.sub(r'"points":\d+', '"points":94', line, count=1)
    s.must(more != line, "no points to edit in results.json")
    cases = {"points": more, "a stranger": lf.signed_results(body, s.station("stranger")), "a stranger who says so":
             lf.signed_results(dict(body, public_key=s.station("stranger").hex), s.station("stranger")), "a space": line.replace(",", ", ", 1),
             "key twice": line[:-2].replace('{"checkpoint"', '{"results":[],"checkpoint"', 1) + "}\n", "behind the signature": line.rstrip("\n")[:-1] + ',"results":[]}\n',
             "two lines": line + line, "a second object": line.rstrip("\n") + "{}\n"}
    last = None
    for name, text in cases.items():
        last = s.ledger("verify", "--results", s.text("r.json", text))
        s.must(last.rc != 0, f"taken: {name}")
    return last
