#include "zero/zero_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "io/log_series.hpp"
#include "pmg_msgs/robot_info_t.hpp"
#include "pmg_msgs/robot_state_t.hpp"

namespace pmg::zero {

namespace {

namespace fs = std::filesystem;

/// Sums over some samples, for their means.
struct Sums {
  double from_s = 0.0, to_s = 0.0;
  double count = 0.0;
  JointVector reading_rad, torque_Nm;
  Eigen::Vector3d gravity_I = Eigen::Vector3d::Zero();

  void add(const Sums& other) {
    if (count == 0.0) {
      *this = other;
      return;
    }
    to_s = other.to_s;
    count += other.count;
    reading_rad += other.reading_rad;
    torque_Nm += other.torque_Nm;
    gravity_I += other.gravity_I;
  }
};

Sums one_sample(const pmg_msgs::robot_state_t& message, double t_s) {
  Sums sample{.from_s = t_s, .to_s = t_s, .count = 1.0, .reading_rad = {}, .torque_Nm = {}};
  sample.reading_rad = Eigen::Map<const Eigen::VectorXd>(message.q_rad.data(), message.joint_count);
  sample.torque_Nm = Eigen::Map<const Eigen::VectorXd>(message.torque_Nm.data(), message.joint_count);
  const Eigen::Quaterniond q_WI(message.orientation_WI[0], message.orientation_WI[1], message.orientation_WI[2],
                                message.orientation_WI[3]);
  sample.gravity_I = q_WI.normalized().conjugate() * -Eigen::Vector3d::UnitZ();
  return sample;
}

bool finite(const Sums& sample) {
  return sample.reading_rad.allFinite() && sample.torque_Nm.allFinite() && sample.gravity_I.allFinite();
}

/// Cuts a stream of samples into still stretches.
class StillnessFinder {
 public:
  StillnessFinder(const StillnessOptions& options, std::string log, std::vector<StillPose>& poses)
      : options_(options), log_(std::move(log)), poses_(poses) {}

  void add(const Sums& sample) {
    block_.add(sample);
    if (block_.to_s - block_.from_s < options_.block_s) return;
    if (!stretch_.empty() && moved(stretch_.back(), block_)) close();
    stretch_.push_back(block_);
    block_ = Sums{};
  }

  void close() {
    Sums sums;
    for (const Sums& block : stretch_) {
      if (block.from_s - stretch_.front().from_s >= options_.settled_after_s) sums.add(block);
    }
    stretch_.clear();
    if (sums.count == 0.0 || sums.to_s - sums.from_s < options_.shortest_s) return;
    poses_.push_back({.log = log_,
                      .from_s = sums.from_s,
                      .to_s = sums.to_s,
                      .reading_rad = sums.reading_rad / sums.count,
                      .torque_Nm = sums.torque_Nm / sums.count,
                      .gravity_I = sums.gravity_I.normalized()});
  }

 private:
  bool moved(const Sums& before, const Sums& after) const {
    const double joints = (before.reading_rad / before.count - after.reading_rad / after.count).cwiseAbs().maxCoeff();
    const double attitude = (before.gravity_I.normalized() - after.gravity_I.normalized()).norm();
    const bool gap = after.from_s - before.to_s > options_.block_s;
    return gap || std::max(joints, attitude) > options_.largest_change_rad;
  }

  StillnessOptions options_;
  std::string log_;
  std::vector<StillPose>& poses_;
  Sums block_;
  std::vector<Sums> stretch_;
};

void expect_joints(const pmg_msgs::robot_info_t& info, const model::RobotModel& robot, const fs::path& log) {
  if (info.joint_names == robot.joint_index.names()) return;
  throw std::runtime_error(
      fmt::format("{}: is a log of {} with {} joints that aren't those of {}; expected the same robot", log.string(),
                  info.model, info.joint_count, robot.name));
}

void read_log(const fs::path& log, const model::RobotModel& robot, const StillnessOptions& options,
              std::vector<StillPose>& poses) {
  io::LogSeries series(io::log_files({log}));
  StillnessFinder finder(options, log.string(), poses);
  pmg_msgs::robot_info_t info;
  pmg_msgs::robot_state_t state;
  std::optional<std::int64_t> first_ns;
  while (series.next()) {
    const io::LogReader& event = series.event();
    if (event.channel() == "ROBOT_INFO" && event.decode_into(info)) expect_joints(info, robot, log);
    if (event.channel() != "STATE" || !event.decode_into(state)) continue;
    if (state.joint_count != robot.joint_index.size()) {
      throw std::runtime_error(fmt::format("{}: states of {} joints; expected the {} of {}", log.string(),
                                           state.joint_count, robot.joint_index.size(), robot.name));
    }
    if (!first_ns) first_ns = state.stamp_ns;
    const Sums sample = one_sample(state, 1e-9 * static_cast<double>(state.stamp_ns - *first_ns));
    if (finite(sample)) finder.add(sample);
  }
  finder.close();
  if (!first_ns)
    throw std::runtime_error(log.string() + ": no state of a robot in it; expected a log of pmg_controller or pmg_sil");
}

}  // namespace

std::vector<StillPose> read_still_poses(const std::vector<fs::path>& logs, const model::RobotModel& robot,
                                        const StillnessOptions& options, const work::Progress& progress) {
  std::vector<StillPose> poses;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (!progress(static_cast<double>(i) / static_cast<double>(logs.size()))) break;
    read_log(logs[i], robot, options, poses);
  }
  return poses;
}

}  // namespace pmg::zero
