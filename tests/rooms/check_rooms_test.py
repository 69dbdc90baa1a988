"""The check of the rooms finds each thing that it is there for, in a small tree made for it."""
import tempfile
import unittest
from pathlib import Path

from check_rooms import namespace_of, problems, read_rooms


class CheckRooms(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        for folder in ("engine/low", "engine/high", "scenarios", "grading", "ui"):
            (self.root / folder).mkdir(parents=True)
        self.write("engine/low/a.h", "")
        self.write("engine/low/a.cpp", '#include "engine/low/a.h"\n')
        self.write("engine/high/b.cpp", '#include "engine/low/a.h"\n')
        self.low, self.high = ("", "a.cpp"), ("low", "b.cpp")

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text, namespace="cavum"):
        (self.root / path).write_text(f"{text}\nnamespace {namespace} {{\n\nint one();\n\n}}  // namespace {namespace}\n")

    def found(self):
        rows = [
            f"{name}|engine/{name}|{below}|{self.root}/engine/{name}/{source}"
            for name, (below, source) in (("low", self.low), ("high", self.high))
        ]
        return problems(read_rooms("\n".join(rows)), self.root)

    def test_a_house_in_order(self):
        self.assertEqual(self.found(), [])

    def test_an_include_against_the_order(self):
        self.write("engine/high/b.h", "")
        self.write("engine/low/a.cpp", '#include "engine/high/b.h"\n')
        self.assertEqual(self.found(), ["engine/low/a.cpp: includes engine/high/b.h of high, which is not below low"])

    def test_a_circle(self):
        self.low = ("high", "a.cpp")
        self.assertEqual(self.found(), ["room low is above itself", "room high is above itself"])

    def test_a_source_that_nobody_compiles(self):
        self.write("engine/low/c.cpp", "")
        self.assertEqual(self.found(), ["engine/low/c.cpp: no room compiles it"])

    def test_a_folder_that_is_no_room(self):
        (self.root / "ui/odd").mkdir()
        self.write("ui/odd/d.h", "")
        self.assertEqual(self.found(), ["ui/odd/d.h: ui/odd is no room"])

    def test_a_header_that_is_gone(self):
        self.write("engine/high/b.cpp", '#include "engine/low/gone.h"\n')
        self.assertEqual(self.found(), ["engine/high/b.cpp: includes engine/low/gone.h, which is not there"])

    def test_a_header_that_is_slow_to_compile(self):
        self.write("engine/low/a.h", "#include <nlohmann/json.hpp>\n")
        self.assertEqual(self.found(), ["engine/low/a.h: includes <nlohmann/json.hpp>, which sources alone do"])

    def test_headers_that_include_each_other(self):
        self.write("engine/low/a.h", '#include "engine/low/b.h"\n')
        self.write("engine/low/b.h", '#include "engine/low/c.h"\n')
        self.write("engine/low/c.h", '#include "engine/low/a.h"\n')
        self.assertEqual(self.found(), ["engine/low/a.h includes engine/low/b.h includes engine/low/c.h includes engine/low/a.h"])

    def test_a_namespace_of_another_room(self):
        self.write("engine/high/b.cpp", "", "cavum::ledger")
        self.assertEqual(self.found(), ["engine/high/b.cpp: opens namespace cavum::ledger; this folder's is cavum"])

    def test_a_second_namespace_beside_the_right_one(self):
        self.write("engine/high/b.cpp", "namespace cavum::ui {\nstruct Two {\n  int two;\n};\n}  // namespace cavum::ui\n")
        self.assertEqual(self.found(), ["engine/high/b.cpp: opens namespace cavum::ui; this folder's is cavum"])

    def test_a_source_without_a_namespace(self):
        (self.root / "engine/high/b.cpp").write_text("int one();\n")
        self.assertEqual(self.found(), ["engine/high/b.cpp: opens no namespace cavum"])

    def test_another_rooms_type_may_be_named_ahead(self):
        self.write("engine/high/b.cpp", "namespace cavum::explain {\nclass Recording;\nstruct Layer;\n}  // namespace cavum::explain\n")
        self.assertEqual(self.found(), [])

    def test_a_folder_has_the_namespace_of_the_nearest_room_that_names_one(self):
        self.assertEqual(namespace_of("engine/tooth/mesh"), "cavum")
        self.assertEqual(namespace_of("grading/measures"), "cavum::grading")
        self.assertEqual(namespace_of("grading/records"), "cavum::records")
        self.assertEqual(namespace_of("ui/report/print"), "cavum::report")


if __name__ == "__main__":
    unittest.main()
