"""mujoco_warp worlds whose state and per-world parameters are torch tensors on the same memory."""

import mujoco
import mujoco_warp as mjw
import torch
import warp as wp

from pmg_train.actuation import step_inertia
from pmg_train.motors import Motors, joints_with_actuators
from pmg_train.randomization import Robots

BATCHED = ("geom_friction", "body_mass", "body_inertia", "body_ipos", "actuator_gainprm", "actuator_biasprm", "dof_armature")


@wp.kernel
def _sole_forces(contacts: wp.array(dtype=int), geom: wp.array(dtype=wp.vec2i), world: wp.array(dtype=int),
                 dim: wp.array(dtype=int), address: wp.array2d(dtype=int), force: wp.array2d(dtype=float),
                 capacity: int, left: int, right: int, out: wp.array2d(dtype=float)):
    c = wp.tid()
    if c >= wp.min(contacts[0], capacity):
        return
    foot = int(-1)
    pair = geom[c]
    if pair[0] == left or pair[1] == left:
        foot = 0
    if pair[0] == right or pair[1] == right:
        foot = 1
    if foot < 0 or dim[c] != 3:
        return
    normal = float(0.0)
    for k in range(4):  # pyramidal cone: the normal force is the sum over the edges
        row = address[c, k]
        if row >= 0:
            normal += force[world[c], row]
    wp.atomic_add(out, world[c], foot, normal)


class Worlds:
    """`substeps` physics steps a call. Positions and forces of bodies are those of the last substep's start."""

    def __init__(self, model: mujoco.MjModel, worlds: int, substeps: int, foot_links: list[str], limits: dict,
                 device: str, motors: dict[str, dict[str, float]] | None = None):
        """motors: what a motor.yaml says of some joints' actuators. Joints with dry friction have an actuator of src/sim's kind in any
        case; the others are MuJoCo's position servos."""
        self.device = device
        self.deployed_step_s = limits["deployed_timestep_s"]
        motors = motors or {}
        modelled = {name: motors.get(name, {}) for name in joints_with_actuators(model, motors)}
        self.motors = Motors(model, modelled, worlds, device) if modelled else None
        self.model = model
        with wp.ScopedDevice(device):
            self.m = mjw.put_model(model, batch_sizes={name: worlds for name in BATCHED})
            self.d = mjw.make_data(model, nworld=worlds, nconmax=limits["contacts_per_world"],
                                   njmax=limits["constraints_per_world"])
        view = wp.to_torch
        self.qpos, self.qvel, self.warmstart = view(self.d.qpos), view(self.d.qvel), view(self.d.qacc_warmstart)
        self.xpos, self.xquat, self.torque = view(self.d.xpos), view(self.d.xquat), view(self.d.actuator_force)
        self.ctrl, self.bias = view(self.d.ctrl), view(self.m.actuator_biasprm)
        self.torch_device = self.qpos.device
        self.target = [torch.zeros(worlds, model.nu, device=self.torch_device) for _ in range(substeps)]
        self._target_warp = [wp.from_torch(t) for t in self.target]
        self.sole_force = torch.zeros(worlds, 2, device=self.torch_device)
        self._sole_force_warp = wp.from_torch(self.sole_force)
        self._soles = [model.geom(f"{link}_sole").id for link in foot_links]
        self._parts = self._parts_of_a_call(self._on_device, lambda part: part)

    def apply(self, robots: Robots, torso: str) -> None:
        """Writes the drawn parameters into the worlds."""
        model, view = self.model, wp.to_torch
        for sole in self._soles:
            view(self.m.geom_friction)[:, sole, 0] = robots.friction
        view(self.m.body_mass).copy_(robots.body_mass)
        view(self.m.body_inertia)[:] *= robots.link_mass[:, :, None]
        view(self.m.body_ipos)[:, model.body(torso).id] += robots.torso_com
        gain = view(self.m.actuator_gainprm)[:, :, 0]
        gain *= robots.kp
        self.bias[:, :, 1] *= robots.kp
        self.bias[:, :, 2] *= robots.kd
        self._set_armature(robots.armature)
        if self.motors:
            gain[:, self.motors.index] = 1.0
            self.motors.vary(robots, self.deployed_step_s)

    def _set_armature(self, factor: torch.Tensor) -> None:
        """The drawn one, less what the damping in these longer steps adds."""
        model, armature = self.model, wp.to_torch(self.m.dof_armature)[:, 6:]
        kd = torch.tensor(model.dof_damping[6:] - model.actuator_biasprm[:, 2], dtype=torch.float32, device=self.torch_device)
        if self.motors:
            actuator = self.motors.model
            damping = self.motors.kd[0] + actuator.p["friction.viscous_Nm_s_per_rad"]
            kd[self.motors.index] += torch.where(actuator.elastic, 0.0, damping)
        added = step_inertia(kd, model.opt.timestep, self.deployed_step_s)
        armature.copy_(torch.maximum(armature * factor - added, 0.1 * armature))

    def capture(self) -> None:
        """Compiles; on a GPU also records a call as CUDA graphs: one, or a torch and a warp graph a step with motors."""
        self.step()
        if self.device.startswith("cuda"):
            wp.synchronize()
            self._parts = self._parts_of_a_call(self._recorded_by_warp, self._recorded_by_torch)
            wp.synchronize()

    def step(self) -> None:
        for part in self._parts:
            part()

    def _parts_of_a_call(self, by_warp, by_torch) -> list:
        """What follows upon what; by_warp and by_torch make something to call of each part."""
        if not self.motors:
            return [by_warp(self._all_steps)]
        physics, parts = by_warp(self._one_step), []
        for target in self.target:
            parts += [by_torch(lambda target=target: self.motors.drive(target, self.qpos, self.qvel, self.ctrl, self.bias)), physics]
        return parts + [by_warp(self._measure_soles)]

    def _on_device(self, part):
        def run() -> None:
            with wp.ScopedDevice(self.device):
                part()
        return run

    def _recorded_by_warp(self, part):
        with wp.ScopedDevice(self.device), wp.ScopedCapture() as recorded:
            part()
        return lambda: wp.capture_launch(recorded.graph)

    def _recorded_by_torch(self, part):
        graph = torch.cuda.CUDAGraph()
        with torch.cuda.graph(graph, stream=torch.cuda.current_stream()):
            part()
        wp.set_stream(wp.get_stream(self.device), self.device)  # a second object of the same stream would unregister it when the first goes
        return graph.replay

    def _all_steps(self) -> None:
        for target in self._target_warp:
            wp.copy(self.d.ctrl, target)
            mjw.step(self.m, self.d)
        self._measure_soles()

    def _one_step(self) -> None:
        mjw.step(self.m, self.d)

    def _measure_soles(self) -> None:
        self._sole_force_warp.zero_()
        contact = self.d.contact
        wp.launch(_sole_forces, dim=self.d.naconmax, device=self.device,
                  inputs=[self.d.nacon, contact.geom, contact.worldid, contact.dim, contact.efc_address,
                          self.d.efc.force, self.d.naconmax, self._soles[0], self._soles[1], self._sole_force_warp])

    def fullest(self) -> tuple[int, int]:
        """(most constraints of a world, contacts of all worlds) of the last step: compare with what was allocated."""
        return int(wp.to_torch(self.d.nefc).max()), int(self.d.nacon.numpy()[0])
