"""A run that is interrupted and resumed learns exactly what an uninterrupted one learns."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import torch

HERE = Path(__file__).resolve().parent.parent
LIBRARY, ROBOT, MJCF = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT", "PMG_MJCF"))
pytestmark = pytest.mark.skipif(not (LIBRARY and ROBOT and MJCF), reason="PMG_BATCH_LIBRARY, PMG_ROBOT, PMG_MJCF not set")


def train(out: Path, iterations: int, *more: str) -> dict:
    subprocess.run([sys.executable, "-m", "pmg_train.train", "--robot", ROBOT, "--mjcf", MJCF, "--library", LIBRARY,
                    "--out", str(out), "--worlds", "4", "--streams", "4", "--ticks", "400", "--threads", "1", "--seed", "3",
                    "--device", "cpu", "--iterations", str(iterations), *more], cwd=HERE, check=True)
    return torch.load(out / "last.pt", weights_only=False)


def test_resumed_run_equals_the_uninterrupted_one(tmp_path):
    whole = train(tmp_path / "whole", 2)
    train(tmp_path / "parts", 1)
    parts = train(tmp_path / "parts", 2, "--resume")
    assert parts["iteration"] == 2
    for name, value in whole["network"].items():
        assert torch.equal(value, parts["network"][name]), name
