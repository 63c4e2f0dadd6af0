#include "udp_backend.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <system_error>

namespace own {
namespace {

using namespace pmg;

constexpr std::int64_t kWait_ns = 500'000;                    // for an answer: a quarter of a bus cycle
constexpr std::uint32_t kFreshCycles = 1, kSilentCycles = 5;  // an answer to the command before is fresh; lost: 10 ms
constexpr int kMostJoints = 64, kConnectCycles = 1000;

template <int Values>
using OfJoints = Eigen::Matrix<float, Values, kMostJoints, Eigen::DontAlign>;  // joint after joint
/// What goes to the board in each cycle: floats, in the processor's byte order.
struct Command {
  std::uint32_t cycle = 0;
  OfJoints<5> joints;  // q [rad], dq [rad/s], kp [Nm/rad], kd [Nm s/rad], tau [Nm]
};
/// Its answer.
struct Answer {
  std::uint32_t cycle = 0;          // of the command that it answers
  Eigen::Matrix<float, 10, 1> imu;  // gyro [rad/s], specific force [m/s^2], orientation w x y z
  OfJoints<4> joints;               // q [rad], dq [rad/s], tau [Nm], temperature [degC]
};
static_assert(sizeof(Command) == 4 * (1 + 5 * kMostJoints) && sizeof(Answer) == 4 * (1 + 10 + 4 * kMostJoints));

class UdpBackend final : public hal::Backend, private hal::Hal {
 public:
  explicit UdpBackend(const hal::BackendSetup& setup)
      : clock_(setup.clock), options_(setup.options), joints_(setup.robot.joint_index.size()) {
    const auto port = std::get<std::uint64_t>(options_.at("board-port"));
    if (port < 1 || port > 65535) throw std::invalid_argument("--board-port: expected 1 to 65535");
    board_.sin_family = AF_INET;
    board_.sin_port = htons(static_cast<std::uint16_t>(port));
    const std::string& address = std::get<std::string>(options_.at("board"));
    if (joints_ > kMostJoints || inet_pton(AF_INET, address.c_str(), &board_.sin_addr) != 1)
      throw std::invalid_argument("--board: expected an address such as 127.0.0.1, and at most 64 joints");
  }
  UdpBackend(const UdpBackend&) = delete;
  UdpBackend& operator=(const UdpBackend&) = delete;
  ~UdpBackend() override { close(socket_); }

  hal::OptionValues configuration() const override { return options_; }
  hal::Hal& connect(const std::function<bool()>& interrupted) override {
    socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (socket_ < 0 || ::connect(socket_, reinterpret_cast<const sockaddr*>(&board_), sizeof board_) != 0)
      throw std::system_error(errno, std::generic_category(), "--board");
    model::RobotState state;
    for (int k = 0; k < kConnectCycles && !interrupted(); ++k) {
      exchange({}, state);
      if (newest_.cycle > 0) return *this;
      constexpr timespec kCycle{.tv_sec = 0, .tv_nsec = 2'000'000};
      nanosleep(&kCycle, nullptr);
    }
    throw std::runtime_error("the board does not answer; expected it powered, at the address of --board");
  }

 private:
  hal::BusStatus exchange(const model::JointCommand& command, model::RobotState& state) noexcept override {
    ++outgoing_.cycle;
    outgoing_.joints.setZero();  // before the first command: limp
    int row = 0;
    for (const JointVector* values : {&command.q, &command.dq, &command.kp, &command.kd, &command.tau_ff})
      outgoing_.joints.row(row++).head(values->size()) = values->cast<float>().transpose();
    ::send(socket_, &outgoing_, sizeof outgoing_, MSG_DONTWAIT);
    const std::int64_t deadline_ns = clock_.now_ns() + kWait_ns;
    while (newest_.cycle != outgoing_.cycle) {
      const timespec left{.tv_sec = 0, .tv_nsec = std::max<std::int64_t>(deadline_ns - clock_.now_ns(), 0)};
      pollfd polled{.fd = socket_, .events = POLLIN, .revents = 0};
      if (ppoll(&polled, 1, &left, nullptr) <= 0) break;
      Answer heard;
      const bool whole = recv(socket_, &heard, sizeof heard, MSG_DONTWAIT) == sizeof heard;
      if (whole && outgoing_.cycle - heard.cycle < outgoing_.cycle - newest_.cycle) newest_ = heard;  // none of old
    }
    const std::uint32_t age = outgoing_.cycle - newest_.cycle;
    if (age > kFreshCycles) return age > kSilentCycles ? hal::BusStatus::kLost : hal::BusStatus::kStale;
    row = 0;
    for (JointVector* values : {&state.q, &state.dq, &state.tau, &state.temperature_degC})
      *values = newest_.joints.row(row++).head(joints_).transpose().cast<double>();
    const Eigen::Matrix<double, 10, 1> imu = newest_.imu.cast<double>();
    state.gyro_rad_s = imu.head<3>();
    state.acceleration_m_s2 = imu.segment<3>(3);
    state.orientation_WI = Eigen::Quaterniond(imu[6], imu[7], imu[8], imu[9]);
    state.bus_sample = newest_.cycle;
    return hal::BusStatus::kOk;
  }

  const io::Clock& clock_;
  hal::OptionValues options_;
  int joints_, socket_ = -1;
  sockaddr_in board_{};
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
