"""Recordings changed by somebody who has the file, and perhaps a key of his own, but not the station's."""

from kinds import ACCEPTED, FOUND, attack
from session_format import decode_removed, encode_removed, fold_columns, pack, unpack

P1 = "a pose, event, clock, scenario, result or tooth in a session is changed: `cavum verify`, and filing"


def changed(s, change, verb="verify", name="anna.cavum"):
    """Writes the recording with the change and nothing made anew, and has it checked by two verbs; filing decides."""
    r = s.session(name)
    change(r)
    s.write(r, "m.cavum")
    if verb == "verify":
        found = s.run("verify", s.p("m.cavum"))
        s.must(found.rc != 0, "`cavum verify` finds nothing")
    return s.add("m.cavum")


@attack("recording", ACCEPTED, "decode and encode: the same bytes before packing; chain, seal and beginning are those of the program")
def control_format_is_understood(s):
    """An operator's recording decoded, encoded, chained and signed anew with the same key is the same, value by value."""
    r = s.session("op_anna.cavum")
    for i, c in enumerate(r.chunks):
        s.must(fold_columns(r.inputs(i), c["ticks"]) == unpack(c["inputs"]), "inputs are packed otherwise")
        s.must(fold_columns(r.records(i), c["ticks"]) == unpack(c["records"]), "records are packed otherwise")
        s.must(encode_removed(*decode_removed(unpack(c["removed"]), c["ticks"])) == unpack(c["removed"]), "removed is packed otherwise")
    again = r.copy().rebuild(s.station(), s.station())
    s.must((again.chunks, again.seal, again.facts) == (r.chunks, r.seal, r.facts), "hashes or signatures differ")
    s.write(again, "m.cavum")
    s.must(s.run("replay", "--verify", s.p("m.cavum"), "--station-key", s.station().hex).rc == 0, "replay refuses it")
    return s.run("verify", s.p("m.cavum"))


@attack("recording", ACCEPTED, "an untouched hand's exam under its ticket, at an enrolled station, is filed")
def control_hand_is_filed(s):
    """The made-up hand's recording: the page owns up to it (a changed program with a station's key)."""
    return s.add("anna.cavum")


@attack("recording", ACCEPTED)
def control_packed_anew(s):
    """Chunks compressed again at another level, chained and signed anew with the same key."""
    r = s.session("anna.cavum")
    for i, c in enumerate(r.chunks):
        r.set_inputs(i, r.inputs(i))
        c["records"] = pack(unpack(c["records"]), 19)
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    return s.add("m.cavum")


@attack("recording", FOUND, P1, "recording_unsound")
def pose_changed(s):
    """One tip position is 0.1 mm lower."""
    def change(r):
        c = r.inputs(1)
        c[2][500] -= 100000
        r.set_inputs(1, c)
    return changed(s, change)


@attack("recording", FOUND, P1, "recording_unsound")
def force_changed(s):
    """One recorded force is halved."""
    def change(r):
        c = r.records(1)
        c[3][700] //= 2
        r.set_records(1, c)
    return changed(s, change)


@attack("recording", FOUND, P1, "recording_unsound")
def result_changed_unsigned(s):
    """The sealed result says pass."""
    return changed(s, lambda r: setattr(r, "result", r.result.replace('"verdict":"fail"', '"verdict":"pass"')))


@attack("recording", FOUND, P1, "recording_unsound")
def event_changed(s):
    """The detail of an event is another."""
    return changed(s, lambda r: r.events[-1].update(detail_json='{"how":"failed"}'))


@attack("recording", FOUND, P1, "recording_unsound")
def event_removed_unsigned(s):
    """The last event is gone."""
    return changed(s, lambda r: r.events.pop())


@attack("recording", FOUND, P1, "recording_unsound")
def clock_changed(s):
    """One second's clock is set back by a minute."""
    return changed(s, lambda r: r.chunks[1].update(utc_ns=r.chunks[1]["utc_ns"] - 60 * 10**9))


