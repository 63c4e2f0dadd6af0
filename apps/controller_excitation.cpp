#include "controller_excitation.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace pmg::apps {

ControllerExcitation::ControllerExcitation(const std::string& joint, const std::string& robot,
                                           const std::filesystem::path& excitation,
                                           const std::filesystem::path& bench_out,
                                           const std::vector<std::string>& own_gains, control::LoadedControl& loaded)
    : bench_out_(bench_out) {
  if (!joint.empty()) {
    bench_.emplace(loaded.robot, joint, excitation, bench_out, loaded.options);
    recorder_.emplace(bench_->recorder());
    loaded.options.excitation = bench_->plan();
  }
  if (robot.empty()) return;
  const control::RobotExcitationPlan& plan = loaded.options.robot_excitation.emplace(
      runtime::robot_excitation_plan(robot, loaded.robot, loaded.library, loaded.options.guard, own_gains));
  robot_.emplace(robot, plan, loaded.options.dt_s);
}

void ControllerExcitation::add_to(nlohmann::ordered_json& json) const {
  if (bench_) json["bench"] = bench_->json();
  if (robot_) json["excite"] = robot_->json();
}

std::string ControllerExcitation::take(const control::TickRecord& record) {
  std::string news;
  if (robot_) {
    news = robot_->news(record);
    over_ = over_ || robot_->may_end();
  }
  if (recorder_) {
    recorder_->add(record);
    over_ = over_ || recorder_->progress().over;
  }
  return news;
}

std::string ControllerExcitation::write() const {
  return bench_ ? fmt::format("{}: {}", bench_->write(*recorder_), bench_out_.string()) : "";
}

bool ControllerExcitation::whole() const {
  return (!bench_ || bench_->whole(*recorder_)) && (!robot_ || robot_->whole());
}

}  // namespace pmg::apps
