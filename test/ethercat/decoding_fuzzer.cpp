// libFuzzer's entry: any bytes as what slaves say of themselves, at the start (EEPROM, registers, mailbox) and in the
// bus cycle. Nothing may crash, a start that is refused is one line, and no motor may be commanded beyond its limits.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "can/limit_check.hpp"
#include "ethercat/cabled_drives.hpp"
#include "ethercat/datagrams.hpp"
#include "model/robots.hpp"

namespace {

using namespace pmg;
using test::require;

/// The cable of a MemoryWire, whose frames come back as the input has it.
class FuzzedWire final : public ethercat::Wire {
 public:
  FuzzedWire(test::MemoryWire& slaves, std::span<const std::uint8_t> input) : slaves_(slaves), input_(input) {}

  bool send(std::span<const std::uint8_t> frame) noexcept override {
    if (look) look(frame);
    return slaves_.send(frame);
  }
  /// Records of 4 bytes: how many frames pass unharmed, place (2 bytes), what is written there; a place in the upper
  /// half cuts the frame there.
  std::size_t receive(std::span<std::uint8_t> frame, std::int64_t wait_ns) noexcept override {
    std::size_t bytes = slaves_.receive(frame, wait_ns);
    if (bytes == 0 || !armed || exhausted()) return bytes;
    if (passed_++ < input_[at_]) return bytes;
    passed_ = 0;
    const std::size_t place = (input_[at_ + 1] | input_[at_ + 2] << 8U) % (2 * bytes);
    if (place < bytes) {
      frame[place] = input_[at_ + 3];
    } else {
      bytes = place - bytes;
    }
    at_ += 4;
    return bytes;
  }
  bool exhausted() const noexcept { return at_ + 4 > input_.size(); }
  bool armed = false;                                       ///< from now on
  std::function<void(std::span<const std::uint8_t>)> look;  ///< at each frame that goes out

 private:
  test::MemoryWire& slaves_;
  std::span<const std::uint8_t> input_;
  std::size_t at_ = 0;
  int passed_ = 0;
};

/// Slaves that wait for nobody: what is lost is lost.
constexpr ethercat::StartTiming kShort = {.answer_us = 20, .mailbox_us = 100, .state_us = 100};

/// A frame to the slaves: if it has outputs, what the drives are told. image: outputs in the cable's order, which is
/// the buses'.
void check_outputs(std::span<const std::uint8_t> frame, const can::DriveSetup& setup) {
  constexpr std::size_t kData = ethercat::FrameWriter::kHeader + 10;
  if (frame.size() < kData ||
      frame[ethercat::FrameWriter::kHeader] != static_cast<std::uint8_t>(ethercat::Command::kLogicalWrite))
    return;
  std::span<const std::uint8_t> image = frame.subspan(kData);
  const auto next = [&](std::size_t bytes) {
    const std::span<const std::uint8_t> part = image.first(bytes);
    image = image.subspan(bytes);
    return part;
  };
  for (const can::BusSetup& bus : setup.buses) {
    if (bus.on_can) {
      ethercat::for_frames(next(ethercat::block_bytes(test::CabledDrives::kFramesOut)),
                           [&](const drives::Message& sent) { test::check_limits(sent, bus); });
      continue;
    }
    for (const drives::MotorSetup& motor : bus.motors)
      test::check_limits(drives::Message::of(drives::canopen::kReceive1 + static_cast<std::uint32_t>(motor.node),
                                             next(ethercat::kDriveOutputs)),
                         bus);
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 4) return 0;
  const bool start = (data[0] & 1U) != 0;
  test::CabledDrives cabled(
      test::z1(), {.leg_drives = (data[0] & 2U) != 0, .imu = (data[0] & 4U) != 0, .clocks = (data[0] & 8U) != 0});
  model::RobotState truth;
  truth.q = test::z1().q_stand();
  truth.dq = truth.tau = JointVector::Zero(truth.q.size());
  truth.acceleration_m_s2 = Eigen::Vector3d(0.0, 0.0, 9.81);
  cabled.feel(truth);
  std::span<const std::uint8_t> input(data + 1, size - 1);
  if (start) {  // the first eight words of the input lie in EEPROMs: slave, place, value
    for (int k = 0; k < 8 && input.size() >= 4; ++k, input = input.subspan(4)) {
      if ((input[0] & 0x80U) != 0) continue;
      test::EmulatedSlave& slave = *cabled.wire.slaves[input[0] % cabled.wire.slaves.size()];
      slave.lie(input[1] % slave.eeprom_words(), static_cast<std::uint16_t>(input[2] | input[3] << 8U));
    }
  }
  FuzzedWire wire(cabled.wire, input);
  wire.armed = start;
  wire.look = [&](std::span<const std::uint8_t> frame) { check_outputs(frame, cabled.setup); };
  cabled.cable.timing = kShort;
  const io::SimulationClock clock;
  std::optional<ethercat::EthercatHal> hal;
  try {
    hal.emplace(
        cabled.cable, cabled.setup, test::z1(), clock, wire, [&] { cabled.drives->serve(); }, std::function<bool()>());
  } catch (const std::runtime_error& error) {
    require(std::string(error.what()).find('\n') == std::string::npos);
    return 0;
  }
  wire.armed = true;
  model::JointCommand most, limp, acting;
  most.q = test::z1().q_upper();
  const Eigen::Index n = most.q.size();
  most.dq = JointVector::Constant(n, 1e3);
  most.kp = most.kd = JointVector::Constant(n, 1e6);
  most.tau_ff = JointVector::Constant(n, -1e6);
  limp = acting = most;
  limp.kp = limp.kd = limp.tau_ff = JointVector::Zero(n);
  model::RobotState state;
  for (int k = 0; k < 100 && !wire.exhausted(); ++k) {
    const hal::BusStatus status = hal->exchange(k % 20 < 10 ? limp : most, state);
    if (status == hal::BusStatus::kOk)
      require(state.q.allFinite() && state.dq.allFinite() && state.tau.allFinite() && state.gyro_rad_s.allFinite());
    hal->take_news();
    cabled.drives->serve();
    cabled.drives->tick(acting);
    cabled.tick_slaves();
  }
  return 0;
}
