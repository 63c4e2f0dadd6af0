"""The numbers of motor.yaml; src/model/actuator_parameters.hpp explains each, and a test of it writes the file that is read here."""

import json
import math
import pathlib

_WRITTEN = json.loads(pathlib.Path(__file__).with_name("neutral_actuator.json").read_text())

# The neutral value of each parameter, by group and key of motor.yaml.
NEUTRAL = {name: math.inf if value is None else value for name, value in _WRITTEN["parameters"].items()}
REFERENCE_TEMPERATURE_C = _WRITTEN["reference_temperature_C"]  # the parameters of friction and torque hold at this temperature
