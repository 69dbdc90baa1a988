"""schemas_test.py CAVUM SOURCE: the JSON Schemas of data/schemas say what the program reads and writes, no more and no less.

Scenario: what ships, all templates, and one of each shape are valid. Each is then changed at every value that the schema names: what the schema refuses
`cavum scenario check` refuses too, and the ends of each range are taken by both.
Result and ticket: what the program writes is valid, and has no name that the schema lacks.
"""
import copy
import json
import os
import re
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

from jsonschema import Draft202012Validator

CAVUM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])


def cavum(*arguments, **more):
    return subprocess.run([CAVUM, *map(str, arguments)], capture_output=True, text=True, **more)


SCHEMAS = {name: json.loads((SOURCE / f"data/schemas/{name}.schema.json").read_text()) for name in ("result", "ticket")}
SCHEMAS["scenario"] = json.loads(cavum("scenario", "schema").stdout)

# What fields of bodies take that are neither a number nor a word.
VALUES = {"at_mm": [0, 0, 4], "size_mm": [1, 2, 3], "axis": [0, 0.1, 1], "tissue": "pulp", "file": "cavity.stl", "bottom": {"kind": "level", "z_mm": 2},
          "outline": {"kind": "circle", "radius_mm": 1, "centre_mm": [0, 4], "from": "tooth", "offset_mm": 0}}


def one_of(branch):
    """A body of one kind, with all its fields."""
    fields = branch["then"]["properties"].items()
    return {"shape": branch["if"]["properties"]["shape"]["const"]} | {
        key: VALUES[key] if key in VALUES else s["enum"][0] if "enum" in s else (s["minimum"] + s["maximum"]) / 2 for key, s in fields if s is not True}


# One of each shape, and of each outline and bottom that no task of ours uses.
SHAPES = [one_of(branch) for branch in SCHEMAS["scenario"]["$defs"]["shape"]["allOf"]] + [
    {"shape": "ball", "at_mm": [0, 0, 4], "radius_mm": 1, "combine": "intersect"},
    {"shape": "prism", "at_mm": [0, 0, 4], "height_mm": 1, "axis": [0, 0, 1], "turn_deg": 5,
     "outline": {"kind": "polygon", "points_mm": [[0, 0], [1, 0], [0, 1]], "centre_mm": [0, 0], "from": "tooth", "offset_mm": 0.1}},
    {"shape": "column", "outline": {"kind": "stroke", "points_mm": [[0, 0], [1, 0]], "width_mm": 1}, "bottom": {"kind": "below_mean", "depth_mm": 2}},
    {"shape": "column", "outline": {"kind": "projection", "tissue": "pulp", "part": "all", "rounding_mm": 0.1, "offset_mm": 0.1},
     "bottom": {"kind": "tissue_roof", "tissue": "pulp", "part": "chamber", "deeper_mm": 0.1}},
    {"shape": "column", "outline": {"kind": "fissure", "width_mm": 1.2, "ridge_mm": 1.5, "branches": "all", "through": "mesial", "offset_mm": 0},
     "bottom": {"kind": "below_border", "depth_mm": 0.2}},
]


def toml(value):
    """Of a value: inline, as TOML allows everywhere."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(v)}" for key, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value)


def toml_file(scenario):
    return "".join(f"{key} = {toml(value)}\n" for key, value in scenario.items())


def errors_of(scenario):
    """What the program says is wrong: [(kind, what)]."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "task.toml"
        path.write_text(toml_file(scenario))
        said = cavum("scenario", "check", path, "--json")
        return [(p["kind"], p["what"]) for p in json.loads(said.stdout)["problems"] if p["severity"] == "error"]


def resolved(schema):
    """What holds at a place: the members of $ref beside its own."""
    while "$ref" in schema:
        rest = {key: value for key, value in schema.items() if key != "$ref"}
        target = SCHEMAS["scenario"]["$defs"][schema["$ref"].rsplit("/", 1)[1]]
        schema = {**target, **rest}
    return schema


def members(schema, value):
    """The properties of an object, of those kinds that it is one of."""
    found = dict(schema.get("properties", {}))
    required = list(schema.get("required", []))
    for branch in schema.get("allOf", []):
        if Draft202012Validator({**branch["if"], "$defs": SCHEMAS["scenario"]["$defs"]}).is_valid(value):
            found.update({k: v for k, v in branch["then"].get("properties", {}).items() if v is not True})
            required += branch["then"].get("required", [])
    return found, required


def places(schema, value, path=()):
    """Every place that the schema names and the scenario has: (path, its schema), and ("required", path, key)."""
    schema = resolved(schema)
    if isinstance(value, dict):
        found, required = members(schema, value)
        for key in required:
            yield "required", path + (key,), None
        yield "object", path, None
        for key, item in value.items():
            named = [s for pattern, s in schema.get("patternProperties", {}).items() if re.search(pattern, key)]
            yield from places(found[key] if key in found else named[0] if named else schema["additionalProperties"], item, path + (key,))
    elif isinstance(value, list) and "items" in schema:
        yield "list", path, schema
        for i, item in enumerate(value[:2]):
            yield from places(schema["items"], item, path + (i,))
    else:
        yield "value", path, schema