@attack("recording", FOUND, P1, "recording_unsound")
def candidate_changed(s):
    """The recording names another candidate."""
    return changed(s, lambda r: r.facts.update(candidate="C-0000-0000-0000"))


@attack("recording", FOUND, P1, "recording_unsound")
def scenario_changed(s):
    """The scenario that is kept asks for less; its SHA-256 in the table fits."""
    return changed(s, lambda r: r.set_artifact("scenario.toml", r.artifact("scenario.toml").replace(b"full = 90", b"full = 10")))


@attack("recording", FOUND, P1, "recording_unsound")
def tooth_changed(s):
    """The final tooth is another candidate's."""
    return changed(s, lambda r: r.set_artifact("final_tooth.cvt", s.session("ben.cavum").artifact("final_tooth.cvt")))


@attack("recording", FOUND, "drops, swaps, repeats or cuts off seconds of a closed session", "recording_unsound")
def seconds_cut_off(s):
    """The last second is gone, its events too."""
    def change(r):
        r.chunks.pop()
        r.events = [e for e in r.events if e["chunk"] < len(r.chunks)]
    return changed(s, change)


@attack("recording", FOUND, "drops, swaps, repeats or cuts off seconds of a closed session", "recording_unsound")
def seconds_swapped(s):
    """Two seconds change places, numbers and all."""
    def change(r):
        a, b = r.chunks[1], r.chunks[2]
        keep = {n: (a[n], b[n]) for n in ("seq", "first_tick")}
        a.update({n: v[1] for n, v in keep.items()})
        b.update({n: v[0] for n, v in keep.items()})
    return changed(s, change)


@attack("recording", FOUND, "drops, swaps, repeats or cuts off seconds of a closed session", "recording_unsound")
def second_repeated(s):
    """The last second stands there twice."""
    def change(r):
        again = dict(r.chunks[-1])
        again.update(seq=again["seq"] + 1, first_tick=again["first_tick"] + again["ticks"])
        r.chunks.append(again)
    return changed(s, change)


@attack("recording", FOUND, "a session without seal is never verified", "error")
def seal_taken_out(s):
    """Seal, result and final tooth are gone: as if it had been interrupted."""
    def change(r):
        r.seal = r.result = None
        r.artifacts = [a for a in r.artifacts if a[0] != "final_tooth.cvt"]
    return changed(s, change)


@attack("recording", FOUND, "sets points in the sealed result and signs it anew, with any key", "station_changed")
def chain_rebuilt_new_seal(s):
    """A better result, sealed with a stranger's key; the beginning stays signed by the station."""
    r = s.session("anna.cavum")
    r.result = r.result.replace('"verdict":"fail"', '"verdict":"pass"')
    s.write(r.rebuild(None, s.station("stranger")), "m.cavum")
    s.must(s.run("verify", s.p("m.cavum")).rc != 0, "`cavum verify` finds nothing")
    return s.add("m.cavum")


@attack("recording", FOUND, "records at a station that nobody enrolled: its key is not in the register", "station_unknown")
def whole_by_a_stranger(s):
    """Everything chained and signed with a key that nobody enrolled."""
    s.write(s.session("anna.cavum").rebuild(s.station("stranger"), s.station("stranger")), "m.cavum")
    s.must(s.run("replay", "--verify", s.p("m.cavum"), "--station-key", s.station().hex).rc != 0, "replay --station-key does not tell the key")
    return s.add("m.cavum")


@attack("recording", FOUND, "whose key was revoked", "station_revoked", "revoked")
def whole_by_a_revoked_station(s):
    """Everything signed with the key that was revoked."""
    s.write(s.session("anna.cavum").rebuild(s.station("revoked"), s.station("revoked")), "m.cavum")
    return s.add("m.cavum")


