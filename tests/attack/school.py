"""One small school with cheap recordings, built once; each attack works on a copy of it."""
import json
import os
import re
import shutil
import subprocess
import time
from datetime import datetime, timedelta, timezone

import ledger_format as lf
from session_format import Key, Session

QUICK_S = 3
TELL_KINDS = {("verify",), ("ledger", "verify"), ("ledger", "add"), ("ledger", "restore"), ("ledger", "cosign")}
CPU_LIMIT_S, WALL_LIMIT_S, MEMORY_LIMIT_KB = 5.0, 120, 1 << 20  # the wall only ends what waits for ever: machines are shared


class Result:
    """How one run of the program ended."""

    def __init__(self, args, rc, stdout, stderr, cpu, memory_kb, wall):
        self.args, self.rc, self.stdout, self.out, self.cpu, self.memory_kb, self.wall = args, rc, stdout, stdout + stderr, cpu, memory_kb, wall
        self.verb = " ".join([a for a in args[:2] if "/" not in a and not a.startswith("-")] + [a for a in args if a in ("--replay", "--receipt", "--results", "--cosigned", "--enrol")])

    def crash(self):
        if self.rc is None:
            return f"no end after {WALL_LIMIT_S} s"
        if self.rc < 0 or self.rc in (134, 136, 139):
            return f"killed by signal {-self.rc}"
        if "Sanitizer" in self.out or "runtime error:" in self.out or "terminate called" in self.out:
            return "sanitizer or uncaught exception"
        if self.cpu > CPU_LIMIT_S:
            return f"{self.cpu:.1f} s of processor time"
        if self.memory_kb > MEMORY_LIMIT_KB:
            return f"{self.memory_kb >> 10} MiB of memory"
        return ""

    def said(self, of="findings"):
        """What --json tells, of all sessions: findings, or what is not_checked, or remarks."""
        try:
            told = json.loads(self.stdout)
        except ValueError:
            return []
        return [f for part in [told, *told.get("sessions", [])] for f in part.get(of, [])]

    def kinds(self, of="findings"):
        return {f["group"] for f in self.said(of)}

    def first(self):
        """The first finding, or the first line of all."""
        if self.said():
            return "{kind}: {text}".format(**self.said()[0])
        lines = [l.strip() for l in self.out.splitlines() if l.strip()]
        found = [l for l in lines if l.startswith("- ")] or [l for l in lines if "cavum:" in l or "NOT" in l] or lines
        return found[0].removeprefix("- ") if found else ""


