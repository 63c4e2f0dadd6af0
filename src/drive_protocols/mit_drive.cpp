#include "drive_protocols/mit_drive.hpp"

#include <algorithm>
#include <cmath>

namespace pmg::drives {

namespace {

/// One motor's way to speak. Every message is a request, and has one reply.
class MitSpeaker final : public Protocol {
 public:
  /// Between two attempts to clear a fault that stays: 0.5 s.
  static constexpr int kClearCycles = 250;

  MitSpeaker(const MitDrive& type, int node, const MotorLimits& limits, bool fd) noexcept
      : type_(&type), node_(node), limits_(limits), fd_(fd) {}

  void order(const Order& order, Outbox& out) noexcept override {
    since_clear_ = std::min(since_clear_ + 1, kClearCycles);
    if (!order.enabling) {
      put(type_->codec().command(order.command, limits_, left_Nm_), out);
    } else {
      put(fault_ != DriveFault::kNone && clears() ? *type_->clearing() : kMitEnable, out);
    }
  }
  /// That a computer fell silent is no fault once one speaks again.
  void off(Outbox& out) noexcept override {
    since_clear_ = std::min(since_clear_ + 1, kClearCycles);
    put(fault_ == DriveFault::kCommunication && clears() ? *type_->clearing() : kMitDisable, out);
  }
  bool zero(Outbox& out) noexcept override {
    put(kMitZero, out);
    return true;
  }

  Heard hear(const Message& message) noexcept override {
    if (message.extended || message.id != type_->ranges().reply_id) return {};
    const auto reply = type_->read(message.bytes());
    if (!reply || reply->node != type_->named(node_)) return {};
    fault_ = reply->reading.fault;
    return {.what = Heard::What::kReading, .reading = reply->reading};
  }
  bool tells_whether_it_follows() const noexcept override { return type_->says_enabled(); }

 private:
  /// Now is the time for the message that clears faults.
  bool clears() noexcept {
    if (type_->clearing() == nullptr || since_clear_ < kClearCycles) return false;
    since_clear_ = 0;
    return true;
  }
  void put(const MitFrame& frame, Outbox& out) const noexcept {
    out.put(Message::of(static_cast<std::uint32_t>(node_), frame, fd_));
  }

  const MitDrive* type_;
  int node_;
  MotorLimits limits_;
  bool fd_;
  double left_Nm_ = 0.0;                  // of the last command's torque, for the next one
  DriveFault fault_ = DriveFault::kNone;  // of the last reply
  int since_clear_ = kClearCycles;
};

}  // namespace

MitDrive::MitDrive(const MitRanges& ranges, const char* protocol, MitSpecials specials) noexcept
    : ranges_(ranges), protocol_(protocol), codec_(ranges, specials) {}

Message MitDrive::reply(const MitReply& reply) const noexcept {
  return Message::of(ranges_.reply_id, codec_.reply(reply));
}

std::unique_ptr<Protocol> MitDrive::protocol(int node, const MotorLimits& limits, bool fd) const {
  return std::make_unique<MitSpeaker>(*this, node, limits, fd);
}

void MitDrive::check_covers(const DriveNeeds& needs, const std::string& joint, const std::string& drive,
                            const files::ConfigReader& reader) const {
  const double range_rad = std::max(std::abs(needs.limits.q_lower_rad), std::abs(needs.limits.q_upper_rad));
  for (const Cover& cover : {Cover{"position_rad", "range", range_rad, ranges_.position_rad},
                             Cover{"velocity_rad_s", "speed limit", needs.limits.dq_rad_s, ranges_.velocity_rad_s},
                             Cover{"torque_Nm", "effort", needs.limits.torque_Nm, ranges_.torque_Nm},
                             Cover{"kp_Nm_per_rad", "kp", needs.gains.kp_Nm_per_rad, ranges_.kp_Nm_per_rad},
                             Cover{"kd_Nm_s_per_rad", "kd", needs.gains.kd_Nm_s_per_rad, ranges_.kd_Nm_s_per_rad}}) {
    check_cover(cover, joint, drive, reader);
  }
}

DriveKind MitDrive::replying_as(std::uint32_t id) const {
  MitRanges ranges = ranges_;
  ranges.reply_id = id;
  return with(ranges);
}

std::vector<MotorId> MitDrive::ids(int node) const {
  return {{.id = static_cast<std::uint32_t>(node), .what = "commands"},
          {.id = ranges_.reply_id, .what = "replies", .answer = true, .shared_by = protocol_, .mark = named(node)}};
}

std::optional<int> MitDrive::sender(const Message& message) const noexcept {
  if (message.extended || message.id != ranges_.reply_id) return std::nullopt;
  const auto reply = read(message.bytes());
  return reply ? std::optional<int>(reply->node) : std::nullopt;
}

MitRanges read_mit_ranges(files::ConfigReader& reader, std::uint32_t reply_id) {
  return {.position_rad = reader.required<double>("position_rad", files::positive()),
          .velocity_rad_s = reader.required<double>("velocity_rad_s", files::positive()),
          .torque_Nm = reader.required<double>("torque_Nm", files::positive()),
          .kp_Nm_per_rad = reader.required<double>("kp_Nm_per_rad", files::positive()),
          .kd_Nm_s_per_rad = reader.required<double>("kd_Nm_s_per_rad", files::positive()),
          .reply_id = static_cast<std::uint32_t>(
              reader.optional<int>("reply_id", static_cast<int>(reply_id), files::in_range(0, 0x7FF)))};
}

DriveKind mit_drive(const MitRanges& ranges) { return std::make_shared<MitDrive>(ranges); }

const MitDrive* as_mit(const DriveKind& kind) noexcept { return dynamic_cast<const MitDrive*>(kind.get()); }

}  // namespace pmg::drives
