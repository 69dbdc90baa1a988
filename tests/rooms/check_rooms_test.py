"""The check of the rooms finds each thing that it is there for, in a small tree made for it."""
import tempfile
import unittest
from pathlib import Path

from check_rooms import problems, read_rooms


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

    def write(self, path, text):
        (self.root / path).write_text(text)

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

    def test_headers_that_include_each_other(self):
        self.write("engine/low/a.h", '#include "engine/low/b.h"\n')
        self.write("engine/low/b.h", '#include "engine/low/c.h"\n')
        self.write("engine/low/c.h", '#include "engine/low/a.h"\n')
        self.assertEqual(self.found(), ["engine/low/a.h includes engine/low/b.h includes engine/low/c.h includes engine/low/a.h"])


if __name__ == "__main__":
    unittest.main()
