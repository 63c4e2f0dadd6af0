// The nightly campaign: many hidden robots, how often the diagnosis is right, as the table of
// docs/explanation/whole-robot-diagnosis.md.
// Usage: hidden_robot_campaign [COUNT [FIRST_SEED]]. Exit code 1 when a promise is broken.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "model/robot_model.hpp"
#include "robot_diagnosis/hidden_robot.hpp"
#include "robot_diagnosis/robot_diagnosis.hpp"

namespace {

using namespace pmg;
using namespace pmg::robot_diagnosis;

struct Count {
  int right = 0, of = 0;
  void add(bool was_right) {
    ++of;
    right += was_right ? 1 : 0;
  }
  bool holds(double share) const { return of == 0 || right >= share * of; }
};

std::string kind(const HiddenEffect& hidden) {
  const bool whole = hidden.effect.empty() || hidden.effect == "payload" || hidden.effect == "center_of_mass" ||
                     hidden.effect == "imu_mounting";
  return hidden.effect.empty() ? "clean" : whole ? hidden.effect : "joint";
}

std::string said(const RobotDiagnosis& diagnosis) {
  std::string text = name(diagnosis.verdict);
  for (const RobotCause& cause : diagnosis.causes) {
    text += fmt::format("; {} of {}", cause.effect, cause.place);
    for (const evidence::ParameterEstimate& p : cause.parameters) text += fmt::format(" {:.3g}", p.estimate.value);
  }
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 100, first = argc > 2 ? std::atoi(argv[2]) : 0;
  const model::RobotModel robot = model::load_robot(model::find_robot("z1"));
  std::map<std::string, Count> counts;
  Count ground;
  fmt::print("| seed | hidden | said | right |\n|---|---|---|---|\n");
  for (int seed = first; seed < first + count; ++seed) {
    const HiddenRobot hidden = hide(robot, static_cast<std::uint64_t>(seed));
    const RobotDiagnosis diagnosis = diagnose_robot(robot, record_hidden(hidden));
    const bool right = named_right(hidden.hidden, diagnosis);
    counts[kind(hidden.hidden)].add(right);
    ground.add(!diagnosis.ground.observable || std::abs(diagnosis.ground.value - hidden.ground_friction) <= 0.1);
    std::string truth =
        hidden.hidden.effect.empty() ? "nothing" : fmt::format("{} of {}", hidden.hidden.effect, hidden.hidden.place);
    for (const double value : hidden.hidden.values) truth += fmt::format(" {:.3g}", value);
    fmt::print("| {} | {} | {} | {} |\n", seed, truth, said(diagnosis), right ? "yes" : "no");
    std::fflush(stdout);
  }
  fmt::print("\n| kind | right | of |\n|---|---|---|\n");
  for (const auto& [name, c] : counts) fmt::print("| {} | {} | {} |\n", name, c.right, c.of);
  fmt::print("| ground friction within 0.1 or not observable | {} | {} |\n", ground.right, ground.of);
  const bool kept = counts["clean"].holds(0.95) && counts["joint"].holds(0.85) && counts["payload"].holds(1.0) &&
                    counts["imu_mounting"].holds(1.0) && ground.holds(1.0);
  return kept ? 0 : 1;
}