@attack("recording", FOUND, "begun by one station, taken up or ended by another", "station_changed")
def ended_at_another_enrolled_station(s):
    """Begun at seat 1, sealed by seat 2: both are enrolled."""
    s.write(s.session("anna.cavum").rebuild(s.station("seat1"), s.station("revoked")), "m.cavum")
    s.must(s.run("verify", s.p("m.cavum")).rc != 0, "`cavum verify` finds nothing")
    s.write(s.session("anna.cavum").rebuild(s.station("seat1"), s.station("seat2")), "m.cavum")
    return s.add("m.cavum")


@attack("recording", FOUND, "Ed25519 as in RFC 8032", "recording_unsound")
def seal_malleable(s):
    """The seal's S is S + L: another file, the same signature to a lax check."""
    order = 2**252 + 27742317777372353535851937790883648493
    r = s.session("anna.cavum")
    raw = r.seal["signature"]
    r.seal["signature"] = raw[:32] + (int.from_bytes(raw[32:], "little") + order).to_bytes(32, "little")
    s.write(r, "m.cavum")
    return s.add("m.cavum")


@attack("recording", FOUND, "submits a session twice", "submitted_twice")
def filed_twice_other_bytes(s):
    """A filed session handed in again, in a file whose bytes differ (vacuumed, another page order)."""
    s.write(s.session("dora.cavum"), "m.cavum")
    import sqlite3
    db = sqlite3.connect(s.p("m.cavum"))
    db.execute("VACUUM")
    db.close()
    return s.add("m.cavum")


@attack("recording", FOUND, "more tables, triggers or views are damage", "error")
def recording_with_a_trigger(s):
    """A trigger, a view and a table more in the recording's file."""
    import sqlite3
    for sql in ("CREATE TABLE more (a)", "CREATE VIEW v AS SELECT 1", "CREATE TRIGGER t AFTER INSERT ON chunk BEGIN SELECT 1; END", "CREATE INDEX i ON chunk(ticks)"):
        s.write(s.session("anna.cavum"), "m.cavum")
        db = sqlite3.connect(s.p("m.cavum"))
        db.execute(sql)
        db.commit()
        db.close()
        s.must(s.run("verify", s.p("m.cavum")).rc != 0, "verify takes: " + sql)
    return s.add("m.cavum")


@attack("recording", FOUND, "the schema must match to the letter; STRICT tables", "error")
def recording_not_strict(s):
    """Tables without STRICT, and a TEXT where a BLOB belongs, a REAL where a whole number does, a NULL."""
    for column, value in (("inputs", "text"), ("ticks", 1000.5), ("state_hash", None)):
        r = s.session("anna.cavum")
        r.schema = [sql.replace(" STRICT", "").replace(", WITHOUT ROWID", " WITHOUT ROWID").replace(" NOT NULL", "") for sql in r.schema]
        r.chunks[1][column] = value
        s.write(r, "m.cavum")
        s.must(s.run("verify", s.p("m.cavum")).rc != 0, f"verify takes {column} = {value!r}")
    return s.add("m.cavum")


@attack("recording", FOUND, "a lying schema", "error recording_unsound")
def recording_schema_lies(s):
    """The schema's text is put back to STRICT by writable_schema after values of the wrong type were written."""
    import sqlite3
    r = s.session("anna.cavum")
    strict = r.schema
    r.schema = [sql.replace(") STRICT", ")") for sql in strict]
    r.chunks[1]["inputs"] = "text where a blob belongs"
    r.chunks[2]["first_tick"] = 2000.25
    s.write(r, "m.cavum")
    db = sqlite3.connect(s.p("m.cavum"))
    db.execute("PRAGMA writable_schema=ON")
    for old, new in zip(r.schema, strict):
        db.execute("UPDATE sqlite_master SET sql=? WHERE sql=?", (new, old))
    db.commit()
    db.close()
    s.run("replay", "--verify", s.p("m.cavum"))
    s.run("grade", s.p("m.cavum"))
    return s.add("m.cavum")
