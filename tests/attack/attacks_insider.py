"""Recordings by somebody who has an enrolled station's key: everything is chained, hashed and signed anew."""
import json

from kinds import ACCEPTED, FOUND, NOBODY, UNSTATED, attack
from session_format import encode_removed, decode_removed, pack, unpack

MARK = "the school's own mark is the one that counts; what differs is named as tampering"
REPLAY = "simulating the inputs gives every record, every removed leaf, every second's state and the final tooth again"
KEYHOLDER = "runs a changed program on a station whose key he has: nobody"


def insider(s, change, name="anna.cavum", *options, also=()):
    """The recording with the change, wholly signed anew by seat 1, handed in."""
    r = s.session(name)
    change(r)
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    for args in also:
        found = s.run(*args, s.p("m.cavum"))
        s.must(found.rc != 0, f"`cavum {' '.join(args)}` finds nothing")
    return s.add("m.cavum", *options)


def renumber(r):
    for i, e in enumerate(r.events):
        e["seq"] = i


@attack("insider", FOUND, MARK, "result_differs")
def forged_result(s):
    """Points 100 and a pass in the sealed result, signed by the station itself."""
    def change(r):
        result = json.loads(r.result)
        result["verdict"], result["score"]["points"] = "pass", 100.0
        r.result = json.dumps(result, ensure_ascii=False, separators=(",", ":"))
    return insider(s, change)


@attack("insider", FOUND, MARK, "result_differs")
def forged_criterion(s):
    """Only one criterion's reason and points in the sealed result are better."""
    def change(r):
        result = json.loads(r.result)
        result["criteria"][1]["points"] += 0.001
        r.result = json.dumps(result, ensure_ascii=False, separators=(",", ":"))
    return insider(s, change)


@attack("insider", FOUND, MARK, "result_differs", " 7")
def forged_result_of_another_grading(s):
    """The forged result says that grading version 7 gave it."""
    def change(r):
        result = json.loads(r.result)
        result["verdict"], result["score"]["points"], result["grading_version"] = "pass", 100.0, 7
        r.result = json.dumps(result, ensure_ascii=False, separators=(",", ":"))
    return insider(s, change)


