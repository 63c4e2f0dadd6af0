"""scripts/import-bench on files as people have them: what it writes, and what it refuses because no file says it."""

import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest
from typing import ClassVar

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BASE = ["--rig", "horizontal", "--law", "position_pd", "--row", "kp_Nm_per_rad=60", "--row", "kd_Nm_s_per_rad=2"]
MAPS = ["--map", "t_s=time[ms]", "--map", "q_cmd_rad=goal[deg]", "--map", "q_rad=pos[deg]"]


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def reader_packages():
    """The folder of the pinned readers of Parquet, MCAP and bags, or nothing."""
    found = subprocess.run([ROOT / "third_party/python-packages", "recordings", "--cached"], capture_output=True, text=True)
    return found.stdout.strip() if found.returncode == 0 else None


class ImportBench(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.out = self.folder / "bench"

    def file(self, name, lines):
        path = self.folder / name
        path.write_text("\n".join(lines) + "\n")
        return path

    def sine(self, name="log.csv", separator=",", times_ms=None, decimal="."):
        """20 rows of 10 ms: the goal in degrees, the position a degree behind, a current of 0.1 A a row."""
        times_ms = [10 * k for k in range(20)] if times_ms is None else times_ms
        lines = [separator.join(["time", "goal", "pos", "current"])]
        for k, t_ms in enumerate(times_ms):
            lines.append(separator.join(f"{value:.3f}".replace(".", decimal) for value in (t_ms, 30 + k, 29 + k, 100 * k)))
        return self.file(name, lines)

    def run_import(self, *words):
        return subprocess.run(
            [sys.executable, ROOT / "scripts/import-bench", *map(str, words), "--out", str(self.out)], capture_output=True, text=True
        )

    def expect_bench(self, *words):
        done = self.run_import(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return rows_of(self.out / "runs.csv")

    def expect_refused(self, word, *words, code=2):
        done = self.run_import(*words)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn(word, done.stderr)
        self.assertFalse(self.out.exists(), "nothing is written of what is refused")

    def test_units_separators_and_decimal_commas_give_the_same_bench(self):
        for name, separator, decimal in (("a.csv", ",", "."), ("b.csv", ";", ","), ("c.tsv", "\t", "."), ("d.txt", "  ", ".")):
            with self.subTest(separator):
                self.out = self.folder / f"bench-{name}"
                (run,) = self.expect_bench(self.sine(name, separator, decimal=decimal), *BASE, *MAPS)
                self.assertEqual(run["kp_Nm_per_rad"], "60")
                rows = rows_of(self.out / "runs" / run["file"])
                self.assertEqual(list(rows[0]), ["t_s", "q_cmd_rad", "q_rad"])
                for k, row in enumerate(rows):
                    self.assertAlmostEqual(float(row["t_s"]), 0.01 * k, 9)
                    self.assertAlmostEqual(float(row["q_cmd_rad"]), math.radians(30 + k), 8)
                    self.assertAlmostEqual(float(row["q_rad"]), math.radians(29 + k), 8)
                self.assertIn("sample_rate_hz: 100\n", (self.out / "bench.yaml").read_text())

    def test_a_current_is_a_torque_by_a_constant_alone(self):
        self.expect_refused("--torque-constant", self.sine(), *BASE, *MAPS, "--map", "torque_Nm=current[mA]")
        (run,) = self.expect_bench(self.sine(), *BASE, *MAPS, "--map", "torque_Nm=current[mA]", "--torque-constant", "0.5")
        self.assertAlmostEqual(float(rows_of(self.out / "runs" / run["file"])[7]["torque_Nm"]), 0.35, 9)

    def test_ticks_of_an_encoder_count_from_their_zero(self):
        path = self.file("log.csv", ["t_s,goal,pos_ticks", *(f"{0.01 * k},0.0,{2048 + 1024 * (k % 2)}" for k in range(12))])
        (run,) = self.expect_bench(path, *BASE, "--map", "t_s=t_s", "--map", "q_cmd_rad=goal[rad]", "--map", "q_rad=pos_ticks[tick/4096]-2048")
        self.assertAlmostEqual(float(rows_of(self.out / "runs" / run["file"])[1]["q_rad"]), math.pi / 2, 8)

    def test_a_unit_that_neither_name_nor_option_says_is_refused(self):
        self.expect_refused("what unit 'pos' is in", self.sine(), *BASE, *MAPS[:4], "--map", "q_rad=pos")
        self.expect_refused("measures an angle", self.sine(), *BASE, "--map", "t_s=time[deg]", *MAPS[2:])
        self.expect_refused("measures a time", self.sine(), *BASE, *MAPS[:4], "--map", "q_rad=pos[ms]")

    def test_degrees_told_to_be_radians_are_asked_about(self):
        rad = ["--map", "t_s=time[ms]", "--map", "q_cmd_rad=goal[rad]", "--map", "q_rad=pos[rad]"]
        done = self.run_import(self.sine(), *BASE, *rad)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("log.csv: q_rad reaches 48 rad, 7.64 turns; were these degrees?", done.stderr)
        self.out = self.folder / "degrees"
        self.assertEqual(self.run_import(self.sine(), *BASE, *MAPS).stderr, "")

    def test_gains_that_nothing_says_are_refused(self):
        self.expect_refused("kp_Nm_per_rad and kd_Nm_s_per_rad", self.sine(), *BASE[:4], *MAPS)

    def test_a_rig_without_a_load_and_a_law_without_its_constant_are_refused(self):
        self.expect_refused("expected --load", self.sine(), "--rig", "pendulum", *BASE[2:], *MAPS)
        servo = ["--rig", "horizontal", "--law", "servo_voltage", "--row", "kp_firmware=16"]
        self.expect_refused("--drive error_gain_per_rad=NUMBER or =unknown", self.sine(), *servo, *MAPS)

    def test_a_gap_is_told_with_its_place_and_split_on_request(self):
        path = self.sine(times_ms=[10 * k + (500 if k >= 10 else 0) for k in range(20)])
        self.expect_refused("1 gap, the first of 0.51 s at 0.09 s", path, *BASE, *MAPS, code=1)
        runs = self.expect_bench(path, *BASE, *MAPS, "--gaps", "split", "--from-zero")
        self.assertEqual([run["file"] for run in runs], ["log-part1.csv", "log-part2.csv"])
        self.assertEqual(len({run["trajectory"] for run in runs}), 2, "parts are no repeats of each other")
        self.assertEqual(float(rows_of(self.out / "runs/log-part2.csv")[0]["t_s"]), 0.0)

    def test_a_clock_that_stands_or_jumps_back_is_told_and_its_rows_dropped_on_request(self):
        path = self.sine(times_ms=[10 * k for k in range(15)] + [140, 130, 150, 160, 170])
        self.expect_refused("row 17 the clock goes from 0.14 s to 0.14 s", path, *BASE, *MAPS, code=1)
        done = self.run_import(path, *BASE, *MAPS, "--clock", "drop")
        self.assertEqual(done.returncode, 0)
        self.assertIn("2 rows are left out", done.stderr)
        self.assertEqual(len(rows_of(self.out / "runs/log.csv")), 18)

    def test_a_stretch_that_is_too_short_for_a_run_is_told(self):
        path = self.sine(times_ms=[10 * k + (500 if k >= 15 else 0) for k in range(20)])
        done = self.run_import(path, *BASE, *MAPS, "--gaps", "split")
        self.assertEqual(done.returncode, 0)
        self.assertIn("5 rows are left out, in stretches of fewer than 10", done.stderr)
        self.assertEqual(len(rows_of(self.out / "runs.csv")), 1)

    def test_a_cell_that_is_no_number_a_missing_column_and_a_ragged_row_are_refused_with_their_place(self):
        rows = [f"{10 * k},1,2" for k in range(12)]
        self.expect_refused("row 3 of 'pos' is 'nan'", self.file("a.csv", ["time,goal,pos", rows[0], "10,1,nan", *rows[2:]]), *BASE, *MAPS)
        self.expect_refused("has no column 'pos'; it has 'time', 'goal', 'angle'", self.file("b.csv", ["time,goal,angle", *rows]), *BASE, *MAPS)
        self.expect_refused("no separator", self.file("c.csv", ["time,goal,pos", *rows, "1,2"]), *BASE, *MAPS)
        self.expect_refused("its first row is numbers", self.file("d.csv", rows), *BASE, *MAPS)
        self.expect_refused("no --map of q_rad", self.sine(), *BASE, *MAPS[:4])

    def test_what_a_files_name_says_is_in_its_row(self):
        path = self.sine("sines_kp40_r1.csv")
        pattern = r"(?P<trajectory>\w+)_kp(?P<kp_Nm_per_rad>\d+)_r(?P<repeat>\d)"
        (run,) = self.expect_bench(path, *BASE[:4], "--row", "kd_Nm_s_per_rad=1", "--name", pattern, *MAPS)
        self.assertEqual((run["trajectory"], run["kp_Nm_per_rad"], run["repeat"]), ("sines", "40", "1"))
        self.out = self.folder / "other"
        self.expect_refused("doesn't fit --name", self.sine("other.csv"), *BASE, "--name", pattern, *MAPS)

    def test_an_existing_folder_and_another_kind_of_file_are_refused(self):
        self.expect_refused("none of the kinds", self.file("log.mat", ["x"]), *BASE, *MAPS)
        self.out.mkdir()
        done = self.run_import(self.sine(), *BASE, *MAPS)
        self.assertEqual(done.returncode, 2)
        self.assertIn("is there already", done.stderr)

    def need_readers(self):
        packages = reader_packages()
        if packages is None:
            self.skipTest("NOT TESTED: Parquet, MCAP, ROS bags: third_party/python-packages recordings makes their readers")
        if packages not in sys.path:
            sys.path.insert(0, packages)

    TOPIC_MAPS: ClassVar = ["--map", "t_s=log_time[ns]", "--map", "q_cmd_rad=velocity.knee[rad]", "--map", "q_rad=position.knee[deg]", "--from-zero"]

    def expect_bag(self, path):
        """20 messages 10 ms apart of two joints, whose knee goes a degree a message."""
        (run,) = self.expect_bench(path, *BASE, *self.TOPIC_MAPS, "--topic", "/joints")
        rows = rows_of(self.out / "runs" / run["file"])
        self.assertEqual(len(rows), 20)
        for k, row in enumerate(rows):
            self.assertAlmostEqual(float(row["t_s"]), 0.01 * k, 6)
            self.assertAlmostEqual(float(row["q_rad"]), math.radians(k), 8)
            self.assertAlmostEqual(float(row["q_cmd_rad"]), 10 + k, 8)

    def test_a_topic_of_an_mcap_file_in_json_is_a_run(self):
        self.need_readers()
        from mcap.writer import Writer

        path = self.folder / "log.mcap"
        with open(path, "wb") as file:
            writer = Writer(file)
            writer.start()
            schema = writer.register_schema("joints", "jsonschema", b"{}")
            channels = {
                topic: writer.register_channel(topic, encoding, schema)
                for topic, encoding in (("/joints", "json"), ("/odd", "json"), ("/other", "protobuf"))
            }
            for k in range(12):
                writer.add_message(channels["/odd"], 10**9 + k, json.dumps({"position": 1.0, **({"extra": 1} if k == 7 else {})}).encode(), 0)
            for k in range(20):
                message = {"name": ["hip", "knee"], "position": [7.0, float(k)], "velocity": [0.0, 10.0 + k], "goal": {"kp": 3}}
                writer.add_message(channels["/joints"], 10**9 + 10_000_000 * k, json.dumps(message).encode(), 0)
            writer.add_message(channels["/other"], 10**9, b"x", 0)
            writer.finish()
        self.expect_refused("choose one by --topic: /joints, /odd, /other", path, *BASE, *self.TOPIC_MAPS)
        self.expect_refused("has no topic '/join'", path, *BASE, *self.TOPIC_MAPS, "--topic", "/join")
        self.expect_bag(path)
        self.out = self.folder / "second"
        self.expect_refused("message 7 of /odd has other fields than the first: extra", path, *BASE, *self.TOPIC_MAPS, "--topic", "/odd")
        self.expect_refused("/other is encoded as protobuf", path, *BASE, *self.TOPIC_MAPS, "--topic", "/other")
        self.expect_refused("no column 'goal.kd'", path, *BASE, *self.TOPIC_MAPS[:4], "--map", "q_rad=goal.kd[deg]", "--topic", "/joints")
        path.write_bytes(path.read_bytes()[:100])
        self.expect_refused("can't be read as MCAP", path, *BASE, *self.TOPIC_MAPS)

    def test_a_topic_of_a_ros_2_bag_is_a_run(self):
        self.need_readers()
        import numpy
        from rosbags.rosbag2 import StoragePlugin, Writer
        from rosbags.typesys import Stores, get_typestore

        store = get_typestore(Stores.ROS2_HUMBLE)
        for name, plugin in (("sqlite", StoragePlugin.SQLITE3), ("mcap", StoragePlugin.MCAP)):
            with self.subTest(name):
                self.out = self.folder / f"bench-{name}"
                bag = self.folder / f"bag-{name}"
                kind = "sensor_msgs/msg/JointState"
                with Writer(bag, version=9, storage_plugin=plugin) as writer:
                    joints, other = (writer.add_connection(topic, kind, typestore=store) for topic in ("/joints", "/other"))
                    for k in range(20):
                        stamp = store.types["builtin_interfaces/msg/Time"](sec=5, nanosec=10_000_000 * k)
                        message = store.types[kind](
                            header=store.types["std_msgs/msg/Header"](stamp=stamp, frame_id=""),
                            name=["hip", "knee"], position=numpy.array([7.0, k]), velocity=numpy.array([0.0, 10.0 + k]), effort=numpy.array([]),
                        )  # fmt: skip
                        writer.write(joints, 10**9 + 10_000_000 * k, store.serialize_cdr(message, kind))
                        writer.write(other, 10**9 + 7_000_000 * k, store.serialize_cdr(message, kind))
                self.expect_bag(bag if name == "sqlite" else next(bag.glob("*.mcap")))
                self.out = self.folder / f"stamp-{name}"
                maps = ["--map", "t_s=header.stamp[ns]", *self.TOPIC_MAPS[2:6]]
                (run,) = self.expect_bench(bag, *BASE, *maps, "--topic", "/joints")
                self.assertAlmostEqual(float(rows_of(self.out / "runs" / run["file"])[3]["t_s"]), 5.03, 6)

    def test_a_topic_of_a_ros_1_bag_is_a_run(self):
        self.need_readers()
        import numpy
        from rosbags.rosbag1 import Writer
        from rosbags.typesys import Stores, get_typestore

        store = get_typestore(Stores.ROS1_NOETIC)
        path, kind = self.folder / "log.bag", "sensor_msgs/msg/JointState"
        with Writer(path) as writer:
            joints, other = (writer.add_connection(topic, kind, typestore=store) for topic in ("/joints", "/other"))
            for k in range(20):
                stamp = store.types["builtin_interfaces/msg/Time"](sec=5, nanosec=10_000_000 * k)
                message = store.types[kind](
                    header=store.types["std_msgs/msg/Header"](seq=k, stamp=stamp, frame_id=""),
                    name=["hip", "knee"], position=numpy.array([7.0, k]), velocity=numpy.array([0.0, 10.0 + k]), effort=numpy.array([]),
                )  # fmt: skip
                writer.write(joints, 10**9 + 10_000_000 * k, store.serialize_ros1(message, kind))
                writer.write(other, 10**9 + 10_000_000 * k, store.serialize_ros1(message, kind))
        self.expect_bag(path)

    def test_a_topic_is_asked_of_recordings_that_have_some(self):
        self.expect_refused("has no topics", self.sine(), *BASE, *MAPS, "--topic", "/joints")
        self.expect_refused("a folder without metadata.yaml", self.folder, *BASE, *MAPS)

    def test_episodes_of_a_parquet_file_are_runs(self):
        self.need_readers()
        import pyarrow
        import pyarrow.parquet

        table = {
            "timestamp": [0.02 * k for k in range(15)] * 2,
            "observation.state": [[0.0, float(k)] for k in range(30)],
            "action": [[0.0, 1.0 + k] for k in range(30)],
            "episode_index": [0] * 15 + [1] * 15,
        }
        path = self.folder / "file-000.parquet"
        pyarrow.parquet.write_table(pyarrow.table(table), path)
        maps = ["--map", "t_s=timestamp[s]", "--map", "q_cmd_rad=action#1[deg]", "--map", "q_rad=observation.state#1[deg]"]
        runs = self.expect_bench(path, *BASE, *maps, "--episode", "episode_index")
        self.assertEqual([run["file"] for run in runs], ["file-000-0.csv", "file-000-1.csv"])
        second = rows_of(self.out / "runs/file-000-1.csv")
        self.assertAlmostEqual(float(second[0]["q_rad"]), math.radians(15), 9)
        self.assertAlmostEqual(float(second[0]["q_cmd_rad"]), math.radians(16), 9)


if __name__ == "__main__":
    unittest.main()
