"""What a recording says of itself: its ticket, what moved the stylus, what was examined. All signed anew by an enrolled station."""
import json
import re

import ledger_format as lf
from attacks_insider import insider
from kinds import ACCEPTED, FOUND, SURVIVES, UNSTATED, attack
from school import as_hand

TICKET = "sits with another tooth, rubric, force model or more time than promised: the ticket, on filing"
SOURCE = "hands in what no hand moved: the source of motion is signed at the beginning"


def ticket_of(r):
    return json.loads(r.facts["note.ticket"])


def own_scenario(r):
    return r.artifact("scenario.toml").decode()


@attack("claim", FOUND, TICKET, "ticket_artifact", "scenario.toml")
def easier_scenario(s):
    """The scenario gives full points from 10 % on; mark and hashes are made anew."""
    return insider(s, lambda r: r.set_artifact("scenario.toml", own_scenario(r).replace("full = 90", "full = 10").replace("zero = 60", "zero = 1").encode()))


@attack("claim", FOUND, TICKET, "ticket_artifact", "force_model.toml")
def softer_model(s):
    """The force model has one more line."""
    return insider(s, lambda r: r.set_artifact("force_model.toml", r.artifact("force_model.toml") + b"\n# softer\n"))


@attack("claim", FOUND, TICKET, "ticket_artifact", "bur_001")
def another_bur(s):
    """A bur of the tray has one more line."""
    return insider(s, lambda r: r.set_artifact("bur_001.toml", r.artifact("bur_001.toml") + b"\n# sharper\n"))


@attack("claim", FOUND, TICKET, "ticket_artifact", "rubric.toml")
def a_rubric_slipped_in(s):
    """A rubric of one's own beside the scenario's."""
    def change(r):
        rubric = own_scenario(r).split("[rubric]")[1].replace("[rubric.criteria]", "[criteria]").replace("[[rubric.criteria]]", "[[criteria]]").replace("zero = 60", "zero = 1")
        r.artifacts.insert(1, ["rubric.toml", rubric.encode()])
    return insider(s, change)


@attack("claim", FOUND, TICKET, "ticket_artifact", "attachment/")
def an_attachment_slipped_in(s):
    """An attachment that the ticket does not know, whose name leads out of the folder."""
    return insider(s, lambda r: r.artifacts.insert(len(r.artifacts) - 1, ["attachment/../../../planted.stl", b"solid x\nendsolid x\n"]))


@attack("claim", FOUND, "any change is found; artifacts in this order", "recording_unsound", "scenario.toml")
def an_artifact_twice(s):
    """Two scenarios in one recording: the promised one, and an easier one of the same name."""
    return insider(s, lambda r: r.artifacts.insert(1, ["scenario.toml", own_scenario(r).replace("full = 90", "full = 10").encode()]))


def resimulated(s, change):
    """An exam with other settings, simulated by the program itself: an empty recording is prepared and `--resume` fills it."""
    r = s.session("op_anna.cavum")
    change(r)
    r.chunks, r.events, r.result, r.seal = [], [], None, None
    r.artifacts = [a for a in r.artifacts if a[0] != "final_tooth.cvt"]
    s.write(r.rebuild(s.station()), "m.cavum")
    nonce = ticket_of(r)["ticket"]["nonce"]
    s.text("seat1/used_tickets", f"used {nonce} {r.facts['created_utc']} m.cavum\n")
    done = s.run("exam", "--resume", "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", home=s.p("seat1"))
    if done.rc != 0:
        return done
    r = s.session("m.cavum")
    if r.events and r.events[0]["kind"] == "gap":
        r.chunks = r.chunks[1:]
        r.events = r.events[1:]
        for i, c in enumerate(r.chunks):
            c["seq"] = i
        for i, e in enumerate(r.events):
            e["seq"], e["chunk"] = i, e["chunk"] - 1
        result = json.loads(r.result)
        result["notes"] = [note for note in result["notes"] if not note["kind"].startswith("interrupted")]  # a result says so
        r.result = json.dumps(result, ensure_ascii=False, separators=(",", ":"))
    s.write(as_hand(r, s.station(), 90), "m.cavum")
    return s.add("m.cavum")


@attack("claim", ACCEPTED, "the way of making it, with nothing changed, is taken")
def control_resimulated(s):
    """The prepared recording with nothing changed."""
    return resimulated(s, lambda r: None)


