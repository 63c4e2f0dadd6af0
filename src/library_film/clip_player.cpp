#include "library_film/clip_player.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::library_film {
namespace {

/// Phases between the foot's middle stance and now, 0 to 0.5.
double from_middle_stance(const DynamicClip& clip, Foot foot, std::size_t sample) {
  const double phase = static_cast<double>(sample) / static_cast<double>(clip.q.size()) - clip.contact_center[foot];
  return std::abs(phase - std::round(phase));
}

}  // namespace

ClipPlayer::ClipPlayer(const model::RobotModel& robot)
    : robot_(robot), world_(robot, {}), attitude_(robot), legs_(robot) {}

ClipPlayer::Pose ClipPlayer::pose_of(std::size_t sample) {
  const JointVector& q = clip_->q[sample];
  const JointVector zero = JointVector::Zero(q.size());
  Pose pose{attitude_.compute(q, zero, 0.0, 0.0, 0.0, 0.0).R_HB, {}, 0.0};
  const auto& feet = legs_.compute(q, zero);
  for (const Foot foot : {kLeft, kRight}) {
    for (std::size_t i = 0; i < feet[foot].sole_B.size(); ++i) {
      pose.sole_H[foot][i] = pose.R_HB * feet[foot].sole_B[i];
      pose.lowest_m = std::min(pose.lowest_m, pose.sole_H[foot][i].z());
    }
  }
  return pose;
}

void ClipPlayer::place(const Pose& pose) {
  base_W_.z() = -pose.lowest_m;
  const Eigen::Quaterniond q_WB(Eigen::AngleAxisd(yaw_rad_, Eigen::Vector3d::UnitZ()).toRotationMatrix() * pose.R_HB);
  mjData* data = world_.mj_data();
  const mjModel* model = world_.mj_model();
  std::copy_n(base_W_.data(), 3, data->qpos);
  for (const auto& [i, value] :
       {std::pair{3, q_WB.w()}, std::pair{4, q_WB.x()}, std::pair{5, q_WB.y()}, std::pair{6, q_WB.z()}})
    data->qpos[i] = value;
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const int id = mj_name2id(model, mjOBJ_JOINT, robot_.joints[j].name.c_str());
    data->qpos[model->jnt_qposadr[id]] = clip_->q[sample_][static_cast<Eigen::Index>(j)];
  }
  mj_fwdPosition(model, data);
}

void ClipPlayer::begin(const DynamicClip& clip) {
  clip_ = &clip;
  sample_ = 0;
  yaw_rad_ = 0.0;
  base_W_.setZero();
  place(pose_of(0));
}

void ClipPlayer::step() {
  const Pose before = pose_of(sample_);
  const std::size_t next = (sample_ + 1) % clip_->q.size();
  const Pose after = pose_of(next);
  const Foot stance =
      from_middle_stance(*clip_, kLeft, sample_) < from_middle_stance(*clip_, kRight, sample_) ? kLeft : kRight;
  const auto lowest =
      std::ranges::min_element(before.sole_H[stance], {}, [](const Eigen::Vector3d& c) { return c.z(); });
  const auto corner = static_cast<std::size_t>(lowest - before.sole_H[stance].begin());
  const double turn_rad = clip_->mean_velocity[kOmega] * clip_->period_s / static_cast<double>(clip_->q.size());
  const Eigen::AngleAxisd now(yaw_rad_, Eigen::Vector3d::UnitZ()), then(yaw_rad_ + turn_rad, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d moved = now * before.sole_H[stance][corner] - then * after.sole_H[stance][corner];
  base_W_.head<2>() += moved.head<2>();
  yaw_rad_ += turn_rad;
  sample_ = next;
  world_.mj_data()->time += clip_->period_s / static_cast<double>(clip_->q.size());
  place(after);
}

Touch ClipPlayer::self_collision(const DynamicClip& clip) {
  Touch worst;
  const mjModel* model = world_.mj_model();
  begin(clip);
  for (std::size_t k = 0; k < clip.q.size(); ++k, step()) {
    const mjData* data = world_.mj_data();
    for (int c = 0; c < data->ncon; ++c) {
      const mjContact& contact = data->contact[c];
      const int one = model->geom_bodyid[contact.geom1], other = model->geom_bodyid[contact.geom2];
      if (one == 0 || other == 0 || -contact.dist <= worst.depth_m) continue;
      worst = {-contact.dist,
               std::string(mj_id2name(model, mjOBJ_BODY, one)) + " and " + mj_id2name(model, mjOBJ_BODY, other)};
    }
  }
  return worst;
}

}  // namespace pmg::library_film
