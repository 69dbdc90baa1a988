"""The check of CHANGELOG.md finds each thing that it is there for, in a small tree made for it."""
import tempfile
import unittest
from pathlib import Path

from check_changelog import problems

FORMATS = "Physics version 3 · session format 1 · tooth file version 2.\n"
GOOD = "# Changes\n\n## 0.2.0, 2026-02-03\n" + FORMATS + "\n- New.\n\n## 0.1.0, 2026-01-02\nPhysics version 1 · session format 1 · tooth file version 1.\n"


class CheckChangelog(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.write("engine/base/version.cpp", 'return "0.2.0";\n')
        self.write("engine/physics/servo/servo.h", "inline constexpr int k_physics_version = 3;\n")
        self.write("engine/session/session.h", "inline constexpr int k_session_format = 1;\n")

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)

    def found(self, changes):
        self.write("CHANGELOG.md", changes)
        return problems(self.root)

    def test_in_order(self):
        self.assertEqual(self.found(GOOD), [])

    def test_what_is_under_way_stands_first(self):
        self.assertEqual(self.found(GOOD.replace("## 0.2.0", "## Unreleased\n" + FORMATS + "\n## 0.2.0")), [])
        self.assertEqual(len(self.found(GOOD + "\n## Unreleased\n")), 1)

    def test_physics_that_nobody_wrote_down(self):
        self.write("engine/physics/servo/servo.h", "inline constexpr int k_physics_version = 4;\n")
        self.assertIn("Physics version 4", self.found(GOOD)[0])

    def test_a_format_that_nobody_wrote_down(self):
        self.write("engine/session/session.h", "inline constexpr int k_session_format = 2;\n")
        self.assertIn("session format 2", self.found(GOOD)[0])

    def test_a_version_that_is_not_built(self):
        self.write("engine/base/version.cpp", 'return "0.3.0";\n')
        self.assertIn("not that of", self.found(GOOD)[0])

    def test_a_version_without_a_date(self):
        self.assertIn("'0.1.0' is no version", self.found(GOOD.replace("0.1.0, 2026-01-02", "0.1.0"))[0])
        self.assertIn("'0.1.0, 2026-13-02' is no version", self.found(GOOD.replace("2026-01-02", "2026-13-02"))[0])

    def test_versions_out_of_order(self):
        self.assertIn("not older", self.found(GOOD.replace("2026-01-02", "2026-02-04"))[0])
        self.assertIn("not older", self.found(GOOD.replace("0.1.0,", "0.2.0,"))[0])

    def test_an_empty_one(self):
        self.assertEqual(len(self.found("")), 2)


if __name__ == "__main__":
    unittest.main()
