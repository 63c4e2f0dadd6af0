"""Writes test/data/policies/linear.onnx: one random linear layer with the metadata of a trained policy, small enough to commit.

To be run again when robot, observation layout or metadata change. Clips may change: the policy is of no clip library, and tests
that need one write their library's hash over the zeros; the blanks behind the variant make room for the longer names likewise
(test/policy/linear_policy.hpp). Needs training's Python packages but no GPU.

Example: cmake --build build/release --target pmg_batch
         PYTHONPATH=training python3 training/tests/make_linear_policy.py build/release/lib/libpmg_batch.so config/robots/z1 \
             test/data/policies/linear.onnx
"""

import json
import sys
from pathlib import Path

import onnx
import torch

from pmg_train import export
from pmg_train.configuration import load_config
from pmg_train.references import ReferenceBatch

VARIANT_ROOM = len("single_gait") - len("pmg")


def main(library: str, robot: Path, out: Path) -> None:
    description = ReferenceBatch(library, robot).description
    config = load_config(Path(export.__file__).parent.parent / "config.yaml")
    generator = torch.Generator().manual_seed(1)
    size, actions = description["observation"]["size"], len(description["action_joints"])
    actor = {
        "actor_norm.mean": torch.zeros(size),
        "actor_norm.variance": torch.ones(size),
        "actor.0.weight": 0.02 * torch.randn(actions, size, generator=generator),
        "actor.0.bias": torch.zeros(actions),
    }
    checkpoint = dict(description=description, config=config, variant="pmg", seed=1, iteration=0, steps=0, learned_s=0.0, processes=1, inputs={})
    model = export.graph_of(actor)
    meta = export.metadata(checkpoint, robot) | {"clip_library_sha256": "0" * 64, "training": {}, "golden": export.golden(model, actor)[:2]}
    text = json.dumps(meta)
    entry = model.metadata_props.add()
    entry.key, entry.value = "pmg_policy", text.replace('"variant": "pmg"', '"variant": "pmg"' + " " * VARIANT_ROOM)
    onnx.save(model, out)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3]))
