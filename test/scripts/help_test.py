"""Who asks a script what it does is told, and nothing else happens; a word that it doesn't know is refused before it does anything."""

import os
import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WORKERS = ("apt-get", "cmake", "ctest", "curl", "dpkg-query", "ffmpeg", "git", "ninja", "pip", "sudo")
SCRIPTS = sorted(file.name for file in (ROOT / "scripts").iterdir() if file.suffix == "" and os.access(file, os.X_OK))


class Help(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for name in WORKERS:  # each leaves a word that it was called
            (self.folder / name).write_text(f"#!/bin/sh\necho {name} >>{self.folder}/called\nexit 1\n")
            (self.folder / name).chmod(0o755)

    def type(self, script, *words):
        """(exit code, what it says); it must call nobody that installs, builds or changes the tree."""
        (self.folder / "called").unlink(missing_ok=True)
        run = subprocess.run(
            [ROOT / "scripts" / script, *words],
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            cwd=self.folder,
            env=os.environ | {"PATH": f"{self.folder}:{os.environ['PATH']}"},
        )
        self.assertFalse((self.folder / "called").exists(), f"{script} {words}: {run.stdout}")
        return run.returncode, run.stdout

    def test_every_script_says_what_it_does(self):
        self.assertGreater(len(SCRIPTS), 15)
        for script in SCRIPTS:
            for asked in ("--help", "-h"):
                with self.subTest(script=script, asked=asked):
                    code, said = self.type(script, asked)
                    self.assertEqual(code, 0, said)
                    self.assertRegex(said, r"(?i)usage")
                    self.assertIn(script, said)
                    self.assertNotIn("set -e", said)

    def test_a_word_that_is_not_known_is_refused(self):
        for line in (("demo", "--video"), ("demo", "out/a", "out/b"), ("setup", "--check"), ("build", "relaese"), ("test", "--fast")):
            with self.subTest(line=line):
                code, said = self.type(*line)
                self.assertEqual(code, 2, said)
                self.assertIn("expected", said)


if __name__ == "__main__":
    unittest.main()
