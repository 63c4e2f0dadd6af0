"""scripts/import-policy and scripts/import-robot on the files of other projects: what they write, and what they name instead of guessing."""

import contextlib
import importlib.machinery
import importlib.util
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import types
import unittest
from typing import ClassVar

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FOUND = subprocess.run([ROOT / "third_party/python-packages", "policies", "--cached"], capture_output=True, text=True)
if FOUND.returncode == 0:
    sys.path.insert(0, FOUND.stdout.strip())
    loader = importlib.machinery.SourceFileLoader("import_policy", str(ROOT / "scripts/import-policy"))
    SCRIPT = importlib.util.module_from_spec(importlib.util.spec_from_loader("import_policy", loader))
    loader.exec_module(SCRIPT)
    import numpy
    import onnx
    import yaml

JOINTS = ["left_knee", "right_knee", "waist"]
RANGES = ["--vx", "-0.5", "1", "--vy", "-0.3", "0.3", "--omega", "-0.4", "0.4"]

# Two legs of one joint and a waist; the foot's spheres; a frame without mass for the IMU, turned by a quarter about z; a mesh.
LINK = (
    '<link name="{0}"><inertial><origin xyz="0 0 0"/><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>{1}</link>'
)
JOINT = (
    '<joint name="{0}" type="revolute"><parent link="pelvis"/><child link="{1}"/><axis xyz="0 1 0"/>'
    '<limit lower="{2}" upper="2" effort="100" velocity="20"/></joint>'
)
SPHERES = "".join(
    f'<collision><origin xyz="{x} {y} -0.02"/><geometry><sphere radius="0.01"/></geometry></collision>' for x in (-0.1, 0.2) for y in (-0.05, 0.05)
)
MESH = '<visual><geometry><mesh filename="torso.stl"/></geometry></visual>'
URDF = "<robot name='r'>" + "".join(
    [
        LINK.format("pelvis", ""), LINK.format("left_foot", SPHERES), LINK.format("right_foot", SPHERES), LINK.format("torso", MESH),
        '<link name="imu"/>', JOINT.format("left_knee", "left_foot", -0.1),
        JOINT.format("right_knee", "right_foot", -0.1), JOINT.format("waist", "torso", -2),
        '<joint name="imu_joint" type="fixed"><origin xyz="0.1 0 0.2" rpy="0 0 1.5707963"/><parent link="pelvis"/><child link="imu"/></joint>',
    ]
) + "</robot>"  # fmt: skip


def deploy():
    """As unitree_rl_lab writes it: gains in the motors' order, the rest in the policy's (right knee, waist, left knee)."""
    return {
        "joint_ids_map": [1, 2, 0], "step_dt": 0.02, "stiffness": [10.0, 20.0, 30.0], "damping": [1.0, 2.0, 3.0],
        "default_joint_pos": [0.2, 0.0, 0.3],
        "commands": {"base_velocity": {"ranges": {"lin_vel_x": [-0.5, 1.0], "lin_vel_y": [-0.3, 0.3], "ang_vel_z": [-0.2, 0.2], "heading": None}}},
        "actions": {"JointPositionAction": {"clip": None, "scale": [0.25, 0.25, 0.5], "offset": [0.2, 0.0, 0.3]}},
        "observations": {
            "base_ang_vel": {"params": {}, "clip": [-10, 10], "scale": [0.2, 0.2, 0.2], "history_length": 2},
            "velocity_commands": {"params": {}, "clip": None, "scale": [1, 1, 1], "history_length": 2},
            "joint_pos_rel": {"params": {}, "clip": None, "scale": [1, 1, 1], "history_length": 2},
            "last_action": {"params": {}, "clip": None, "scale": [1, 1, 1], "history_length": 2},
        },
    }  # fmt: skip


