"""What Foxglove and PlotJuggler get of a walk of Z1: a second in the simulation, exported, and read without any code of this project.

The robot in 3D is computed here from the URDF and the joint states of the MCAP file, and compared with its transforms; everything that the layout
config/foxglove/walk.json names must be in the file. Usage: walk_export_test.py FOLDER_OF_PROGRAMS     Exit code 77: NumPy or zstandard is missing
"""

import csv
import json
import math
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "third_party/prefix/python"))
try:
    import numpy as np
    import zstandard  # noqa: F401  the chunks' compression
    from mcap.reader import make_reader
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)

SCENARIO = "name: short\nsteps:\n  - {for_s: 0.5, text: stands, mode: stand}\n  - {for_s: 0.5, text: walks, mode: walk, command: {vx_m_s: 0.4}}\n"
PANELS = {"3D", "Plot", "StateTransitions", "RosOut"}
NUMBER_DIGITS = 2e-6  # numbers have a 32-bit float's seven digits; a link's frame is the product of two


def rotation(axis, angle):
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def of_quaternion(q):
    w, x, y, z = (q[name] for name in "wxyz")
    assert abs(w * w + x * x + y * y + z * z - 1) < 1e-5, q
    return rotation([x, y, z], 2 * math.atan2(math.hypot(x, y, z), w)) if math.hypot(x, y, z) > 0 else np.eye(3)


def numbers(element, name, default="0 0 0"):
    return [float(one) for one in (element.get(name, default) if element is not None else default).split()]


def joint_frame(joint, q_rad):
    """Rotation and translation of a joint's child in its parent, as the URDF's specification says."""
    origin = joint.find("origin")
    roll, pitch, yaw = numbers(origin, "rpy")
    R = rotation([0, 0, 1], yaw) @ rotation([0, 1, 0], pitch) @ rotation([1, 0, 0], roll)
    if joint.get("type") != "fixed":
        R = R @ rotation(numbers(joint.find("axis"), "xyz", "1 0 0"), q_rad)
    return R, numbers(origin, "xyz")


def check_robot(messages):
    """Every link of the URDF has its place in every /tf, where its joint puts it."""
    urdf = ElementTree.fromstring(messages["/robot_description"][0][1]["data"])
    joints = {joint.find("child").get("link"): joint for joint in urdf.findall("joint")}
    links = {link.get("name") for link in urdf.findall("link")}
    assert any(link.find("visual") is not None for link in urdf.findall("link")), "nothing to draw"
    assert not urdf.findall(".//mesh"), "a viewer elsewhere doesn't find meshes"
    states = {time: {one["name"]: one["position"] for one in state["joints"]} for time, state in messages["/joint_states"]}
    assert len(messages["/tf"]) >= 50 - 1, len(messages["/tf"])
    for time, message in messages["/tf"]:
        frames = {one["child_frame_id"]: one for one in message["transforms"]}
        assert set(frames) == links, set(frames) ^ links
        roots = [one["parent_frame_id"] for name, one in frames.items() if name not in joints]
        assert roots == ["world"], roots
        for name, joint in joints.items():
            assert frames[name]["parent_frame_id"] == joint.find("parent").get("link"), name
            R, p = joint_frame(joint, states[time].get(joint.get("name"), 0.0))
            translation = frames[name]["translation"]
            assert np.allclose([translation[axis] for axis in "xyz"], p, atol=NUMBER_DIGITS), name
            assert np.allclose(of_quaternion(frames[name]["rotation"]), R, atol=NUMBER_DIGITS), name
    heights = [one["translation"]["z"] for one in message["transforms"] if one["parent_frame_id"] == "world"]
    assert 0.7 < heights[0] < 0.85, f"the pelvis stands {heights[0]} m high"


def value_at(path, messages):
    """What a path of Foxglove's ("STATE.q_rad.left_knee") names in the topic's last message."""
    topic, *names = re.findall(r"[\w/]+", path)
    assert topic in messages, f"{path}: no such topic"
    value = messages[topic][-1][1]
    for name in names:
        assert name in value, f"{path}: no {name} in {list(value)}"
        value = value[name]
    return value


def check_layout(layout, messages, schemas):
    panels = layout["configById"]
    placed = re.findall(r'"((?:\w+)!(?:\w+))"', json.dumps(layout["layout"]))
    assert sorted(placed) == sorted(panels) and len(placed) == len(set(placed)), "panels without a place, or places without a panel"
    assert {name.split("!")[0] for name in panels} == PANELS
    frames = {"world"} | {one["child_frame_id"] for one in messages["/tf"][0][1]["transforms"]}
    for name, panel in panels.items():
        kind = name.split("!")[0]
        if kind == "3D":
            assert panel["followTf"] in frames, f"follows {panel['followTf']}, which is no frame"
            robots = [layer for layer in panel["layers"].values() if layer["layerId"] == "foxglove.Urdf"]
            assert [schemas[layer["topic"]] for layer in robots] == ["std_msgs/String"] and robots[0]["sourceType"] == "topic"
            assert all(layer["frameId"] in frames for layer in panel["layers"].values() if "frameId" in layer)
            assert set(panel["topics"]) <= set(messages)
        elif kind == "RosOut":
            assert schemas[panel["topicToRender"]] == "foxglove.Log"
        else:
            expected = (int, float) if kind == "Plot" else str
            for path in panel["paths"]:
                value = value_at(path["value"], messages)
                assert isinstance(value, expected) and not isinstance(value, bool), f"{path['value']} is {value!r}"


def check_csv(folder):
    """As PlotJuggler wants it: one name a column, rows of one length, a time that never goes back, numbers that read as such."""
    for file in sorted(folder.glob("*.csv")):
        with open(file, newline="") as stream:
            header, *rows = csv.reader(stream)
        assert header[0] == "time_s" and len(set(header)) == len(header) and all(header), file
        assert all(len(row) == len(header) for row in rows), file
        times = [float(row[0]) for row in rows]
        assert times == sorted(times), file
    with open(folder / "STATE.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 100
    assert all(math.isfinite(float(row[name])) for row in rows for name in row if name.startswith(("q_rad.", "torque_Nm.")))
    with open(folder / "STATUS.csv", newline="") as stream:
        assert [row["mode_name"] for row in csv.DictReader(stream)][-1] == "WALK"


def main(programs: Path):
    with tempfile.TemporaryDirectory() as work:
        Path(work, "short.yaml").write_text(SCENARIO)
        for command in (
            [f"{programs}/pmg_sil", "--robot", "z1", "--policy", "pmg", "--scenario", "short.yaml", "--out", "run"],
            [f"{programs}/pmg_log", "export", "run", "--mcap", "run.mcap", "--csv", "csv"],
        ):
            done = subprocess.run(command, cwd=work, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
        messages, schemas = {}, {}
        with open(Path(work, "run.mcap"), "rb") as stream:
            for schema, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
                messages.setdefault(channel.topic, []).append((message.log_time, json.loads(message.data)))
                schemas[channel.topic] = schema.name
        check_csv(Path(work, "csv"))
    check_robot(messages)
    check_layout(json.loads((ROOT / "config/foxglove/walk.json").read_text()), messages, schemas)
    print("all as promised")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