@attack("insider", FOUND, REPLAY, "recording_unsound")
def forged_forces(s):
    """All forces of one second are lower, so that no peak is seen."""
    def change(r):
        c = r.records(1)
        c[3] = [v // 2 for v in c[3]]
        r.set_records(1, c)
    return insider(s, change, also=[("replay", "--verify"), ("verify",)])


@attack("insider", FOUND, REPLAY, "recording_unsound")
def forged_removed_leaves(s):
    """One removed leaf is said to lie elsewhere."""
    def change(r):
        c = r.chunks[1]
        counts, axes, tissues = decode_removed(unpack(c["removed"]), c["ticks"])
        axes[2][0] += 1
        c["removed"] = pack(encode_removed(counts, axes, tissues))
    return insider(s, change, also=[("replay", "--verify")])


@attack("insider", FOUND, REPLAY, "recording_unsound")
def forged_tissue(s):
    """A removed leaf of enamel is said to have been dentin."""
    def change(r):
        c = r.chunks[1]
        counts, axes, tissues = decode_removed(unpack(c["removed"]), c["ticks"])
        tissues[0] ^= 3
        c["removed"] = pack(encode_removed(counts, axes, tissues))
    return insider(s, change, also=[("replay", "--verify")])


@attack("insider", FOUND, REPLAY, "recording_unsound")
def forged_final_tooth(s):
    """The final tooth is Dora's better one."""
    return insider(s, lambda r: r.set_artifact("final_tooth.cvt", s.session("dora.cavum").artifact("final_tooth.cvt")), also=[("replay", "--verify")])


@attack("insider", FOUND, REPLAY, "recording_unsound")
def forged_state_hash(s):
    """One second's state is another."""
    return insider(s, lambda r: r.chunks[1].update(state_hash=r.chunks[1]["state_hash"] ^ 1), also=[("replay", "--verify")])


@attack("insider", FOUND, "leaves out, adds or moves an event of the exam: the events come from the motion", "exam_differs")
def event_left_out(s):
    """The event that the time was up is left out."""
    def change(r):
        r.events = [e for e in r.events if e["kind"] != "time_limit"]
        renumber(r)
    return insider(s, change)


@attack("insider", FOUND, "leaves out, adds or moves an event of the exam: the events come from the motion", "exam_differs")
def event_added(s):
    """An event says that the step was completed."""
    def change(r):
        last = r.events[-1]
        r.events.insert(1, dict(last, kind="step_completed", detail_json='{"step":0}', tick=last["tick"] - 5))
        renumber(r)
    return insider(s, change)


@attack("insider", FOUND, "leaves out, adds or moves an event of the exam: the events come from the motion", "exam_differs")
def event_moved(s):
    """The exam is said to have ended 200 ticks earlier."""
    return insider(s, lambda r: [e.update(tick=e["tick"] - 200) for e in r.events[1:]])


@attack("insider", FOUND, "any other kind, member or way of writing is damage", "recording_unsound")
def event_of_unknown_kind(s):
    """An event `examiner_excused` with a text for people."""
    def change(r):
        r.events.insert(1, dict(r.events[0], kind="examiner_excused", detail_json='{"why":"all is well"}', tick=5))
        renumber(r)
    return insider(s, change)


@attack("insider", FOUND, REPLAY, "recording_unsound")
def spliced_second_half(s):
    """The first second is Anna's, the rest Dora's, with Dora's final tooth and result."""
    other = s.session("dora.cavum")

    def change(r):
        for i in (1, 2):
            for n in ("inputs", "records", "removed", "state_hash"):
                r.chunks[i][n] = other.chunks[i][n]
        r.set_artifact("final_tooth.cvt", other.artifact("final_tooth.cvt"))
        r.result = other.result
    return insider(s, change, also=[("replay", "--verify")])


@attack("insider", FOUND, REPLAY, "recording_unsound")
def truncated_and_sealed(s):
    """The last second is gone and the seal made anew over what is left, events too."""
    def change(r):
        r.chunks.pop()
        for e in r.events:
            e["chunk"], e["tick"] = min(e["chunk"], 1), min(e["tick"], 1999)
    return insider(s, change, also=[("replay", "--verify")])


@attack("insider", FOUND, REPLAY, "recording_unsound")
def stretched_in_time(s):
    """Every pose of one second is held twice as long."""
    def change(r):
        first, then = r.inputs(1), r.inputs(2)
        for column in range(10):
            both = first[column] + then[column]
            first[column], then[column] = [v for v in both[:500] for _ in (0, 1)], [v for v in both[500:1000] for _ in (0, 1)]
        r.set_inputs(1, first)
        r.set_inputs(2, then)
    return insider(s, change, also=[("replay", "--verify")])


@attack("insider", FOUND, "chunk: meta.tick_s is the length of a tick; any change is found; simulating gives everything again", "recording_unsound")
def another_tick_length(s):
    """The fact tick_s says half a millisecond: the exam took half as long."""
    return insider(s, lambda r: r.facts.update(tick_s="0.0005"))


@attack("insider", NOBODY, KEYHOLDER)
def anothers_motion_under_own_ticket(s):
    """Dora's motion, already filed, is handed in by Anna under Anna's own ticket, with other clocks."""
    mine = s.session("anna.cavum")

    def change(r):
        r.facts["candidate"], r.facts["note.ticket"] = mine.facts["candidate"], mine.facts["note.ticket"]
        r.set_clocks(int(mine.facts["created_utc_ns"]), int(mine.facts["created_boot_ns"]))
    return insider(s, change, "dora.cavum")


@attack("insider", FOUND, "makes an exam up faster than time: the clocks of every second are findings", "clock")
def made_up_faster_than_time(s):
    """An operator's recording is only renamed to a hand's; its clocks are those of the simulation."""
    def change(r):
        for n in ("note.operator", "note.operator_seed"):
            del r.facts[n]
        r.facts.update(source="device", source_name="Novint Falcon", source_serial="F-1")
    return insider(s, change, "op_anna.cavum")


def clocks(s, change):
    return insider(s, lambda r: change(r))


@attack("insider", FOUND, "with clocks that do not fit one another", "clock")
def clocks_disagree(s):
    """The boot clock shows 20 s more than the monotonic and the wall clock."""
    return insider(s, lambda r: [c.update(boot_ns=c["boot_ns"] + 20 * 10**9) for c in r.chunks[1:]])


@attack("insider", FOUND, "with clocks that do not fit one another", "clock")
def clocks_run_backwards(s):
    """The last second was complete before the second before it."""
    def change(r):
        for n in ("utc_ns", "boot_ns", "monotonic_ns"):
            r.chunks[2][n] = r.chunks[1][n] - 5 * 10**8
    return insider(s, change)


@attack("insider", FOUND, "time that the recording does not own up to is a finding", "clock")
def pause_not_owned_up_to(s):
    """40 s pass between two seconds, and no gap is noted."""
    def change(r):
        for c in r.chunks[1:] + [r.seal]:
            for n in ("utc_ns", "boot_ns", "monotonic_ns"):
                c[n] += 40 * 10**9
    return insider(s, change)


@attack("insider", FOUND, "sets the station's clock against the ledger's: findings", "clock")
def recorded_in_the_future(s):
    """All clocks are three hours ahead, within the ticket's time."""
    return insider(s, lambda r: r.set_clocks(int(r.facts["created_utc_ns"]) + 3 * 3600 * 10**9, int(r.facts["created_boot_ns"])))


@attack("insider", FOUND, "outside the hours: the ticket, on filing", "ticket_time")
def begun_before_the_hours(s):
    """Begun three hours before the ticket's time."""
    return insider(s, lambda r: r.set_clocks(int(r.facts["created_utc_ns"]) - 5 * 3600 * 10**9, int(r.facts["created_boot_ns"])))


@attack("insider", FOUND, "more than a day after its ticket's time and its own end is a finding", "handed_in_late")
def handed_in_days_later(s):
    """A ticket of three days ago, and a recording whose clocks were set to it."""
    import school
    s.needs("ledger", "ticket", s.L, s.p("quick.toml"), "--candidate", "4799", "--from", school.hours(-80), "--until", school.hours(-70), "--out", s.p("old.ticket"))

    def change(r):
        ticket = open(s.p("old.ticket"), encoding="utf-8").read().strip()
        r.facts.update({"note.ticket": ticket, "candidate": json.loads(ticket)["ticket"]["candidate"]})
        r.set_clocks(int(r.facts["created_utc_ns"]) - 75 * 3600 * 10**9, int(r.facts["created_boot_ns"]))
    return insider(s, change)


@attack("insider", UNSTATED, "created_utc and created_utc_ns say the same twice")
def two_beginnings(s):
    """created_utc names another moment than created_utc_ns."""
    return insider(s, lambda r: r.facts.update(created_utc="2026-01-01T00:00:00Z"))
