"""A wrong file that the C++ programs read too stops a training with the line of their reader.

test/training/reading_test.py compares that line with pmg_sil's, for many errors.
"""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from pmg_train.checked_files import read_motor_file, read_randomization

HERE = Path(__file__).resolve().parent.parent
LIBRARY, ROBOT, MJCF = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT", "PMG_MJCF"))
pytestmark = pytest.mark.skipif(not (LIBRARY and ROBOT), reason="PMG_BATCH_LIBRARY, PMG_ROBOT not set")
NO_KEY = "joints:\n  left_knee:\n    friction: {culomb_Nm: 1}\n"


def test_a_motor_file_is_read_whole_or_refused(tmp_path):
    path = tmp_path / "motor.yaml"
    path.write_text("joints:\n  left_knee:\n    friction:\n      coulomb_Nm: 0.5\n    command: {delay_s: 0.004}\n  right_knee: {}\n")
    assert read_motor_file(LIBRARY, ROBOT, path) == {"left_knee": {"friction.coulomb_Nm": 0.5, "command.delay_s": 0.004}, "right_knee": {}}
    path.write_text(NO_KEY)
    with pytest.raises(ValueError) as refused:
        read_motor_file(LIBRARY, ROBOT, path)
    assert str(refused.value) == f"{path}:3:16: joints.left_knee.friction.culomb_Nm: is unknown; did you mean coulomb_Nm?"


def test_the_committed_randomization_is_complete():
    assert read_randomization(LIBRARY, HERE / "randomization.yaml")["friction"] == [0.4, 1.2]


@pytest.mark.skipif(not MJCF, reason="PMG_MJCF not set")
@pytest.mark.parametrize(
    "option, text, said",
    [
        ("--motor", NO_KEY, ":3:16: joints.left_knee.friction.culomb_Nm: is unknown; did you mean coulomb_Nm?"),
        (
            "--motor",
            "joints: {left_knee: {friction: {load_driving: 0.1, load_net: 1}}}\n",
            ": joints.left_knee.friction.load_net: training doesn't know what else turns a joint; calibrate without it, or with load_by_motor",
        ),
        ("--randomization", "friction: [1.2, 0.4]\n", ":1:11: friction: runs backwards; expected [lower, upper]"),
    ],
)
def test_a_training_ends_with_that_line(tmp_path, option, text, said):
    path = tmp_path / "wrong.yaml"
    path.write_text(text)
    given = [word for name, value in (("--robot", ROBOT), ("--mjcf", MJCF), ("--library", LIBRARY)) for word in (name, str(Path(value).resolve()))]
    run = subprocess.run(
        [
            sys.executable,
            "-m",
            "pmg_train.train",
            *given,
            option,
            str(path),
            "--out",
            str(tmp_path / "out"),
            "--worlds",
            "2",
            "--streams",
            "1",
            "--ticks",
            "10",
            "--threads",
            "1",
            "--device",
            "cpu",
            "--iterations",
            "1",
        ],
        cwd=HERE,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 2
    assert run.stderr.splitlines()[-1] == f"train: {path}{said}"
