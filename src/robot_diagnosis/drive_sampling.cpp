#include "robot_diagnosis/drive_sampling.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "model/constants.hpp"

namespace pmg::robot_diagnosis {

DriveSampling drive_sampling(const std::string& backend, const std::string& options) {
  const nlohmann::json json = nlohmann::json::parse(options, nullptr, false);
  if (json.is_object() && json.contains("drive_sampling_s") && json["drive_sampling_s"].is_number())
    return {json["drive_sampling_s"].get<double>(), "the log says so"};
  if (backend == "sil") return {model::kBusPeriod_s, "the log's backend is sil, whose drives have it"};
  return {0.0,
          fmt::format("the log of backend '{}' doesn't say; much faster than the control tick is assumed", backend)};
}

std::string drive_sampling_text(const DriveSampling& sampling) {
  const std::string what = sampling.step_s > 0.0
                               ? fmt::format("drives take positions every {:g} ms", 1e3 * sampling.step_s)
                               : "drives take positions all the time";
  return fmt::format("{} ({})", what, sampling.known_from);
}

}  // namespace pmg::robot_diagnosis
