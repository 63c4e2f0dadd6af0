"""Several checkpoints of a run are exported as the mean of their weights."""

import pytest
import torch

from pmg_train.averaging import averaged


def checkpoint(iteration: int, weight: float, **other) -> dict:
    actor = {"actor.0.weight": torch.full((2, 3), weight), "actor_norm.variance": torch.full((3,), 2 * weight)}
    run = dict(variant="pmg", seed=1, processes=1, inputs={"clips": "a"}, config={}, randomization={})
    return dict(actor=actor, iteration=iteration, **(run | other))


def test_weights_are_the_mean_and_the_rest_is_the_lasts():
    result = averaged([checkpoint(30, 4.0), checkpoint(10, 1.0), checkpoint(20, 1.0)])
    assert torch.equal(result["actor"]["actor.0.weight"], torch.full((2, 3), 2.0, dtype=torch.float64))
    assert torch.equal(result["actor"]["actor_norm.variance"], torch.full((3,), 4.0, dtype=torch.float64))
    assert result["iteration"] == 30
    assert result["averaged_iterations"] == [10, 20, 30]


def test_one_checkpoint_stays_as_it_is():
    alone = checkpoint(10, 1.0)
    assert averaged([alone]) is alone


@pytest.mark.parametrize("other", [dict(seed=2), dict(variant="without_gco"), dict(inputs={"clips": "b"}), dict(config={"tick_s": 0.02})])
def test_checkpoints_of_several_runs_are_refused(other):
    with pytest.raises(ValueError, match=f"differ in {next(iter(other))}"):
        averaged([checkpoint(10, 1.0), checkpoint(20, 1.0, **other)])


def test_a_checkpoint_counts_once():
    with pytest.raises(ValueError, match="twice"):
        averaged([checkpoint(10, 1.0), checkpoint(10, 1.0)])
