"""Stations' requests and codes, the register of stations, keys on disk."""
import json
import os
import shutil
import time

import ledger_format as lf
import school
from kinds import ACCEPTED, FOUND, SURVIVES, UNSTATED, attack
from session_format import Key

CODE = "enrols a station of his own: a one-time code, which the office gives, signs the station's request"


def ask(s, request, name="m.request"):
    path = s.text(name, (request if isinstance(request, str) else lf.json_text(request)) + "\n")
    return s.ledger("station", "--enrol", path)


def fresh():
    return Key(os.urandom(32))


@attack("station", ACCEPTED, "a request of our own making is taken")
def control_enrolled(s):
    """A code, a key, a request by the page; then the program's own request is compared with ours."""
    code = school.invite(s, "Compared")
    shutil.copytree(s.p("stranger"), s.p("fresh"))
    s.needs("station", "--enrol", code, "--out", s.p("theirs"), home=s.p("fresh"))
    theirs = json.loads(open(s.p("theirs")).read())
    ours = lf.station_request(s.school_key().hex, s.station("fresh"), lf.code_key(code), made=theirs["request"]["made_utc_ns"])
    s.must(ours == theirs, "our request is another")
    return ask(s, ours)


@attack("station", FOUND, CODE, "error")
def without_a_code(s):
    """A code that nobody gave."""
    return ask(s, lf.station_request(s.school_key().hex, fresh(), lf.code_key("S-0000-0000-0000-0000-0000")))


@attack("station", FOUND, "a code is good once", "error")
def code_used_twice(s):
    """The same code for a second station; the same request a second time."""
    code = school.invite(s, "Twice")
    first = lf.station_request(s.school_key().hex, fresh(), lf.code_key(code))
    s.must(ask(s, first).rc == 0, "the first is refused")
    s.must(ask(s, first).rc != 0, "the same request is taken twice")
    return ask(s, lf.station_request(s.school_key().hex, fresh(), lf.code_key(code)))


@attack("station", FOUND, CODE, "error")
def request_edited(s):
    """Devices, school or key are edited after the signature; a signature is missing; both are the same; of another text."""
    last = None
    code = school.invite(s, "Edited")

    def made(**more):
        more = dict({"devices": [{"name": "Novint Falcon", "serial": "F-9"}], "school": s.school_key().hex}, **more)
        school_hex, devices = more.pop("school"), more.pop("devices")
        return lf.station_request(school_hex, fresh(), lf.code_key(code), devices, **more)

    def tried(what, request):
        nonlocal last
        last = ask(s, request)
        s.must(last.rc != 0, what + " is taken")
    r = made()
    r["request"]["devices"] = []
    tried("devices edited", r)
    r = made()
    r["request"]["public_key"] = s.station("stranger").hex
    tried("key edited", r)
    r = made()
    del r["code_signature"]
    tried("no signature of the code", r)
    r = made()
    del r["signature"]
    tried("no signature of the station", r)
    r = made()
    r["signature"] = r["code_signature"]
    tried("one signature for both", r)
    tried("another school", made(school="00" * 32))
    tried("another format", made(format="cavum station request 2"))
    r = made()
    r["old_signature"] = r.pop("code_signature")
    tried("the code as an old key", r)
    text = lf.json_text(made())
    tried("a member twice", text[:-1] + ',"request":' + lf.json_text(made(devices=[])["request"]) + "}")
    return last


@attack("station", UNSTATED, "{request, signature, and code_signature or old_signature}")
def request_signed_both_ways(s):
    """A request with both, a code's signature and (the same as) an old key's."""
    r = lf.station_request(s.school_key().hex, fresh(), lf.code_key(school.invite(s, "Both")))
    r["old_signature"] = r["code_signature"]
    return ask(s, r)


@attack("station", FOUND, "somebody else's key", "error")
def key_of_another_station(s):
    """A second name for a key that is enrolled already; a request that names seat 1's key without its signature."""
    code = school.invite(s, "Second name")
    r = lf.station_request(s.school_key().hex, s.station("seat1"), lf.code_key(code))
    r["signature"] = fresh().sign(b"x").hex()
    s.must(ask(s, r).rc != 0, "another's key is enrolled without its signature")
    return ask(s, lf.station_request(s.school_key().hex, s.station("seat1"), lf.code_key(code)))


@attack("station", FOUND, "one that was revoked is not good for anything that comes in later", "error")
def revoked_key_again(s):
    """The revoked key asks again, with a new code; then asks to be replaced."""
    code = school.invite(s, "Again")
    replace = lf.station_request(s.school_key().hex, fresh(), s.station("revoked"), replaces=True)
    s.must(ask(s, replace).rc != 0, "a revoked key appoints its successor")
    return ask(s, lf.station_request(s.school_key().hex, s.station("revoked"), lf.code_key(code)))


@attack("station", FOUND, "a replacement is signed by the old key", "error")
def replaced_by_a_stranger(s):
    """A stranger asks to take the place of a key that nobody enrolled, and of seat 1's without its signature."""
    s.must(ask(s, lf.station_request(s.school_key().hex, fresh(), s.station("stranger"), replaces=True)).rc != 0, "a key that nobody enrolled is replaced")
    r = lf.station_request(s.school_key().hex, fresh(), s.station("seat1"), replaces=True)
    r["old_signature"] = s.station("stranger").sign(b"x").hex()
    return ask(s, r)


@attack("station", UNSTATED, "devices of a replacement")
def replacement_widens_devices(s):
    """Seat 2, enrolled for one stylus, replaces its key by a request that names no device: any stylus."""
    return ask(s, lf.station_request(s.school_key().hex, fresh(), s.station("seat2"), replaces=True))


