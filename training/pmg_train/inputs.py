"""What a policy is made from: SHA-256 of each input, so that its file says which run made it."""

import argparse
import hashlib
from pathlib import Path

HERE = Path(__file__).resolve().parent


def _of_files(paths: list[Path], root: Path) -> str:
    digest = hashlib.sha256()
    for path in sorted(paths):
        content = path.read_bytes()
        digest.update(f"{path.relative_to(root)}\n{len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def clip_library_hash(robot: Path) -> str:
    """The same as model::clip_library_sha256 (src/model/bundle.hpp)."""
    clips = robot / "clips"
    return _of_files([path for path in clips.iterdir() if path.suffix in (".csv", ".yaml")], clips)


def input_hashes(a: argparse.Namespace) -> dict[str, str]:
    """Of robot, mjcf, config, randomization, library and, if given, motor (train.py's arguments of these names): name -> SHA-256.
    clips: the robot's clip library; code: pmg_train's Python. The library is compiled, so another compiler gives another hash."""
    robot = Path(a.robot)
    hashes = {
        "robot.yaml": _of_files([robot / "robot.yaml"], robot),
        "urdf": _of_files(list(robot.glob("*.urdf")), robot),
        "clips": clip_library_hash(robot),
        "code": _of_files(list(HERE.glob("*.py")), HERE),
    }
    for name in ("mjcf", "config", "randomization", "library", "motor"):
        path = getattr(a, name)
        if path is not None:
            hashes[name] = hashlib.sha256(Path(path).read_bytes()).hexdigest()
    return hashes


def changed_inputs(before: dict[str, str], now: dict[str, str]) -> list[str]:
    """Names of inputs that make another policy. The compiled library and the code may differ: a mended host goes on."""
    names = (before.keys() | now.keys()) - {"library", "code"}
    return sorted(name for name in names if before.get(name) != now.get(name))
