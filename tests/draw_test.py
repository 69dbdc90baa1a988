"""What draw.py promises: over eight turns every long test runs, each commit has about the same to do, and what is left out is exactly the rest."""
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import draw

TABLE = draw.read_table(pathlib.Path(__file__).with_name("long_tests.txt"))


def runs(name, patterns):
    """Whether a test runs under what left_out gives."""
    gtest, ctest = patterns
    return name not in gtest[1:].split(":") and not re.search(ctest, name)


class Draw(unittest.TestCase):
    def test_every_long_test_runs_at_one_turn_of_as_many_as_there_are_hands(self):
        patterns = [draw.left_out(TABLE, turn) for turn in range(40, 40 + draw.HANDS)]
        for name, _ in TABLE:
            self.assertEqual([runs(name, pattern) for pattern in patterns].count(True), 1, name)

    def test_what_is_not_long_always_runs(self):
        for turn in range(5):
            for name in ("Octree.IsADenseGrid", "replay.every_build_gives_the_same_bits", "ui_test", "report.page.units", "report.page.browse"):
                self.assertTrue(runs(name, draw.left_out(TABLE, turn)), name)

    def test_hands_are_of_one_length(self):
        seconds = dict(TABLE)
        sums = [sum(seconds[name] for name in hand) for hand in draw.deal(TABLE)]
        self.assertLess(max(sums) - min(sums), max(seconds.values()))
        self.assertLess(max(sums), 1.1 * min(sums))

    def test_the_order_of_the_table_changes_nothing(self):
        shuffled = random.Random(7).sample(TABLE, len(TABLE))
        self.assertEqual(draw.deal(shuffled), draw.deal(TABLE))

    def test_a_damaged_table_is_refused_with_its_line(self):
        for text, words in (("5 A.B\nx C.D\n", ":2: not `SECONDS NAME`"), ("5 A.B\n6 A.B\n", "named twice"), ("5 A B\n", ":1: not")):
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "t.txt"
                path.write_text(text)
                with self.assertRaises(SystemExit) as refused:
                    draw.read_table(path)
                self.assertIn(words, str(refused.exception))

    def test_the_shell_gets_two_lines(self):
        said = subprocess.run([sys.executable, draw.__file__, "6"], capture_output=True, text=True, check=True).stdout.splitlines()
        self.assertEqual(tuple(said), draw.left_out(TABLE, 6))


if __name__ == "__main__":
    unittest.main()
