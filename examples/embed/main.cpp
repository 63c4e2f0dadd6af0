// Loads Z1's clips and walks for two seconds; prints time, gait phase and the left knee's angle.
#include <iostream>

#include "model/clip_library_file.hpp"
#include "pmg/generator.hpp"

int main() {
  const pmg::model::RobotModel robot = pmg::model::load_robot(ROBOT);
  pmg::GeneratorOptions options;
  options.limits = robot.command_limits;
  options.scale_positive = robot.velocity_scale_positive;
  options.scale_negative = robot.velocity_scale_negative;
  pmg::Generator generator(pmg::model::load_clip_library(robot.directory / "clips", robot), options);
  pmg::Command command;
  command[pmg::kVx] = 0.5;                  // m/s
  for (int tick = 0; tick < 200; ++tick) {  // at 100 Hz
    const pmg::Reference& reference = generator.step(command, 0.01);
    std::cout << 0.01 * tick << ' ' << reference.phase << ' ' << reference.q[robot.joint_index.at("left_knee")] << '\n';
  }
}