class School:
    """A folder with a school's home, its ledger, stations and recordings."""

    def __init__(self, cavum, data, folder):
        self.cavum, self.data, self.folder = cavum, data, folder
        self.home, self.L = f"{folder}/home", f"{folder}/L"
        self.results = []
        self.notes = []
        self.ask_kinds = False  # --json, where a verb tells its findings so

    def p(self, name):
        return f"{self.folder}/{name}"

    def run(self, *args, home=None, stdin=None, quiet=False):
        env = dict(os.environ, CAVUM_HOME=home or self.home, LC_ALL="C.UTF-8")
        args = [str(a) for a in args]
        if self.ask_kinds and ((args[0],) in TELL_KINDS or tuple(args[:2]) in TELL_KINDS) and "--json" not in args:
            args.append("--json")
        started = time.monotonic()
        with open(self.p(".out"), "wb") as out, open(self.p(".err"), "wb") as err:
            process = subprocess.Popen([self.cavum, *args], env=env, stdout=out, stderr=err, stdin=subprocess.DEVNULL, cwd=self.folder)
            rc = None
            while time.monotonic() - started < WALL_LIMIT_S:
                pid, status, usage = os.wait4(process.pid, os.WNOHANG)
                if pid:
                    rc = os.waitstatus_to_exitcode(status)
                    break
                time.sleep(0.004)
            if rc is None:
                process.kill()
                _, _, usage = os.wait4(process.pid, 0)
            process.returncode = 0 if rc is None else rc
        stdout, stderr = (open(self.p(name), "rb").read(1 << 20).decode("utf-8", "surrogateescape") for name in (".out", ".err"))
        result = Result(args, rc, stdout, stderr, usage.ru_utime + usage.ru_stime, usage.ru_maxrss, time.monotonic() - started)
        if not quiet:
            self.results.append(result)
        return result

    def ledger(self, verb, *args, **more):
        return self.run("ledger", verb, self.L, *args, **more)

    def add(self, name, *options):
        return self.ledger("add", self.p(name), *options)

    def needs(self, *args, **more):
        result = self.run(*args, **more)
        if result.rc != 0:
            raise RuntimeError(f"building the school: {' '.join(result.args)}: {result.out}")
        return result.out

    def copy_to(self, folder):
        shutil.copytree(self.folder, folder, symlinks=True)
        return School(self.cavum, self.data, folder)

    def school_key(self):
        return Key.read(f"{self.home}/school.key")

    def station(self, name="seat1"):
        return Key.read(self.p(f"{name}/station.key"))

    def session(self, name):
        return Session.read(self.p(name))

    def write(self, session, name):
        if os.path.exists(self.p(name)):
            os.remove(self.p(name))
        return session.write(self.p(name))

    def text(self, name, content, mode="w"):
        with open(self.p(name), mode, **({} if "b" in mode else {"encoding": "utf-8", "errors": "surrogateescape"})) as file:
            file.write(content)
        return self.p(name)

    def witness_path(self):
        return f"{self.home}/witness/{lf.Ledger(self.L).id}"

    def must(self, holds, what):
        """A promise beside the exit code: what does not hold is reported as a hole."""
        if not holds:
            self.notes.append(what)


def seat(school, name, seed=None):
    """A station's own folder, with a key that we know."""
    os.makedirs(school.p(name), mode=0o700)
    key = Key(seed or os.urandom(32))
    path = school.p(f"{name}/station.key")
    with open(os.open(path, os.O_WRONLY | os.O_CREAT, 0o600), "w") as file:
        file.write(f"cavum station key 1 (Ed25519 seed; keep secret): {key.seed.hex()}\n")
    if os.path.exists(f"{school.home}/school.pub"):
        shutil.copy(f"{school.home}/school.pub", school.p(name))
    return key


def invite(school, name, *options):
    return json.loads(school.needs("ledger", "station", school.L, "--invite", name, "--json", *options))["code"]


def enrol(school, name, key, devices=()):
    """Enrols by the request's format alone."""
    request = lf.station_request(school.school_key().hex, key, lf.code_key(invite(school, name)), devices)
    path = school.text(f"{name}.request", lf.json_text(request) + "\n")
    school.needs("ledger", "station", school.L, "--enrol", path)


def as_hand(session, key, seconds_ago, seal_key=None, source="device", device="Novint Falcon", serial="F-1"):
    """An operator's recording with the facts of a hand's device and the clocks of real time, chained and signed anew."""
    s = session.copy()
    for name in ("note.operator", "note.operator_seed"):
        s.facts.pop(name, None)
    s.facts.update(source=source, source_name=device, source_serial=serial)
    s.set_clocks(time.time_ns() - seconds_ago * 10**9, int(session.facts["created_boot_ns"]) - seconds_ago * 10**9)
    return s.rebuild(key, seal_key or key)


def hours(offset):
    return (datetime.now(timezone.utc) + timedelta(hours=offset)).strftime("%Y-%m-%dT%H:%MZ")


CLASS = [("4711", "Anna Ahrens"), ("4712", "Ben Behrens"), ("4713", "Cara Claus"), ("4714", "Dora Dirks"), ("4715", "Emil Ebert"), ("4716", "Finn Fuchs")]


