"""Stands in for the board: answers every command with a robot at rest. Prints its port; ends on SIGTERM and prints what it heard."""

import signal
import socket
import struct
import sys

JOINTS = 64
COMMAND = struct.Struct(f"=I{5 * JOINTS}f")
ANSWER = struct.Struct(f"=I{10 + 4 * JOINTS}f")
AT_REST = (0.0, 0.0, 0.0, 0.0, 0.0, 9.81, 1.0, 0.0, 0.0, 0.0) + (0.0, 0.0, 0.0, 30.0) * JOINTS


def main():
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    board = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    board.bind(("127.0.0.1", 0))
    print(board.getsockname()[1], flush=True)
    commands = stiff = 0
    try:
        while True:
            data, host = board.recvfrom(4096)
            if len(data) != COMMAND.size:
                continue
            cycle, *values = COMMAND.unpack(data)
            commands += 1
            stiff += any(values[2::5])
            board.sendto(ANSWER.pack(cycle, *AT_REST), host)
    finally:
        print(f"{commands} commands, {stiff} with stiffness", flush=True)


main()