@attack("claim", FOUND, "the ticket promises scenario.toml, whose max_rpm is 200000; servo.toml, which says what was really used, is in no ticket", "exam_differs", "max_rpm")
def another_servo(s):
    """servo.toml has 400000 rpm, twice what the promised scenario allows, really simulated: 25 points instead of 14."""
    def change(r):
        r.set_artifact("servo.toml", re.sub(r"max_rpm = \d+", "max_rpm = 400000", r.artifact("servo.toml").decode()).encode())
    return resimulated(s, change)


@attack("claim", FOUND, TICKET + " (a tick of another length is more time)", "exam_differs", "tick_s")
def slower_tick(s):
    """servo.toml and tick_s say 10 ms, with clocks that fit: thirty seconds for an exam of three, 32 points instead of 14."""
    def change(r):
        servo = re.sub(r"watchdog_s = [\d.]+", "watchdog_s = 0.05", r.artifact("servo.toml").decode())
        r.set_artifact("servo.toml", re.sub(r"tick_s = [\d.]+", "tick_s = 0.01", servo).encode())
        r.facts["tick_s"] = "0.01"
    return resimulated(s, change)


@attack("claim", FOUND, TICKET, "ticket_accommodations")
def more_time_than_promised(s):
    """Extra time of 100 % that the ticket does not grant, really simulated."""
    return resimulated(s, lambda r: r.facts.update({"note.accommodation.extra_time_percent": "100"}))


@attack("claim", UNSTATED, "the first pose of the servo's state is a fact")
def begins_elsewhere(s):
    """The servo begins with the tip at another place than the scenario's stations do, really simulated."""
    return resimulated(s, lambda r: r.facts.update(first_tip_x_nm="500000", first_tip_z_nm="-300000"))


@attack("claim", FOUND, "simulated on filing; `verified` needs the same physics", "recording_unsound", "3")
def older_physics(s):
    """The recording says that physics version 3 simulated it, so that nobody may simulate it again."""
    return insider(s, lambda r: r.facts.update(physics_version="3"))


@attack("claim", FOUND, "simulated on filing; `verified` needs the same physics", "recording_unsound", "99999999999999999999")
def physics_of_the_future(s):
    """... version 99999999999999999999."""
    s.must(insider(s, lambda r: r.facts.update(physics_version="1000")).rc != 0, "physics version 1000 is taken")
    return insider(s, lambda r: r.facts.update(physics_version="99999999999999999999"))


@attack("claim", FOUND, "format n", "recording_unsound", "'2'")
def format_of_the_future(s):
    """The fact `format` says 2."""
    return insider(s, lambda r: r.facts.update(format="2"))


@attack("claim", FOUND, SOURCE, "no_hand", "expert")
def operator_is_not_filed(s):
    """An operator's recording without --simulated."""
    return s.add("op_anna.cavum")


@attack("claim", ACCEPTED, "--simulated files it as what it is")
def control_operator_filed_as_simulated(s):
    """... and with it; the release and the gradebook then know no student of that number."""
    done = s.add("op_anna.cavum", "--simulated")
    s.ledger("release", "--all", "--undecided")
    s.ledger("export", "--format", "moodle", "--with-simulated", "--out", s.p("g.csv"))
    s.must("4711" not in open(s.p("g.csv")).read(), "a simulated exam stands under a student's number")
    return done


@attack("claim", FOUND, SOURCE, "no_hand")
def every_source_but_a_hand(s):
    """pointer, practice, motion_file, program, and names that no page knows."""
    last = None
    for source in ("pointer", "practice", "motion_file", "program", "operator", "Device", "device ", "device\0", "", "hand", "dev\u0456ce"):
        def change(r):
            r.facts["source"] = source
        last = insider(s, change)
        s.must(last.rc != 0, f"source {source!r} is filed as a candidate's exam")
    return last


@attack("claim", FOUND, "a recording that does not say it is no candidate's exam", "no_hand")
def source_taken_out(s):
    """The three facts of the source are not there."""
    return insider(s, lambda r: [r.facts.pop(n) for n in ("source", "source_name", "source_serial")])


@attack("claim", FOUND, SOURCE, "no_hand", "expert")
def note_of_operator_left(s):
    """A hand's recording whose notes still name the operator and its seed."""
    return insider(s, lambda r: r.facts.update({"note.operator": "expert", "note.operator_seed": "1"}))


@attack("claim", FOUND, SOURCE, "no_hand", "practice")
def note_of_practice_left(s):
    """A hand's recording with a note of practice."""
    return insider(s, lambda r: r.facts.update({"note.practice": "yes"}))


@attack("claim", UNSTATED, "a device's name that stands for none")
def device_is_simulated(s):
    """source `device`, named as the simulated stylus is."""
    return insider(s, lambda r: r.facts.update(source_name="simulated"))


