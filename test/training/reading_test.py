"""Training reads every file that it shares with the C++ programs by their readers: what is wrong in a file gives the line of pmg_sil.

Usage: reading_test.py LIBRARY BIN_DIR
"""

import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ROBOT = ROOT / "config/robots/z1"
sys.path.insert(0, str(ROOT / "training"))
LIBRARY, BIN = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])

from pmg_train import checked_files  # noqa: E402
from pmg_train.library import load  # noqa: E402


def said_by_pmg_sil(*options, scenario=ROOT / "config/scenarios/stand.yaml"):
    """Its one line about the file, without the program's name."""
    run = subprocess.run([BIN / "pmg_sil", "--policy", "none", "--scenario", scenario, *options], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 2, run.stderr
    assert run.stderr.startswith("pmg_sil: ") and run.stderr.count("\n") == 1, run.stderr
    return run.stderr.removeprefix("pmg_sil: ").rstrip("\n")


def said_by_training(read, *arguments):
    try:
        read(LIBRARY, *arguments)
    except ValueError as error:
        return str(error)
    return "accepted"


def robot_said_by_training(_, robot):
    """The generator that training makes its references with."""
    lib = load(LIBRARY)
    assert lib.pmg_batch_create(str(robot).encode(), b"pmg", 1, 1, 1) is None
    raise ValueError(lib.pmg_batch_error().decode())


class Reading(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def expect(self, place_and_words, by_pmg_sil, by_training):
        self.assertEqual(by_training, by_pmg_sil)
        self.assertIn(place_and_words, by_training)

    def test_a_bad_motor_file_gets_pmg_sils_line(self):
        for text, said in (
            ("joints:\n  left_knee:\n    friction: {culomb_Nm: 1}\n", ":3:16: joints.left_knee.friction.culomb_Nm: is unknown"),
            ("joints:\n  left_knee:\n    command: {delay_ms: 4}\n", ":3:15: joints.left_knee.command.delay_ms: is unknown"),
            ("joints:\n  left_knee:\n    friction: {coulomb_Nm: .nan}\n", ":3:28: joints.left_knee.friction.coulomb_Nm: is '.nan'"),
            ("joints:\n  left_knee:\n    friction: {coulomb_Nm: inf}\n", "expected a finite number"),
            ("joints:\n  left_knee:\n    friction: {coulomb_Nm: -1}\n", "expected a number of at least 0"),
            ('joints:\n  left_knee:\n    friction: {coulomb_Nm: "1"}\n', "expected a number"),
            ("joints:\n  left_knee:\n    transmission: {backlash_rad: 0.1}\n", "joints.left_knee"),
            ("joints:\n  left_kne: {}\n", "did you mean left_knee?"),
            ("joints: {left_knee: {}}\njoints: {}\n", "is there twice"),
            ("motors: {}\n", "joints: is missing"),
            ("joints: {", ":1:"),
        ):
            path = self.write("motor.yaml", text)
            self.expect(
                said,
                said_by_pmg_sil("--robot", ROBOT, "--out", self.folder, "--motor", path),
                said_by_training(checked_files.read_motor_file, ROBOT, path),
            )

    def test_a_bad_randomization_gets_pmg_sils_line(self):
        committed = (ROOT / "training/randomization.yaml").read_text()
        for old, new, said in (
            ("friction: [0.4, 1.2]", "fricton: [0.4, 1.2]", "fricton"),
            ("friction: [0.4, 1.2]", "friction: [1.2, 0.4]", "friction: runs backwards; expected [lower, upper]"),
            ("friction: [0.4, 1.2]", "friction: [0.4]", "friction: has 1 numbers"),
            ("delay_s: [0.0, 0.02]", "delay_s: [0.0, 20]", "delay_s: is '20'; expected a number from 0 to 0.2"),
            ("payload_share: 0.5", "payload_share: .nan", "payload_share: is '.nan'"),
            ("gyro_rad_s: 0.2", "gyro_deg_s: 12", "noise.gyro_deg_s: is unknown"),
            ("gyro_rad_s: 0.2", "gyro_rad_s: true", "noise.gyro_rad_s: is 'true'; expected a number"),
            ("from_share: 0.2", "from_share: 2", "kicks.from_share: is '2'; expected a number from 0 to 1"),
            ("ramp_iterations: 800", "ramp_iterations: 0.5", "kicks.ramp_iterations: is '0.5'; expected a whole number"),
            ("frequency_Hz: [0.1, 0.7]", "frequency_hz: [0.1, 0.7]", "upper_body.frequency_hz: is unknown"),
            ("waist_yaw: 0.12", "waist_yaw: -0.12", "upper_body.amplitude_rad.waist_yaw: is '-0.12'"),
        ):
            self.assertEqual(committed.count(old), 1, old)
            path = self.write("randomization.yaml", committed.replace(old, new))
            missing = new.split(":")[0] not in old  # training finds first that the right key isn't there
            by_sil = said_by_pmg_sil("--robot", ROBOT, "--out", self.folder, "--vary", path)
            by_training = said_by_training(checked_files.read_randomization, path)
            self.assertIn(said, by_sil)
            if missing:
                self.assertIn(f"{old.split(':')[0]}: is missing", by_training)
            else:
                self.assertEqual(by_training, by_sil)

    def test_a_bad_robot_gets_pmg_sils_line(self):
        robot = self.folder / "robot"
        shutil.copytree(ROBOT, robot, ignore=shutil.ignore_patterns("policies"))
        committed = (ROBOT / "robot.yaml").read_text()
        knee = next(line for line in committed.splitlines() if line.strip().startswith("left_knee:"))
        for change, said in (
            (("armature_kg_m2", "armature_g_m2"), "joints.left_knee.armature_"),
            (("kp_Nm_per_rad: 700", "kp_Nm_per_rad: .nan"), "joints.left_knee.kp_Nm_per_rad: is '.nan'"),
            (("kp_Nm_per_rad: 700", "kp_Nm_per_rad: -700"), "joints.left_knee.kp_Nm_per_rad: is '-700'"),
            ((" bus:", " colour: red, bus:"), "joints.left_knee.colour: is unknown"),
        ):
            (robot / "robot.yaml").write_text(committed.replace(knee, knee.replace(*change)))
            self.expect(said, said_by_pmg_sil("--robot", robot, "--out", self.folder), said_by_training(robot_said_by_training, robot))

    def test_a_bad_scenario_gets_pmg_sils_line(self):
        for text, said in (
            ("name: a\nsteps: [{for_s: -1, text: x}]\n", ":2:17: steps[0].for_s: is '-1'"),
            ("name: a\nsteps: [{for_s: 1, text: x, command: {vx: 1}}]\n", "steps[0].command.vx: is unknown"),
            ("name: a\nsteps: []\n", "steps: is empty"),
        ):
            path = self.write("scenario.yaml", text)
            self.expect(
                said, said_by_pmg_sil("--robot", ROBOT, "--out", self.folder, scenario=path), said_by_training(checked_files.read_scenario, path)
            )

    def test_a_missing_file_is_named(self):
        path = self.folder / "none.yaml"
        self.expect(
            "none.yaml: ",
            said_by_pmg_sil("--robot", ROBOT, "--out", self.folder, "--motor", path),
            said_by_training(checked_files.read_motor_file, ROBOT, path),
        )
        self.assertIn("none.yaml: ", said_by_training(checked_files.read_randomization, path))

    def test_what_is_right_is_read_whole(self):
        path = self.write(
            "motor.yaml", "joints:\n  right_knee: {}\n  left_knee:\n    friction:\n      coulomb_Nm: 0.5\n    command: {delay_s: 0.004}\n"
        )
        self.assertEqual(
            checked_files.read_motor_file(LIBRARY, ROBOT, path),
            {"left_knee": {"friction.coulomb_Nm": 0.5, "command.delay_s": 0.004}, "right_knee": {}},
        )
        ranges = checked_files.read_randomization(LIBRARY, ROOT / "training/randomization.yaml")
        self.assertEqual(ranges["friction"], [0.4, 1.2])
        self.assertEqual(
            ranges["kicks"],
            {"every_s": [3.0, 8.0], "linear_m_s": 1.2, "vertical_m_s": 0.2, "angular_rad_s": 0.8, "from_share": 0.2, "ramp_iterations": 800},
        )
        self.assertIs(type(ranges["kicks"]["ramp_iterations"]), int)
        self.assertEqual(ranges["upper_body"]["amplitude_rad"]["elbow"], 0.4)
        steps = checked_files.read_scenario(LIBRARY, ROOT / "config/scenarios/tour.yaml")
        self.assertTrue(all(math.isfinite(u) for step in steps for u in step["command"]))
        lifted = [step["text"] for step in steps if step["hoist_without_policy"]]
        self.assertEqual((lifted[0], lifted[-1]), ("ready to walk", "stop"))

    def test_every_key_of_a_randomization_is_needed(self):
        lines = (ROOT / "training/randomization.yaml").read_text().splitlines(keepends=True)
        keys = [number for number, line in enumerate(lines) if ":" in line.split("#")[0] and not line.split("#")[0].rstrip().endswith(":")]
        self.assertEqual(len(keys), 25)
        for number in keys:
            path = self.write("randomization.yaml", "".join(lines[:number] + lines[number + 1 :]))
            self.assertIn(f"{lines[number].split(':')[0].strip()}: is missing", said_by_training(checked_files.read_randomization, path))

    def test_the_library_brings_no_other_mujoco(self):
        """Training's own MuJoCo is another version, in the same process."""
        program = "import sys; from pmg_train.library import load; load(sys.argv[1]); print(open('/proc/self/maps').read())"
        maps = subprocess.run([sys.executable, "-c", program, LIBRARY], cwd=ROOT / "training", capture_output=True, text=True, check=True).stdout
        self.assertIn("libpmg_batch.so", maps)
        for other in ("libmujoco", "libglfw", "OSMesa", "libonnxruntime"):
            self.assertNotIn(other, maps)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
