"""scripts/tidy on a small project: what it finds, which files it takes, and what it remembers."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
USED = (".clang-tidy", "scripts/tidy", "third_party/pinned_folder.bash", "third_party/python-packages", "third_party/python/tools.txt")
TOOLS = [ROOT / "third_party/python-packages", "tools", "--cached"]
MOVED = "#include <string>\n#include <utility>\nstd::string f(std::string a) { std::string b = std::move(a); return a + b; }\n"


class Tidy(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name) / "project"
        for name in USED:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        (self.root / "scripts/build").symlink_to("/bin/true")
        (self.root / "src").mkdir()
        self.write("src/a.hpp", "#pragma once\nint twice(int value);\n")
        self.write("src/a.cpp", '#include "a.hpp"\nint twice(int value) { return 2 * value; }\n')
        self.write("src/user.cpp", '#include "a.hpp"\nint four() { return twice(2); }\n')
        (self.root / "build/tidy").mkdir(parents=True)
        entries = [
            {
                "file": str(self.root / "src" / name),
                "directory": str(self.root),
                "command": f"/usr/bin/c++ -I{self.root}/src -Werror -o x.o -c {self.root}/src/{name}",
            }
            for name in ("a.cpp", "user.cpp")
        ]
        (self.root / "build/tidy/compile_commands.json").write_text(json.dumps(entries))
        self.cache = pathlib.Path(folder.name) / "cache"
        self.cache.mkdir()
        tools = pathlib.Path(subprocess.run(TOOLS, capture_output=True, text=True, check=True).stdout.strip())
        (self.cache / "pmg-python").symlink_to(tools.parent)
        commit = ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-q", "--allow-empty", "-m"]
        for command in (["init", "-q", "-b", "main"], ["add", "scripts", "src"], [*commit, "First"], [*commit, "Second"]):
            subprocess.run(["git", "-C", self.root, *command], check=True)

    def write(self, name, text):
        (self.root / name).write_text(text)

    def tidy(self, *options):
        """(exit code, all that it says)"""
        environment = os.environ | {"XDG_CACHE_HOME": str(self.cache)}
        command = [self.root / "scripts/tidy", *options]
        run = subprocess.run(command, cwd=self.root, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment)
        return run.returncode, run.stdout

    def expect(self, code, words, *options):
        got, said = self.tidy(*options)
        self.assertEqual(got, code, said)
        self.assertIn(words, said)

    def test_a_clean_tree_passes_and_is_remembered_until_something_that_it_reads_changes(self):
        self.expect(0, "2 files, 0 known to be clean, 0 with findings", "--all")
        self.expect(0, "2 files, 2 known to be clean, 0 with findings", "--all")
        self.write("src/a.cpp", '#include "a.hpp"\nint twice(int value) { return value + value; }\n')
        self.expect(0, "2 files, 1 known to be clean, 0 with findings", "--all")
        self.write("src/a.hpp", "#pragma once\nint twice(int number);\n")
        self.expect(0, "2 files, 0 known to be clean, 0 with findings", "--all")
        self.write(".clang-tidy", (self.root / ".clang-tidy").read_text() + "# changed\n")
        self.expect(0, "2 files, 0 known to be clean, 0 with findings", "--all")

    def test_a_breach_of_each_group_of_checks_is_found_and_never_remembered_as_clean(self):
        for text, check in (
            ("int Twice(int value) { return 2 * value; }\n", "readability-identifier-naming"),
            ("int twice(int valueNm) { return 2 * valueNm; }\n", "readability-identifier-naming"),
            (MOVED, "bugprone-use-after-move"),
            ("#include <string>\nunsigned long f(std::string a) { return a.size(); }\n", "performance-unnecessary-value-param"),
            ("int f(const int* a) { return *const_cast<int*>(a); }\n", "cppcoreguidelines-pro-type-const-cast"),
        ):
            with self.subTest(check=check, text=text):
                self.write("src/a.cpp", text)
                self.expect(1, check, "src/a.cpp")
                self.expect(1, check, "src/a.cpp")

    def test_units_frames_and_symbols_in_names_are_no_breach(self):
        limit = "namespace {\nconstexpr double kLimit_Nm = 1.0;\n}\n"
        self.write("src/a.cpp", f"{limit}double f(double R_HB, double p_WF, double R) {{ return kLimit_Nm * R_HB * p_WF * R; }}\n")
        self.expect(0, "0 with findings", "src/a.cpp")

    def test_what_changed_is_checked_and_a_header_through_one_that_includes_it(self):
        self.expect(0, "0 files", "--since", "HEAD")
        self.write("src/user.cpp", '#include "a.hpp"\nint Four() { return twice(2); }\n')
        self.expect(1, "1 files", "--since", "HEAD")
        self.write("src/user.cpp", '#include "a.hpp"\nint four() { return twice(2); }\n')
        self.write("src/a.hpp", "#pragma once\nint twice(int value);\ninline int Thrice(int value) { return 3 * value; }\n")
        self.expect(1, "src/a.cpp FINDINGS", "--since", "HEAD")
        self.expect(1, "invalid case style for function 'Thrice'", "src/a.hpp")

    def test_without_a_base_it_takes_the_last_commit(self):
        self.expect(0, "0 files")
        self.expect(2, "knows no commit nowhere", "--since", "nowhere")

    def test_a_file_that_nothing_compiles_is_refused(self):
        self.write("src/alone.hpp", "")
        self.expect(2, "src/alone.hpp: no source file", "src/alone.hpp")


if __name__ == "__main__":
    if subprocess.run(TOOLS, stdout=subprocess.DEVNULL).returncode != 0:
        sys.exit(77)
    unittest.main()