@attack("station", FOUND, "only recordings of the stylus that was enrolled count", "device_other", "F-OTHER")
def widened_devices_used(s):
    """... and then a recording with another stylus is handed in under the new key."""
    from school import as_hand
    key = fresh()
    ask(s, lf.station_request(s.school_key().hex, key, s.station("seat2"), replaces=True))
    s.write(as_hand(s.session("op_anna.cavum"), key, 30, serial="F-OTHER"), "m.cavum")
    return s.add("m.cavum")


@attack("station", ACCEPTED, "a key that was replaced is good for a day more")
def control_replaced(s):
    """Seat 1 replaces its key; its older recording is still filed."""
    s.must(ask(s, lf.station_request(s.school_key().hex, fresh(), s.station("seat1"), replaces=True)).rc == 0, "the replacement is refused")
    return s.add("anna.cavum")


@attack("station", UNSTATED, "a key that was replaced asks for another replacement within its day")
def replaced_key_appoints_again(s):
    """The old key appoints a second successor."""
    s.must(ask(s, lf.station_request(s.school_key().hex, fresh(), s.station("seat1"), replaces=True)).rc == 0, "the replacement is refused")
    return ask(s, lf.station_request(s.school_key().hex, fresh(), s.station("seat1"), replaces=True))


@attack("station", FOUND, "good once, up to its until_utc_ns", "error")
def code_ran_out(s):
    """A code whose time is over."""
    r = s.ledger("station", "--invite", "Late", "--until", time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(time.time() + 1)), "--json")
    if r.rc != 0:
        return r
    code = json.loads(r.out)["code"]
    time.sleep(1.5)
    return ask(s, lf.station_request(s.school_key().hex, fresh(), lf.code_key(code), made=time.time_ns() - 10**10))


@attack("station", FOUND, "an Ed25519 key is one", "error")
def small_order_key(s):
    """A station key of small order, under which one signature holds for every text; and one that is no point."""
    code = school.invite(s, "Small")
    last = None
    for public in ("01" + "00" * 31, "00" * 32, "ec" + "ff" * 30 + "7f", "ff" * 32, "c7176a703d4dd84fba3c0b760d10670f2a2053fa2c39ccc64ec7fd7792ac037a"):
        for signature in ("01" + "00" * 63, public + "00" * 32):
            request = {"format": "cavum station request 1", "school": s.school_key().hex, "public_key": public, "by": lf.code_key(code).hex, "made_utc_ns": time.time_ns(), "devices": []}
            message = b"CVENROL1" + lf.json_text(request).encode()
            last = ask(s, {"request": request, "signature": signature, "code_signature": lf.code_key(code).sign(message).hex()})
            s.must(last.rc != 0, f"the key {public[:8]}… is enrolled: anybody's signature holds under it")
    return last


@attack("station", SURVIVES, "requests are input")
def request_of_many_devices(s):
    """A request of 600 kB: 200000 empty devices, unsigned. The office reads it."""
    code = school.invite(s, "Many")
    good = lf.json_text(lf.station_request(s.school_key().hex, fresh(), lf.code_key(code)))
    return ask(s, good.replace('"devices":[]', '"devices":[' + "{}," * 200_000 + "{}]"))


@attack("station", SURVIVES, "requests are input")
def requests_hostile(s):
    """Nested deep, 1e999, huge numbers, a pipe, hostile names."""
    code = school.invite(s, "Hostile")
    good = lf.json_text(lf.station_request(s.school_key().hex, fresh(), lf.code_key(code)))
    last = None
    for text in ("[" * 200000, '{"request":' * 100000, good.replace('"devices":[]', '"devices":1e999'), good.replace('"made_utc_ns":1', '"made_utc_ns":99999999999991'),
                 "", "\0", good + good, good.replace('"request"', '"\\u0000request"')):
        last = ask(s, text)
        s.must(last.rc != 0, f"taken: {text[:50]}")
    os.mkfifo(s.p("pipe"))
    last = s.ledger("station", "--enrol", s.p("pipe"))
    for made in (2**63 - 1, -2**63, 0):
        r = lf.station_request(s.school_key().hex, fresh(), lf.code_key(code), made=made or 1)
        ask(s, r)
        s.ledger("verify")
    return last


@attack("station", FOUND, "the station refuses: station.key.enrolled remembers", "error")
def lost_key_made_anew(s):
    """The key of an enrolled station is removed; the next exam must not begin with a new one."""
    shutil.copytree(s.p("stranger"), s.p("fresh"))
    s.needs("station", "--enrol", school.invite(s, "Loses"), "--out", s.p("theirs"), home=s.p("fresh"))
    os.remove(s.p("fresh/station.key"))
    return s.run("exam", s.p("quick.toml"), "--candidate", "x", "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", home=s.p("fresh"))


@attack("station", SURVIVES, "keys on disk are input")
def key_files_hostile(s):
    """station.key as pipe, folder, endless device, rubbish, another kind of key, with mode 0666."""
    last = None
    path = s.p("stranger/station.key")
    good = open(path).read()
    for make in (os.mkfifo, os.makedirs, lambda p: os.symlink("/dev/zero", p), lambda p: open(p, "wb").write(os.urandom(200)), lambda p: open(p, "w").write(good.replace("station", "school")),
                 lambda p: open(p, "w").write(good.strip()[:-1] + "g\n")):
        os.rmdir(path) if os.path.isdir(path) and not os.path.islink(path) else os.path.lexists(path) and os.remove(path)
        make(path)
        last = s.run("exam", s.p("quick.toml"), "--candidate", "x", "--operator", "expert", "--out", s.p("m.cavum"), "--quiet", home=s.p("stranger"))
        s.must(last.rc != 0, "an exam begins with such a key")
    return last
