"""What configuration files say counts whole, or not at all."""

from pathlib import Path

import pytest
import yaml

from pmg_train.configuration import load_config, load_randomization

HERE = Path(__file__).resolve().parent.parent


def test_the_committed_files_are_complete():
    assert load_config(HERE / "config.yaml")["symmetry"]["weight"] >= 0
    assert load_randomization(HERE / "randomization.yaml")["friction"] == [0.4, 1.2]


def changed(tmp_path: Path, name: str, change) -> Path:
    content = yaml.safe_load((HERE / name).read_text())
    change(content)
    path = tmp_path / name
    path.write_text(yaml.safe_dump(content))
    return path


def put(*keys_and_value):
    *keys, last, value = keys_and_value

    def change(content):
        for key in keys:
            content = content[key]
        content[last] = value

    return change


@pytest.mark.parametrize("name, change, said", [
    ("config.yaml", put("rewards", "velocty", 1.0), "rewards: unknown key velocty; expected velocity_slow, "),
    ("config.yaml", put("rewards", "height", 1.0), "rewards: height: 1.0; expected a map with the keys weight, s"),
    ("config.yaml", lambda c: c["ppo"].pop("gamma"), "ppo: gamma is missing"),
    ("config.yaml", put("gains", "knee", [150]), "gains: .*; expected {name: .number, number., ...}"),
    ("config.yaml", put("physics", "jacobian", "thin"), "jacobian: thin; expected auto, dense or sparse"),
    ("randomization.yaml", put("fricton", [0.4, 1.2]), "unknown key fricton"),
    ("randomization.yaml", put("friction", [1.2, 0.4]), r"friction: .*; expected .lower, upper."),
    ("randomization.yaml", put("noise", "gyro_rad_s", True), "noise: gyro_rad_s: True; expected a number"),
    ("randomization.yaml", lambda c: c.pop("delay_s"), "delay_s is missing"),
])
def test_a_key_or_value_that_means_nothing_is_named(tmp_path, name, change, said):
    load = load_config if name == "config.yaml" else load_randomization
    with pytest.raises(ValueError, match=f"{name}: (.*: )?{said}"):
        load(changed(tmp_path, name, change))


def test_a_file_that_is_no_yaml_is_named(tmp_path):
    path = tmp_path / "config.yaml"
    path.write_text("ppo: {")
    with pytest.raises(ValueError, match=r"config.yaml: .*line 1"):
        load_config(path)
