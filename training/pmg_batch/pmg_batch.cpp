#include "pmg_batch.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "checked_files.hpp"
#include "model/clip_library_file.hpp"
#include "policy/observation.hpp"
#include "reference_stream.hpp"
#include "work/parallel.hpp"

namespace {

thread_local std::string last_error;

/// The text of a checked file for a caller of the C interface; NULL when it throws.
template <typename Read>
const char* answer(Read&& read) {
  thread_local std::string text;
  try {
    text = read();
    return text.c_str();
  } catch (const std::exception& error) {
    last_error = error.what();
    return nullptr;
  }
}

pmg::Variant variant_of(const std::string& name) {
  const auto variant = pmg::variant_named(name);
  if (!variant) throw std::invalid_argument("variant " + name + "; expected pmg, without_gco or single_gait");
  return *variant;
}

nlohmann::ordered_json describe(const pmg::model::RobotModel& robot, const std::string& variant,
                                const std::vector<pmg::training::Field>& fields) {
  using nlohmann::ordered_json;
  ordered_json joints = ordered_json::array(), columns = ordered_json::array(), range = ordered_json::array();
  for (std::size_t i = 0; i < robot.joints.size(); ++i) {
    const pmg::model::Joint& joint = robot.joints[i];
    joints.push_back({{"name", joint.name},
                      {"stand_rad", joint.stand_rad},
                      {"lower_rad", joint.lower_rad},
                      {"upper_rad", joint.upper_rad},
                      {"effort_limit_Nm", joint.effort_limit_Nm},
                      {"kp_Nm_per_rad", joint.kp_Nm_per_rad},
                      {"kd_Nm_s_per_rad", joint.kd_Nm_s_per_rad},
                      {"policy", joint.policy},
                      {"mirror_joint", robot.joint_index.name(robot.mirror.partner[i])},
                      {"mirror_sign", robot.mirror.sign[i]}});
  }
  for (const auto& field : fields) {
    columns.push_back({{"name", field.name}, {"offset", field.offset}, {"size", field.size}});
  }
  for (std::size_t c = 0; c < pmg::kChannels; ++c) {
    range.push_back({{"name", pmg::kChannelNames[c]},
                     {"lower", robot.command_limits.lower[c]},
                     {"upper", robot.command_limits.upper[c]}});
  }
  const pmg::policy::ObservationLayout layout(robot);
  return {{"robot", robot.name},
          {"variant", variant},
          {"tick_s", pmg::training::ReferenceStream::kTick_s},
          {"standing_height_m", robot.standing_height_m},
          {"base_link", robot.base_link},
          {"torso_link", robot.torso_link},
          {"foot_links", {robot.feet[pmg::kLeft].link, robot.feet[pmg::kRight].link}},
          {"joints", joints},
          {"action_joints", layout.action_joints()},
          {"command", range},
          {"fields", columns},
          {"row_size", fields.back().offset + fields.back().size},
          {"observation", ordered_json::parse(layout.to_json())},
          {"quantities", ordered_json::parse(pmg::policy::quantities_json())}};
}

}  // namespace

struct pmg_batch {
  pmg_batch(const std::string& directory, const std::string& variant_name, int streams, std::uint64_t seed,
            int thread_count)
      : robot(pmg::model::load_robot(directory)), observation(robot), threads(std::max(1, thread_count)) {
    const auto library = pmg::model::load_clip_library(robot.directory / "clips", robot);
    const pmg::Variant variant = variant_of(variant_name);
    if (streams < 1) throw std::invalid_argument("streams; expected 1 or more");
    stream.reserve(static_cast<std::size_t>(streams));
    for (int i = 0; i < streams; ++i) {
      stream.push_back(std::make_unique<pmg::training::ReferenceStream>(robot, library, variant,
                                                                        seed + static_cast<std::uint64_t>(i)));
    }
    const auto fields = pmg::training::ReferenceStream::fields(robot);
    row_size = static_cast<std::size_t>(fields.back().offset + fields.back().size);
    description = describe(robot, variant_name, fields).dump();
  }

