"""What follow_page.py does with a page, and that it refuses what it cannot follow."""
import tempfile
import unittest
from pathlib import Path

from follow_page import Wrong, follow


class FollowPage(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        self.work = self.root / "work"
        self.work.mkdir()

    def follow(self, text, **more):
        page = self.root / "page.md"
        page.write_text(text)
        return follow(page, self.work, **more)

    def test_files_are_written_and_commands_see_them(self):
        made = self.follow("1. Write `a/b.txt`:\n\n   ```text\n   one\n     two\n   ```\n2. Run:\n   ```sh\n   cat a/b.txt\n   ```\n"
                           "   It says:\n   ```text\n   one\n   t…o\n   ```\n")
        self.assertEqual(made, ["a/b.txt"])
        self.assertEqual((self.work / "a/b.txt").read_text(), "one\n  two\n")

    def test_what_is_not_printed_or_in_another_order_is_wrong(self):
        for expected in ("three", "two\none"):
            with self.assertRaisesRegex(Wrong, "nothing reads"):
                self.follow(f"Run:\n```sh\nprintf 'one\\ntwo\\n'\n```\nIt says:\n```text\n{expected}\n```\n")

    def test_a_command_that_fails_is_wrong_and_one_that_should_fail_must(self):
        with self.assertRaisesRegex(Wrong, "ended with 3"):
            self.follow("Run:\n```sh\nexit 3\n```\n")
        self.follow("Run, and see it fail:\n```sh\nfalse\n```\n")
        with self.assertRaisesRegex(Wrong, "ended with 0"):
            self.follow("Run, and see it fail:\n```sh\ntrue\n```\n")

    def test_lines_are_inserted_into_a_copy_and_the_tree_stays(self):
        tree = self.root / "tree"
        tree.mkdir()
        (tree / "x.cpp").write_text("begin\n  end\n  end\nlast\n")
        made = self.follow("In `x.cpp`, above `end`:\n```cpp\nnew\n```\nIn `x.cpp`, below `begin`:\n```cpp\nfirst\n```\n", tree=tree)
        self.assertEqual(made, ["x.cpp"])
        self.assertEqual((self.work / "x.cpp").read_text(), "begin\nfirst\n  end\nnew\n  end\nlast\n")
        self.assertEqual((tree / "x.cpp").read_text(), "begin\n  end\n  end\nlast\n")
        with self.assertRaisesRegex(Wrong, "no line reads 'gone'"):
            self.follow("In `x.cpp`, above `gone`:\n```cpp\nnew\n```\n", tree=tree)

    def test_a_block_that_nobody_says_what_to_do_with_is_wrong(self):
        with self.assertRaisesRegex(Wrong, "does not say what to do"):
            self.follow("For example:\n```cpp\nx\n```\n")


if __name__ == "__main__":
    unittest.main()
