"""The check of names finds each thing that it is there for, in a small tree made for it."""
import tempfile
import unittest
from pathlib import Path

from check_names import MOST_CHARACTERS, MOST_LINES, problems


class CheckNames(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = Path(self.folder.name)
        self.write("README.md", "# Top\nThe [page](docs/page.md#its-heading-2).\n")
        self.write("docs/page.md", "# Page\n## Its heading, 2\nSee `engine/low/a.h`, [the top](../README.md) and [the web](https://example.org/x.md).\n")
        self.write("engine/low/a.h", "// Made by low/a.cpp; docs/page.md, low/*.cpp.\n")
        self.write("engine/low/a.cpp", "")

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)

    def found(self):
        return problems(self.root)[0]

    def test_a_tree_in_order(self):
        self.assertEqual(self.found(), [])

    def test_a_link_that_leads_nowhere(self):
        self.write("README.md", "[page](docs/gone.md)\n")
        self.assertEqual(self.found(), ["README.md:1: links to docs/gone.md, which is not there"])

    def test_a_heading_that_is_gone(self):
        self.write("README.md", "[page](docs/page.md#another)\n")
        self.assertEqual(self.found(), ["README.md:1: links to docs/page.md#another, which has no such heading"])

    def test_a_page_that_a_comment_names(self):
        self.write("engine/low/a.h", "int a;  // after GONE.md, section 2\n")
        self.assertEqual(self.found(), ["engine/low/a.h:1: names GONE.md, which is not there"])

    def test_a_file_that_a_page_names(self):
        self.write("docs/page.md", "# Page\n## Its heading, 2\nIt stands in `low/b.cpp`.\n")
        self.assertEqual(self.found(), ["docs/page.md:3: names low/b.cpp, which is not there"])

    def test_comments_of_other_files(self):
        self.write("engine/CMakeLists.txt", "# after GONE.md\n")
        self.write("dev", "# runs tests/gone.sh\n")
        self.write("data/a.toml", "a = 1  # see docs/gone.md\n")
        self.assertEqual(len(self.found()), 3, self.found())

    def test_code_is_no_comment(self):
        self.write("engine/low/a.h", 'const char* name = "http://x/docs/gone.md";\n')
        self.assertEqual(self.found(), [])

    def test_what_is_made_is_excepted(self):
        self.write("engine/low/a.h", "// written to build/release/rooms.txt\n")
        self.assertEqual(self.found(), [])

    def test_history_may_name_what_is_gone(self):
        self.write("CHANGELOG.md", "The page docs/gone.md is split.\n")
        self.assertEqual(self.found(), [])

    def test_a_readme_that_is_too_long(self):
        self.write("engine/README.md", "line\n\n" * 31)
        self.assertEqual(self.found(), [f"engine/README.md: has 62 lines, {MOST_LINES} are allowed"])

    def test_a_paragraph_that_is_too_long(self):
        self.write("docs/page.md", "# Page\n## Its heading, 2\n\n" + ("w" * 99 + "\n") * 9)
        self.assertEqual(self.found(), [f"docs/page.md:4: a paragraph of 899 characters, {MOST_CHARACTERS} are allowed"])

    def test_tables_lists_and_commands_are_no_paragraphs(self):
        self.write("docs/page.md", "# Page\n## Its heading, 2\n" + "| cell |\n" * 200 + "\n" + "- an item of a list\n" * 99 + "\n" + "    a command\n" * 99)
        self.assertEqual(self.found(), [])


if __name__ == "__main__":
    unittest.main()
