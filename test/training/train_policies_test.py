"""training/train_policies.sh starts each run with its variant, seed and GPU, goes on where one was, and says how runs ended."""

import os
import pathlib
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SCRIPT = ROOT / "training/train_policies.sh"
# Stands for Python: tells its arguments, and runs until it is ended, as the training does. `end` in the folder ends it, too.
TRAINER = """#!/usr/bin/env bash
echo "$* on GPU ${CUDA_VISIBLE_DEVICES-none}" >>told
trap 'echo saved; exit 0' TERM
until [ -e end ]; do sleep 0.05; done
exit "$(cat end)"
"""


class TrainPolicies(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        (self.folder / "python").write_text(TRAINER)
        (self.folder / "python").chmod(0o755)

    def tearDown(self):
        self.run_script("stop", "out")
        self.until(self.none_runs)
        self.temporary.cleanup()

    def run_script(self, *arguments, gpus=2):
        environment = os.environ | {"RUNS": "a:pmg:1 b:single_gait:2 c:pmg:3", "PYTHON": "./python", "GPUS": str(gpus)}
        environment.pop("CUDA_VISIBLE_DEVICES", None)
        return subprocess.run([SCRIPT, *arguments], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=60)

    def until(self, holds):
        """The runs are processes of their own: what they write comes when the machine gives them time."""
        end = time.monotonic() + 60
        while not holds():
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)

    def none_runs(self):
        return "(running)" not in self.run_script("show", "out").stdout

    def told(self):
        file = self.folder / "told"
        return sorted(file.read_text().splitlines()) if file.exists() else []

    def test_each_run_has_its_variant_seed_and_gpu_and_goes_on(self):
        (self.folder / "out/b").mkdir(parents=True)
        (self.folder / "out/b/last.pt").touch()
        self.assertEqual(self.run_script("start", "out", "7", "--streams", "9").returncode, 0)
        self.until(lambda: len(self.told()) == 3)
        a, c, b = self.told()
        self.assertIn("--variant pmg --seed 1 --out out/a --minutes 7 --streams 9 on GPU 0", a)
        self.assertIn("--variant pmg --seed 3 --out out/c --minutes 7 --streams 9 on GPU 0", c)
        self.assertIn("--variant single_gait --seed 2 --out out/b --minutes 7 --resume --streams 9 on GPU 1", b)
        self.assertEqual(self.run_script("show", "out").returncode, 1)
        again = self.run_script("start", "out", "7")
        self.assertEqual(again.stdout.count("runs already"), 3, again.stdout)

    def test_stop_lets_runs_save_and_a_failure_is_said(self):
        self.run_script("start", "out", "7")
        self.until(lambda: len(self.told()) == 3)
        self.run_script("stop", "out")
        self.until(self.none_runs)
        shown = self.run_script("show", "out")
        self.assertEqual(shown.returncode, 0, shown.stdout)
        self.assertEqual(shown.stdout.count("(ended with 0): saved"), 3, shown.stdout)
        (self.folder / "end").write_text("2")
        self.run_script("start", "out", "7")
        self.until(self.none_runs)
        shown = self.run_script("show", "out")
        self.assertEqual(shown.returncode, 2)
        self.assertEqual(shown.stdout.count("(ended with 2)"), 3, shown.stdout)

    def test_without_gpus_none_is_named(self):
        self.run_script("start", "out", "7", gpus=0)
        self.until(lambda: len(self.told()) == 3)
        self.assertTrue(all(line.endswith("on GPU none") for line in self.told()), self.told())


if __name__ == "__main__":
    unittest.main()
