#include "udp_backend.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <system_error>

namespace own {

namespace {

using namespace pmg;

constexpr std::size_t kMostJoints = 64;
constexpr std::int64_t kWait_ns = 500'000;  // for an answer: a quarter of a bus cycle
constexpr std::uint32_t kFreshCycles = 1;   // an answer to the command before is still fresh
constexpr std::uint32_t kSilentCycles = 5;  // 10 ms
constexpr int kConnect_ms = 2000;

/// What goes to the board in each cycle: floats, in the processor's byte order.
struct Command {
  std::uint32_t cycle = 0;
  std::array<std::array<float, 5>, kMostJoints> joints{};  // q [rad], dq [rad/s], kp [Nm/rad], kd [Nm s/rad], tau [Nm]
};
/// Its answer.
struct Answer {
  std::uint32_t cycle = 0;                                 // of the command that it answers
  std::array<float, 10> imu{};                             // gyro [rad/s], specific force [m/s^2], orientation w x y z
  std::array<std::array<float, 4>, kMostJoints> joints{};  // q [rad], dq [rad/s], tau [Nm], temperature [degC]
};

class UdpBackend final : public hal::Backend, private hal::Hal {
 public:
  explicit UdpBackend(const hal::BackendSetup& setup)
      : robot_(setup.robot), clock_(setup.clock), options_(setup.options) {
    const auto port = std::get<std::uint64_t>(options_.at("board-port"));
    if (port < 1 || port > 65535) throw std::invalid_argument("--board-port: expected 1 to 65535");
    if (joints() > kMostJoints) throw std::invalid_argument(robot_.name + " has more joints than the board");
    board_.sin_family = AF_INET;
    board_.sin_port = htons(static_cast<std::uint16_t>(port));
    if (inet_pton(AF_INET, std::get<std::string>(options_.at("board")).c_str(), &board_.sin_addr) != 1)
      throw std::invalid_argument("--board: expected an address such as 127.0.0.1");
  }
  UdpBackend(const UdpBackend&) = delete;
  UdpBackend& operator=(const UdpBackend&) = delete;
  ~UdpBackend() override {
    if (socket_ >= 0) close(socket_);
  }

  hal::OptionValues configuration() const override { return options_; }

  hal::Hal& connect(const std::function<bool()>& interrupted) override {
    socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0 || ::connect(socket_, reinterpret_cast<const sockaddr*>(&board_), sizeof board_) != 0)
      throw std::system_error(errno, std::generic_category(), "--board");
    model::RobotState state;
    for (int k = 0; k < kConnect_ms / 2 && !interrupted(); ++k) {
      exchange({}, state);
      if (newest_.cycle > 0) return *this;
      const timespec cycle{.tv_sec = 0, .tv_nsec = 2'000'000};
      nanosleep(&cycle, nullptr);
    }
    throw std::runtime_error("the board does not answer; expected it powered, at the address of --board");
  }

 private:
  std::size_t joints() const { return static_cast<std::size_t>(robot_.joint_index.size()); }

  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    ++outgoing_.cycle;
    for (std::size_t j = 0; j < joints(); ++j) {
      const auto i = static_cast<Eigen::Index>(j);
      auto& joint = outgoing_.joints[j];
      joint.fill(0.0F);
      if (i >= command.q.size()) continue;  // before the first command: limp
      const std::array<double, 5> values = {command.q[i], command.dq[i], command.kp[i], command.kd[i],
                                            command.tau_ff[i]};
      for (std::size_t k = 0; k < values.size(); ++k) joint[k] = static_cast<float>(values[k]);
    }
    ::send(socket_, &outgoing_, sizeof outgoing_, MSG_DONTWAIT);
    await();
    const std::uint32_t age = outgoing_.cycle - newest_.cycle;
    if (age > kSilentCycles) return hal::BusStatus::kLost;
    if (age > kFreshCycles) return hal::BusStatus::kStale;
    read(state);
    return hal::BusStatus::kOk;
  }

  /// The newest answer, within kWait_ns.
  void await() noexcept {
    const std::int64_t deadline_ns = clock_.now_ns() + kWait_ns;
    while (newest_.cycle != outgoing_.cycle) {
      const timespec left{.tv_sec = 0, .tv_nsec = std::max<std::int64_t>(deadline_ns - clock_.now_ns(), 0)};
      pollfd polled{.fd = socket_, .events = POLLIN, .revents = 0};
      if (ppoll(&polled, 1, &left, nullptr) <= 0) return;
      Answer heard;
      const ssize_t size = recv(socket_, &heard, sizeof heard, MSG_DONTWAIT);
      const bool ours = size == sizeof heard && outgoing_.cycle - heard.cycle < outgoing_.cycle - newest_.cycle;
      if (ours) newest_ = heard;
    }
  }

  void read(model::RobotState& state) const noexcept {
    const auto n = static_cast<Eigen::Index>(joints());
    for (JointVector* values : {&state.q, &state.dq, &state.tau, &state.temperature_degC}) values->resize(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto& joint = newest_.joints[static_cast<std::size_t>(i)];
      state.q[i] = static_cast<double>(joint[0]);
      state.dq[i] = static_cast<double>(joint[1]);
      state.tau[i] = static_cast<double>(joint[2]);
      state.temperature_degC[i] = static_cast<double>(joint[3]);
    }
    const auto value = [this](std::size_t k) { return static_cast<double>(newest_.imu[k]); };
    state.gyro_rad_s = {value(0), value(1), value(2)};
    state.acceleration_m_s2 = {value(3), value(4), value(5)};
    state.orientation_WI = Eigen::Quaterniond(value(6), value(7), value(8), value(9));
    state.bus_sample = newest_.cycle;
  }

  const model::RobotModel& robot_;
  const io::Clock& clock_;
  hal::OptionValues options_;
  sockaddr_in board_{};
  int socket_ = -1;
  Command outgoing_;
  Answer newest_;
};

}  // namespace

void register_backend(hal::BackendFactory& factory) {
  factory.add({.name = "udp",
               .summary = "drives on a board that speaks UDP",
               .options = {{"board", "address of the board", std::string("127.0.0.1")},
                           {"board-port", "its UDP port", std::uint64_t{9750}}},
               .make = [](const hal::BackendSetup& setup) { return std::make_unique<UdpBackend>(setup); }});
}

}  // namespace own