@attack("claim", FOUND, "makes a ticket up: the ledger, on filing", "ticket_other_school")
def ticket_self_signed(s):
    """A ticket of one's own with more time, signed with the station's key, which it names."""
    def change(r):
        t = ticket_of(r)["ticket"]
        t.update(public_key=s.station().hex)
        r.facts["note.ticket"] = lf.signed_ticket(t, s.station(), {"extra_time_percent": "100"})
    return insider(s, change)


@attack("claim", FOUND, "makes a ticket up: the ledger, on filing", "ticket_invalid")
def ticket_edited(s):
    """The ticket's end is two days later; the signature stays."""
    return insider(s, lambda r: r.facts.update({"note.ticket": re.sub(r'"not_after":"\d{4}', '"not_after":"2030', r.facts["note.ticket"])}))


@attack("claim", FOUND, "makes a ticket up; JSON text in one form", "ticket_invalid")
def ticket_key_twice(s):
    """`ticket` stands there twice: one that was signed, one that counts for a careless reader."""
    def change(r):
        signed = r.facts["note.ticket"]
        inner = json.loads(signed)["ticket"]
        for other in (dict(inner, nonce="00" * 16), dict(inner, not_after="2030-01-01T00:00:00Z")):
            r.facts["note.ticket"] = signed[:-1] + ',"ticket":' + lf.json_text(other) + "}"
    return insider(s, change)


@attack("claim", UNSTATED, "hash and check a text as it is stored")
def ticket_spaced(s):
    """The same ticket with spaces between its members: not the text that was signed."""
    return insider(s, lambda r: r.facts.update({"note.ticket": json.dumps(ticket_of(r), ensure_ascii=False, indent=1)}))


@attack("claim", FOUND, "under another's ticket", "ticket_candidate")
def ticket_of_another(s):
    """Anna's recording with Ben's ticket."""
    return insider(s, lambda r: r.facts.update({"note.ticket": s.session("ben.cavum").facts["note.ticket"]}))


@attack("claim", FOUND, "every exam that counts is promised by a ticket", "ticket_missing")
def ticket_taken_out(s):
    """No ticket."""
    return insider(s, lambda r: r.facts.pop("note.ticket") and None)


@attack("claim", FOUND, "uses a ticket twice: the ledger, on filing", "ticket_used", "18")
def ticket_used_twice(s):
    """Anna hands in one recording, then another sat with the same ticket."""
    s.must(s.add("anna.cavum").rc == 0, "the first is refused")
    r = s.session("emil.cavum")
    mine = s.session("anna.cavum")
    r.facts.update({"candidate": mine.facts["candidate"], "note.ticket": mine.facts["note.ticket"]})
    s.write(r.rebuild(s.station(), s.station()), "m.cavum")
    return s.add("m.cavum")


@attack("claim", FOUND, "begins twice with one ticket at a station: refused", "error")
def ticket_begun_twice(s):
    """The same ticket at the same station, another file."""
    return s.run("exam", s.p("quick.toml"), "--ticket", s.p("anna.ticket"), "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", home=s.p("seat1"))


@attack("claim", FOUND, "the ticket, at the station", "error", "scenario.toml")
def ticket_with_another_scenario(s):
    """At the station: Finn's ticket with another scenario, and with a model and extra time of one's own."""
    for more in (["--model", "paper"], ["--extra-time-percent", "10"], ["--left-handed"]):
        r = s.run("exam", s.p("quick.toml"), "--ticket", s.p("finn.ticket"), "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", *more, home=s.p("seat1"))
        s.must(r.rc != 0, f"the station takes {more}")
    return s.run("exam", s.p("long.toml"), "--ticket", s.p("finn.ticket"), "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", home=s.p("seat1"))


@attack("claim", SURVIVES, "a ticket's file is input")
def ticket_hostile(s):
    """Ticket files: deep nesting, huge numbers, NaN, control characters, a folder, nothing at all."""
    good = open(s.p("finn.ticket"), encoding="utf-8").read()
    cases = ["", "{", "[" * 200000, '{"ticket":' * 100000, good.replace('"nonce":"', '"nonce":1e999,"n":"'), good.replace('"nonce":"', '"nonce":NaN,"n":"'),
             good.replace('"exam":"block_cavity"', '"exam":"\u001b[2J\u202e../../x"'), good.replace('"candidate":"C-', '"candidate":"\\u001b]0;x\\u0007'), good + good]
    for case in cases:
        r = s.run("exam", s.p("quick.toml"), "--ticket", s.text("m.ticket", case), "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", home=s.p("seat1"))
        s.must(r.rc != 0, f"taken: {case[:60]!r}")
    return r
