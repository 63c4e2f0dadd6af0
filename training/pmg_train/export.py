"""Writes a trained actor as ONNX, with the metadata that a controller checks before it uses the policy.

Example: python3 -m pmg_train.export runs/pmg/actor.pt --robot config/robots/z1 --out pmg.onnx
Exit codes: 0 done, 2 bad input.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np
import onnx
import torch
from onnx import TensorProto, helper, numpy_helper

from pmg_train.inputs import clip_library_hash
from pmg_train.robot import policy_gains

OPSET, IR_VERSION = 17, 8  # ONNX Runtime 1.21 reads IR 10 and below
GOLDEN_PAIRS = 8
GOLDEN_TOLERANCE = 1e-4
ACTION_LIMIT = 4.0  # the environment's clamp


def graph_of(actor: dict[str, torch.Tensor]) -> onnx.ModelProto:
    array = lambda key: actor[key].double().numpy()
    mean, variance = array("actor_norm.mean"), array("actor_norm.variance")
    scale = 1 / np.sqrt(variance + 1e-4)
    constants = {"mean": mean, "scale": scale, "low": np.array(-8.0), "high": np.array(8.0)}
    nodes = [
        helper.make_node("Sub", ["observation", "mean"], ["centred"]),
        helper.make_node("Mul", ["centred", "scale"], ["scaled"]),
        helper.make_node("Clip", ["scaled", "low", "high"], ["h"]),
    ]
    layers = sorted({int(k.split(".")[1]) for k in actor if k.startswith("actor.")})
    value = "h"
    for i, layer in enumerate(layers):
        constants[f"w{i}"], constants[f"b{i}"] = array(f"actor.{layer}.weight"), array(f"actor.{layer}.bias")
        last = i == len(layers) - 1
        out = "raw" if last else f"g{i}"
        nodes.append(helper.make_node("Gemm", [value, f"w{i}", f"b{i}"], [out], transB=1))
        if not last:
            nodes.append(helper.make_node("Elu", [out], [f"e{i}"]))
            value = f"e{i}"
    constants["action_low"], constants["action_high"] = np.array(-ACTION_LIMIT), np.array(ACTION_LIMIT)
    nodes.append(helper.make_node("Clip", ["raw", "action_low", "action_high"], ["action"]))
    initializers = [numpy_helper.from_array(v.astype(np.float32), k) for k, v in constants.items()]
    actions = constants[f"b{len(layers) - 1}"].shape[0]
    graph = helper.make_graph(
        nodes,
        "pmg_policy",
        [helper.make_tensor_value_info("observation", TensorProto.FLOAT, [1, mean.shape[0]])],
        [helper.make_tensor_value_info("action", TensorProto.FLOAT, [1, actions])],
        initializers,
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)], producer_name="pmg_train")
    model.ir_version = IR_VERSION
    onnx.checker.check_model(model)
    return model


def golden(model: onnx.ModelProto, actor: dict[str, torch.Tensor], seed: int = 1) -> list[dict]:
    """Observations of plausible size and the actions that a plain double-precision evaluation gives."""
    weights = {i.name: numpy_helper.to_array(i).astype(np.float64) for i in model.graph.initializer}
    random = np.random.default_rng(seed)
    mean, scale = weights["mean"], weights["scale"]
    layers = sum(1 for name in weights if name.startswith("w"))
    pairs = []
    for _ in range(GOLDEN_PAIRS):
        seen = (mean + random.normal(size=mean.shape) / scale).astype(np.float32)
        h = np.clip((seen - mean) * scale, -8, 8)
        for i in range(layers):
            h = weights[f"w{i}"] @ h + weights[f"b{i}"]
            if i < layers - 1:
                h = np.where(h > 0, h, np.expm1(np.minimum(h, 0)))
        pairs.append({"observation": [float(x) for x in seen], "action": [float(x) for x in np.clip(h, -ACTION_LIMIT, ACTION_LIMIT)]})
    return pairs


def metadata(checkpoint: dict, robot: Path) -> dict:
    description, config = checkpoint["description"], checkpoint["config"]
    kp, kd = policy_gains(description, config["gains"])
    names = [j["name"] for j in description["joints"]]
    return {
        "format": 1,
        "robot": description["robot"],
        "variant": checkpoint["variant"],
        "joints": names,
        "action_joints": description["action_joints"],
        "action_scale": config["action_scale"],
        "action_limit": ACTION_LIMIT,
        "observation": description["observation"],
        "stand_rad": [j["stand_rad"] for j in description["joints"]],
        "kp_Nm_per_rad": kp.tolist(),
        "kd_Nm_s_per_rad": kd.tolist(),
        "policy_rate_Hz": round(1 / config["tick_s"]),
        "clip_library_sha256": clip_library_hash(robot),
        "golden_tolerance": GOLDEN_TOLERANCE,
        "training": {k: checkpoint[k] for k in ("seed", "iteration", "steps", "learned_s", "processes", "inputs")},
    }


def export(checkpoint: dict, robot: Path, out: Path) -> dict:
    if clip_library_hash(robot) != checkpoint["inputs"]["clips"]:
        raise ValueError(f"{robot}: other clips than those that the policy was trained on")
    model = graph_of(checkpoint["actor"])
    meta = metadata(checkpoint, robot)
    meta["golden"] = golden(model, checkpoint["actor"])
    entry = model.metadata_props.add()
    entry.key, entry.value = "pmg_policy", json.dumps(meta)
    onnx.save(model, out)
    return meta


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkpoint", type=Path)
    parser.add_argument("--robot", type=Path, required=True)
    parser.add_argument("--out", type=Path, required=True)
    a = parser.parse_args()
    try:
        meta = export(torch.load(a.checkpoint, map_location="cpu", weights_only=False), a.robot, a.out)
    except (OSError, KeyError, ValueError) as error:
        print(f"export: {error}", file=sys.stderr)
        return 2
    print(f"{a.out}: {meta['variant']}, {meta['observation']['size']} -> {len(meta['action_joints'])}, {meta['training']['steps'] / 1e6:.0f} M steps")
    return 0


if __name__ == "__main__":
    sys.exit(main())
