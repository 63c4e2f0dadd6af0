#include "sil/live_view.hpp"

#include <fmt/format.h>

#include <span>
#include <thread>

#include "control/mode_text.hpp"

namespace pmg::sil {

LiveView::LiveView(sim::World& world, const model::RobotModel& robot)
    : world_(world), robot_(robot), viewer_(world.mj_model(), {.title = "PMG: " + robot.name}) {}

void LiveView::after_tick(const RunProgress& progress) {
  constexpr int kTicksPerFrame = 2;
  if (start_s_ < 0.0) {
    start_s_ = progress.time_s;
    start_ = std::chrono::steady_clock::now();
  }
  if (++ticks_ % kTicksPerFrame != 0) return;
  const auto due = start_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                std::chrono::duration<double>(progress.time_s - start_s_));
  const auto now = std::chrono::steady_clock::now();
  // A computer that draws slowly shows fewer frames, but some; one that falls behind altogether starts counting anew.
  constexpr std::chrono::milliseconds kBehind{50}, kLongestWait{500}, kLost{1000};
  if (now - due > kLost) start_ += now - due;
  if (now - due < kBehind || now - last_frame_ > kLongestWait) {
    const mjModel& model = *world_.mj_model();
    viewer_.show({world_.mj_data()->qpos, static_cast<std::size_t>(model.nq)}, text(progress), world_.gantry_rope());
    last_frame_ = std::chrono::steady_clock::now();
  }
  std::this_thread::sleep_until(due);
}

void LiveView::note(const RunProgress& progress) {
  std::string noted = text(progress);
  const std::lock_guard lock(mutex_);
  noted_ = std::move(noted);
}

void LiveView::draw(SimulatedRobot& robot) {
  robot.take(pose_);
  std::string noted;
  {
    const std::lock_guard lock(mutex_);
    noted = noted_;
  }
  if (pose_.count > 0) viewer_.show({pose_.qpos.data(), pose_.count}, noted, pose_.rope);
}

std::string LiveView::text(const RunProgress& progress) const {
  const std::string fault =
      progress.result.mode == control::Mode::kFault ? describe(progress.result.fault, robot_) : std::string();
  return fmt::format("{:6.1f} s  {}\n{}\n{}", progress.time_s,
                     mode_text(progress.result.mode, hanging(progress.result.maker)), progress.step.text, fault);
}

}  // namespace pmg::sil