@unittest.skipUnless(FOUND.returncode == 0, "the pinned packages 'policies' are missing (third_party/python-packages policies)")
class ImportPolicy(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.urdf = self.folder / "r.urdf"
        self.urdf.write_text(URDF)
        self.out = self.folder / "robot/policies/walk"

    def network(self, inputs, outputs=3, metadata=None, layers=(), extra=()):
        """One linear layer, its weights drawn by a seed."""
        weights = numpy.random.default_rng(1).normal(size=(inputs, outputs)).astype(numpy.float32)
        value = onnx.helper.make_tensor_value_info
        graph = onnx.helper.make_graph(
            [onnx.helper.make_node("MatMul", ["obs", "w"], ["act"]), *layers],
            "g",
            [value("obs", 1, [1, inputs]), *(value(name, 1, [1, 4]) for name in extra)],
            [value("act", 1, [1, outputs])],
            [onnx.numpy_helper.from_array(weights, "w")],
        )
        model = onnx.helper.make_model(graph, opset_imports=[onnx.helper.make_opsetid("", 17)], ir_version=8)
        for key, text in (metadata or {}).items():
            model.metadata_props.add(key=key, value=text)
        path = self.folder / "policy.onnx"
        onnx.save(model, path)
        return path, weights

    def run_import(self, network, *words):
        """In this process: a new one would import onnx again."""
        said, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            code = SCRIPT.main([str(word) for word in (network, "--robot", self.urdf, "--out", self.out, *words)])
        return types.SimpleNamespace(returncode=code, stdout=said.getvalue(), stderr=complained.getvalue())

    def expect_descriptor(self, network, *words):
        done = self.run_import(network, *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        return yaml.safe_load(self.out.with_suffix(".yaml").read_text())

    def expect_refused(self, word, network, *words):
        done = self.run_import(network, *words)
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(word, done.stderr)
        self.assertFalse(self.out.with_suffix(".yaml").exists(), "nothing is written of what is refused")

    def unitree(self, change=lambda told: None):
        told = deploy()
        change(told)
        path = self.folder / "deploy.yaml"
        path.write_text(yaml.safe_dump(told, sort_keys=False) + "ids: !!python/object/apply:builtins.slice [null, null, null]\n")
        return ["--unitree", path, "--motors", "robot"]

    def test_a_robot_that_is_no_folder_and_no_urdf_is_named_with_what_was_expected(self):
        network, _ = self.network(24)
        self.urdf = self.folder / "z9"
        self.expect_refused(f"--robot {self.urdf}: there is no robot.yaml; expected a robot's folder", network, *self.unitree())

    def test_unitrees_description_becomes_a_descriptor_in_the_policys_order(self):
        network, weights = self.network(24)
        told = self.expect_descriptor(network, *self.unitree())
        self.assertEqual(told["joints"], ["right_knee", "waist", "left_knee"])
        self.assertEqual((told["kp_Nm_per_rad"], told["kd_Nm_s_per_rad"]), ([20, 30, 10], [2, 3, 1]))
        self.assertEqual((told["default_rad"], told["action_scale_rad"]), ([0.2, 0, 0.3], [0.25, 0.25, 0.5]))
        self.assertEqual((told["rate_Hz"], told["frames"], told["first_frame"]), (50, "by_term", "oldest"))
        self.assertEqual(told["command"], {"vx_m_s": [-0.5, 1], "vy_m_s": [-0.3, 0.3], "omega_rad_s": [-0.2, 0.2]})
        self.assertEqual(told["observation"][0], {"term": "gyro", "scale": [0.2], "history": 2, "clip": 10})
        self.assertEqual([term["term"] for term in told["observation"]], ["gyro", "command", "joint_position", "last_action"])
        rows = numpy.loadtxt(self.out.with_name(told["golden"]), delimiter=",")
        numpy.testing.assert_allclose(rows[:, :24] @ weights, rows[:, 24:], atol=1e-4)

    def test_a_gait_phase_is_two_terms_of_one_clock(self):
        def clock(told):
            told["observations"]["gait_phase"] = {"params": {"period": 0.8}, "clip": None, "scale": [1, 2], "history_length": 1}

        told = self.expect_descriptor(self.network(26)[0], *self.unitree(clock))
        self.out = self.folder / "robot/policies/remembers"
        remembers = {"params": {"period": 0.8}, "clip": None, "scale": [1, 2], "history_length": 2}
        self.expect_refused("has a history of 2", self.network(28)[0], *self.unitree(lambda told: told["observations"].update(gait_phase=remembers)))
        clock = {"period_s": 0.8, "offsets_cycle": [0]}
        self.assertEqual(told["observation"][-2:], [{"term": "clock_sin", "scale": [1]} | clock, {"term": "clock_cos", "scale": [2]} | clock])

    def test_what_unitrees_description_has_and_this_controller_has_not_is_named(self):
        network, _ = self.network(24)
        changes = {
            "observes height_scan": lambda told: told["observations"].update(height_scan={"scale": None}),
            "of some joints only": lambda told: told["observations"]["joint_pos_rel"].update(params={"asset_cfg": {"joint_ids": [0]}}),
            "commands JointVelocityAction": lambda told: told.update(actions={"JointVelocityAction": {}}),
            "clips its targets": lambda told: told["actions"]["JointPositionAction"].update(clip=[[-1, 1]] * 3),
            "offset isn't default_joint_pos": lambda told: told["actions"]["JointPositionAction"].update(offset=[0.0, 0.0, 0.0]),
            "expected the same below and above": lambda told: told["observations"]["base_ang_vel"].update(clip=[-10, 5]),
            "is no order of 3 motors": lambda told: told.update(joint_ids_map=[0, 1, 1]),
            "the terms have 18 numbers (gyro 3 x 2 + command 3 x 2 + joint_position 3 x 2)": lambda told: told["observations"].pop("last_action"),
            "has no step_dt": lambda told: told.pop("step_dt"),
        }
        for word, change in changes.items():
            with self.subTest(word):
                self.expect_refused(word, network, *self.unitree(change))
        self.expect_refused("--motors A,B,...", network, *self.unitree()[:2])
        self.expect_refused("drives left_elbow, which", network, *self.unitree()[:2], "--motors", "left_knee,left_elbow,waist")

    def rl_sar(self, **change):
        base = {"dt": 0.005, "decimation": 4, "num_of_dofs": 3, "joint_names": JOINTS}
        told = {
            "num_observations": 15, "observations": ["ang_vel", "gravity_vec", "commands", "dof_pos", "actions"], "observations_history": [1, 0],
            "observations_history_priority": "time", "clip_obs": 100.0, "clip_actions_lower": [-20.0] * 3, "clip_actions_upper": [20.0] * 3,
            "rl_kp": [10.0, 20.0, 30.0], "rl_kd": [1.0, 2.0, 3.0], "action_scale": [0.25] * 3, "wheel_indices": [], "ang_vel_scale": 0.25,
            "dof_pos_scale": 1.0, "dof_vel_scale": 0.05, "commands_scale": [2.0, 2.0, 0.25], "default_dof_pos": [0.1, 0.2, 0.3],
            "joint_mapping": [2, 0, 1],
        }  # fmt: skip
        (self.folder / "base.yaml").write_text(yaml.safe_dump({"r": base}))
        (self.folder / "config.yaml").write_text(yaml.safe_dump({"r/walk": told | change}))
        return ["--rl-sar", self.folder / "base.yaml", self.folder / "config.yaml", *RANGES]

    def test_rl_sars_files_become_a_descriptor(self):
        told = self.expect_descriptor(self.network(30)[0], *self.rl_sar())
        self.assertEqual(told["joints"], ["waist", "left_knee", "right_knee"])
        self.assertEqual((told["kp_Nm_per_rad"], told["default_rad"]), ([10, 20, 30], [0.1, 0.2, 0.3]), "these are in the policy's order")
        self.assertEqual((told["rate_Hz"], told["frames"], told["first_frame"], told["action_limit"]), (50, "by_frame", "oldest", 20))
        self.assertEqual(told["observation"][2], {"term": "command", "scale": [2, 2, 0.25], "clip": 50, "history": 2})
        self.assertEqual(told["command"]["omega_rad_s"], [-0.4, 0.4])

    def test_what_rl_sars_files_dont_say_is_asked_for(self):
        network, _ = self.network(30)
        self.expect_refused("by --omega LOWER UPPER", network, *self.rl_sar()[:-3])
        told = self.rl_sar()
        self.expect_refused("base.yaml first", network, told[0], told[2], told[1], *RANGES)
        self.expect_refused("can't be opened: No such file", network, told[0], self.folder / "absent.yaml", told[2], *RANGES)
        self.expect_refused("observes lin_vel", network, *self.rl_sar(observations=["lin_vel"]))
        self.expect_refused("drives wheels", network, *self.rl_sar(wheel_indices=[2]))
        self.expect_refused("expected all ages", network, *self.rl_sar(observations_history=[0, 2]))

    METADATA: ClassVar = {
        "joint_names": ",".join(JOINTS), "joint_stiffness": "10.000,20.000,30.000", "joint_damping": "1.0,2.0,3.0",
        "default_joint_pos": "0.1,0.2,0.3",
        "action_scale": "0.5", "observation_names": "base_ang_vel,projected_gravity,joint_pos,joint_vel,actions,command",
    }  # fmt: skip
    TOLD: ClassVar = ["--metadata", "--rate-Hz", "50", "--history", "1", "--scale", "all=1", *RANGES]

    def test_the_entries_of_mjlab_and_isaaclab_become_a_descriptor(self):
        told = self.expect_descriptor(self.network(18, metadata=self.METADATA)[0], *self.TOLD, "--scale", "joint_vel=0.05")
        self.assertEqual((told["joints"], told["kd_Nm_s_per_rad"], told["action_scale_rad"]), (JOINTS, [1, 2, 3], [0.5] * 3))
        self.assertEqual([term["scale"] for term in told["observation"]], [[1], [1], [1], [0.05], [1], [1]])
        self.assertEqual(told["observation"][-1]["term"], "command")

    def test_what_the_entries_dont_say_is_asked_for(self):
        network, _ = self.network(18, metadata=self.METADATA)
        self.expect_refused("by --rate-Hz", network, "--metadata", *self.TOLD[3:])
        self.expect_refused("no scale of base_ang_vel", network, *self.TOLD[:5], *RANGES)
        network, _ = self.network(18, metadata=self.METADATA | {"observation_names": "base_lin_vel,actions"})
        self.expect_refused("observes base_lin_vel", network, *self.TOLD)
        self.expect_refused("has no joint_names or dof_names (it has nothing)", self.network(18)[0], *self.TOLD)

    def test_the_entries_of_holosoma_and_options_become_a_descriptor(self):
        ranges = json.dumps({"lin_vel_x": [-1, 1], "lin_vel_y": [-0.5, 0.5], "ang_vel_yaw": [-1, 1]})
        entries = {"dof_names": json.dumps(JOINTS), "kp": "[10, 20, 30]", "kd": "[1, 2, 3]", "command_ranges": ranges}
        network, _ = self.network(16, metadata=entries)
        words = [
            *self.TOLD[:7], "--observation", "actions,command_ang_vel,command_lin_vel,cos_phase,dof_pos,dof_vel,sin_phase",
            "--default", "left_knee=0.4,others=0", "--action-scale", "others=0.25",
        ]  # fmt: skip
        self.expect_refused("--clock-period", network, *words)
        told = self.expect_descriptor(network, *words, "--clock-period", "1", "--clock-offsets", "0,0.5", "--clock-at-rest", "0.5")
        self.assertEqual((told["default_rad"], told["command"]["vy_m_s"]), ([0.4, 0, 0], [-0.5, 0.5]))
        self.assertEqual(
            told["observation"][3], {"term": "clock_cos", "scale": [1], "history": 1, "period_s": 1, "offsets_cycle": [0, 0.5], "at_rest_cycle": 0.5}
        )

    def test_a_recorded_rollout_is_replayed_before_it_is_believed(self):
        network, weights = self.network(24)
        seen = numpy.random.default_rng(2).normal(size=(20, 24)).astype(numpy.float32)
        rollout = self.folder / "rollout.csv"
        numpy.savetxt(rollout, numpy.hstack([seen, seen @ weights]), delimiter=",")
        told = self.expect_descriptor(network, *self.unitree(), "--rollout", rollout)
        numpy.testing.assert_allclose(numpy.loadtxt(self.out.with_name(told["golden"]), delimiter=",")[1, :24], seen[2], atol=1e-6)
        self.out = self.folder / "robot/policies/other"
        numpy.savetxt(rollout, numpy.hstack([seen, seen @ weights + 0.01]), delimiter=",")
        self.expect_refused("off the recorded one", network, *self.unitree(), "--rollout", rollout)
        numpy.savetxt(rollout, seen, delimiter=",")
        self.expect_refused("rollout.csv:1: has 24 numbers", network, *self.unitree(), "--rollout", rollout)

    def test_a_violent_start_is_told(self):
        network, weights = self.network(18, metadata=self.METADATA)
        gravity = -weights[5] * 0.5  # base_ang_vel has the first three numbers, then projected_gravity
        worst = int(numpy.argmax(abs(gravity)))
        done = self.run_import(network, *self.TOLD)
        self.assertIn(f"from rest it moves {JOINTS[worst]} most, by {abs(gravity[worst]):.2f} rad", done.stdout)
        self.assertEqual(done.stderr != "", abs(gravity[worst]) > 0.5)
        self.out = self.folder / "robot/policies/wild"
        network, _ = self.network(18, metadata=self.METADATA | {"action_scale": "50"})
        self.assertIn("refused by the controller", self.run_import(network, *self.TOLD).stderr)

    def test_a_network_that_remembers_or_is_none_is_refused(self):
        self.expect_refused("with a memory of its own", self.network(24, extra=["h_in"])[0], *self.unitree())
        memory = onnx.helper.make_node("GRU", ["x", "w", "r"], ["y"])
        self.expect_refused("a layer GRU", self.network(24, layers=[memory])[0], *self.unitree())
        (self.folder / "policy.onnx").write_bytes(b"no network")
        self.expect_refused("can't be read as ONNX", self.folder / "policy.onnx", *self.unitree())
        self.expect_refused("torch.onnx.export", self.folder / "policy.pt", *self.unitree())

    def robot(self, *words):
        command = [
            sys.executable,
            ROOT / "scripts/import-robot",
            self.urdf,
            "--policy",
            self.out.with_suffix(".yaml"),
            "--name",
            "r",
            "--base",
            "pelvis",
        ]
        command += [
            "--torso",
            "torso",
            "--imu",
            "imu",
            "--left-foot",
            "left_foot",
            "--right-foot",
            "right_foot",
            "--out",
            self.folder / "robot",
            *words,
        ]
        return subprocess.run(list(map(str, command)), capture_output=True, text=True)

    def test_the_robot_stands_as_its_policy_was_trained_to(self):
        self.expect_descriptor(self.network(24)[0], *self.unitree())
        done = self.robot()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("left out: 1 shapes by meshes, imu", done.stdout)
        robot = yaml.safe_load((self.folder / "robot/robot.yaml").read_text())
        self.assertEqual((robot["joints"]["left_knee"]["stand_rad"], robot["joints"]["left_knee"]["kp_Nm_per_rad"]), (0.3, 10))
        self.assertEqual((robot["imu"]["link"], robot["imu"]["position_m"]), ("pelvis", [0.1, 0, 0.2]))
        self.assertAlmostEqual(robot["imu"]["rpy_rad"][2], 1.570796, 5)
        self.assertEqual(robot["feet"]["left"]["box_size_m"], [0.32, 0.12, 0.02])
        self.assertEqual(robot["feet"]["left"]["box_center_m"], [0.05, 0, -0.02])
        self.assertNotIn("mesh", (self.folder / "robot/r.urdf").read_text())
        self.assertIn("exists", self.robot().stderr)

    def test_a_robot_that_its_policy_doesnt_fit_is_refused(self):
        self.expect_descriptor(self.network(24)[0], *self.unitree())
        self.assertIn("--imu nowhere: no link", self.robot("--imu", "nowhere").stderr)
        self.urdf.write_text(URDF.replace('name="waist"', 'name="spine"'))
        self.assertIn("drives waist, which", self.robot().stderr)
        self.urdf.write_text(URDF.replace(SPHERES, ""))
        self.assertIn("--left-sole", self.robot().stderr)


if __name__ == "__main__":
    unittest.main()
