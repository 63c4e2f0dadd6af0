"""A run that is interrupted and resumed learns exactly what an uninterrupted one learns, in one process and in several."""

import csv
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest
import torch

HERE = Path(__file__).resolve().parent.parent
LIBRARY, ROBOT, MJCF = (os.environ.get(name) for name in ("PMG_BATCH_LIBRARY", "PMG_ROBOT", "PMG_MJCF"))
pytestmark = pytest.mark.skipif(not (LIBRARY and ROBOT and MJCF), reason="PMG_BATCH_LIBRARY, PMG_ROBOT, PMG_MJCF not set")


def train(out: Path, processes: int, iterations: int, *more: str) -> dict:
    start = [sys.executable, "-m"]
    if processes > 1:
        # Port 0: a free one. --standalone of torch 1.13 takes port 29400, whoever holds it.
        start += ["torch.distributed.run", "--rdzv_backend", "c10d", "--rdzv_endpoint", "localhost:0", "--nproc_per_node", str(processes)]
        # Tee of stdout: with no redirection, the default, torch 1.13 fails under Python 3.11.
        start += ["--redirects", "1", "--tee", "1", "-m"]
    given = [word for option, path in (("--robot", ROBOT), ("--mjcf", MJCF), ("--library", LIBRARY)) for word in (option, str(Path(path).resolve()))]
    subprocess.run(
        [
            *start,
            "pmg_train.train",
            *given,
            "--out",
            str(out),
            "--worlds",
            "8",
            "--streams",
            "4",
            "--ticks",
            "400",
            "--threads",
            "1",
            "--seed",
            "3",
            "--device",
            "cpu",
            "--iterations",
            str(iterations),
            *more,
        ],
        # Tiny tensors: more threads a process only wait for each other.
        cwd=HERE,
        check=True,
        env=os.environ | {"OMP_NUM_THREADS": "1"},
    )
    return torch.load(out / "last.pt", weights_only=False)


@pytest.mark.parametrize("processes", [1, 2])
def test_resumed_run_equals_the_uninterrupted_one(tmp_path, processes):
    whole = train(tmp_path / "whole", processes, 2)
    first = train(tmp_path / "parts", processes, 1)
    parts = train(tmp_path / "parts", processes, 2, "--resume")
    assert parts["iteration"] == 2
    assert parts["steps"] == whole["steps"] == 2 * 24 * 8 * processes
    for name, value in whole["network"].items():
        assert torch.equal(value, parts["network"][name]), name
    policy = torch.load(tmp_path / "parts" / "actor.pt", weights_only=False)["actor"]
    for name, mean in whole["mean_actor"].items():
        assert torch.allclose(mean, (first["network"][name] + whole["network"][name]) / 2), name
        assert torch.equal(mean, policy[name]), name
    with open(tmp_path / "parts" / "curve.csv") as file:
        assert [int(row["iteration"]) for row in csv.DictReader(file)] == [1, 2]


@pytest.mark.skipif(not importlib.util.find_spec("tensorboard"), reason="TensorBoard is not installed")
def test_curves_are_in_tensorboard_too(tmp_path):
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    train(tmp_path, 1, 2)
    events = EventAccumulator(str(tmp_path / "tensorboard"))
    events.Reload()
    assert [e.step for e in events.Scalars("error/ankle_pitch")] == [1, 2]
