"""Writes test/data/policies/linear.onnx: one random linear layer with the metadata of a trained policy, small enough to commit.

Example: python3 training/tests/make_linear_policy.py runs/pmg/actor.pt config/robots/z1 test/data/policies/linear.onnx
"""

import json
import sys
from pathlib import Path

import onnx
import torch

from pmg_train import export

checkpoint = torch.load(sys.argv[1], map_location="cpu", weights_only=False)
generator = torch.Generator().manual_seed(1)
size, actions = checkpoint["description"]["observation"]["size"], len(checkpoint["description"]["action_joints"])
actor = {"actor_norm.mean": torch.zeros(size), "actor_norm.variance": torch.ones(size),
         "actor.0.weight": 0.02 * torch.randn(actions, size, generator=generator), "actor.0.bias": torch.zeros(actions)}
model = export.graph_of(actor)
meta = export.metadata(checkpoint, Path(sys.argv[2]))
meta["clip_library_sha256"] = "0" * 64  # of no library: tests bring their own number
meta["training"] = {}
meta["golden"] = export.golden(model, actor)[:2]
entry = model.metadata_props.add()
entry.key, entry.value = "pmg_policy", json.dumps(meta)
onnx.save(model, sys.argv[3])
