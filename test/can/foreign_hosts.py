"""Hosts of drives that this project did not write, each driving one emulated drive (node 4 of can0) as its own documentation says:
it switches the drive on, reads it, moves it, and switches it off. What a host reads is compared with what pmg_bus read before, and
with where the host told the drive to go. Prints what it saw; ends with 1 and the reason where something differs. Waits for events,
at most 60 s for each: a loaded computer is slow, not wrong."""

import math
import sys
import threading
import time

NODE = 4
PATIENCE_S = 60
BY_RAD, NEAR_RAD = -0.2, 0.03
STIFFNESS_NM_PER_RAD, DAMPING_NM_S_PER_RAD = 60, 2


def until(what: str, step, done):
    """The first value of step() for which done() holds."""
    end = time.monotonic() + PATIENCE_S
    while True:
        value = step()
        if done(value):
            return value
        if time.monotonic() > end:
            sys.exit(f"{what}: still {value} after {PATIENCE_S} s")
        time.sleep(0.002)


def near(what: str, value: float, expected: float, within: float):
    print(f"{what}: {value:.4f}, expected {expected:.4f} within {within}")
    if not abs(value - expected) <= within:
        sys.exit(f"{what}: {value}, expected {expected} within {within}")


def moves(step, start_rad: float):
    """step(target [rad]) sends one command and returns position [rad], velocity [rad/s] and torque [Nm] as the host read them. It
    goes there at half a radian a second: no host does this by itself, and a jump would be a blow."""
    toward = math.copysign(1.0, BY_RAD)
    fastest = 0.0
    begun = time.monotonic()

    def gone():
        nonlocal fastest
        share = min(1.0, 0.5 * (time.monotonic() - begun) / abs(BY_RAD))
        q_rad, dq_rad_s, torque_Nm = step(start_rad + share * BY_RAD)
        fastest = max(fastest, toward * dq_rad_s)
        return share, q_rad, torque_Nm

    # The forearm weighs on the loop: once it rests, the torque is what the stiffness makes of the distance that is left.
    def there(seen):
        share, q_rad, torque_Nm = seen
        left_Nm = STIFFNESS_NM_PER_RAD * (start_rad + BY_RAD - q_rad)
        moved_rad = toward * (q_rad - start_rad)
        return share == 1.0 and 0.5 * abs(BY_RAD) < moved_rad < 1.1 * abs(BY_RAD) and abs(torque_Nm - left_Nm) < 0.5

    _, q_rad, torque_Nm = until("it does not move there", gone, there)
    print(f"moved by {q_rad - start_rad:.3f} rad, at most {fastest:.2f} rad/s; holds with {torque_Nm:.2f} Nm")
    if fastest < 0.2:
        sys.exit(f"its velocity was at most {fastest} rad/s on the way; expected about 0.5")


def cubemars(q_rad: float):
    from TMotorCANControl.mit_can import TMotorManager_mit_can

    # This package takes the reply's temperature as it stands, without the 40 degC that the maker's manual takes off.
    with TMotorManager_mit_can(motor_type="AK10-9", motor_ID=NODE, max_mosfett_temp=100) as motor:
        motor.set_impedance_gains_real_unit(K=STIFFNESS_NM_PER_RAD, B=DAMPING_NM_S_PER_RAD)
        motor.position = q_rad  # its setter is the command, its getter the reading

        def step(target_rad: float):
            motor.position = target_rad
            time.sleep(0.002)
            motor.update()
            state = motor._motor_state_async
            torque_Nm = motor.qaxis_current_to_TMotor_current(state.current)
            return state.position, state.velocity, torque_Nm

        near("position", step(q_rad)[0], q_rad, NEAR_RAD)
        near("temperature's byte", motor.temperature, 75, 0)
        near("fault", motor.error, 0, 0)
        moves(step, q_rad)


def mini_cheetah(q_rad: float):
    import socket

    from motor_driver.canmotorlib import CanMotorController

    motor = CanMotorController("can0", NODE, "AK80_9_V1p1", socket_timeout=PATIENCE_S)
    motor.change_motor_constants(-12.5, 12.5, -22.5, 22.5, 0, 500, 0, 5, -65, 65)
    # It switches off that its frames are heard on its own computer, where on vcan everybody is.
    CanMotorController.motor_socket.setsockopt(socket.SOL_CAN_RAW, socket.CAN_RAW_LOOPBACK, 1)
    before_rad, _, _ = motor.send_rad_command(0, 0, 0, 0, 0)
    near("position", before_rad, q_rad, NEAR_RAD)
    at_rad, _, _ = motor.enable_motor()  # sets the zero first
    near("position after its zero", at_rad, 0, NEAR_RAD)
    moves(lambda target_rad: motor.send_rad_command(target_rad, 0, STIFFNESS_NM_PER_RAD, DAMPING_NM_S_PER_RAD, 0), at_rad)
    motor.disable_motor()


