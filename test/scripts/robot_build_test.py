"""A robot's controller needs no simulation: not when its rooms are linked whole, and not in a build that is configured with PMG_SIL=OFF."""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SIMULATION = re.compile(r"mujoco|glfw|osmesa|libE?GL\b|libGLX|nlopt|pagmo", re.I)


def simulation_in(text):
    """Lines that name a library of the simulation or the calibration."""
    return [line.strip() for line in text.splitlines() if SIMULATION.search(line)]


class RobotBuild(unittest.TestCase):
    def test_what_is_searched_for_would_be_found(self):
        for line in ("libmujoco.so.2.2.2 => /x (0x1)", "libglfw.so.3 => /x", "libGL.so.1 => /x", "libOSMesa.so.8", "libEGL.so.1"):
            self.assertEqual(simulation_in(line), [line])
        self.assertEqual(simulation_in("libc.so.6 => /lib/x\nlibglib-2.0.so.0 => /x"), [])

    def test_hal_control_and_runtime_load_no_simulation(self):
        loaded = subprocess.run(["ldd", PROBE], capture_output=True, text=True, check=True).stdout
        self.assertIn("libonnxruntime", loaded, "every library of these rooms is listed")
        self.assertEqual(simulation_in(loaded), [])
        subprocess.run([PROBE], check=True)

    def test_a_build_without_simulation_has_the_robots_programs_and_names_no_library_of_it(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(
                ["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DPMG_SIL=OFF", "-DPMG_BUILD_TESTS=OFF"],
                capture_output=True,
                text=True,
                check=True,
            )
            rules = (pathlib.Path(folder) / "build.ninja").read_text()
        programs = set(re.findall(r"^build bin/(\w+):", rules, re.M))
        self.assertEqual(
            programs,
            {"pmg_bus", "pmg_clips", "pmg_controller", "pmg_doctor", "pmg_gamepad", "pmg_key", "pmg_keyboard", "pmg_send", "pmg_watch", "pmg_web"},
        )
        self.assertEqual(simulation_in(rules), [])


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--probe", required=True, help="program that links the robot's rooms whole")
    arguments, rest = parser.parse_known_args()
    PROBE = arguments.probe
    unittest.main(argv=sys.argv[:1] + rest)
