// `--inject FILE` of pmg_controller: failures of a simulated robot's parts, and what they led to.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "control/control_setup.hpp"
#include "control/tick_record.hpp"
#include "hal/hal.hpp"

namespace pmg::apps {

class Injection {
 public:
  /// file: empty injects nothing. Throws files::ConfigError, and std::invalid_argument unless the drives are simulated.
  Injection(const std::filesystem::path& file, const std::string& hal, const model::RobotModel& robot);
  ~Injection();
  Injection(const Injection&) = delete;
  Injection& operator=(const Injection&) = delete;

  void into(control::LoadedControl& loaded);                         ///< policy and tick
  hal::Hal& into(hal::Hal& drives, const model::RobotModel& robot);  ///< the bus; outlives the threads
  void watch(const control::TickRecord& record);                     ///< every tick, in its order
  /// After the threads' end: an entry for each failure (sil/failure_report.hpp); empty without a file.
  nlohmann::ordered_json report() const;
  std::vector<std::string> lines() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace pmg::apps