def damiao(q_rad: float):
    from damiao_motor import DaMiaoController

    host = DaMiaoController(channel="can0", bustype="socketcan")
    motor = host.add_motor(motor_id=NODE, feedback_id=0x70, motor_type="8009")
    motor.disable()
    state = until("no reply", motor.get_states, bool)
    near("position", state["pos"], q_rad, NEAR_RAD)
    near("temperature of the bridge", state["t_mos"], 35, 0)
    near("reply's identifier", state["arbitration_id"], 0x70, 0)
    if state["status"] != "DISABLED":
        sys.exit(f"its state is {state['status']}, expected DISABLED")
    motor.enable()
    until("not enabled", motor.get_states, lambda state: state["status"] == "ENABLED")

    def step(target_rad: float):
        motor.send_cmd_mit(target_rad, 0, STIFFNESS_NM_PER_RAD, DAMPING_NM_S_PER_RAD, 0)
        state = motor.get_states()
        return state["pos"], state["vel"], state["torq"]

    moves(step, q_rad)
    motor.disable()
    until("not disabled", motor.get_states, lambda state: state["status"] == "DISABLED")
    host.shutdown()


def damiao_motorbridge(q_rad: float):
    from motorbridge import Controller

    with Controller("can0") as host:
        motor = host.add_damiao_motor(NODE, 0x70, "8009")

        def read():
            host.poll_feedback_once()
            return motor.get_state()

        motor.disable()
        state = until("no reply", read, lambda state: state is not None)
        near("position", state.pos, q_rad, NEAR_RAD)
        near("temperature of the bridge", state.t_mos, 35, 0)
        near("state (0: off)", state.status_code, 0, 0)
        motor.enable()
        until("not enabled", read, lambda state: state.status_code == 1)

        def step(target_rad: float):
            motor.send_mit(target_rad, 0, STIFFNESS_NM_PER_RAD, DAMPING_NM_S_PER_RAD, 0)
            state = read()
            return state.pos, state.vel, state.torq

        moves(step, q_rad)
        motor.disable()
        until("not disabled", read, lambda state: state.status_code == 0)
        motor.close()


def cia402(q_rad: float):
    import canopen
    from canopen.profiles.p402 import BaseNode402
    from foreign_node import dictionary

    counts_per_rad = 65536 / math.tau
    network = canopen.Network()
    network.connect(channel="can0", interface="socketcan")
    drive = BaseNode402(NODE, dictionary(NODE))
    network.add_node(drive)
    drive.sdo.RESPONSE_TIMEOUT = PATIENCE_S / 6
    drive.nmt.state = "PRE-OPERATIONAL"
    near("device type", drive.sdo[0x1000].raw, 0x20192, 0)
    drive.tpdo.read()
    drive.rpdo.read()
    for number, objects in ((1, (0x6041, 0x6064)), (2, (0x606C, 0x6077))):
        drive.tpdo[number].clear()
        for index in objects:
            drive.tpdo[number].add_variable(index)
        drive.tpdo[number].trans_type = 1
        drive.tpdo[number].enabled = True
    drive.rpdo[1].clear()
    for index in (0x6040, 0x607A):
        drive.rpdo[1].add_variable(index)
    drive.rpdo[1].trans_type = 255
    drive.rpdo[1].enabled = True
    for pdo in (3, 4):
        if pdo in drive.tpdo:
            drive.tpdo[pdo].enabled = drive.rpdo[pdo].enabled = False
    drive.tpdo.save()
    drive.rpdo.save()
    drive.nmt.state = "OPERATIONAL"
    drive.setup_pdos(upload=False)
    drive.op_mode = "CYCLIC SYNCHRONOUS POSITION"
    near("mode", drive.sdo[0x6061].raw, 8, 0)

    def step(target_rad: float):
        drive.rpdo[1][0x607A].raw = round(target_rad * counts_per_rad)
        drive.rpdo[1].transmit()
        network.sync.transmit()
        drive.tpdo[2].wait_for_reception(timeout=PATIENCE_S)
        return drive.tpdo[1][0x6064].raw / counts_per_rad, 1e-3 * drive.tpdo[2][0x606C].raw, 0.04 * drive.tpdo[2][0x6077].raw

    near("position", step(q_rad)[0], q_rad, NEAR_RAD)
    # Its state machine waits for status words, which come with SYNC. Its own timer needs the kernel's broadcast manager.
    ended = threading.Event()

    def sync():
        while not ended.wait(0.01):
            network.sync.transmit()

    beat = threading.Thread(target=sync)
    beat.start()
    BaseNode402.TIMEOUT_SWITCH_STATE_FINAL = BaseNode402.TIMEOUT_SWITCH_STATE_SINGLE = PATIENCE_S / 6
    drive.rpdo[1][0x607A].raw = round(q_rad * counts_per_rad)
    try:
        drive.state = "OPERATION ENABLED"
        print(f"state: {drive.state}")
        moves(step, q_rad)
        drive.state = "SWITCH ON DISABLED"
        print(f"state: {drive.state}")
    finally:
        ended.set()
        beat.join()
    network.disconnect()


HOSTS = {"cubemars": cubemars, "mini_cheetah": mini_cheetah, "damiao": damiao, "damiao_motorbridge": damiao_motorbridge, "cia402": cia402}

if __name__ == "__main__":
    HOSTS[sys.argv[1]](math.radians(float(sys.argv[2])))