def build(cavum, data, folder):
    """The school: stations seat1 (any stylus), seat2 (one Falcon), revoked, stranger; six candidates; recordings of all kinds."""
    os.makedirs(folder)
    s = School(cavum, data, folder)
    source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "replay", "block_cavity.toml")
    scenario = open(source, encoding="utf-8").read()
    s.text("quick.toml", re.sub(r"time_limit_s = \d+", f"time_limit_s = {QUICK_S}", scenario))
    s.text("long.toml", re.sub(r"time_limit_s = \d+", "time_limit_s = 600", scenario))
    s.text("corrected.toml", re.sub(r"pass_percent = \d+", "pass_percent = 5", re.sub(r"time_limit_s = \d+", f"time_limit_s = {QUICK_S}", scenario)))
    s.needs("ledger", "init", s.L, "--school", "School of Dentistry")
    for name in ("seat1", "seat2", "revoked", "stranger"):
        seat(s, name)
    enrol(s, "seat1", s.station("seat1"))
    enrol(s, "seat2", s.station("seat2"), [{"name": "Novint Falcon", "serial": "F-2"}])
    enrol(s, "revoked", s.station("revoked"))
    s.needs("ledger", "station", s.L, "--revoke", s.station("revoked").hex, "--reason", "stolen")
    s.text("class.csv", "id,name\n" + "".join(f"{i},{n}\n" for i, n in CLASS))
    s.needs("ledger", "ticket", s.L, s.p("quick.toml"), "--candidates", s.p("class.csv"), "--from", hours(-2), "--until", hours(20), "--out", s.p("tickets"))
    names = {c["id"]: c["pseudonym"] for c in identities(s)}
    for number, name in CLASS:
        shutil.copy(s.p(f"tickets/{names[number]}.ticket"), s.p(name.split()[0].lower() + ".ticket"))
    for seed, name in enumerate(["anna", "ben", "cara", "dora", "emil"], 1):
        s.needs("exam", s.p("quick.toml"), "--ticket", s.p(name + ".ticket"), "--operator", "expert" if name != "ben" else "novice",
                "--seed", str(seed), "--out", s.p(f"op_{name}.cavum"), "--quiet", home=s.p("seat1"))
    s.needs("exam", s.p("quick.toml"), "--candidate", "x", "--operator", "expert", "--out", s.p("op_x.cavum"), "--quiet", home=s.p("seat1"))
    key = s.station()
    for i, name in enumerate(["anna", "ben", "dora", "emil"]):
        as_hand(s.session(f"op_{name}.cavum"), key, 60 + 10 * i).write(s.p(f"{name}.cavum"))
    as_hand(s.session("op_x.cavum"), key, 200).write(s.p("x.cavum"))
    shutil.copytree(s.L, s.p("older"))
    shutil.copytree(f"{s.home}/witness", s.p("older_witness"))
    s.needs("ledger", "add", s.L, s.p("dora.cavum"), "--receipts", s.p("receipts"))
    s.needs("ledger", "add", s.L, s.p("op_cara.cavum"), "--simulated")
    s.needs("ledger", "regrade", s.L, "--session", str(lf.Ledger(s.L).find("session")), "--scenario", s.p("corrected.toml"), "--reason", "pass mark")
    s.needs("ledger", "release", s.L, "--all", "--undecided")
    s.needs("ledger", "export", s.L, "--format", "json", "--out", s.p("results.json"))
    s.needs("ledger", "backup", s.L, "--out", s.p("backup"), "--with-identities")
    os.makedirs(s.p("cosigner"), mode=0o700)
    s.needs("ledger", "checkpoint", s.L, "--since", "0", "--out", s.p("to-sign"))
    s.needs("ledger", "cosign", s.p("to-sign"), "--school-key", s.school_key().hex, "--name", "cosigner.example/one", "--out", s.p("cosigned"), home=s.p("cosigner"))
    cosigner = Key.read(s.p("cosigner/cosigner.key"))
    s.text("home/cosigners", lf.key_line("cosigner.example/one", 4, cosigner.public) + "\n")
    s.needs("ledger", "add-cosignature", s.L, s.p("cosigned"))
    return s


def identities(s):
    """Who is behind which pseudonym, from identities.db itself."""
    import sqlite3
    db = sqlite3.connect(f"{s.L}/identities.db")
    db.row_factory = sqlite3.Row
    rows = [dict(r) for r in db.execute("SELECT * FROM identity")]
    db.close()
    return rows
