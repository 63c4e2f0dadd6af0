"""A CiA 402 drive made of the package `canopen`. That package's are the object dictionary, the SDO server, the network states,
boot-up and emergency messages, and the PDOs with their mapping and packing. Only the drive is here: the profile's state machine, and
a motor that follows its position or turns an inertia by its torque, 2 ms with each SYNC. No clock decides anything: it acts on what it
hears, in that order. Object 0x2000 is an error code that it shall report. Ends on SIGTERM and prints what it was told."""

import argparse
import gc
import math
import signal
import threading

import can
import canopen
from canopen.objectdictionary import INTEGER8, INTEGER16, INTEGER32, UNSIGNED8, UNSIGNED16, UNSIGNED32, ODArray, ODRecord, ODVariable

OBJECTS = [  # index, name, type, value
    (0x1000, "Device type", UNSIGNED32, 0x00020192),
    (0x1001, "Error register", UNSIGNED8, 0),
    (0x1017, "Producer heartbeat time", UNSIGNED16, 0),
    (0x2000, "Error to report", UNSIGNED16, 0),
    (0x6007, "Abort connection option code", INTEGER16, 1),
    (0x603F, "Error code", UNSIGNED16, 0),
    (0x6040, "Control word", UNSIGNED16, 0),
    (0x6041, "Status word", UNSIGNED16, 0x250),
    (0x605A, "Quick stop option code", INTEGER16, 2),
    (0x6060, "Modes of operation", INTEGER8, 0),
    (0x6061, "Modes of operation display", INTEGER8, 0),
    (0x6064, "Position actual value", INTEGER32, 0),
    (0x606C, "Velocity actual value", INTEGER32, 0),
    (0x6071, "Target torque", INTEGER16, 0),
    (0x6072, "Max torque", UNSIGNED16, 1000),
    (0x6076, "Motor rated torque", UNSIGNED32, 40_000),
    (0x6077, "Torque actual value", INTEGER16, 0),
    (0x607A, "Target position", INTEGER32, 0),
    (0x6502, "Supported drive modes", UNSIGNED32, 1 << 7 | 1 << 9),
]
RECORDS = [  # index, name, [(type, value) of subindex 1...]
    (0x1016, "Consumer heartbeat time", [(UNSIGNED32, 0)]),
    (0x1018, "Identity", [(UNSIGNED32, 0xABC), (UNSIGNED32, 1)]),
    (0x608F, "Position encoder resolution", [(UNSIGNED32, 65536), (UNSIGNED32, 1)]),
]


def dictionary(node: int) -> canopen.ObjectDictionary:
    found = canopen.ObjectDictionary()
    found.node_id = node

    def variable(index, subindex, name, kind, value):
        made = ODVariable(name, index, subindex)
        made.data_type, made.default, made.access_type = kind, value, "rw"
        return made

    def group(index, name, members, kind=ODRecord):
        made = kind(name, index)
        for subindex, (member, value) in enumerate([(UNSIGNED8, len(members)), *members]):
            made.add_member(variable(index, subindex, f"{name} {subindex}", member, value))
        found.add_object(made)

    for index, name, kind, value in OBJECTS:
        found.add_object(variable(index, 0, name, kind, value))
    for index, name, members in RECORDS:
        group(index, name, members)
    for pdo in range(2):
        for what, settings, base in (("RPDO", 0x1400, 0x200), ("TPDO", 0x1800, 0x180)):
            group(settings + pdo, f"{what} {pdo}", [(UNSIGNED32, (base + 0x100 * pdo + node) | 1 << 31), (UNSIGNED8, 255)])
            group(settings + 0x200 + pdo, f"{what} map {pdo}", [(UNSIGNED32, 0)] * 4, ODArray)
            found[settings + 0x200 + pdo][0].default = 0
    return found


