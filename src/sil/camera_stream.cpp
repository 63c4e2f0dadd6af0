#include "sil/camera_stream.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "sim/head_camera.hpp"

namespace pmg::sil {

namespace {

/// Of this thread and of those that it makes: OSMesa draws in some.
void lower_priority() {
  constexpr int kNice = 10;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);  // what it fails by, it does without
}

}  // namespace

CameraEye::CameraEye(const mjModel* model, const std::string& torso_link)
    : model_(model),
      data_(mj_makeData(model)),
      renderer_(model, {.width = kWidth,
                        .height = kHeight,
                        .mounted = sim::mounted(sim::HeadCamera(), torso_link, kWidth, kHeight)}) {}

std::vector<std::uint8_t> CameraEye::look(const PoseSample& pose) {
  std::copy_n(pose.qpos.begin(), std::min(pose.count, static_cast<std::size_t>(model_->nq)), data_->qpos);
  data_->time = pose.time_s;
  mj_kinematics(model_, data_.get());
  mj_comPos(model_, data_.get());
  mj_camlight(model_, data_.get());
  return encoder_.encode(renderer_.render(data_.get(), "", pose.rope), kWidth, kHeight, pmg_msgs::camera_t::MOST_BYTES);
}

CameraSender::CameraSender(CameraEye& eye, SimulatedRobot& robot, const std::string& name, io::LcmLink& link,
                           const io::Clock& clock)
    : eye_(eye), robot_(robot), link_(link), clock_(clock), due_ns_(clock.now_ns()) {
  picture_.robot = name;
  picture_.session = std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

void CameraSender::step() {
  const std::int64_t now_ns = clock_.now_ns();
  if (now_ns < due_ns_) return;
  due_ns_ = now_ns + kPeriod_ns;
  if (!robot_.take(pose_)) return;
  picture_.stamp_ns = now_ns;  // a pose is 10 ms old at most, unless the simulation stands still
  picture_.jpeg = eye_.look(pose_);
  picture_.size = static_cast<std::int32_t>(picture_.jpeg.size());
  ++picture_.sequence;
  link_.publish("CAMERA", picture_);
}

CameraStream::CameraStream(const mjModel* model, const std::string& torso_link, SimulatedRobot& robot, std::string name,
                           std::string lcm_url, const io::Clock& clock)
    : robot_(robot), name_(std::move(name)), lcm_url_(std::move(lcm_url)), clock_(clock) {
  std::future<void> ready = ready_.get_future();
  thread_ = std::jthread([this, model, torso_link](const std::stop_token& stop) { work(stop, model, torso_link); });
  ready.get();
}

void CameraStream::work(const std::stop_token& stop, const mjModel* model, const std::string& torso_link) {
  lower_priority();
  bool begun = false;
  try {
    CameraEye eye(model, torso_link);
    io::LcmLink link(lcm_url_);
    CameraSender sender(eye, robot_, name_, link, clock_);
    ready_.set_value();
    begun = true;
    send_until(stop, sender);
  } catch (const std::exception& error) {
    if (!begun) return ready_.set_exception(std::current_exception());
    const std::lock_guard lock(mutex_);
    failure_ = std::string("the head's camera shows nothing more: ") + error.what();
  }
}

void CameraStream::send_until(const std::stop_token& stop, CameraSender& sender) {
  while (!stop.stop_requested()) {
    sender.step();
    std::unique_lock lock(mutex_);
    stopped_.wait_for(lock, stop, std::chrono::nanoseconds(sender.due_ns() - clock_.now_ns()), [] { return false; });
  }
}

std::string CameraStream::take_failure() {
  const std::lock_guard lock(mutex_);
  return std::exchange(failure_, {});
}

}  // namespace pmg::sil
