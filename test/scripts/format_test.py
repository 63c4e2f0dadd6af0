"""scripts/format on small projects: what it finds, what it mends, and what it says without its formatters."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
USED = (
    ".clang-format",
    "ruff.toml",
    "scripts/format",
    "scripts/help.bash",
    "third_party/pinned_folder.bash",
    "third_party/python-packages",
    "third_party/python/tools.txt",
)
GOOD = {"a.cpp": "int f() { return 1; }\n", "a.py": '"""A module."""\n', "tool": '#!/usr/bin/env python3\n"""A script without a suffix."""\n'}


class Format(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in USED:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        for name, text in GOOD.items():
            (self.root / name).write_text(text)
        subprocess.run(["git", "init", "--quiet", self.root], check=True)

    def format(self, *options, **environment):
        """(exit code, all that it says)"""
        run = subprocess.run(
            [self.root / "scripts/format", *options], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=os.environ | environment
        )
        return run.returncode, run.stdout

    def check_is_found(self, name, text, said, mended=True):
        """That a file is found and named, and afterwards mended by scripts/format or, where only a person can, still found."""
        with self.subTest(name=name, text=text):
            (self.root / name).write_text(text)
            code, words = self.format("--check")
            self.assertEqual(code, 1, words)
            self.assertIn(said, words)
            self.assertIn(name, words)
            self.format()
            self.assertEqual(self.format("--check")[0], 0 if mended else 1)
            (self.root / name).write_text(GOOD.get(name, ""))

    def test_well_formatted_files_pass(self):
        code, words = self.format("--check")
        self.assertEqual(code, 0, words)

    def test_a_breach_is_found_and_mended_where_it_can_be(self):
        self.check_is_found("a.cpp", "int  f() { return 1; }\n", "clang-formatted")
        self.check_is_found("a.hpp", "int f( );\n", "clang-formatted")
        self.check_is_found("a.py", "x = 'a'\n", "Would reformat")
        self.check_is_found("a.py", "import os\n", "F401")
        self.check_is_found("tool", "#!/usr/bin/env python3\nimport os\n", "F401")
        self.check_is_found("a.py", "def f():\n    return missing\n", "F821", mended=False)
        self.check_is_found("a.py", f'x = "{"a" * 150}"\n', "E501", mended=False)

    def test_a_file_that_git_still_lists_and_is_gone_is_passed_over(self):
        subprocess.run(["git", "-C", self.root, "add", "."], check=True)
        (self.root / "a.cpp").unlink()
        (self.root / "a.py").unlink()
        code, words = self.format("--check")
        self.assertEqual(code, 0, words)

    def test_without_formatters_the_check_says_what_is_missing_and_how_to_get_it(self):
        code, words = self.format("--check", XDG_CACHE_HOME=str(self.root))
        self.assertEqual(code, 77)
        self.assertIn("third_party/python-packages tools", words)


if __name__ == "__main__":
    if subprocess.run([ROOT / "third_party/python-packages", "tools", "--cached"], stdout=subprocess.DEVNULL).returncode != 0:
        sys.exit(77)
    unittest.main()