def changed(scenario, path, value):
    copied = copy.deepcopy(scenario)
    at = copied
    for step in path[:-1]:
        at = at[step]
    if value is None:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return copied


def value_at(scenario, path):
    for step in path:
        scenario = scenario[step]
    return scenario


def spoilt(scenario):
    """(what was done, the scenario changed so that the schema refuses it)."""
    for kind, path, schema in places(SCHEMAS["scenario"], scenario):
        if kind == "required":
            yield f"without {path}", changed(scenario, path, None)
        elif kind == "object":
            yield f"unknown key in {path}", changed(scenario, path + ("unheard_of",), 1)
        elif kind == "list":
            items = value_at(scenario, path)
            yield f"no list in {path}", changed(scenario, path, 7)
            if "maxItems" in schema and items:
                yield f"too many in {path}", changed(scenario, path, items + items[-1:] * (schema["maxItems"] + 1 - len(items)))
            if schema.get("minItems"):
                yield f"too few in {path}", changed(scenario, path, items[: schema["minItems"] - 1])
        else:
            yield f"another type in {path}", changed(scenario, path, [[1]])
            for bound, step in (("minimum", -1), ("maximum", 1)):
                if bound in schema:
                    limit = schema[bound]
                    beyond = limit + step if schema["type"] == "integer" else limit + step * max(abs(limit) * 1e-6, 1e-6)
                    yield f"beyond the {bound} in {path}", changed(scenario, path, beyond)
            if "exclusiveMinimum" in schema:
                yield f"at the open end in {path}", changed(scenario, path, schema["exclusiveMinimum"])
            if "enum" in schema:
                yield f"another word in {path}", changed(scenario, path, "unheard of")
            if "maxLength" in schema:
                yield f"too long in {path}", changed(scenario, path, "x" * (schema["maxLength"] + 1))
            if schema.get("pattern") == "\\S":
                yield f"empty in {path}", changed(scenario, path, " ")
            elif "pattern" in schema:
                yield f"not of the pattern in {path}", changed(scenario, path, "Not/So")


def at_the_ends(scenario):
    """(paths, the scenario with the last values that the schema takes there): all minima at once, all maxima at once, and each word."""
    values = [(path, schema) for kind, path, schema in places(SCHEMAS["scenario"], scenario) if kind == "value"]
    for bound in ("minimum", "maximum"):
        ends = scenario
        for path, schema in values:
            if bound in schema:
                ends = changed(ends, path, schema[bound])
        yield [path for path, schema in values if bound in schema], ends
    for path, schema in values:
        for word in schema.get("enum", []):
            yield [path], changed(scenario, path, word)


