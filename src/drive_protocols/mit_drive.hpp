// Drives of the MIT protocol as a kind: commands are the same for all that descend from it, replies differ. This class
// is the dialect of CubeMars' AK series; other dialects derive from it.
#pragma once

#include "drive_protocols/mit_protocol.hpp"
#include "drives/drive_type.hpp"

namespace pmg::drives {

class MitDrive : public DriveType {
 public:
  /// protocol: its name in robot.yaml.
  explicit MitDrive(const MitRanges& ranges, const char* protocol = "mit", MitSpecials specials = {}) noexcept;

  const char* protocol_name() const noexcept { return protocol_; }
  const MitRanges& ranges() const noexcept { return ranges_; }
  const MitProtocol& codec() const noexcept { return codec_; }

  /// A reply, whichever node it names; nullopt: it isn't one of this dialect.
  virtual std::optional<MitReply> read(std::span<const std::uint8_t> bytes) const noexcept {
    return codec_.reply(bytes);
  }
  /// What a drive of this dialect replies with: for emulators.
  virtual Message reply(const MitReply& reply) const noexcept;
  /// The number with which a drive of this node replies.
  virtual std::uint8_t named(int node) const noexcept { return static_cast<std::uint8_t>(node); }
  /// The message that clears a fault; null: enabling does.
  virtual const MitFrame* clearing() const noexcept { return nullptr; }
  /// Replies say whether the drive is enabled.
  virtual bool says_enabled() const noexcept { return false; }

  /// Keeps a reference to this kind.
  std::unique_ptr<Protocol> protocol(int node, const MotorLimits& limits, bool fd) const override;
  void check_covers(const DriveNeeds& needs, const std::string& joint, const std::string& drive,
                    const files::ConfigReader& reader) const override;
  DriveKind replying_as(std::uint32_t id) const override;
  std::vector<MotorId> ids(int node) const override;
  std::optional<int> sender(const Message& message) const noexcept override;
  /// Of no dialect is a message known that only asks. Switching off is the least: every drive answers it with its
  /// state.
  bool off_is_harmless() const noexcept override { return true; }
  double torque_step_Nm() const noexcept override { return codec_.torque().step(); }

 protected:
  /// The same dialect with other ranges.
  virtual DriveKind with(const MitRanges& ranges) const { return std::make_shared<MitDrive>(ranges); }

 private:
  MitRanges ranges_;
  const char* protocol_;
  MitProtocol codec_;
};

/// Reads an entry with `protocol: mit`, or a dialect's. reply_id: where robot.yaml has none. Throws files::ConfigError.
MitRanges read_mit_ranges(files::ConfigReader& reader, std::uint32_t reply_id = 0);
DriveKind mit_drive(const MitRanges& ranges);
/// Null: not an MIT drive.
const MitDrive* as_mit(const DriveKind& kind) noexcept;

}  // namespace pmg::drives
