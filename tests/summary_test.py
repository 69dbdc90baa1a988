"""What summary.py says of failures, from a report that CTest itself has written: of a GoogleTest program the tests that failed, of any other its last words."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import summary

GTEST_REPORT = """<testsuites><testsuite name="Cut"><testcase classname="Cut" name="IsClean" time="1"/>
<testcase classname="Cut" name="IsDeep" time="1"><failure message="cut_test.cpp:7&#x0A;Expected: 2&#x0A;  Actual: 3"/></testcase></testsuite></testsuites>"""


class Failures(unittest.TestCase):
    def failures(self, *tests):
        """Of programs that are lines for the shell, by name, run by CTest."""
        with tempfile.TemporaryDirectory() as folder:
            lines = "".join(f'add_test({name} sh -c [==[{script}]==])\n' for name, script in tests)
            pathlib.Path(folder, "CTestTestfile.cmake").write_text(lines, encoding="utf-8")
            subprocess.run(["ctest", "--test-dir", folder, "--output-junit", f"{folder}/tests.xml"], capture_output=True, check=False)
            pathlib.Path(folder, "cut_test.xml").write_text(GTEST_REPORT, encoding="utf-8")
            return dict(summary.failures(f"{folder}/tests.xml", folder))

    def test_of_a_googletest_program_each_test_that_failed_is_named_with_its_reason(self):
        found = self.failures(("cut_test", "echo '[==========] 2 tests'; exit 1"))
        self.assertEqual(list(found), ["cut_test: Cut.IsDeep"])
        self.assertIn("Actual: 3", found["cut_test: Cut.IsDeep"])

    def test_one_that_left_no_report_is_named_with_its_last_words(self):
        found = self.failures(("tick_test", "seq 40; echo '[==========] and then a signal'; kill -SEGV $$"), ("page", "echo 'not ok 1'; exit 1"))
        self.assertEqual(sorted(found), ["page", "tick_test"])
        self.assertTrue(found["tick_test"].endswith("and then a signal"), found["tick_test"])
        self.assertEqual(found["page"], "not ok 1")

    def test_what_passed_is_not_named(self):
        self.assertEqual(self.failures(("cut_test", "echo '[==========]'"), ("page", "true")), {})


if __name__ == "__main__":
    unittest.main()