class Scenarios(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.valid = Draft202012Validator(SCHEMAS["scenario"])
        cls.shipped = {path.name: tomllib.loads(path.read_text()) for path in sorted((SOURCE / "data/scenarios").glob("*.toml"))}
        full = copy.deepcopy(cls.shipped["molar_access.toml"])
        full["tooth"] = "nowhere.cvt"  # so that the program stops after reading
        full["zones"]["target"] += SHAPES[:-1]
        full["zones"]["protected"] = SHAPES[-1:]
        full["pauses"] = {"count": 1, "longest_s": 60, "button": 2}
        full["gauges"] = ["speed"]
        full["hold_results"] = True
        full["careless"] = {"fails_by": "perforation", "sides_mm": -0.5, "bottom_mm": 0.5, "opening_percent": 50, "perforates": True}
        full["steps"][0].update({"fail_when": "force_n > 50", "time_limit_s": 60, "failure_ends_exam": False})
        full["accommodations"] = {"extra_time_percent": 25, "extra_time_s": 60, "left_handed": True, "high_contrast": False}
        full["rubric"]["criteria"][1]["critical_below"] = -1
        full["rubric"]["open_step_passes"] = True
        full["rubric"]["review_within_bound"] = True
        full["rubric"]["bands"] = [{"name": "acceptable"}, {"name": "marginal", "most": 2}, {"name": "critical", "most": 0}]
        criterion = full["rubric"]["criteria"][1]
        criterion["bands"] = [criterion["full"] + share * (criterion["zero"] - criterion["full"]) for share in (0.25, 0.5)]
        cls.full, cls.errors_of_full = full, set(errors_of(full))

    def test_what_ships_is_valid(self):
        for name, scenario in self.shipped.items():
            with self.subTest(name):
                self.assertEqual([], [e.message for e in self.valid.iter_errors(scenario)])

    def test_templates_are_valid(self):
        for tooth, task in (("molar", "access"), ("molar", "class_2_mesial"), ("premolar", "access"), ("incisor", "access"), ("carious_molar", "lesion"), ("block", "cross")):
            with self.subTest(f"{tooth} {task}"), tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "new.toml"
                self.assertEqual(0, cavum("scenario", "new", "--tooth", tooth, "--task", task, "--out", path).returncode)
                self.assertEqual([], [e.message for e in self.valid.iter_errors(tomllib.loads(path.read_text()))])

    def test_one_of_everything_is_valid_and_known_to_the_program(self):
        self.assertEqual([], [e.message for e in self.valid.iter_errors(self.full)])
        unknown = [what for kind, what in errors_of(self.full | {"unheard_of": 1}) if kind == "unknown_key"]
        self.assertEqual([True], ["'unheard_of'" in what for what in unknown])

    def test_every_name_of_the_schema_is_tried(self):
        """Else a name could be in the schema that the program does not know."""
        def names(schema):
            if isinstance(schema, dict):
                if isinstance(schema.get("properties"), dict):
                    yield from schema["properties"]
                for item in schema.values():
                    yield from names(item)
            elif isinstance(schema, list):
                for item in schema:
                    yield from names(item)

        def keys(value):
            if isinstance(value, dict):
                yield from value
            for item in value.values() if isinstance(value, dict) else value if isinstance(value, list) else []:
                yield from keys(item)
        self.assertEqual(set(), set(names(SCHEMAS["scenario"])) - set(keys(self.full)))

    def test_what_the_schema_refuses_the_program_refuses(self):
        tried = 0
        for what, scenario in spoilt(self.full):
            with self.subTest(what):
                self.assertFalse(self.valid.is_valid(scenario), "the schema takes it")
                self.assertTrue(set(errors_of(scenario)) - self.errors_of_full, "the program takes it")
                tried += 1
        self.assertGreater(tried, 300)

    def test_the_ends_of_each_range_are_taken_by_both(self):
        for paths, scenario in at_the_ends(self.full):
            keys = [f"'{path[-1]}'" for path in paths]
            with self.subTest(keys):
                if paths[0][-1] not in ("shape", "kind"):  # another shape needs other keys
                    self.assertEqual([], [e.message for e in self.valid.iter_errors(scenario)])
                said = [what for kind, what in errors_of(scenario) if kind in ("out_of_range", "unknown_name") and any(key in what for key in keys)]
                self.assertEqual([], said)


def closed(schema):
    """The same schema, refusing names that it does not have."""
    if isinstance(schema, list):
        return [closed(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    out = {key: closed(value) for key, value in schema.items()}
    if isinstance(schema.get("properties"), dict) and schema.get("type") == "object":
        out.setdefault("additionalProperties", False)
    return out


class WhatIsWritten(unittest.TestCase):
    def check(self, name, document):
        self.assertEqual([], [f"{list(e.path)}: {e.message}" for e in Draft202012Validator(closed(SCHEMAS[name])).iter_errors(document)])

    def test_results(self):
        sessions = sorted((SOURCE / "tests/replay/sessions").glob("*.cavum"))
        self.assertTrue(sessions)
        for session in sessions:
            with self.subTest(session.name):
                self.check("result", json.loads(cavum("grade", session, "--json").stdout))

    def test_result_of_an_exam_that_has_everything(self):
        """A chamber that is to be opened, pulp that is to be kept away from, accommodations, a pause."""
        scenario = tomllib.loads((SOURCE / "data/scenarios/molar_access.toml").read_text())
        scenario["tooth"] = str(SOURCE / "data/teeth/lower_molar.cvt")
        scenario["time_limit_s"] = 5
        scenario["accommodations"] = {"extra_time_percent": 25}
        scenario["rubric"]["criteria"].append({"id": "over_pulp", "metric": "dentin_over_pulp_mm", "full": 1, "zero": 0.2, "points": 5})
        with tempfile.TemporaryDirectory() as folder:
            task, session = pathlib.Path(folder) / "task.toml", pathlib.Path(folder) / "s.cavum"
            task.write_text(toml_file(scenario))
            sat = cavum("exam", task, "--candidate", "c", "--operator", "expert", "--out", session, env={**os.environ, "CAVUM_HOME": folder})
            self.assertTrue(session.exists(), sat.stderr)
            result = json.loads(cavum("grade", session, "--json").stdout)
            self.assertLessEqual({"access", "pulp", "accommodations", "time_limit_s"}, set(result))
            self.check("result", result)

    def test_tickets(self):
        with tempfile.TemporaryDirectory() as folder:
            home = {**os.environ, "CAVUM_HOME": folder + "/home"}
            ledger = folder + "/ledger"
            self.assertEqual(0, cavum("ledger", "init", ledger, "--school", "S", env=home).returncode)
            for name, more in (("anna", ["--extra-time-percent", "25", "--left-handed"]), ("bert", []), ("cora", ["--begin-at-ledger"])):
                path = pathlib.Path(folder) / (name + ".ticket")
                made = cavum("ledger", "ticket", ledger, SOURCE / "data/scenarios/slot.toml", "--candidate", name, "--from", "2026-01-01T09:00Z",
                             "--until", "2099-01-01T09:00Z", "--out", path, *more, env=home)
                self.assertEqual(0, made.returncode, made.stderr)
                self.check("ticket", json.loads(path.read_text()))


if __name__ == "__main__":
    for schema in SCHEMAS.values():
        Draft202012Validator.check_schema(schema)
    unittest.main(argv=sys.argv[:1])