  void run(std::size_t ticks, const float* commands, float* out) {
    // Streams are handed out in small groups, so that no thread waits long for the slowest.
    constexpr std::size_t kGroup = 16;
    const std::size_t count = stream.size();
    const auto step_group = [&](std::size_t group) {
      for (std::size_t s = group * kGroup; s < std::min((group + 1) * kGroup, count); ++s)
        run_stream(s, ticks, commands, out);
    };
    pmg::work::for_each_in_parallel((count + kGroup - 1) / kGroup, static_cast<unsigned>(threads), step_group);
  }

  void run_stream(std::size_t s, std::size_t ticks, const float* commands, float* out) {
    for (std::size_t t = 0; t < ticks; ++t) {
      const std::size_t at = t * stream.size() + s;
      float* row = out + at * row_size;
      if (commands == nullptr) {
        stream[s]->step(row);
        continue;
      }
      pmg::Command user;
      for (std::size_t c = 0; c < pmg::kChannels; ++c) {
        user.u[c] = static_cast<double>(commands[at * pmg::kChannels + c]);
      }
      stream[s]->step(user, row);
    }
  }

  pmg::model::RobotModel robot;
  pmg::policy::Observation observation;
  int threads;
  std::vector<std::unique_ptr<pmg::training::ReferenceStream>> stream;
  std::size_t row_size = 0;
  std::string description;
};

extern "C" {

pmg_batch* pmg_batch_create(const char* robot, const char* variant, int32_t streams, uint64_t seed, int32_t threads) {
  try {
    return std::make_unique<pmg_batch>(robot, variant, streams, seed, threads).release();
  } catch (const std::exception& error) {
    last_error = error.what();
    return nullptr;
  }
}

void pmg_batch_destroy(pmg_batch* batch) { delete batch; }

const char* pmg_batch_error(void) { return last_error.c_str(); }

const char* pmg_batch_description(const pmg_batch* batch) { return batch->description.c_str(); }

int32_t pmg_batch_run(pmg_batch* batch, int32_t ticks, const float* commands, float* out) {
  try {
    if (ticks < 0) throw std::invalid_argument("ticks; expected 0 or more");
    batch->run(static_cast<std::size_t>(ticks), commands, out);
    return 0;
  } catch (const std::exception& error) {
    last_error = error.what();
    return 1;
  }
}

void pmg_batch_reset(pmg_batch* batch) {
  for (const auto& stream : batch->stream) stream->reset();
}

int32_t pmg_batch_observe(pmg_batch* batch, int32_t first, const double* gyro, const double* quat_wxyz, const double* q,
                          const double* dq, const float* last_action, float* out) {
  if (first != 0) batch->observation.reset();
  const auto joints = static_cast<Eigen::Index>(batch->robot.joints.size());
  const auto actions = static_cast<Eigen::Index>(batch->observation.layout().action_joints().size());
  pmg::model::RobotState state;
  state.gyro_rad_s = Eigen::Map<const Eigen::Vector3d>(gyro);
  state.orientation_WI = Eigen::Quaterniond(quat_wxyz[0], quat_wxyz[1], quat_wxyz[2], quat_wxyz[3]);
  state.q = Eigen::Map<const Eigen::VectorXd>(q, joints);
  state.dq = Eigen::Map<const Eigen::VectorXd>(dq, joints);
  const Eigen::VectorXf action = Eigen::Map<const Eigen::VectorXf>(last_action, actions);
  const auto& stream = *batch->stream.front();
  const Eigen::VectorXf& seen = batch->observation.assemble(state, stream.reference(), stream.observed(), action);
  std::copy(seen.begin(), seen.end(), out);
  return 0;
}

const char* pmg_batch_randomization(const char* file) {
  return answer([&] { return pmg::training::randomization_json(file); });
}
const char* pmg_batch_motors(const char* robot, const char* file) {
  return answer([&] { return pmg::training::motors_json(robot, file); });
}
const char* pmg_batch_scenario(const char* file) {
  return answer([&] { return pmg::training::scenario_json(file); });
}
}
