"""Exams taken up again, ended twice, moved to another station, handed in twice: by somebody with a station's key."""
import os

import ledger_format as lf
from attacks_insider import KEYHOLDER, insider
from kinds import FOUND, NOBODY, UNSTATED, attack
from school import as_hand
from session_format import Session, pack, unpack


@attack("insider", FOUND, "the sealed result says nothing of the interruption; one that did would pass: as after any crash (the page says: nobody)", "result_differs")
def forged_gap(s):
    """A pause of 31.2 s with a made-up `gap` event at the same station: an interruption that no crash explains."""
    def change(r):
        before = r.chunks[1]
        for c in r.chunks[2:] + [r.seal]:
            for n in ("utc_ns", "boot_ns", "monotonic_ns"):
                c[n] += int(31.3 * 10**9)
        clocks = {n: before[n] + int(31.2 * 10**9) for n in ("utc_ns", "boot_ns", "monotonic_ns")}
        detail = {"boot_id": r.facts["boot_id"], "boot_s": 31.2, "last_utc_ns": before["utc_ns"], "resumed_utc_ns": clocks["utc_ns"],
                  "by": {"notes": {}, "source": {"kind": "device", "name": "Novint Falcon", "serial": "F-1"}, "ticket_remembered": True},
                  "station_key": s.station().hex}
        empty = dict(before, seq=2, first_tick=2000, ticks=0, inputs=pack(b""), records=pack(b""), removed=pack(b""), **clocks)
        sample = Session.read(s.p("cut.cavum"))
        like = next(c for c in sample.chunks if c["ticks"] == 0)
        for n in ("inputs", "records", "removed"):
            empty[n] = like[n]
        r.chunks[2]["seq"] = 3
        r.chunks.insert(2, empty)
        for e in r.events[1:]:
            e["chunk"], e["seq"] = 3, e["seq"] + 1
        r.events.insert(1, {"seq": 1, "tick": 2000, "chunk": 2, "kind": "gap", "detail_json": lf.json_text(detail)})
    cut_back(s, "cut.cavum")
    s.needs("exam", "--resume", "--operator", "expert", "--out", s.p("cut.cavum"), "--quiet", home=s.p("seat2"))
    return insider(s, change)


def cut_back(s, name, source="op_anna.cavum"):
    """A copy of a closed exam, cut back to before its end."""
    r = s.session(source)
    r.chunks = r.chunks[:2]
    r.events = [e for e in r.events if e["chunk"] < 2]
    r.seal = r.result = None
    r.artifacts = [a for a in r.artifacts if a[0] != "final_tooth.cvt"]
    s.write(r, name)


def resume(s, seat):
    return s.run("exam", "--resume", "--operator", "expert", "--out", s.p("cut.cavum"), "--quiet", home=s.p(seat))


@attack("insider", FOUND, "takes an exam up again that was closed: the station where it was closed refuses", "error")
def cut_back_same_station(s):
    """A closed exam cut back to before its end and taken up at the same station."""
    cut_back(s, "cut.cavum")
    return resume(s, "seat1")


@attack("insider", FOUND, "... at another station: begun by one station, taken up or ended by another", "station_changed")
def cut_back_other_station(s):
    """... and taken up at seat 2, which is enrolled, too."""
    cut_back(s, "cut.cavum")
    resume(s, "seat2")
    s.must(s.run("verify", s.p("cut.cavum")).rc != 0, "`cavum verify` finds nothing")
    return s.add("cut.cavum", "--simulated")


@attack("insider", FOUND, "... its used_tickets removed: taken up at a station that does not remember beginning it", "station_changed")
def cut_back_memory_removed(s):
    """... and taken up at the same station, whose memory of tickets was removed."""
    cut_back(s, "cut.cavum")
    os.remove(s.p("seat1/used_tickets"))
    resume(s, "seat1")
    return s.add("cut.cavum", "--simulated")


@attack("insider", NOBODY, "... its used_tickets put back to what they were before the end: nobody")
def cut_back_memory_put_back(s):
    """... and taken up at the same station, with the line `closed` taken out of its memory."""
    cut_back(s, "cut.cavum")
    lines = [l for l in open(s.p("seat1/used_tickets")) if not l.startswith("closed")]
    s.text("seat1/used_tickets", "".join(lines))
    resume(s, "seat1")
    return s.add("cut.cavum", "--simulated")


@attack("insider", FOUND, "filing of the second: up to which tick they are one recording", "ticket_used", "2000")
def both_endings_handed_in(s):
    """The first ending is filed, then the second of the same exam."""
    s.must(s.add("op_anna.cavum", "--simulated").rc == 0, "the first ending is refused")
    return cut_back_memory_put_back(s)


@attack("insider", NOBODY, KEYHOLDER)
def whole_by_another_enrolled_station(s):
    """An exam of seat 1, begun and ended anew under seat 2's key (which is enrolled for the stylus F-2), with that stylus."""
    s.write(as_hand(s.session("op_anna.cavum"), s.station("seat2"), 60, serial="F-2"), "m.cavum")
    return s.add("m.cavum")


@attack("insider", FOUND, "only recordings of the stylus that the station asked for count", "device_other", "F-1")
def another_stylus(s):
    """At seat 2, enrolled for the stylus F-2, with the stylus F-1."""
    s.write(as_hand(s.session("op_anna.cavum"), s.station("seat2"), 60, serial="F-1"), "m.cavum")
    return s.add("m.cavum")


@attack("insider", UNSTATED, "recordings from before begun_signature have neither fact")
def beginning_stripped(s):
    """begun_signature and station_key are taken out, the seal is the station's: the check of who began is gone with them."""
    r = s.session("anna.cavum")
    del r.facts["begun_signature"], r.facts["station_key"]
    s.write(r.rebuild(None, s.station()), "m.cavum")
    return s.add("m.cavum")


@attack("insider", UNSTATED, "recordings from before begun_signature have neither fact")
def beginning_stripped_and_taken_elsewhere(s):
    """Begun and sealed at seat 1; the beginning's facts are taken out and seat 2 seals it: `begun by one, ended by another` cannot be told."""
    r = s.session("anna.cavum")
    del r.facts["begun_signature"], r.facts["station_key"]
    r.facts["source_serial"] = "F-2"
    s.write(r.rebuild(None, s.station("seat2")), "m.cavum")
    return s.add("m.cavum")


@attack("insider", NOBODY, KEYHOLDER + " (but: submits a session twice: the ledger, on filing)")
def without_ticket_twice(s):
    """An exam without ticket filed twice: as it is, and packed and signed anew by the station."""
    s.must(s.add("x.cavum", "--without-ticket").rc == 0, "the first is refused")
    r = s.session("x.cavum")
    for c in r.chunks:
        c["inputs"] = pack(unpack(c["inputs"]), 12)
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    return s.add("m.cavum", "--without-ticket")
