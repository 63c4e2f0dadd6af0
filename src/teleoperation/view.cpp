#include "teleoperation/view.hpp"

#include <cmath>
#include <numbers>
#include <utility>

namespace pmg::teleoperation {

namespace {

/// Of a direction in the world to the left of a heading there [rad].
double yaw_from(double heading_rad, const Eigen::Vector3d& direction_W) {
  return std::remainder(std::atan2(direction_W.y(), direction_W.x()) - heading_rad, 2.0 * std::numbers::pi);
}

}  // namespace

View::View(const model::RobotModel& robot, const sim::World& world, std::string object, std::string table,
           const Eigen::Vector3d& table_half_m, std::uint64_t seed, const ViewOptions& options)
    : robot_(robot),
      world_(world),
      object_(std::move(object)),
      table_(std::move(table)),
      table_half_m_(table_half_m),
      options_(options),
      arms_(arms::read_arm_setup(robot)),
      random_(seed) {}

const Picture* View::look(double now_s) {
  if (now_s >= next_s_) {
    next_s_ = now_s + options_.period_s;
    underway_.push_back(take(now_s));
  }
  for (; !underway_.empty() && underway_.front().time_s + options_.delay_s <= now_s; underway_.pop_front())
    newest_ = underway_.front();
  return newest_ ? &*newest_ : nullptr;
}

Eigen::Isometry3d View::body(const std::string& name) const { return world_.pose(name); }

Eigen::Isometry3d View::torso() const { return body(robot_.torso_link); }

bool View::in_picture(const Eigen::Vector3d& p_T_m) const {
  const sim::HeadCamera& camera = options_.camera;
  const Eigen::Vector3d along(std::cos(camera.down_rad), 0.0, -std::sin(camera.down_rad));
  const Eigen::Vector3d from_camera_m = p_T_m - camera.p_TC_m;
  return from_camera_m.normalized().dot(along) >= std::cos(camera.half_angle_rad);
}

Eigen::Vector3d View::seen(const Eigen::Vector3d& p_T_m) {
  std::normal_distribution<double> noise_m(0.0, options_.noise_m);
  Eigen::Vector3d p_m = p_T_m;
  for (double& x : p_m) x += noise_m(random_);
  return p_m;
}

Eigen::Quaterniond View::seen(const Eigen::Matrix3d& R) {
  std::normal_distribution<double> noise_rad(0.0, options_.noise_turn_rad);
  Eigen::Quaterniond off = Eigen::Quaterniond::Identity();
  for (double& half : off.vec()) half = 0.5 * noise_rad(random_);
  return (off * Eigen::Quaterniond(R)).normalized();
}

Picture View::take(double now_s) {
  Picture picture;
  picture.time_s = now_s;
  const Eigen::Isometry3d T_WT = torso(), T_TW = T_WT.inverse();
  const Eigen::Isometry3d T_WO = body(object_), T_WE = body(table_);
  const Eigen::Vector3d object_T_m = T_TW * T_WO.translation();
  std::normal_distribution<double> noise_m(0.0, options_.noise_m), noise_rad(0.0, options_.noise_rad);
  // Straight ahead in the torso's heading.
  const Eigen::Vector3d ahead_W = T_WT.linear() * Eigen::Vector3d::UnitX();
  const double heading_rad = std::atan2(ahead_W.y(), ahead_W.x());
  if (in_picture(object_T_m)) {
    picture.object_m = seen(object_T_m);
    picture.mark_m = seen(Eigen::Vector3d(T_WE.inverse() * T_WO.translation())).y();
    picture.object_R = seen(Eigen::Matrix3d(T_TW.linear() * T_WO.linear()));
  }
  if (arms_) {
    for (const Foot side : {kLeft, kRight}) {
      const Eigen::Isometry3d T_TP = T_TW * body(arms_->palm[side].link) * arms_->palm[side].T_LP;
      if (!in_picture(T_TP.translation())) continue;
      picture.palm_m[side] = seen(Eigen::Vector3d(T_TP.translation()));
      picture.palm_R[side] = seen(Eigen::Matrix3d(T_TP.linear()));
    }
  }
  // To the line of the front edge: x = -depth / 2 in the table's frame E.
  const Eigen::Vector3d normal_W = T_WE.linear() * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d edge_W_m = T_WE * Eigen::Vector3d(-table_half_m_.x(), 0.0, table_half_m_.z());
  const double facing = std::cos(heading_rad) * normal_W.x() + std::sin(heading_rad) * normal_W.y();
  if (facing > 0.3) {
    picture.edge_m = (edge_W_m - T_WT.translation()).dot(normal_W) / facing + noise_m(random_);
    picture.edge_yaw_rad = yaw_from(heading_rad, normal_W) + noise_rad(random_);
    picture.up = seen(Eigen::Matrix3d(T_TW.linear() * T_WE.linear())) * Eigen::Vector3d::UnitZ();
    picture.top_m = (T_TW * edge_W_m).z() + noise_m(random_);
  }
  return picture;
}

}  // namespace pmg::teleoperation
