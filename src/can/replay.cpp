#include "can/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <stdexcept>

#include "hal/bus_cycle.hpp"

namespace pmg::can {

namespace {

constexpr std::int64_t kPeriod_ns = hal::BusCycle::kPeriod_ns;
/// Frames of both ways are missing for so long: who recorded wasn't there, or nobody drove the buses.
constexpr std::int64_t kHole_ns = 5 * kPeriod_ns;
/// Cycles after which every drive and the IMU have spoken that speak at all.
constexpr std::uint64_t kFirstCycles = XsensImu::kSilentCycles + 2;

/// This computer sent it for all drives of a bus together.
bool for_all(const std::unique_ptr<drives::Network>& network, const drives::Message& frame) {
  return network && !frame.extended &&
         std::ranges::find(network->messages(), frame.id, &drives::NetworkMessage::id) != network->messages().end();
}

}  // namespace

/// One bus: what was pushed is received; what is sent goes nowhere.
class Replay::RecordedLink final : public Link {
 public:
  std::size_t send(std::span<const drives::Message> frames) noexcept override { return frames.size(); }
  std::size_t receive(std::span<drives::Message> frames) noexcept override {
    const std::size_t count = std::min(frames.size(), waiting_.size());
    std::copy_n(waiting_.begin(), count, frames.begin());
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }
  BusHealth health() const noexcept override { return BusHealth::kGood; }
  const LinkCounts& counts() const noexcept override { return counts_; }
  void push(const drives::Message& frame) { waiting_.push_back(frame); }

 private:
  std::deque<drives::Message> waiting_;
  LinkCounts counts_;
};

Replay::Replay(const DriveSetup& setup, const model::RobotModel& robot, Tell tell)
    : setup_(setup), tell_(std::move(tell)) {
  std::vector<std::unique_ptr<Link>> links;
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    auto link = std::make_unique<RecordedLink>();
    links_.push_back(link.get());
    links.push_back(std::move(link));
    networks_.push_back(drives::network_of(setup.buses[b]));
  }
  hal_ = std::make_unique<CanHal>(setup, robot, clock_, std::move(links));
  const int joints = robot.joint_index.size();
  for (JointVector* values : {&limp_.q, &limp_.dq, &limp_.kp, &limp_.kd, &limp_.tau_ff}) values->setZero(joints);
}

Replay::~Replay() = default;

bool Replay::asks(std::size_t bus, const drives::Message& frame) const {
  if (frame.extended) return false;
  const BusSetup& setup = setup_.buses[bus];
  if (networks_[bus] && frame.id == networks_[bus]->sync().id) return true;
  return std::ranges::any_of(setup.motors, [&](const drives::MotorSetup& motor) {
    return std::ranges::any_of(motor.drive->ids(motor.node),
                               [&](const drives::MotorId& id) { return !id.answer && id.id == frame.id; });
  });
}

void Replay::take(const RecordedFrame& recorded) {
  const auto bus = std::ranges::find(setup_.buses, recorded.interface, &BusSetup::name);
  if (bus == setup_.buses.end() || recorded.kind != RecordedFrame::Kind::kData) {
    ++left_out_;
    return;
  }
  ++frames_;
  const auto at = static_cast<std::size_t>(bus - setup_.buses.begin());
  stamp_ns_ = std::max(stamp_ns_, recorded.stamp_ns);  // clocks are set back at times
  if (!first_ns_) first_ns_ = stamp_ns_;
  const bool asking = asks(at, recorded.frame);
  if (!running_) {  // answers to what was asked before the recording belong to no cycle
    if (!asking && stamp_ns_ - *first_ns_ < kHole_ns) return;
    begin(stamp_ns_);
  }
  const std::int64_t since_ns = stamp_ns_ - begin_ns_;
  if (since_ns > kHole_ns) {
    const double at_s = 1e-9 * static_cast<double>(begin_ns_ - *first_ns_);
    if (tell_) tell_(at_s, fmt::format("nothing was recorded for {:.3f} s", 1e-9 * static_cast<double>(since_ns)));
    begin(stamp_ns_);
  } else if (!marker_ && since_ns >= kPeriod_ns) {
    begin(stamp_ns_);
  }
  if (asking && !marker_) marker_ = {at, recorded.frame.id};
  if (asking && *marker_ == std::pair{at, recorded.frame.id} && stamp_ns_ > begin_ns_) begin(stamp_ns_);
  if (!asking && !for_all(networks_[at], recorded.frame)) links_[at]->push(recorded.frame);
}

void Replay::begin(std::int64_t stamp_ns) {
  end();
  begin_ns_ = stamp_ns;
  clock_.advance_to(std::max(clock_.now_ns(), stamp_ns - *first_ns_ + 1));
  hal_->send(limp_);
  running_ = true;
}

void Replay::end() {
  if (!running_) return;
  hal_->receive(state_);
  running_ = false;
  BusTrouble change;
  bool changed = hal_->take_change(change);
  if (++cycles_ < kFirstCycles) return;
  if (cycles_ == kFirstCycles) {
    change = hal_->trouble();
    changed = change.status == hal::BusStatus::kLost;
  }
  if (!changed) return;
  if (change.status != hal::BusStatus::kOk) ++troubles_;
  if (tell_) tell_(1e-9 * static_cast<double>(begin_ns_ - *first_ns_), describe(change, setup_));
}

void feed(Replay& replay, std::istream& recording, const std::string& name) {
  std::string line;
  for (int number = 1; std::getline(recording, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    const auto recorded = from_line(line);
    if (!recorded)
      throw std::runtime_error(fmt::format(
          "{}:{}: isn't a frame; expected candump's log format, as `pmg_bus dump` writes it: (1436509052.249713) "
          "can0 044#2A366C2B",
          name, number));
    replay.take(*recorded);
  }
  replay.end();
  if (replay.frames() == 0)
    throw std::runtime_error(name + ": has no frame of the robot's buses; expected the interfaces of robot.yaml");
}

}  // namespace pmg::can
