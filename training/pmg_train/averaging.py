"""The mean policy of several checkpoints of one run.

Learning never comes to rest: from one checkpoint to the next the same policy drifts to the left, then to the right, and its feet land now
early, now late. The mean of the weights does less of both (training/README.md).
"""

import torch

RUN = ("variant", "seed", "processes", "inputs", "config", "randomization")  # what checkpoints of one run have in common


def averaged(checkpoints: list[dict]) -> dict:
    """The last checkpoint with the mean of all actors (networks, mean and variance of the observation), and `averaged_iterations`.

    One checkpoint is given back as it is. Raises ValueError for checkpoints of different runs, or one of them twice."""
    checkpoints = sorted(checkpoints, key=lambda c: c["iteration"])
    last = checkpoints[-1]
    if len(checkpoints) == 1:
        return last
    for key in RUN:
        if any(c[key] != last[key] for c in checkpoints):
            raise ValueError(f"checkpoints of several runs: they differ in {key}")
    iterations = [c["iteration"] for c in checkpoints]
    if len(set(iterations)) < len(iterations):
        raise ValueError(f"the same checkpoint twice: iterations {iterations}")
    actor = {name: torch.stack([c["actor"][name].double() for c in checkpoints]).mean(0) for name in last["actor"]}
    return last | dict(actor=actor, averaged_iterations=iterations)
