"""Reads config.yaml, which only training has. Every key must be there and known, every value must have its shape; else one clear line
says so. checked_files.py reads the files that the C++ programs read too."""

import math
from pathlib import Path

import yaml


def _is_number(value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


class Number:
    wanted = "a finite number"
    fits = staticmethod(_is_number)


class Pair:
    wanted = "[number, number]"

    @staticmethod
    def fits(value) -> bool:
        return isinstance(value, list) and len(value) == 2 and all(map(_is_number, value))


class Range:
    wanted = "[lower, upper]"

    @staticmethod
    def fits(value) -> bool:
        return Pair.fits(value) and value[0] <= value[1]


class Numbers:
    wanted = "{name: number, ...}"

    @staticmethod
    def fits(value) -> bool:
        return isinstance(value, dict) and all(map(_is_number, value.values()))


class Pairs:
    wanted = "{name: [number, number], ...}"

    @staticmethod
    def fits(value) -> bool:
        return isinstance(value, dict) and all(map(Pair.fits, value.values()))


class Widths:
    wanted = "[number, ...]"

    @staticmethod
    def fits(value) -> bool:
        return isinstance(value, list) and len(value) > 0 and all(map(_is_number, value))


class Jacobian:
    wanted = "auto, dense or sparse"

    @staticmethod
    def fits(value) -> bool:
        return value in ("auto", "dense", "sparse")


_EXPONENTIAL = {"weight": Number, "s": Number}

CONFIG = {
    "tick_s": Number,
    "physics": {
        "timestep_s": Number,
        "deployed_timestep_s": Number,
        "iterations": Number,
        "ls_iterations": Number,
        "contacts_per_world": Number,
        "constraints_per_world": Number,
        "jacobian": Jacobian,
    },
    "action_scale": Number,
    "gains": Pairs,
    "references": {"streams": Number, "ticks": Number},
    "episode_s": Number,
    "fall": {"height_share": Number, "upright": Number},
    "ppo": {
        "worlds": Number,
        "steps": Number,
        "epochs": Number,
        "minibatches": Number,
        "gamma": Number,
        "lambda": Number,
        "clip": Number,
        "learning_rate": Range,
        "kl_target": Number,
        "entropy": Pair,
        "entropy_iterations": Number,
        "initial_std": Number,
        "gradient_norm": Number,
        "hidden": Widths,
        "mean_iterations": Number,
    },
    "symmetry": {"weight": Number},
    "strictness": {"from_share": Number, "iterations": Range},
    "rewards": dict.fromkeys(
        ("velocity_slow", "velocity_fast", "yaw_rate", "height", "bob", "attitude", "joint_position", "joint_velocity"), _EXPONENTIAL
    )
    | {"joint_position_linear": Numbers}
    | dict.fromkeys(
        (
            "alive",
            "velocity_linear",
            "yaw_rate_linear",
            "attitude_linear",
            "height_linear",
            "contact_mismatch",
            "slip",
            "foot_tilt",
            "vertical_velocity",
            "rocking",
            "yaw_jitter",
            "torque",
            "power",
            "acceleration",
            "action_rate",
            "action_curvature",
            "action_size",
            "limits",
            "saturation",
            "standing_motion",
            "fall",
        ),
        Number,
    ),
    "joint_weight": Numbers,
    "average_s": Number,
}


def _check(value, schema, where: str) -> None:
    if not isinstance(schema, dict):
        if not schema.fits(value):
            raise ValueError(f"{where}: {value}; expected {schema.wanted}")
        return
    if not isinstance(value, dict):
        raise ValueError(f"{where}: {value}; expected a map with the keys {', '.join(schema)}")
    for key in value:
        if key not in schema:
            raise ValueError(f"{where}: unknown key {key}; expected {', '.join(schema)}")
    for key, inner in schema.items():
        if key not in value:
            raise ValueError(f"{where}: {key} is missing")
        _check(value[key], inner, f"{where}: {key}")


def load_config(path: str | Path) -> dict:
    """ValueError names the file, the key and the expected value."""
    path = Path(path)
    try:
        value = yaml.safe_load(path.read_text())
    except yaml.YAMLError as error:
        raise ValueError(f"{path}: {' '.join(str(error).split())}") from None
    _check(value, CONFIG, str(path))
    return value
