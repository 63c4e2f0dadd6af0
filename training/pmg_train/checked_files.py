"""Files that the C++ programs read too: randomization.yaml, motor.yaml, scenarios. The programs' own code reads and checks them, through
libpmg_batch.so. ValueError holds the line that pmg_sil prints for the same file."""

import json
from pathlib import Path

from pmg_train.library import load


def read_randomization(library: str | Path, path: str | Path) -> dict:
    """The file's keys and values; every key must be there. SI units, as the keys say."""
    return _read(library, "randomization", path)


def read_motor_file(library: str | Path, robot: str | Path, path: str | Path) -> dict[str, dict[str, float]]:
    """What isn't neutral, as "group.key", of each joint in the file. robot: the robot's directory. ValueError also for what training can't
    simulate."""
    motors = _read(library, "motors", robot, path)
    for joint, values in motors.items():
        if values.get("friction.load_net", 0.0) != 0.0:
            raise ValueError(
                f"{path}: joints.{joint}.friction.load_net: training doesn't know what else turns a joint; "
                "calibrate without it, or with load_by_motor"
            )
    return motors


def read_scenario(library: str | Path, path: str | Path) -> list[dict]:
    """Steps: text, for_s, command (vx, vy [m/s], omega [rad/s], pitch, roll [rad], height [m]), hoist_without_policy."""
    return _read(library, "scenario", path)


def _read(library: str | Path, kind: str, *paths: str | Path):
    lib = load(library)
    text = getattr(lib, f"pmg_batch_{kind}")(*(str(path).encode() for path in paths))
    if text is None:
        raise ValueError(lib.pmg_batch_error().decode())
    return json.loads(text.decode())