class Drive:
    SWITCHED_OFF, READY, SWITCHED_ON, ON, FAULT = 0x250, 0x231, 0x233, 0x237, 0x218  # status words
    POSITION, TORQUE = 8, 10  # modes
    COUNTS_PER_RAD, UNITS_PER_RAD_S, RATED_NM, CYCLE_S, INERTIA_KG_M2 = 65536 / math.tau, 1000, 40, 0.002, 0.1

    def __init__(self, network: canopen.Network, node: int):
        self.node = network.create_node(node, dictionary(node))
        self.state, self.error, self.mapped, self.mode = self.SWITCHED_OFF, 0, False, 0
        self.q_rad, self.dq_rad_s, self.torque = 0.3, 0.0, 0
        self.syncs, self.commands, self.writes = 0, 0, 0
        self.node.add_write_callback(self.on_write)
        self.node.rpdo[1].add_callback(self.on_command)
        network.subscribe(0x080, self.on_sync)
        self.node.nmt.send_command(0)  # boot-up
        self.node.nmt.state = "PRE-OPERATIONAL"

    @property
    def position(self):
        return round(self.q_rad * self.COUNTS_PER_RAD)

    def put(self, index, value):
        self.node.sdo[index].raw = value

    def on_write(self, index, subindex, od, data):
        self.writes += 1
        if index == 0x6040:
            self.obey(int.from_bytes(data, "little"))
        if index == 0x2000:
            self.error = int.from_bytes(data, "little")

    def obey(self, word: int):
        if self.state == self.FAULT:
            if word & 0x80 and not self.error:
                self.state = self.SWITCHED_OFF
            return
        if not word & 0x2 or not word & 0x4:
            self.state = self.SWITCHED_OFF
        elif word & 0xF == 0x6:
            self.state = self.READY
        elif word & 0xF == 0x7 and self.state in (self.READY, self.ON):
            self.state = self.SWITCHED_ON
        elif word & 0xF == 0xF and self.state == self.SWITCHED_ON:
            self.state = self.ON

    def on_command(self, pdo):
        self.commands += 1
        values = {variable.index: variable.raw for variable in pdo}
        self.obey(values[0x6040])
        on = self.state == self.ON
        self.torque = values[0x6071] if on and self.mode == self.TORQUE else 0
        if self.mode == self.POSITION:
            q_rad = values[0x607A] / self.COUNTS_PER_RAD if on else self.q_rad
            self.dq_rad_s, self.q_rad = (q_rad - self.q_rad) / self.CYCLE_S, q_rad

    def move(self):
        """2 ms of a motor without load; one that is off stands still."""
        if self.mode != self.TORQUE:
            return
        torque_Nm = self.torque * self.RATED_NM / 1000
        self.dq_rad_s = (self.dq_rad_s + torque_Nm / self.INERTIA_KG_M2 * self.CYCLE_S) if self.state == self.ON else 0.0
        self.q_rad += self.dq_rad_s * self.CYCLE_S

    def on_sync(self, can_id, data, timestamp):
        if self.node.nmt.state != "OPERATIONAL":
            self.mapped = False
            return
        if not self.mapped:
            self.node.rpdo.read()
            self.node.tpdo.read()
            self.mode = self.node.sdo[0x6060].raw
            self.mapped = True
        if self.error and self.state != self.FAULT:
            self.state = self.FAULT
            self.node.emcy.send(self.error)
        self.syncs += 1
        self.move()
        speed = int(self.dq_rad_s * self.UNITS_PER_RAD_S)
        shown = {0x6041: self.state, 0x6064: self.position, 0x606C: speed, 0x6077: self.torque, 0x603F: self.error}
        for pdo in (self.node.tpdo[1], self.node.tpdo[2]):
            for variable in pdo:
                variable.raw = shown[variable.index]
            pdo.transmit()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--channel", default="can0")
    parser.add_argument("--node", type=int, default=4)
    parser.add_argument("--rated", type=int, default=40_000, help="object 0x6076 [mNm]")
    parser.add_argument("--error", type=lambda text: int(text, 0), default=0, help="error code that it reports once it runs")
    arguments = parser.parse_args()
    network = canopen.Network()
    network.connect(interface="socketcan", channel=arguments.channel)
    drive = Drive(network, arguments.node)
    drive.put(0x6076, arguments.rated)
    drive.put(0x6064, drive.position)
    drive.error = arguments.error
    gc.disable()  # its pauses would be a silent drive
    ended = threading.Event()
    signal.signal(signal.SIGTERM, lambda *_: ended.set())
    print(f"canopen {canopen.__version__}, python-can {can.__version__}: node {arguments.node} answers", flush=True)
    ended.wait()
    mode, timeout = drive.node.sdo[0x6060].raw, drive.node.sdo[0x1016][1].raw
    print(f"mode {mode}, heartbeat 0x{timeout:X}, {drive.writes} writes, {drive.syncs} SYNCs, {drive.commands} commands", flush=True)
    network.disconnect()


if __name__ == "__main__":
    main()
