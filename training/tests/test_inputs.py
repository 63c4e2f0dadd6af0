"""A policy says what it was made from, and a run doesn't go on from other inputs."""

import argparse
import os
import shutil
from pathlib import Path

import pytest

from pmg_train.inputs import changed_inputs, clip_library_hash, input_hashes

ROOT = Path(__file__).resolve().parents[2]
ROBOT = Path(os.environ.get("PMG_ROBOT") or ROOT / "config" / "robots" / "z1")


@pytest.fixture
def given(tmp_path):
    robot = tmp_path / "robot"
    shutil.copytree(ROBOT, robot, ignore=shutil.ignore_patterns("policies"))
    files = {}
    for name in ("mjcf", "config", "randomization", "library", "motor"):
        files[name] = tmp_path / name
        files[name].write_text(name)
    return argparse.Namespace(robot=str(robot), **files)


def appended(path: Path) -> None:
    path.write_text(path.read_text() + "\n")


@pytest.mark.parametrize(
    "name, of",
    [
        ("robot.yaml", lambda a: Path(a.robot) / "robot.yaml"),
        ("urdf", lambda a: Path(a.robot) / "z1.urdf"),
        ("clips", lambda a: Path(a.robot) / "clips" / "inverse.csv"),
        ("mjcf", lambda a: a.mjcf),
        ("config", lambda a: a.config),
        ("randomization", lambda a: a.randomization),
        ("motor", lambda a: a.motor),
    ],
)
def test_each_input_is_told_apart(given, name, of):
    before = input_hashes(given)
    assert changed_inputs(before, input_hashes(given)) == []
    appended(of(given))
    assert changed_inputs(before, input_hashes(given)) == [name]


def test_a_motor_that_comes_or_goes_is_a_change(given):
    before = input_hashes(given)
    given.motor = None
    assert changed_inputs(before, input_hashes(given)) == ["motor"]
    assert changed_inputs(input_hashes(given), before) == ["motor"]


def test_another_build_of_the_library_goes_on_and_is_recorded(given):
    before = input_hashes(given)
    appended(given.library)
    now = input_hashes(given)
    assert now["library"] != before["library"]
    assert changed_inputs(before, now) == []


def test_a_renamed_clip_is_another_library(given):
    before = clip_library_hash(Path(given.robot))
    clips = Path(given.robot) / "clips"
    (clips / "squat.csv").rename(clips / "crouch.csv")
    assert clip_library_hash(Path(given.robot)) != before
