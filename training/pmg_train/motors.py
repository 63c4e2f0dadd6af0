"""The actuators of motor.yaml, which calibration writes and the controller's simulation reads, in training's physics."""

import mujoco
import torch

from pmg_train.actuation import step_inertia
from pmg_train.actuator import NEUTRAL, ActuatorModel
from pmg_train.randomization import Robots

FRICTION = [name for name in NEUTRAL if name.startswith("friction.")]
DRY_FRICTION = [f"friction.{key}" for key in ("coulomb_Nm", "stribeck_Nm", "load_driving", "load_backdriving")]


def joints_with_actuators(model: mujoco.MjModel, motors: dict[str, dict[str, float]]) -> list[str]:
    """Joints that a motor file names or that have dry friction, in the model's order. MuJoCo's own friction differs from the deployed one."""
    friction = lambda name: model.dof_frictionloss[model.joint(name).dofadr[0]]
    names = [model.actuator(a).name for a in range(model.nu)]
    return [name for name in names if name in motors or friction(name) > 0]


def actuator_in_force(model: mujoco.MjModel, actuator: int, values: dict[str, float]) -> dict[str, float]:
    """Values that `values` lacks are the robot's own, as in src/sim/motors_in_force.cpp."""
    dof = model.jnt_dofadr[model.actuator_trnid[actuator, 0]]
    own = {}
    if not values.get("transmission.armature_kg_m2"):
        own["transmission.armature_kg_m2"] = float(model.dof_armature[dof])
    if all(values.get(name, NEUTRAL[name]) == NEUTRAL[name] for name in FRICTION):
        own |= {"friction.coulomb_Nm": float(model.dof_frictionloss[dof]), "friction.viscous_Nm_s_per_rad": float(model.dof_damping[dof])}
    return {"drive.limit": float(model.actuator_forcerange[actuator, 1])} | values | own


class Motors:
    """The batched actuators of the joints in `motors`. They replace MuJoCo's as in src/sim/actuator_joint.cpp."""

    def __init__(self, model: mujoco.MjModel, motors: dict[str, dict[str, float]], worlds: int, device):
        """Changes the model: MuJoCo's own actuators of these joints become plain torques."""
        self.actuator = [model.actuator(name).id for name in motors]
        self.index = torch.tensor(self.actuator, device=device)
        column = lambda values: torch.tensor(values, dtype=torch.float32, device=device)
        self.kp = column(model.actuator_gainprm[self.actuator, 0]).repeat(worlds, 1)
        self.kd = column(-model.actuator_biasprm[self.actuator, 2]).repeat(worlds, 1)
        in_force = [actuator_in_force(model, a, values) for a, values in zip(self.actuator, motors.values(), strict=True)]
        self.model = ActuatorModel(in_force, model.opt.timestep, worlds, device)
        for a, values in zip(self.actuator, in_force, strict=True):
            self._hand_over(model, a, NEUTRAL | values)

    @staticmethod
    def _hand_over(model: mujoco.MjModel, actuator: int, values: dict[str, float]) -> None:
        dof = model.jnt_dofadr[model.actuator_trnid[actuator, 0]]
        elastic = values["transmission.stiffness_Nm_per_rad"] != NEUTRAL["transmission.stiffness_Nm_per_rad"]
        model.dof_armature[dof] = 0.0 if elastic else values["transmission.armature_kg_m2"]
        model.dof_damping[dof] = model.dof_frictionloss[dof] = 0.0
        model.actuator_forcelimited[actuator] = 0
        model.actuator_gainprm[actuator, 0] = 1.0
        model.actuator_biasprm[actuator, :3] = 0.0

    def vary(self, robots: Robots, deployed_step_s: float) -> None:
        """Applies the drawn factors of gains, rotor inertias and dry friction as src/sim/variation.cpp does. Once, before the first step."""
        self.kp *= robots.kp[:, self.actuator]
        self.kd *= robots.kd[:, self.actuator]
        for name in DRY_FRICTION:
            self.model.p[name] = self.model.p[name] * robots.joint_friction[:, self.actuator]
        name = "transmission.armature_kg_m2"
        armature = self.model.p[name] * robots.armature[:, self.actuator]
        added = step_inertia(self.kd + self.model.p["friction.viscous_Nm_s_per_rad"], self.model.step_s, deployed_step_s)
        self.model.p[name] = torch.where(self.model.elastic, torch.maximum(armature - added, 0.1 * armature), armature)

    def drive(self, target: torch.Tensor, qpos: torch.Tensor, qvel: torch.Tensor, ctrl: torch.Tensor, bias: torch.Tensor) -> None:
        """Writes the next step's torques into MuJoCo's ctrl and their slopes into its velocity bias. target: q_des of all joints [rad]."""
        q, dq = qpos[:, 7:].index_select(1, self.index), qvel[:, 6:].index_select(1, self.index)
        torque, slope = self.model.step(target.index_select(1, self.index), self.kp, self.kd, q, dq)
        ctrl.copy_(target.index_copy(1, self.index, torque - slope * dq))
        bias[:, :, 2].index_copy_(1, self.index, slope)

    def reset(self, qpos: torch.Tensor, where: torch.Tensor | None = None) -> None:
        self.model.reset(qpos[:, 7:].index_select(1, self.index), where)

    def reading(self, q: torch.Tensor) -> torch.Tensor:
        """The encoders' readings of all joints [rad]."""
        return q.index_copy(1, self.index, self.model.reading(q.index_select(1, self.index)))

    def momentary(self) -> dict[str, torch.Tensor]:
        return {f"motors.{name}": value for name, value in self.model.momentary().items()}
