// What pmg_controller excites: one joint of a hanging robot (--bench), the whole robot (--excite), or nothing.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "control/control_setup.hpp"
#include "runtime/bench_session.hpp"
#include "runtime/robot_excitation_session.hpp"

namespace pmg::apps {

class ControllerExcitation {
 public:
  /// joint, robot: empty for none. own_gains: as hal::BackendDescription's. Gives the tick of `loaded` its plan. Throws
  /// std::invalid_argument and files::ConfigError.
  ControllerExcitation(const std::string& joint, const std::string& robot, const std::filesystem::path& excitation,
                       const std::filesystem::path& bench_out, const std::vector<std::string>& own_gains,
                       control::LoadedControl& loaded);

  void add_to(nlohmann::ordered_json& json) const;  ///< for the log's header, so that the log can be replayed
  /// (tick) => (a line for people; "": none).
  std::string take(const control::TickRecord& record);
  bool over() const { return over_; }  ///< nothing is left to play, and the robot may be damped
  /// Writes the bench; one line for people, "" without one.
  std::string write() const;
  bool whole() const;  ///< all that was asked for was played; true for nothing

 private:
  std::filesystem::path bench_out_;
  std::optional<runtime::BenchSession> bench_;
  std::optional<runtime::ExcitationRecorder> recorder_;
  std::optional<runtime::RobotExcitationSession> robot_;
  bool over_ = false;
};

}  // namespace pmg::apps
